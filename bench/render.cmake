add_executable(render_bench render_bench.cpp)
target_link_libraries(render_bench PRIVATE cairn::renderer cairn::reference fmt::fmt)
cairn_options(render_bench)
