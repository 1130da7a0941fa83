# The command, run as a user runs it.
find_package(nlohmann_json REQUIRED)
find_library(OSMESA_LIBRARY NAMES OSMesa libOSMesa.so.8 libOSMesa.so.6)

set(app_definitions CAIRN_COMMAND="$<TARGET_FILE:cairn_app>" CAIRN_SHADER_DIR="${PROJECT_SOURCE_DIR}/shaders"
                    CAIRN_VERSION="${PROJECT_VERSION}")
if(OSMESA_LIBRARY)
  list(APPEND app_definitions CAIRN_HAS_OSMESA)
endif()
cairn_test(app_test
  SOURCES app_usage_test.cpp app_figures_test.cpp app_render_test.cpp command.h command.cpp gltf_file.h scratch_folder.h
  LIBRARIES cairn::base nlohmann_json::nlohmann_json fmt::fmt
  DEFINITIONS ${app_definitions}
  TIMEOUT 120)
add_dependencies(app_test cairn_app)
