#!/usr/bin/env bash
# scripts/release.sh on small trees that agree, and on such as do not.
#   release_test.sh RELEASE_SCRIPT
set -euo pipefail
script=$1
root=$(mktemp -d)
trap 'rm -rf "$root"' EXIT

# No settings of the user's, and a name for commits.
export GIT_CONFIG_GLOBAL=/dev/null GIT_CONFIG_NOSYSTEM=1
export GIT_AUTHOR_NAME=test GIT_AUTHOR_EMAIL=test@example.org GIT_COMMITTER_NAME=test GIT_COMMITTER_EMAIL=test@example.org

# A tree of version 1.2.3 in which everything agrees.
make_tree() {
  rm -rf "$root/tree"
  mkdir -p "$root/tree/scripts"
  cd "$root/tree"
  cp "$script" scripts/release.sh
  echo 'project(cairn VERSION 1.2.3 LANGUAGES CXX)' > CMakeLists.txt
  printf '# Changelog\n\n## [Unreleased]\n\n## [1.2.3] - 2024-02-29\n\n### Added\n- All.\n\n## [1.2.2] - 2023-01-01\n' \
    > CHANGELOG.md
  printf 'cff-version: 1.2.0\nversion: 1.2.3\ndate-released: 2024-02-29\n' > CITATION.cff
  git init -q .
  git add -A
  git commit -q -m first
}

failures=0
# expect STATUS TEXT ARGUMENTS...: release.sh ends with this status, and its words hold the text.
expect() {
  local wanted=$1 text=$2 status=0 words
  shift 2
  words=$(scripts/release.sh "$@" 2>&1) || status=$?
  if [[ $status != "$wanted" || $words != *"$text"* ]]; then
    printf 'line %s: expected status %s and "%s", got %s:\n%s\n' "${BASH_LINENO[0]}" "$wanted" "$text" "$status" "$words"
    failures=$((failures + 1))
  fi
}

make_tree
expect 0 "scripts/release.sh --tag"
expect 2 "takes --tag" --push
if [[ -n $(git tag) ]]; then echo "a check has tagged" && failures=$((failures + 1)); fi
expect 0 "tagged v1.2.3" --tag
expect 0 "this commit is v1.2.3"
git commit -q --allow-empty -m second
expect 1 "v1.2.3 is another commit"

make_tree
git tag v1.3.0
expect 1 "v1.3.0 is newer than v1.2.3"
git tag -d v1.3.0 > /dev/null
git tag v1.2.2
expect 0 "agree"
touch new
expect 1 "the work tree differs" --tag

make_tree
sed -i 's/1\.2\.3/1.2.4/' CMakeLists.txt
expect 1 'CHANGELOG.md: its newest section is "1.2.3"'
expect 1 'CITATION.cff: version is "1.2.3"'

make_tree
sed -i 's/ - 2024-02-29//' CHANGELOG.md
expect 1 "has no date"

make_tree
sed -i 's/2024-02-29/2024-02-30/' CHANGELOG.md CITATION.cff
expect 1 "2024-02-30 is no day"

make_tree
sed -i 's/2024-02-29/2024-03-01/' CITATION.cff
expect 1 'date-released is "2024-03-01"'

make_tree
sed -i 's/^## \[Unreleased\]$/&\n\n- One more./' CHANGELOG.md
expect 1 "under [Unreleased]"

make_tree
rm CITATION.cff
expect 1 "CITATION.cff: version is \"none\""

exit "$failures"
