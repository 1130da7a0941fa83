cairn_test(traversal_test
  SOURCES traversal_test.cpp test_scenes.h test_scenes.cpp gl_fixture.h
  LIBRARIES cairn::renderer fmt::fmt
  TIMEOUT 180)
