# Every N and M that a tree may have, and tiles that need no brick.
cairn_test(tree_shapes_test
  SOURCES tree_shapes_test.cpp shaped_bricks_test.cpp constant_tiles_test.cpp box_content.h box_content.cpp
          produced_brick.h produced_brick.cpp clipped_triangle.h lattice_surface.h march_twin.h march_twin.cpp
          test_scenes.h test_scenes.cpp gl_fixture.h
  LIBRARIES cairn::renderer cairn::reference fmt::fmt
  TIMEOUT 180)
