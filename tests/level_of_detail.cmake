cairn_test(level_of_detail_test
  SOURCES level_of_detail_test.cpp test_scenes.h test_scenes.cpp gl_fixture.h
  LIBRARIES cairn::renderer fmt::fmt
  TIMEOUT 180)
