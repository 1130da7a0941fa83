# Shadow rays through the xy-reduced pyramid.
cairn_test(columns_test
  SOURCES columns_test.cpp gl_fixture.h
  LIBRARIES cairn::renderer fmt::fmt
  TIMEOUT 120)
cairn_test(pyramid_shadow_test
  SOURCES pyramid_shadow_test.cpp moving_scenes.h moving_scenes.cpp test_scenes.h test_scenes.cpp mesh_rays.h gl_fixture.h
  LIBRARIES cairn::renderer cairn::reference cairn::scenes fmt::fmt
  TIMEOUT 180)
find_package(nlohmann_json REQUIRED)
set(app_pyramid_definitions CAIRN_COMMAND="$<TARGET_FILE:cairn_app>")
if(CAIRN_BENCH)
  list(APPEND app_pyramid_definitions CAIRN_BENCH)
endif()
cairn_test(app_pyramid_test
  SOURCES app_pyramid_test.cpp command.h command.cpp scratch_folder.h
  LIBRARIES cairn::base nlohmann_json::nlohmann_json fmt::fmt
  DEFINITIONS ${app_pyramid_definitions}
  TIMEOUT 180)
add_dependencies(app_pyramid_test cairn_app)
cairn_test(ground_test SOURCES ground_test.cpp LIBRARIES cairn::scenes)
