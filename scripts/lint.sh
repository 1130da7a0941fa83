#!/usr/bin/env bash
# Checks what machines can check: the form of C++ (clang-format), its habits (clang-tidy), scripts (shellcheck) and the
# spelling of words (codespell).
#
#   scripts/lint.sh                       every check on every file
#   scripts/lint.sh format spelling       these checks: format, tidy, scripts, spelling
#   scripts/lint.sh --changed             only files that differ from origin/main, or from main where there is no origin;
#                                         on main itself, from the commit before
#   scripts/lint.sh format FILE ...       only these files
#   scripts/lint.sh --fix                 formats, and mends what clang-tidy and codespell can mend
#
# Every check that was asked for runs, also after one has failed.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

if ! git rev-parse --is-inside-work-tree > /dev/null; then
  echo "error: lint.sh asks git for the files of the project, and git does not answer here" >&2
  exit 1
fi

fix=false
only_changed=false
checks=()
files=()
for argument in "$@"; do
  case $argument in
    --fix) fix=true ;;
    --changed) only_changed=true ;;
    format | tidy | scripts | spelling) checks+=("$argument") ;;
    *)
      if [[ ! -f $argument ]]; then
        echo "error: \"$argument\" is neither a file nor a check of lint.sh (format, tidy, scripts, spelling)" >&2
        exit 2
      fi
      files+=("$argument")
      ;;
  esac
done
if ((${#checks[@]} == 0)); then checks=(format tidy scripts spelling); fi

# need COMMAND: fails, with the way out, where it is not installed.
need() {
  if command -v "$1" > /dev/null; then return; fi
  echo "error: $1 is not installed" >&2
  echo "  scripts/setup.sh --lint installs what lint.sh needs" >&2
  return 1
}

# The files that git knows or that are new, and that still exist; or those that were asked for. Arguments are pathspecs.
listed() {
  local file
  {
    if ((${#files[@]} > 0)); then
      git ls-files --cached --others --exclude-standard -- "$@" | grep -Fx -f <(printf '%s\n' "${files[@]#./}") || true
    elif $only_changed; then
      local base=origin/main
      git rev-parse --quiet --verify "$base" > /dev/null || base=main
      # A clone without that much history: everything.
      if ! base=$(git merge-base "$base" HEAD 2> /dev/null); then base=$(git hash-object -t tree /dev/null); fi
      # On main itself: what its last commit, or last merge, brought.
      if [[ $base == "$(git rev-parse HEAD)" ]]; then base=$(git rev-parse --quiet --verify HEAD^ || echo "$base"); fi
      git diff --name-only "$base" -- "$@"
      git ls-files --others --exclude-standard -- "$@"
    else
      git ls-files --cached --others --exclude-standard -- "$@"
    fi
  } | sort -u | while read -r file; do
    if [[ -f $file ]]; then echo "$file"; fi
  done
}

# clang-format itself reads .clang-format-ignore from version 17 on only. Versions form code differently, so it must be 14.
format() {
  local tool=clang-format-14 pattern
  command -v "$tool" > /dev/null || tool=clang-format
  need "$tool" || return
  if [[ $("$tool" --version) != *" 14."* ]]; then
    echo "error: the code is formed by clang-format 14, and here is $("$tool" --version)" >&2
    echo "  install the package clang-format-14" >&2
    return 1
  fi
  local -a paths=('*.h' '*.cpp')
  while read -r pattern; do
    if [[ -n $pattern && $pattern != "#"* ]]; then paths+=(":(exclude,glob)$pattern"); fi
  done < .clang-format-ignore
  local -a how=(--dry-run --Werror)
  if $fix; then how=(-i); fi
  listed "${paths[@]}" | xargs --no-run-if-empty -d '\n' "$tool" "${how[@]}"
}

# tidy_file FILE OPTION...: what clang-tidy finds in one file, and nothing else: it also counts what it does not show.
tidy_file() {
  local file=$1 report status=0
  shift
  report=$(clang-tidy --quiet -p build/lint "$@" "$file" 2>&1) || status=$?
  grep -v -E '^[0-9]+ warnings? (and [0-9]+ errors? )?generated|^Suppressed |^Use -header-filter' <<< "$report" || true
  return "$status"
}
export -f tidy_file

# Reads the compile commands of a build folder of its own, of which nothing is compiled. Of headers, those are
# checked that the sources include. Tests are left to the compilers: GoogleTest's macros expand to what the rules forbid.
tidy() {
  need clang-tidy && need clang || return
  mkdir -p build/lint
  # Examples include the faces as an installation has them, which a build writes.
  if ! { cmake --preset lint && cmake --build build/lint --target cairn_headers; } > build/lint/configure.log 2>&1; then
    cat build/lint/configure.log >&2
    return 1
  fi
  local header
  {
    listed '*.cpp' ':(exclude)tests'
    # A header has no compile command: a source that includes it speaks for it.
    if $only_changed || ((${#files[@]} > 0)); then
      listed '*.h' ':(exclude)tests' | while read -r header; do
        git grep --untracked -l -F "#include \"$header\"" -- '*.cpp' ':(exclude)tests' | head -n 1 || true
      done
    fi
  } | sort -u > build/lint/files
  local -a how=()
  local processes
  processes=$(nproc)
  if $fix; then
    how=(--fix)
    processes=1
  fi
  # shellcheck disable=SC2016  # the inner shell expands these
  xargs --no-run-if-empty -d '\n' -n 1 -P "$processes" bash -c 'tidy_file "${@: -1}" "${@:1:$#-1}"' tidy "${how[@]}" \
    < build/lint/files
}

scripts() {
  need shellcheck || return
  {
    listed '*.sh'
    listed .ci/run
  } | xargs --no-run-if-empty -d '\n' shellcheck --external-sources --source-path=SCRIPTDIR
}

spelling() {
  need codespell || return
  local -a how=(--ignore-words=.codespell-ignore --quiet-level=2)
  if $fix; then how+=(--write-changes); fi
  listed . ':(exclude)LICENSE' ':(exclude)fuzz/corpus' ':(exclude)*.png' ':(exclude)*.csv' ':(exclude).codespell-ignore' |
    xargs --no-run-if-empty -d '\n' codespell "${how[@]}"
}

failed=()
for check in "${checks[@]}"; do
  echo "== lint: $check"
  if ! "$check"; then failed+=("$check"); fi
done
if ((${#failed[@]} > 0)); then
  echo "lint found faults: ${failed[*]}" >&2
  exit 1
fi
