cairn_test(shadow_cones_test
  SOURCES shadow_cones_test.cpp square_over_floor.h gl_fixture.h mesh_rays.h test_scenes.h test_scenes.cpp
  LIBRARIES cairn::renderer fmt::fmt
  TIMEOUT 120)
cairn_test(shadow_flicker_test
  SOURCES shadow_flicker_test.cpp square_over_floor.h gl_fixture.h mesh_rays.h test_scenes.h test_scenes.cpp
  LIBRARIES cairn::renderer fmt::fmt
  TIMEOUT 120)
