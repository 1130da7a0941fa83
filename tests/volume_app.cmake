# Volumes on the command line.
find_package(nlohmann_json REQUIRED)
cairn_test(volume_app_test
  SOURCES app_volume_test.cpp command.h command.cpp scratch_folder.h
  LIBRARIES cairn::base nlohmann_json::nlohmann_json fmt::fmt
  DEFINITIONS CAIRN_COMMAND="$<TARGET_FILE:cairn_app>"
  TIMEOUT 120)
add_dependencies(volume_app_test cairn_app)
