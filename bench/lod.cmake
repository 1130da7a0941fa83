add_executable(lod_bench programs/lod_bench.cpp)
target_link_libraries(lod_bench PRIVATE cairn::renderer cairn::reference cairn::scenes cairn::gl fmt::fmt)
cairn_options(lod_bench)
