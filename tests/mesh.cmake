# Rasterized meshes, and their mix with voxels.
cairn_test(mesh_raster_test
  SOURCES mesh_raster_test.cpp mesh_rays.h gl_fixture.h test_scenes.h test_scenes.cpp
  LIBRARIES cairn::renderer cairn::reference fmt::fmt
  TIMEOUT 120)
cairn_test(mesh_mix_test
  SOURCES mesh_mix_test.cpp mesh_rays.h gl_fixture.h test_scenes.h test_scenes.cpp
  LIBRARIES cairn::renderer cairn::reference fmt::fmt
  TIMEOUT 120)
