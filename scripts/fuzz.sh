#!/usr/bin/env bash
# Builds the fuzzers by clang, and runs each for some seconds from the seeds in fuzz/corpus.
#
#   scripts/fuzz.sh [SECONDS [TARGET ...]]   60 seconds each of gltf, volume, uri, options and transfer
#
# Files that once went wrong are seeds too, where they lie beside the scenes: in ../cases of the folder that the environment
# variable CAIRN_SCENE_DATA names, or in ../shared/cases.
#
# What it learns stays in build/fuzz/corpus. An input that breaks something is kept in build/fuzz/found: mend the fault, and
# move the input to fuzz/corpus, where the tests run it.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

seconds=${1:-60}
shift || true
if [[ ! $seconds =~ ^[0-9]+$ ]]; then
  echo "error: \"$seconds\" is no number of seconds" >&2
  exit 2
fi
targets=("$@")
if ((${#targets[@]} == 0)); then targets=(gltf volume uri options transfer); fi

cmake --preset fuzz
cmake --build --preset fuzz --target "${targets[@]/%/_fuzz}"

cases=${CAIRN_SCENE_DATA:-../shared/data}/../cases
seeds_of() {
  echo "$PWD/fuzz/corpus/$1"
  case $1 in
    gltf) folders=(voxelize hostile pictures) ;;
    volume) folders=(hostile pictures) ;;
    *) folders=() ;;
  esac
  for folder in "${folders[@]}"; do
    if [[ -d $cases/$folder ]]; then (cd "$cases/$folder" && pwd); fi
  done
}

failed=()
for target in "${targets[@]}"; do
  echo "== fuzz: $target, $seconds s"
  mkdir -p "build/fuzz/corpus/$target" build/fuzz/found
  mapfile -t seeds < <(seeds_of "$target")
  # A file of some KB may ask for no more than this much memory and time. Whole paths, because a fuzzer may go to a folder
  # of its own.
  if ! "build/fuzz/fuzz/${target}_fuzz" -max_total_time="$seconds" -timeout=20 -rss_limit_mb=2048 -max_len=16384 \
    -print_final_stats=1 -artifact_prefix="$PWD/build/fuzz/found/$target-" "$PWD/build/fuzz/corpus/$target" \
    "${seeds[@]}" 2> "build/fuzz/$target.log"; then
    failed+=("$target")
    tail -n 60 "build/fuzz/$target.log"
  fi
  grep -E '^stat::(number_of_executed_units|new_units_added|peak_rss_mb)' "build/fuzz/$target.log" || true
done
if ((${#failed[@]} > 0)); then
  echo "fuzzers found faults: ${failed[*]}; their inputs are in build/fuzz/found" >&2
  exit 1
fi
