#!/usr/bin/env bash
# Installs what is missing, builds everything and runs every test.
#
#   scripts/test.sh [--preset NAME] [arguments of ctest]
#   scripts/test.sh -R Builtin
#
# Tests on real scenes run where there are some: in the folder that the environment variable CAIRN_SCENE_DATA names, or in
# ../shared/data.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

preset="test"
if [[ ${1:-} == --preset ]]; then
  preset=${2:?"--preset takes the name of a preset of CMakePresets.json"}
  shift 2
fi

# The tests run without a display, also where there is one.
unset DISPLAY WAYLAND_DISPLAY

if [[ -z ${CAIRN_SCENE_DATA+set} && -d ../shared/data ]]; then
  CAIRN_SCENE_DATA=$(cd ../shared/data && pwd)
fi
export CAIRN_SCENE_DATA=${CAIRN_SCENE_DATA:-}

scripts/setup.sh --all
cmake --preset "$preset"
cmake --build --preset "$preset"
# One more than there are cores: a test waits for its driver a quarter of its time.
ctest --preset "$preset" -j"$(($(nproc) + 1))" "$@"
