#!/usr/bin/env bash
# with_xvfb.sh COMMAND [ARGUMENT ...]: runs a command on a virtual display of its own, and answers with its exit code.
set -euo pipefail

scratch=$(mktemp -d)
server=
clean_up() {
  if [ -n "$server" ]; then
    # A server that ends removes the socket of its display, which by then may be that of another that has just started there.
    exec 9<"$0"
    flock 9
    kill "$server" 2>/dev/null || true
    wait "$server" 2>/dev/null || true
  fi
  rm -rf "$scratch"
}
trap clean_up EXIT

# Xvfb picks a free display by itself, and writes its number when it is ready. Two that start at once may pick the same, so
# they start one after the other.
exec 9<"$0"
flock 9
mkfifo "$scratch/display"
# Without -noreset the server starts anew when its last client leaves, and refuses a client that comes meanwhile: that of a
# command's next window.
Xvfb -noreset -displayfd 3 -screen 0 800x600x24 -nolisten tcp 3>"$scratch/display" 2>"$scratch/log" 9<&- &
server=$!
if ! read -r -t 30 number <"$scratch/display"; then
  echo "Xvfb did not start:" >&2
  cat "$scratch/log" >&2
  exit 1
fi

exec 9<&-

unset WAYLAND_DISPLAY
DISPLAY=":$number" "$@"
