# Hard shadows on what primary rays find in voxels, against Embree's.
cairn_test(marched_receivers_test
  SOURCES marched_receivers_test.cpp gl_fixture.h test_scenes.h test_scenes.cpp
  LIBRARIES cairn::renderer cairn::reference fmt::fmt
  TIMEOUT 120)
