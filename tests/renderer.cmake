add_executable(renderer_test renderer_test.cpp march_twin.h march_twin.cpp test_scenes.h test_scenes.cpp)
target_link_libraries(renderer_test PRIVATE cairn::renderer cairn::reference GTest::gtest_main fmt::fmt)
cairn_options(renderer_test)
gtest_discover_tests(renderer_test DISCOVERY_TIMEOUT 60 PROPERTIES TIMEOUT 120)
