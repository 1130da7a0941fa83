# The findings of Atty et al. 2005, and the limits of the two kinds of shadows.
if(CAIRN_BENCH)
  cairn_test(soft_shadow_findings_test
    SOURCES soft_shadow_findings_test.cpp soft_shadow_scene.h soft_shadow_scene.cpp gl_fixture.h
    LIBRARIES cairn_bench cairn::renderer cairn::reference fmt::fmt
    TIMEOUT 180)
  find_program(GNUPLOT_PROGRAM gnuplot)
  set(study_definitions CAIRN_COMMAND="$<TARGET_FILE:cairn_app>")
  if(GNUPLOT_PROGRAM)
    list(APPEND study_definitions CAIRN_HAS_GNUPLOT)
  endif()
  find_package(nlohmann_json REQUIRED)
  cairn_test(bench_soft_shadow_test SOURCES bench_soft_shadow_test.cpp command.h command.cpp scratch_folder.h
    LIBRARIES cairn::base nlohmann_json::nlohmann_json fmt::fmt
    DEFINITIONS ${study_definitions} TIMEOUT 180)
  add_dependencies(bench_soft_shadow_test cairn_app)
endif()
cairn_test(voxel_shadow_limits_test
  SOURCES voxel_shadow_limits_test.cpp gl_fixture.h mesh_rays.h test_scenes.h test_scenes.cpp
  LIBRARIES cairn::renderer cairn::reference fmt::fmt
  TIMEOUT 120)
cairn_test(soft_shadow_limits_test
  SOURCES soft_shadow_limits_test.cpp soft_shadow_scene.h soft_shadow_scene.cpp gl_fixture.h
  LIBRARIES cairn::renderer cairn::reference fmt::fmt
  TIMEOUT 120)
