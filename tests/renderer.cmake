cairn_test(renderer_test
  SOURCES renderer_test.cpp march_twin.h march_twin.cpp test_scenes.h test_scenes.cpp
  LIBRARIES cairn::renderer cairn::reference fmt::fmt
  TIMEOUT 180)
cairn_test(frame_budget_test SOURCES frame_budget_test.cpp gl_fixture.h LIBRARIES cairn::renderer fmt::fmt TIMEOUT 120)
