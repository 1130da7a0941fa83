cairn_test(reference_test SOURCES reference_test.cpp lattice_surface.h LIBRARIES cairn::reference fmt::fmt)

# GMP's integers are the witness that 128 bits are enough.
find_package(PkgConfig REQUIRED)
pkg_check_modules(GMPXX REQUIRED IMPORTED_TARGET gmpxx)
cairn_test(separating_axes_test SOURCES separating_axes_test.cpp clipped_triangle.h lattice_surface.h
           LIBRARIES cairn::reference fmt::fmt PkgConfig::GMPXX)
