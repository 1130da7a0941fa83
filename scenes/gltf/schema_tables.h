#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "scenes/load.h"

namespace cairn::scenes::gltf {

enum class Kind {
    boolean,
    string,
    strings,
    number,
    numbers,
    whole,      ///< 0, 1, 2, ... up to 2^53
    whole_int,  ///< 0, 1, 2, ... up to 2^31 - 1: an int of tinygltf
    index,      ///< index into the array `target`
    indices,
    index_map,   ///< object of indices: the attributes of a primitive
    index_maps,  ///< array of objects of indices: morph targets
    any_object,  ///< an object that is kept as it is
    object,
    objects,
};

struct Shape;

/// One property of a JSON object: a row of the glTF 2.0 specification, section 5 (or of an extension's).
struct Property {
    const char* name;
    Kind kind;
    bool required = false;
    /// For kinds of indices: JSON pointer to the array that they point into.
    const char* target = nullptr;
    std::size_t length = 0;         ///< for numbers: their count, 0 = any
    const Shape* inside = nullptr;  ///< for an object or objects: their properties
    const char* label = "";         ///< for objects: the name of one of them in messages
    /// For arrays: the limit of their elements.
    std::uint64_t Limits::*most = &Limits::elements;
};

struct Shape {
    std::span<const Property> properties;
};

/// The properties of a document that the loader reads.
[[nodiscard]] const Shape& schema_of_document();

}  // namespace cairn::scenes::gltf
