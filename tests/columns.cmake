# Shadow rays through the xy-reduced pyramid.
cairn_test(columns_test
  SOURCES columns_test.cpp gl_fixture.h
  LIBRARIES cairn::renderer fmt::fmt
  TIMEOUT 120)
