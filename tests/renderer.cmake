cairn_test(renderer_test
  SOURCES renderer_test.cpp march_twin.h march_twin.cpp test_scenes.h test_scenes.cpp
  LIBRARIES cairn::renderer cairn::reference fmt::fmt
  TIMEOUT 180)
