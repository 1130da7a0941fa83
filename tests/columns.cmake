# Shadow rays through the xy-reduced pyramid.
cairn_test(columns_test
  SOURCES columns_test.cpp gl_fixture.h
  LIBRARIES cairn::renderer fmt::fmt
  TIMEOUT 120)
cairn_test(pyramid_shadow_test
  SOURCES pyramid_shadow_test.cpp moving_scenes.h moving_scenes.cpp test_scenes.h test_scenes.cpp mesh_rays.h gl_fixture.h
  LIBRARIES cairn::renderer cairn::reference cairn::scenes fmt::fmt
  TIMEOUT 180)
