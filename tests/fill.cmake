# Solid fill.
cairn_test(fill_test SOURCES fill_test.cpp closed_meshes.h lattice_surface.h test_scenes.h test_scenes.cpp
           LIBRARIES cairn::voxelizer cairn::reference cairn::scenes fmt::fmt)
