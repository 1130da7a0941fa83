# The one list of what Cairn needs from Debian 12 or Ubuntu 24.04, by what it is needed for. Sourced by setup.sh; it only
# sets arrays.
# shellcheck shell=bash disable=SC2034

# For a picture: to build the libraries and the command, and to run it without a GPU and without a display.
run_packages=(
  g++ cmake ninja-build python3-glad
  libglm-dev libfmt-dev libegl-dev libtinygltf-dev libstb-dev nlohmann-json3-dev libdraco-dev libmeshoptimizer-dev
  zlib1g-dev libembree-dev libtbb-dev libxxhash-dev libcli11-dev
  libegl1 libgl1-mesa-dri
  # a scene to show
  assimp-testmodels
)

# Mesa 25.1 ended OSMesa, so a newer distribution may lack it; EGL then takes its place.
optional_packages=(libosmesa6)

# `cairn view`
view_packages=(libglfw3-dev libimgui-dev pkg-config)

test_packages=(
  libgtest-dev libgmp-dev pkg-config glslang-tools xvfb xdotool
  # the example inside_gl, with libglfw3-dev
  libopengl-dev
  # to read back the voxel files that are written
  python3-numpy python3-openvdb libopenvdb-tools goxel
)

# To measure: peers, and what draws the charts.
bench_packages=(libopenvdb-dev libnanovdb-dev libboost-dev gnuplot-nox)

# A second compiler, with its sanitizers and libFuzzer.
clang_packages=(clang libclang-rt-dev)

# scripts/lint.sh
lint_packages=(clang clang-format clang-tidy shellcheck codespell git)
