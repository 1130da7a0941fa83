#!/usr/bin/env bash
# .ci/run with stages that only say what real ones would: it must run them all, and count what failed.
#   ci_run_test.sh CI_RUN
set -euo pipefail
run=$1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat > "$folder/ci.sh" << 'STAGES'
#!/usr/bin/env bash
case $1 in
  quiet) ;;
  faulty) exit 1 ;;
  tests) echo "100% tests passed, 0 tests failed out of 40" ;;
  broken) echo "90% tests passed, 1 tests failed out of 10"; exit 8 ;;
  unclean) echo "100% tests passed, 0 tests failed out of 5"; exit 1 ;;
esac
STAGES
chmod +x "$folder/ci.sh"

failures=0
# expect STATUS LAST_LINE STAGES...
expect() {
  local wanted=$1 line=$2 status=0 words
  shift 2
  words=$(CAIRN_CI=$folder/ci.sh "$run" "$@") || status=$?
  if [[ $status != "$wanted" || $(tail -n 1 <<< "$words") != "$line" ]]; then
    printf '%s: expected status %s and "%s", got %s:\n%s\n' "$*" "$wanted" "$line" "$status" "$words"
    failures=$((failures + 1))
  fi
}
expect 0 "41 passed, 0 failed" quiet tests
expect 1 "40 passed, 1 failed" faulty tests
expect 1 "50 passed, 2 failed" broken tests faulty quiet
expect 1 "4 passed, 1 failed" unclean
exit "$failures"
