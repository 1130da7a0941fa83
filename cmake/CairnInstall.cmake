# Installs the command, the libraries, and what find_package(cairn) reads. Headers: cmake/PublicHeaders.cmake.
include(CMakePackageConfigHelpers)

set(cairn_config_dir "${CMAKE_INSTALL_LIBDIR}/cmake/cairn")
get_property(cairn_libraries GLOBAL PROPERTY CAIRN_LIBRARIES)

if(CAIRN_APP)
  install(TARGETS cairn_app RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  if(TARGET cairn_bench_app)
    install(TARGETS cairn_bench_app RUNTIME DESTINATION ${CMAKE_INSTALL_LIBEXECDIR})
  endif()
endif()
install(TARGETS ${cairn_libraries} EXPORT cairnTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT cairnTargets NAMESPACE cairn:: DESTINATION ${cairn_config_dir})

install(FILES LICENSE README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR})

# A static library needs at its user's place all that it links, private or not. So the packages to find there follow
# from what the libraries link: an imported target, and the package that has it.
set(package_of_fmt::fmt fmt)
set(package_of_fmt::fmt-header-only fmt)
set(package_of_glm::glm glm)
set(package_of_glfw glfw3)
set(package_of_Threads::Threads Threads)
set(package_of_draco::draco draco)
set(package_of_meshoptimizer::meshoptimizer meshoptimizer)
set(package_of_embree embree)
set(package_of_TBB::tbb TBB)
set(package_of_nlohmann_json::nlohmann_json nlohmann_json)
set(package_of_ZLIB::ZLIB ZLIB)

set(packages "")
foreach(library IN LISTS cairn_libraries)
  get_target_property(links ${library} LINK_LIBRARIES)
  foreach(link IN LISTS links)
    if(DEFINED package_of_${link})
      list(APPEND packages "${package_of_${link}}")
    elseif(link MATCHES "::" AND NOT link MATCHES "^cairn::")
      message(FATAL_ERROR "${library} links ${link}: add the package that has it to cmake/CairnInstall.cmake")
    endif()
  endforeach()
endforeach()
list(REMOVE_DUPLICATES packages)
set(cairn_dependencies "")
foreach(package IN LISTS packages)
  string(APPEND cairn_dependencies "find_dependency(${package})\n")
endforeach()

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/cairnConfig.cmake.in cairnConfig.cmake
                              INSTALL_DESTINATION ${cairn_config_dir})
write_basic_package_version_file(cairnConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/cairnConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/cairnConfigVersion.cmake
        DESTINATION ${cairn_config_dir})
