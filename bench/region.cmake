add_executable(region_bench programs/region_bench.cpp)
target_link_libraries(region_bench PRIVATE cairn::voxelizer cairn::scenes cairn::gl fmt::fmt)
cairn_options(region_bench)
