# Colours and normals of voxels.
cairn_test(voxel_attributes_test SOURCES voxel_attributes_test.cpp attribute_truth.h gl_fixture.h lattice_surface.h
           LIBRARIES cairn::voxelizer cairn::reference cairn::scenes cairn::gl fmt::fmt TIMEOUT 120)
