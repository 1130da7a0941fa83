# The explorer: without a window, and on a virtual display with real keys and a real mouse.
find_package(nlohmann_json REQUIRED)
find_program(XVFB Xvfb)
find_program(XDOTOOL xdotool)

cairn_test(viewer_test SOURCES viewer_test.cpp gl_fixture.h LIBRARIES cairn_viewer cairn::renderer fmt::fmt TIMEOUT 120)
if(XVFB AND XDOTOOL)
  add_executable(view_window_test view_window_test.cpp scratch_folder.h)
  target_link_libraries(view_window_test PRIVATE cairn::base nlohmann_json::nlohmann_json fmt::fmt GTest::gtest_main)
  target_compile_definitions(view_window_test PRIVATE CAIRN_COMMAND="$<TARGET_FILE:cairn_app>")
  cairn_options(view_window_test)
  add_dependencies(view_window_test cairn_app)
  add_test(NAME View COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/with_xvfb.sh $<TARGET_FILE:view_window_test>)
  # GLX unloads its driver before the end, so a leak check cannot tell its leftovers from ours.
  set_tests_properties(View PROPERTIES TIMEOUT 180 ENVIRONMENT ASAN_OPTIONS=detect_leaks=0)
endif()
