# A peer of the charts of shadows.
if(CAIRN_BENCH)
  cairn_test(pcf_shadow_test SOURCES pcf_shadow_test.cpp soft_shadow_scene.h soft_shadow_scene.cpp gl_fixture.h
             LIBRARIES cairn_bench cairn::renderer fmt::fmt)
endif()
