#!/usr/bin/env bash
# Checks that everything that names a version of Cairn names the same one: CMakeLists.txt, CHANGELOG.md, CITATION.cff, and
# the tags of git. Says what is left to do, and changes nothing.
#
#   scripts/release.sh          checks
#   scripts/release.sh --tag    checks, then tags this commit; pushing the tag is left to you
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

tag=false
case ${1:-} in
  "") ;;
  --tag) tag=true ;;
  *)
    echo "error: release.sh takes --tag or nothing" >&2
    exit 2
    ;;
esac

faults=()
fault() { faults+=("$1"); }

# The first match of a pattern's group in a file; nothing where there is none.
first() { sed -nE "s/$1/\\1/p" "$2" 2> /dev/null | head -n 1 || true; }

version=$(first '^project\(cairn VERSION ([0-9]+\.[0-9]+\.[0-9]+).*' CMakeLists.txt)
if [[ -z $version ]]; then
  echo "error: CMakeLists.txt names no version: project(cairn VERSION X.Y.Z" >&2
  exit 1
fi

# "## [0.2.0] - 2026-11-28"; above it may stand what is not released yet.
changed=$(first '^## \[([0-9]+\.[0-9]+\.[0-9]+)\].*' CHANGELOG.md)
date=$(first '^## \[[0-9.]+\] - ([0-9]{4}-[0-9]{2}-[0-9]{2})$' CHANGELOG.md)
if [[ $changed != "$version" ]]; then
  fault "CHANGELOG.md: its newest section is \"${changed:-none}\", CMakeLists.txt says $version"
elif ! grep -q -E "^## \[$version\] - [0-9]{4}-[0-9]{2}-[0-9]{2}$" CHANGELOG.md; then
  fault "CHANGELOG.md: the section of $version has no date: \"## [$version] - $(date +%F)\""
elif [[ $(date --date="$date" +%F 2> /dev/null) != "$date" ]]; then
  fault "CHANGELOG.md: $date is no day"
fi
# Between the heading of what is unreleased and the newest section nothing may stand.
unreleased=$(awk '/^## /{inside = /^## \[Unreleased\]/; next} inside && NF' CHANGELOG.md)
if [[ -n $unreleased ]]; then
  fault "CHANGELOG.md: changes stand under [Unreleased]; move them to the section of this version"
fi

cited=$(first '^version: *"?([^" ]+)"?$' CITATION.cff)
cited_date=$(first '^date-released: *"?([^" ]+)"?$' CITATION.cff)
if [[ $cited != "$version" ]]; then
  fault "CITATION.cff: version is \"${cited:-none}\", CMakeLists.txt says $version"
fi
if [[ $cited_date != "$date" ]]; then
  fault "CITATION.cff: date-released is \"${cited_date:-none}\", CHANGELOG.md says \"${date:-none}\""
fi

# A tag may be missing, newer than all others, or of this commit.
name=v$version
if tagged=$(git rev-parse --quiet --verify "refs/tags/$name^{commit}"); then
  if [[ $tagged != "$(git rev-parse HEAD)" ]]; then
    fault "git: $name is another commit already (${tagged:0:10}); raise the version"
  fi
else
  tagged=""
  newest=$(git tag --list 'v[0-9]*' | sort -V | tail -n 1)
  if [[ -n $newest && $(printf '%s\n' "$newest" "$name" | sort -V | tail -n 1) != "$name" ]]; then
    fault "git: $newest is newer than $name"
  fi
fi

if ((${#faults[@]} > 0)); then
  printf 'error: %s\n' "${faults[@]}" >&2
  exit 1
fi
echo "version $version of $date: CMakeLists.txt, CHANGELOG.md and CITATION.cff agree"
if [[ -n $tagged ]]; then
  echo "  this commit is $name; push it: git push origin $name"
elif ! $tag; then
  echo "  next: scripts/ci.sh test, then scripts/release.sh --tag"
elif [[ -n $(git status --porcelain) ]]; then
  echo "error: the work tree differs from the commit that would be tagged" >&2
  echo "  commit or stash, and try again" >&2
  exit 1
else
  git tag --annotate "$name" --message "Cairn $version"
  echo "  tagged $name; push it: git push origin $name"
fi
