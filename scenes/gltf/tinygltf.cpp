// The one translation unit that compiles tinygltf's implementation (its switches: scenes/CMakeLists.txt).
#include <fstream>  // which TINYGLTF_NO_FS forgets for its own writers

#define TINYGLTF_IMPLEMENTATION
#include <tiny_gltf.h>
