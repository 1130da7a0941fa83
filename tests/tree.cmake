# The tree, its pools, and what fills them.
cairn_test(tree_test
  SOURCES tree_test.cpp tree_stress_test.cpp tree_view.h triangle_index_test.cpp oracle_test.cpp
          brick_pool_test.cpp producer_test.cpp producer_color_test.cpp produced_brick.h produced_brick.cpp
          lattice_surface.h gl_fixture.h
  LIBRARIES cairn::renderer cairn::reference cairn::scenes fmt::fmt
  TIMEOUT 120)
