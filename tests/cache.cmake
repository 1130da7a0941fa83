cairn_test(cache_convergence_test SOURCES cache_convergence_test.cpp gl_fixture.h LIBRARIES cairn_viewer cairn::renderer fmt::fmt TIMEOUT 120)
cairn_test(cache_stability_test
  SOURCES cache_stability_test.cpp test_scenes.h test_scenes.cpp lattice_surface.h gl_fixture.h
  LIBRARIES cairn::renderer cairn::reference fmt::fmt
  TIMEOUT 300)
