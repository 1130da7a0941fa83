# Surfaces that move on the GPU, against snapshots taken on the CPU.
cairn_test(moving_surface_test
  SOURCES moving_surface_test.cpp moving_fixture.h moving_scenes.h moving_scenes.cpp
          count_news.h count_news.cpp gl_fixture.h lattice_surface.h
  LIBRARIES cairn::voxelizer cairn::reference cairn::scenes cairn::gl fmt::fmt TIMEOUT 120)
