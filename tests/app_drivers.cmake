# The command under every way to run the driver.
find_package(nlohmann_json REQUIRED)
cairn_test(app_drivers_test
  SOURCES app_drivers_test.cpp command.h command.cpp scratch_folder.h
  LIBRARIES cairn::base nlohmann_json::nlohmann_json fmt::fmt
  DEFINITIONS CAIRN_COMMAND="$<TARGET_FILE:cairn_app>")
add_dependencies(app_drivers_test cairn_app)
