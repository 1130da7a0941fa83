# cairn_library(NAME SOURCES a.cpp b.h ... [PUBLIC targets ...] [PRIVATE targets ...])
#
# One static library a folder: cairn_NAME, called cairn::NAME by those who link it.
# The project's own sources include headers from its root ("voxelizer/grid.h"). Who links a library sees the public ones
# alone, as <cairn/voxelizer/grid.h>, from a build tree and from an installed prefix alike (cmake/PublicHeaders.cmake).
#
# cairn_options(TARGET): what every target of the project compiles with.
#
# cairn_compile_alone(FILES): sources that a unity build does not join with their neighbours, because both have a name of
# their own, in an unnamed namespace, that is spelled alike.
function(cairn_options target)
  target_include_directories(${target} BEFORE PRIVATE ${PROJECT_SOURCE_DIR})
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor)
  if(CMAKE_UNITY_BUILD)
    # Of one source, another's unnamed namespace is global, and outside the main file. A build without unity warns of both.
    target_compile_options(${target} PRIVATE -Wno-shadow $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
  endif()
  # gcc 12 takes the copy within std::string's operator+ for one that overlaps (gcc bug 105329).
  target_compile_options(${target} PRIVATE $<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>>:-Wno-restrict>)
  # The lattice of the voxelizer is defined by IEEE operations done one by one: a fused multiply-add rounds otherwise.
  target_compile_options(${target} PRIVATE -ffp-contract=off)
  if(CAIRN_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(CAIRN_COVERAGE)
    target_compile_options(${target} PUBLIC --coverage -fprofile-update=atomic)
    target_link_options(${target} PUBLIC --coverage)
  endif()
  if(CAIRN_FUZZ)
    target_compile_options(${target} PRIVATE -fsanitize=fuzzer-no-link)
  endif()
  cairn_sanitize(${target})
endfunction()

function(cairn_compile_alone)
  set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()

function(cairn_sanitize target)
  if(CAIRN_SANITIZE STREQUAL "")
    return()
  elseif(CAIRN_SANITIZE STREQUAL "address")
    set(sanitizers -fsanitize=address,undefined)
    target_compile_options(${target} PUBLIC -fno-sanitize-recover=undefined)
  elseif(CAIRN_SANITIZE STREQUAL "thread")
    set(sanitizers -fsanitize=thread)
  else()
    message(FATAL_ERROR "CAIRN_SANITIZE is \"${CAIRN_SANITIZE}\": it may be empty, address or thread")
  endif()
  target_compile_options(${target} PUBLIC ${sanitizers} -fno-omit-frame-pointer)
  # Under sanitizers gcc takes members of std::function, as in std::regex, for uninitialized (gcc bug 105562).
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  target_link_options(${target} PUBLIC ${sanitizers})
  get_target_property(type ${target} TYPE)
  if(type STREQUAL "EXECUTABLE")
    target_sources(${target} PRIVATE ${PROJECT_SOURCE_DIR}/cmake/sanitizer_defaults.cpp)
    target_link_libraries(${target} PRIVATE ${CMAKE_DL_LIBS})
  endif()
endfunction()

function(cairn_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  set(target cairn_${name})
  add_library(${target} STATIC ${ARG_SOURCES})
  add_library(cairn::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON)
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  add_dependencies(${target} cairn_headers)
  target_link_libraries(${target} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
  cairn_options(${target})
  set_property(GLOBAL APPEND PROPERTY CAIRN_LIBRARIES ${target})
endfunction()
