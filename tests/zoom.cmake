cairn_test(zoom_test SOURCES zoom_test.cpp gl_fixture.h LIBRARIES cairn::renderer fmt::fmt TIMEOUT 180)
cairn_test(zoom_rays_test
  SOURCES zoom_rays_test.cpp gl_fixture.h exact_rays.h exact_rays.cpp probe.h probe.cpp
  LIBRARIES cairn::renderer fmt::fmt TIMEOUT 180)
cairn_test(app_zoom_test
  SOURCES app_zoom_test.cpp command.h command.cpp scratch_folder.h
  LIBRARIES cairn::base nlohmann_json::nlohmann_json fmt::fmt
  DEFINITIONS CAIRN_COMMAND="$<TARGET_FILE:cairn_app>")
add_dependencies(app_zoom_test cairn_app)
