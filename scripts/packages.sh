# The one list of what Cairn needs from Debian 12 or Ubuntu 24.04. Sourced by setup.sh; it only sets two arrays.
# shellcheck shell=bash disable=SC2034

packages=(
  # to build
  g++ cmake ninja-build pkg-config python3-glad
  # linked, or compiled in
  libglm-dev libfmt-dev libglfw3-dev libegl-dev libtinygltf-dev libstb-dev nlohmann-json3-dev
  libdraco-dev libmeshoptimizer-dev zlib1g-dev libembree-dev libtbb-dev libxxhash-dev libcli11-dev libimgui-dev
  # opened when the program runs: OpenGL without a GPU and without a display
  libegl1 libgl1-mesa-dri
  # to test, and to have something to show
  libgtest-dev libgmp-dev glslang-tools xvfb xdotool assimp-testmodels
  # to read back, in tests, the voxel files that are written
  python3-numpy python3-openvdb libopenvdb-tools goxel
  # to measure: peers, and what draws the charts
  libopenvdb-dev libnanovdb-dev libboost-dev gnuplot-nox
)

# Mesa 25.1 ended OSMesa, so a newer distribution may lack it; EGL then takes its place.
optional_packages=(libosmesa6)
