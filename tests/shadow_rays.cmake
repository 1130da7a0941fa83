# Shadow rays to lights with an extent, and the command that compares shadows.
find_package(nlohmann_json REQUIRED)
cairn_test(shadow_rays_test
  SOURCES shadow_rays_test.cpp gl_fixture.h mesh_rays.h test_scenes.h test_scenes.cpp
  LIBRARIES cairn::renderer fmt::fmt
  TIMEOUT 120)
cairn_test(app_shadow_test
  SOURCES app_shadow_test.cpp command.h command.cpp scratch_folder.h
  LIBRARIES cairn::base nlohmann_json::nlohmann_json fmt::fmt
  DEFINITIONS CAIRN_COMMAND="$<TARGET_FILE:cairn_app>"
  TIMEOUT 120)
add_dependencies(app_shadow_test cairn_app)
