// The vector types of GLSL, for the structures that C++ shares with it.
//
// A vec3 here is always followed by a scalar, which fills its fourth component: so std140, std430 and C++ lay
// a structure out alike, and its size is a multiple of 16. Each structure asserts its size, which a vec3
// without a scalar would change.
#ifndef CAIRN_INTEROP_VECTORS_H
#define CAIRN_INTEROP_VECTORS_H

#ifdef __cplusplus
#include <cstddef>

#include <glm/glm.hpp>
namespace cairn::interop {
using glm::dvec3;
using glm::ivec3;
using glm::ivec4;
using glm::uvec2;
using glm::uvec3;
using glm::uvec4;
using glm::vec2;
using glm::vec3;
using glm::vec4;
using uint = glm::uint;
}  // namespace cairn::interop
#endif

#endif
