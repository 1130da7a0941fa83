# The glTF loader and its snapshots: CPU only.
find_package(draco REQUIRED)
find_package(meshoptimizer REQUIRED)
find_package(nlohmann_json REQUIRED)

cairn_test(scenes_test
  SOURCES scenes_test.cpp scenes_deform_test.cpp scenes_geometry_test.cpp scenes_compression_test.cpp
          gltf_file.h scratch_folder.h
  LIBRARIES cairn::scenes fmt::fmt draco::draco meshoptimizer::meshoptimizer nlohmann_json::nlohmann_json)
cairn_test(scenes_bad_input_test
  SOURCES scenes_bad_input_test.cpp scenes_fuzz_test.cpp gltf_file.h rich_gltf_file.h scratch_folder.h
  LIBRARIES cairn::scenes fmt::fmt nlohmann_json::nlohmann_json)
if(IS_DIRECTORY "${CAIRN_SCENE_DATA}/gltf")
  cairn_test(scenes_data_test SOURCES scenes_data_test.cpp LIBRARIES cairn::scenes fmt::fmt)
endif()
