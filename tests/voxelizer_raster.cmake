# The raster methods: what they get right, and what they are known to miss.
cairn_test(voxelizer_raster_test SOURCES voxelizer_raster_test.cpp gl_fixture.h lattice_surface.h
           LIBRARIES ${voxelizer_libraries})
cairn_test(voxelizer_raster_scenes_test SOURCES voxelizer_raster_scenes_test.cpp gl_fixture.h lattice_surface.h
           LIBRARIES ${voxelizer_libraries})
cairn_test(voxelizer_pyramid_test SOURCES voxelizer_pyramid_test.cpp gl_fixture.h lattice_surface.h
           LIBRARIES ${voxelizer_libraries})
