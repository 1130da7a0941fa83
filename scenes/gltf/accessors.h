#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "scenes/gltf/buffers.h"
#include "scenes/gltf/source.h"

namespace cairn::scenes::gltf {

/// The elements of an accessor, in the memory where they lie: element i begins at data + i * stride. All
/// ranges are checked.
struct Elements {
    std::string where;                   ///< names the accessor in messages
    const std::uint8_t* data = nullptr;  ///< null: every component is 0
    std::size_t stride = 0;
    std::size_t count = 0;
    int width = 0;  ///< components per element: 1, 2, 3, 4, 9 or 16
    int component = TINYGLTF_COMPONENT_TYPE_FLOAT;
    bool normalized = false;
    /// Owns the memory that `data` points into, if the elements do not lie in a buffer.
    std::shared_ptr<const std::vector<std::uint8_t>> storage;
};

/// Which elements to read, in which order; empty = all.
using Selection = std::span<const std::uint32_t>;

class Accessors {
public:
    Accessors(const Source& source, Buffers& buffers, Budget& budget)
        : source_(source), buffers_(buffers), budget_(budget) {}

    /// The elements of an accessor: dense, interleaved or sparse.
    /// @param user    names the user of the accessor in messages: `ear.glb: mesh 2 "ear", primitive 0`.
    /// @throws Error  if the accessor leaves its buffer view, or its types are not glTF's.
    [[nodiscard]] Elements elements(const std::string& user, int accessor);

    /// The elements of an accessor without their data, if that stands elsewhere (in a Draco stream).
    [[nodiscard]] Elements shape(const std::string& user, int accessor) const;

private:
    [[nodiscard]] Elements with_sparse(const Elements& dense, const tinygltf::Accessor& accessor);

    const Source& source_;
    Buffers& buffers_;
    Budget& budget_;
};

[[nodiscard]] std::size_t component_bytes(int component);

/// Reads `width` floats per element. Normalized integers are converted as in glTF 2.0, 3.11; components that
/// the accessor lacks become `filler`.
void read_floats(const Elements& elements, Selection selection, int width, float filler, float* out);

/// Reads `width` whole numbers per element.
/// @throws Error  if the accessor's components are not unsigned integers.
void read_integers(const Elements& elements, Selection selection, int width, std::uint32_t* out);

}  // namespace cairn::scenes::gltf
