cairn_test(zoom_test SOURCES zoom_test.cpp gl_fixture.h LIBRARIES cairn::renderer fmt::fmt TIMEOUT 180)
