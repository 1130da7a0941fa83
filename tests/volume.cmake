# Volumes: their files, the fields that fill bricks, and their pictures.
cairn_test(volume_test
  SOURCES volume_picture_test.cpp volume_twin.h volume_twin.cpp volume_scenes.h gl_fixture.h
  LIBRARIES cairn::renderer fmt::fmt
  TIMEOUT 120)
