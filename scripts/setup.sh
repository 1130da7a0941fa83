#!/usr/bin/env bash
# Installs what is missing of scripts/packages.sh, after saying so. When nothing is missing it only asks dpkg, and ends.
#
#   scripts/setup.sh [--all]      to build everything, to run every test and every chart
#   scripts/setup.sh --run-only   for a picture: the command without windows
#   scripts/setup.sh --lint       for scripts/lint.sh
#   scripts/setup.sh --clang      for the presets of clang, and for fuzzing
#
# Several of them add up.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/packages.sh"

# Set by packages.sh, one list per purpose.
declare -a run_packages view_packages test_packages bench_packages lint_packages clang_packages optional_packages

packages=()
if (($# == 0)); then set -- --all; fi
for purpose in "$@"; do
  case $purpose in
    --run-only) packages+=("${run_packages[@]}") ;;
    --all) packages+=("${run_packages[@]}" "${view_packages[@]}" "${test_packages[@]}" "${bench_packages[@]}") ;;
    # clang-tidy reads what all of the code includes.
    --lint) packages+=("${run_packages[@]}" "${view_packages[@]}" "${test_packages[@]}" "${bench_packages[@]}"
      "${lint_packages[@]}") ;;
    --clang) packages+=("${run_packages[@]}" "${clang_packages[@]}") ;;
    *)
      echo "error: setup.sh does not know \"$purpose\"" >&2
      echo "  it takes --all, --run-only, --lint and --clang" >&2
      exit 2
      ;;
  esac
done
mapfile -t packages < <(printf '%s\n' "${packages[@]}" | sort -u)

if ! command -v apt-get > /dev/null || ! command -v dpkg-query > /dev/null; then
  {
    echo "error: there is no apt-get here, so nothing was installed"
    echo "  Cairn is built on Debian 12 and Ubuntu 24.04. Elsewhere, install what these packages hold, and build by hand"
    echo "  (cmake --preset release && cmake --build --preset release):"
    printf '%s\n' "${packages[@]}" "${optional_packages[@]}" | sed 's/^/    /'
  } >&2
  exit 1
fi

# Of the packages named, those that are not installed.
missing_of() {
  # dpkg-query complains about, and fails for, packages that it has never heard of: those are missing too.
  local installed
  installed=$(dpkg-query --show --showformat='${db:Status-Status} ${Package}\n' "$@" 2> /dev/null |
    sed -n 's/^installed //p' || true)
  comm -23 <(printf '%s\n' "$@" | sort -u) <(sort -u <<< "$installed")
}

can_install() { apt-get install --simulate --no-install-recommends "$@" > /dev/null 2>&1; }

as_root() {
  if ((EUID == 0)); then
    "$@"
  elif command -v sudo > /dev/null; then
    sudo "$@"
  else
    echo "error: installing needs root, and there is no sudo; as root, run: $*" >&2
    exit 1
  fi
}

mapfile -t missing < <(missing_of "${packages[@]}")
mapfile -t wanted < <(missing_of "${optional_packages[@]}")

if ((${#missing[@]} > 0)); then
  echo "will be installed by apt-get, with what they depend on: ${missing[*]}"
  as_root apt-get update -q
fi
if ((${#wanted[@]} > 0)); then
  if can_install "${missing[@]}" "${wanted[@]}"; then
    echo "will be installed by apt-get, as this distribution has it: ${wanted[*]}"
    missing+=("${wanted[@]}")
  else
    echo "left out, as this distribution does not have it: ${wanted[*]}"
  fi
fi
if ((${#missing[@]} == 0)); then
  echo "every package that is needed is installed"
  exit 0
fi
as_root env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "${missing[@]}"
