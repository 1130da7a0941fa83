# The voxelizer against the exact reference.
set(CAIRN_ENGINE "/usr/share/assimp/models/glTF2/2CylinderEngine-glTF-Binary/2CylinderEngine.glb")
set(voxelizer_definitions "")
if(EXISTS "${CAIRN_ENGINE}")
  list(APPEND voxelizer_definitions CAIRN_ENGINE="${CAIRN_ENGINE}")
endif()
set(voxelizer_libraries cairn::voxelizer cairn::reference cairn::scenes cairn::gl fmt::fmt)
cairn_test(voxelizer_test SOURCES voxelizer_test.cpp gl_fixture.h lattice_surface.h LIBRARIES ${voxelizer_libraries})
cairn_test(voxelizer_surface_test SOURCES voxelizer_surface_test.cpp lattice_surface.h scratch_folder.h
           LIBRARIES ${voxelizer_libraries})
cairn_test(voxelizer_mask_test SOURCES voxelizer_mask_test.cpp masked_scene.h gl_fixture.h lattice_surface.h
           LIBRARIES ${voxelizer_libraries})
cairn_test(voxelizer_scenes_test SOURCES voxelizer_scenes_test.cpp gl_fixture.h lattice_surface.h
           LIBRARIES ${voxelizer_libraries} DEFINITIONS ${voxelizer_definitions} TIMEOUT 120)
cairn_test(voxelizer_metamorphic_test SOURCES voxelizer_metamorphic_test.cpp voxelizer_fixture.h lattice_surface.h
           LIBRARIES ${voxelizer_libraries} DEFINITIONS ${voxelizer_definitions})
cairn_test(voxelizer_fuzz_test
           SOURCES voxelizer_fuzz_test.cpp clipped_triangle.h fuzz.h voxelizer_fixture.h lattice_surface.h
           LIBRARIES ${voxelizer_libraries})
cairn_test(voxelizer_traps_test
           SOURCES voxelizer_traps_test.cpp gltf_file.h scratch_folder.h test_scenes.h test_scenes.cpp
                   voxelizer_fixture.h lattice_surface.h
           LIBRARIES ${voxelizer_libraries} nlohmann_json::nlohmann_json)
cairn_test(voxelizer_mask_fuzz_test
           SOURCES voxelizer_mask_fuzz_test.cpp clipped_triangle.h fuzz.h masked_scene.h voxelizer_fixture.h
                   lattice_surface.h
           LIBRARIES ${voxelizer_libraries})
