cairn_test(reference_test SOURCES reference_test.cpp lattice_surface.h LIBRARIES cairn::reference fmt::fmt)
