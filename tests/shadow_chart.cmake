# The charts of shadows.
if(CAIRN_BENCH)
  find_program(GNUPLOT_PROGRAM gnuplot)
  set(shadow_chart_definitions)
  if(GNUPLOT_PROGRAM)
    list(APPEND shadow_chart_definitions CAIRN_HAS_GNUPLOT)
  endif()
  cairn_test(shadow_chart_test SOURCES shadow_chart_test.cpp gl_fixture.h scratch_folder.h
             LIBRARIES cairn_bench cairn::renderer cairn::reference fmt::fmt DEFINITIONS ${shadow_chart_definitions} TIMEOUT 300)
endif()
