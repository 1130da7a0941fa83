# Voxel files, read back by NumPy and OpenVDB, whose modules belong to the system's Python.
find_program(CAIRN_TEST_PYTHON python3 PATHS /usr/bin NO_DEFAULT_PATH)
find_program(CAIRN_TEST_PYTHON python3 REQUIRED)
cairn_test(voxel_files_test SOURCES voxel_files_test.cpp gl_fixture.h lattice_surface.h scratch_folder.h
           LIBRARIES cairn::voxelizer cairn::reference cairn::scenes cairn::gl fmt::fmt
           DEFINITIONS CAIRN_TEST_PYTHON="${CAIRN_TEST_PYTHON}"
                       CAIRN_READ_VOXELS="${CMAKE_CURRENT_SOURCE_DIR}/read_voxels.py"
           TIMEOUT 120)
