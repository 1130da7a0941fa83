#!/usr/bin/env bash
# Installs what is missing, builds everything and runs every test. Arguments go to ctest: scripts/test.sh -R Builtin
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# The tests run without a display, also where there is one.
unset DISPLAY WAYLAND_DISPLAY

scripts/setup.sh
cmake --preset release
cmake --build --preset release
ctest --preset release -j2 "$@"
