cairn_test(level_of_detail_test
  SOURCES level_of_detail_test.cpp test_scenes.h test_scenes.cpp gl_fixture.h
  LIBRARIES cairn::renderer fmt::fmt
  TIMEOUT 180)
cairn_test(brick_mips_test
  SOURCES brick_mips_test.cpp produced_brick.h produced_brick.cpp lattice_surface.h gl_fixture.h
  LIBRARIES cairn::renderer cairn::reference cairn::scenes fmt::fmt
  TIMEOUT 120)
