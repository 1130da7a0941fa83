# Reads the project's #includes; links nothing of it.
cairn_test(include_arrows_test
  SOURCES include_arrows_test.cpp scratch_folder.h
  LIBRARIES fmt::fmt
  DEFINITIONS CAIRN_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
# The only thing of ours that it includes lies in tests/.
target_include_directories(include_arrows_test PRIVATE ${PROJECT_SOURCE_DIR})
