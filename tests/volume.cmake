# Volumes: their files, the fields that fill bricks, and their pictures.
cairn_test(volume_test
  SOURCES volume_field_test.cpp volume_picture_test.cpp volume_light_test.cpp volume_twin.h volume_twin.cpp
          volume_scenes.h gl_fixture.h
  LIBRARIES cairn::renderer fmt::fmt
  TIMEOUT 120)
find_package(ZLIB REQUIRED)
cairn_test(volume_file_test
  SOURCES volume_file_test.cpp scratch_folder.h
  LIBRARIES cairn::scenes fmt::fmt ZLIB::ZLIB
  TIMEOUT 60)
