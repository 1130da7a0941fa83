cairn_test(soft_shadow_map_test
  SOURCES soft_shadow_map_test.cpp soft_shadow_scene.h soft_shadow_scene.cpp soft_shadow_twin.h soft_shadow_twin.cpp
          gl_fixture.h
  LIBRARIES cairn::renderer cairn::reference fmt::fmt
  TIMEOUT 180)
cairn_test(soft_shadow_picture_test
  SOURCES soft_shadow_picture_test.cpp soft_shadow_scene.h soft_shadow_scene.cpp gl_fixture.h
  LIBRARIES cairn::renderer cairn::reference fmt::fmt
  TIMEOUT 120)
cairn_test(area_light_test
  SOURCES area_light_test.cpp soft_shadow_scene.h soft_shadow_scene.cpp
  LIBRARIES cairn::renderer cairn::reference fmt::fmt
  TIMEOUT 120)
cairn_test(node_selection_test SOURCES node_selection_test.cpp LIBRARIES cairn::scenes fmt::fmt)

cairn_test(shadow_truth_test
  SOURCES shadow_truth_test.cpp scratch_folder.h
  LIBRARIES cairn::reference cairn::renderer)
