# Reads the project's #includes; links nothing of it.
add_executable(include_arrows_test include_arrows_test.cpp)
target_link_libraries(include_arrows_test PRIVATE fmt::fmt GTest::gtest_main)
target_compile_definitions(include_arrows_test PRIVATE CAIRN_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
cairn_options(include_arrows_test)
gtest_discover_tests(include_arrows_test)
