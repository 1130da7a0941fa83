# What the charts stand on.
if(CAIRN_BENCH)
  cairn_test(bench_test SOURCES bench_test.cpp lattice_surface.h
             LIBRARIES cairn_bench cairn::voxelizer cairn::reference cairn::scenes fmt::fmt)
  find_program(GNUPLOT_PROGRAM gnuplot)
  set(bench_definitions CAIRN_COMMAND="$<TARGET_FILE:cairn_app>")
  if(GNUPLOT_PROGRAM)
    list(APPEND bench_definitions CAIRN_HAS_GNUPLOT)
  endif()
  cairn_test(bench_command_test SOURCES bench_command_test.cpp command.h command.cpp scratch_folder.h
             LIBRARIES cairn::base nlohmann_json::nlohmann_json fmt::fmt
             DEFINITIONS ${bench_definitions} TIMEOUT 300)
  add_dependencies(bench_command_test cairn_app)
endif()
