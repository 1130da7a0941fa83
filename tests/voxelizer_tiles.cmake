# Grids of any size, tile by tile.
cairn_test(voxelizer_tiles_test
  SOURCES voxelizer_tiles_test.cpp region_index_test.cpp grid_shapes_test.cpp gl_fixture.h lattice_surface.h
  LIBRARIES cairn::voxelizer cairn::reference cairn::scenes cairn::gl fmt::fmt)
