# The built-in scenes and the .glb writer: CPU only.
add_executable(builtin_test builtin_test.cpp)
target_link_libraries(builtin_test PRIVATE cairn::scenes GTest::gtest_main)
cairn_options(builtin_test)
gtest_discover_tests(builtin_test)
