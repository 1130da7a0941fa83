add_executable(voxelize_bench voxelize_bench.cpp)
target_link_libraries(voxelize_bench PRIVATE cairn::voxelizer cairn::scenes cairn::gl fmt::fmt)
cairn_options(voxelize_bench)
