# The built-in scenes and the .glb writer: CPU only.
cairn_test(builtin_test SOURCES builtin_test.cpp scratch_folder.h LIBRARIES cairn::scenes)
