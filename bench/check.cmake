# The command checks itself on every scene there is.
if(TARGET cairn_app)
  find_package(nlohmann_json REQUIRED)
  add_executable(check_scenes programs/check_scenes.cpp)
  target_link_libraries(check_scenes PRIVATE cairn::scenes fmt::fmt nlohmann_json::nlohmann_json)
  target_compile_definitions(check_scenes PRIVATE CAIRN_COMMAND="$<TARGET_FILE:cairn_app>")
  add_dependencies(check_scenes cairn_app)
  cairn_options(check_scenes)
endif()
