# The OpenGL layer, and every shader.
find_library(OSMESA_LIBRARY NAMES OSMesa libOSMesa.so.8 libOSMesa.so.6)
find_program(GLSLANG_VALIDATOR glslangValidator REQUIRED)
find_program(XVFB Xvfb)

set(gl_definitions "")
if(OSMESA_LIBRARY)
  list(APPEND gl_definitions CAIRN_HAS_OSMESA)
endif()
cairn_test(gl_test SOURCES gl_test.cpp gl_fixture.h scratch_folder.h LIBRARIES cairn::gl fmt::fmt
           DEFINITIONS ${gl_definitions})
cairn_test(shaders_test SOURCES shaders_test.cpp gl_fixture.h scratch_folder.h LIBRARIES cairn::gl cairn::shaders fmt::fmt
           DEFINITIONS CAIRN_GLSLANG_VALIDATOR="${GLSLANG_VALIDATOR}" CAIRN_SHADER_DIR="${PROJECT_SOURCE_DIR}/shaders")

# Windows need a display, so a virtual one is started for them; the program runs as one test.
if(XVFB)
  add_executable(window_test window_test.cpp)
  target_link_libraries(window_test PRIVATE cairn::window GTest::gtest_main)
  cairn_options(window_test)
  add_test(NAME Window COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/with_xvfb.sh $<TARGET_FILE:window_test>)
  # GLX unloads its driver before the end, so a leak check cannot tell its leftovers from ours.
  set_tests_properties(Window PROPERTIES TIMEOUT 60 ENVIRONMENT ASAN_OPTIONS=detect_leaks=0)
endif()
