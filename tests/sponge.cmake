cairn_test(sponge_test
  SOURCES sponge_test.cpp produced_brick.h produced_brick.cpp gl_fixture.h
  LIBRARIES cairn::renderer cairn::voxelizer fmt::fmt)
