#!/usr/bin/env bash
# One stage of what runs before a change is taken. .ci/run and .github/workflows/ci.yml call the same stages.
#
#   scripts/ci.sh lint    scripts/lint.sh on everything
#   scripts/ci.sh quick   the same, with clang-tidy only on what differs from main: the whole takes it 20 minutes on 2 cores
#   scripts/ci.sh test    every test, in release, with warnings as errors
#   scripts/ci.sh clang   the same, built by clang
#   scripts/ci.sh asan    under the address and undefined-behaviour sanitizers: the tests that draw no long frames
#   scripts/ci.sh fuzz    each fuzzer for a minute
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# Whoever owns the clone: git may read it here.
export GIT_CONFIG_COUNT=1 GIT_CONFIG_KEY_0=safe.directory GIT_CONFIG_VALUE_0=$PWD

case ${1:-} in
  lint)
    scripts/setup.sh --lint
    scripts/lint.sh
    ;;
  quick)
    scripts/setup.sh --lint
    scripts/lint.sh format scripts spelling
    scripts/lint.sh --changed tidy
    ;;
  test) scripts/test.sh --preset ci ;;
  clang)
    scripts/setup.sh --clang
    scripts/test.sh --preset ci-clang
    ;;
  asan) scripts/test.sh --preset asan-short ;;
  fuzz)
    scripts/setup.sh --clang
    scripts/fuzz.sh 60
    ;;
  *)
    echo "error: \"${1:-}\" is no stage of ci.sh: lint, quick, test, clang, asan, fuzz" >&2
    exit 2
    ;;
esac
