# What occlusion queries decide.
if(CAIRN_BENCH)
  cairn_test(visibility_test SOURCES visibility_test.cpp gl_fixture.h
             LIBRARIES cairn_bench cairn::renderer cairn::voxelizer cairn::scenes fmt::fmt TIMEOUT 120)
endif()
