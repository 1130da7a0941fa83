# Rasterized meshes, and their mix with voxels.
cairn_test(mesh_raster_test
  SOURCES mesh_raster_test.cpp mesh_rays.h gl_fixture.h test_scenes.h test_scenes.cpp
  LIBRARIES cairn::renderer cairn::reference fmt::fmt
  TIMEOUT 120)
cairn_test(mesh_mix_test
  SOURCES mesh_mix_test.cpp mesh_proxy_test.cpp mesh_mix_pictures.h mesh_rays.h gl_fixture.h test_scenes.h test_scenes.cpp
  LIBRARIES cairn::renderer cairn::reference fmt::fmt
  TIMEOUT 120)
find_package(nlohmann_json REQUIRED)
cairn_test(app_mesh_test
  SOURCES app_mesh_test.cpp command.h command.cpp scratch_folder.h
  LIBRARIES cairn::base nlohmann_json::nlohmann_json fmt::fmt
  DEFINITIONS CAIRN_COMMAND="$<TARGET_FILE:cairn_app>")
add_dependencies(app_mesh_test cairn_app)
