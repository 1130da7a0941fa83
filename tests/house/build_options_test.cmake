# cmake -DSOURCE=… -DSCRATCH=… -DGENERATOR=… -DMAKE_PROGRAM=… -DCXX=… -DC=… -P build_options_test.cmake
# Configures Cairn without parts of it, where what only those need cannot be found, and reads what Ninja is told to build.

set(failures "")

# configure(NAME SOURCE_FOLDER options...): into ${SCRATCH}/NAME.
function(configure name source)
  file(REMOVE_RECURSE "${SCRATCH}/${name}")
  execute_process(
    COMMAND ${CMAKE_COMMAND} -S ${source} -B ${SCRATCH}/${name} -G ${GENERATOR} -DCMAKE_MAKE_PROGRAM=${MAKE_PROGRAM}
            -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_C_COMPILER=${C} -DCAIRN_SCENE_DATA= ${ARGN}
    RESULT_VARIABLE result OUTPUT_VARIABLE words ERROR_VARIABLE words)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${name} does not configure:\n${words}")
  endif()
  file(READ ${SCRATCH}/${name}/build.ninja plan)
  set(plan "${plan}" PARENT_SCOPE)
  set(words "${words}" PARENT_SCOPE)
endfunction()

# plan_has(PATTERN TRUE|FALSE): whether a file of that name is part of the build.
function(plan_has pattern expected)
  set(found FALSE)
  if(plan MATCHES "${pattern}")
    set(found TRUE)
  endif()
  if(NOT found STREQUAL expected)
    message(FATAL_ERROR "${name}: the build has ${pattern}: ${found}, expected ${expected}")
  endif()
endfunction()

set(no_windows -DCMAKE_DISABLE_FIND_PACKAGE_glfw3=ON)
set(no_pkg_config -DCMAKE_DISABLE_FIND_PACKAGE_PkgConfig=ON)  # what finds Dear ImGui, and GMP for tests
set(no_tests -DCMAKE_DISABLE_FIND_PACKAGE_GTest=ON)
set(no_command -DCMAKE_DISABLE_FIND_PACKAGE_CLI11=ON)
set(no_bench -DCMAKE_DISABLE_FIND_PACKAGE_Imath=ON)

# The command without windows, as scripts/demo.sh builds it.
set(name run_only)
configure(run_only ${SOURCE} -DCAIRN_VIEWER=OFF -DCAIRN_TESTS=OFF -DCAIRN_BENCH=OFF ${no_windows} ${no_pkg_config} ${no_tests} ${no_bench})
plan_has("verb_view_absent\\.cpp" TRUE)
plan_has("verb_render\\.cpp" TRUE)
plan_has("gl/window\\.cpp|verb_view\\.cpp|overlay\\.cpp|glfw|imgui" FALSE)
plan_has("_test\\.cpp" FALSE)
plan_has("bench/charts" FALSE)
plan_has("inside_gl" FALSE)
if(NOT words MATCHES "inside_gl is left out")
  message(FATAL_ERROR "CMake does not say that the example inside_gl is left out:\n${words}")
endif()
# What stands in for `cairn view` compiles.
execute_process(COMMAND ${MAKE_PROGRAM} -C ${SCRATCH}/run_only app/CMakeFiles/cairn_command.dir/verbs/verb_view_absent.cpp.o
                RESULT_VARIABLE result OUTPUT_VARIABLE words ERROR_VARIABLE words)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "verb_view_absent.cpp does not compile:\n${words}")
endif()

# Tests of the libraries alone.
set(name no_app)
configure(no_app ${SOURCE} -DCAIRN_APP=OFF -DCAIRN_VIEWER=OFF ${no_windows} ${no_command})
plan_has("tests/scenes/load_test\\.cpp" TRUE)
plan_has("real_scenes_test\\.cpp" FALSE)  # there is no CAIRN_SCENE_DATA
plan_has("cairn_bench" TRUE)
plan_has("glfw|imgui" FALSE)
plan_has("verb_render\\.cpp|app/usage_test\\.cpp" FALSE)

# Part of somebody else's build: the libraries, and nothing that was not asked for.
set(name part)
file(WRITE ${SCRATCH}/outer/CMakeLists.txt
     "cmake_minimum_required(VERSION 3.25)\nproject(outer C CXX)\nadd_subdirectory(${SOURCE} cairn)\n")
configure(part ${SCRATCH}/outer ${no_windows} ${no_pkg_config} ${no_tests} ${no_command} ${no_bench})
plan_has("renderer/renderer\\.cpp" TRUE)
plan_has("cairn_app|cairn_command|cairn_bench|_test\\.cpp|gl/window\\.cpp" FALSE)
