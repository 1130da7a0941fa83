#!/usr/bin/env bash
# From a bare clone to a picture: installs what is missing, builds the command, renders a real scene to out/demo.png.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

scene=/usr/share/assimp/models/glTF2/2CylinderEngine-glTF-Binary/2CylinderEngine.glb
picture=out/demo.png
report=""

# stage NAME COMMAND...: runs the command and notes how long it took.
stage() {
  local name=$1 start=$SECONDS
  shift
  echo "== $name"
  "$@"
  report+=$(printf '  %-10s %4d s' "$name" $((SECONDS - start)))$'\n'
}

build() {
  cmake --preset run-only
  cmake --build --preset run-only --target cairn_app
}

render() {
  mkdir -p "$(dirname "$picture")"
  build/run-only/app/cairn render "$scene" --size 1024x768 --shadow hard -o "$picture"
}

stage packages scripts/setup.sh --run-only
stage build build
stage render render
printf '\nThe picture is %s\n%s' "$PWD/$picture" "$report"
