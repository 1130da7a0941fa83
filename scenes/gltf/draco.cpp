#include "scenes/gltf/draco.h"

#include <cstring>
#include <memory>
#include <new>
#include <stdexcept>

#include <draco/compression/decode.h>
#include <fmt/format.h>

#include "scenes/gltf/failure.h"

namespace cairn::scenes::gltf {
namespace {

/// Reads the counts from the head of a stream, so that an absurd one is refused before Draco allocates for
/// it. https://google.github.io/draco/spec/, sections 3 to 5.
class Head {
public:
    Head(const std::string& where, std::span<const std::uint8_t> stream) : where_(where), stream_(stream) {}

    void check(Budget& budget) {
        constexpr std::size_t header_bytes = 11;
        if (stream_.size() < header_bytes || std::memcmp(stream_.data(), "DRACO", 5) != 0)
            fail(where_, "the stream does not begin with DRACO");
        const int version = stream_[5] * 100 + stream_[6];
        if (version != 202)
            fail(where_,
                 fmt::format("the stream is of Draco {}.{}; only 2.2 is read", stream_[5], stream_[6]));
        if (stream_[7] != 1) fail(where_, "the stream holds no triangle mesh");
        const bool edgebreaker = stream_[8] == 1;
        const bool has_metadata = (stream_[10] & 0x80U) != 0;
        at_ = header_bytes;
        if (has_metadata) skip_metadata();
        if (edgebreaker) next();  // the kind of traversal
        const std::uint64_t first = varint();
        const std::uint64_t second = varint();
        const std::uint64_t faces = edgebreaker ? second : first;
        const std::uint64_t vertices = edgebreaker ? first : second;
        // Draco keeps some dozens of bytes for each while it decodes.
        budget.charge(where_, faces, 12);
        budget.charge(where_, vertices, 12);
    }

private:
    std::uint8_t next() {
        if (at_ >= stream_.size()) fail(where_, "the stream ends inside its header");
        return stream_[at_++];
    }

    std::uint64_t varint() {
        std::uint64_t value = 0;
        for (unsigned shift = 0; shift < 35; shift += 7) {
            const std::uint8_t byte = next();
            value |= static_cast<std::uint64_t>(byte & 0x7FU) << shift;
            if ((byte & 0x80U) == 0) return value;
        }
        fail(where_, "the stream's header is broken");
    }

    void skip(std::uint64_t count) {
        if (count > stream_.size() - at_) fail(where_, "the stream ends inside its header");
        at_ += count;
    }

    void skip_metadata() {
        for (std::uint64_t attributes = varint(); attributes > 0; --attributes) {
            varint();  // which attribute
            skip_metadata_element(0);
        }
        skip_metadata_element(0);
    }

    /// Named values, then named elements of the same kind.
    void skip_metadata_element(int depth) {
        constexpr int deepest = 100;
        if (depth > deepest) fail(where_, "the stream's metadata nests too deep");
        for (std::uint64_t entries = varint(); entries > 0; --entries) {
            skip(next());
            skip(varint());
        }
        for (std::uint64_t inner = varint(); inner > 0; --inner) {
            skip(next());
            skip_metadata_element(depth + 1);
        }
    }

    const std::string& where_;
    std::span<const std::uint8_t> stream_;
    std::size_t at_ = 0;
};

/// Copies one attribute into consecutive elements of the accessor's component type.
template <typename Number>
bool copy_attribute(const draco::PointAttribute& attribute, std::uint32_t point_count, int width,
                    std::uint8_t* out) {
    const std::size_t element_bytes = static_cast<std::size_t>(width) * sizeof(Number);
    Number element[4];
    for (draco::PointIndex point(0); point < point_count; ++point, out += element_bytes) {
        const draco::AttributeValueIndex value = attribute.mapped_index(point);
        if (value.value() >= attribute.size()) return false;
        if (!attribute.ConvertValue<Number>(value, static_cast<std::int8_t>(width), element)) return false;
        std::memcpy(out, element, element_bytes);
    }
    return true;
}

bool copy_typed(const draco::PointAttribute& attribute, std::uint32_t point_count, const Elements& shape,
                std::uint8_t* out) {
    switch (shape.component) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return copy_attribute<std::int8_t>(attribute, point_count, shape.width, out);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return copy_attribute<std::uint8_t>(attribute, point_count, shape.width, out);
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return copy_attribute<std::int16_t>(attribute, point_count, shape.width, out);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return copy_attribute<std::uint16_t>(attribute, point_count, shape.width, out);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return copy_attribute<std::uint32_t>(attribute, point_count, shape.width, out);
        default:
            return copy_attribute<float>(attribute, point_count, shape.width, out);
    }
}

Elements unpacked(const std::string& where, const draco::Mesh& mesh, const std::string& name,
                  const Elements& shape, int id, Budget& budget) {
    const draco::PointAttribute* attribute = mesh.GetAttributeByUniqueId(static_cast<std::uint32_t>(id));
    if (attribute == nullptr)
        fail(where, fmt::format("the stream has no attribute of id {} ({})", id, in_quotes(name)));
    if (mesh.num_points() != shape.count)
        fail(where, fmt::format("the stream has {} vertices, accessor {} says {}", mesh.num_points(),
                                in_quotes(name), shape.count));
    if (attribute->num_components() != shape.width || shape.width > 4)
        fail(where, fmt::format("the stream's {} has {} components, its accessor {}", in_quotes(name),
                                int{attribute->num_components()}, shape.width));
    budget.charge(where, shape.count, shape.stride);
    auto storage = std::make_shared<std::vector<std::uint8_t>>(shape.count * shape.stride);
    if (!copy_typed(*attribute, mesh.num_points(), shape, storage->data()))
        fail(where, fmt::format("the stream's {} does not fit its accessor's type", in_quotes(name)));
    Elements result = shape;
    result.data = storage->data();
    result.storage = std::move(storage);
    return result;
}

std::unique_ptr<draco::Mesh> decode(const std::string& where, std::span<const std::uint8_t> stream) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(stream.data()), stream.size());
    try {
        auto decoded = draco::Decoder().DecodeMeshFromBuffer(&buffer);
        if (!decoded.ok()) fail(where, "the stream is broken: " + decoded.status().error_msg_string());
        return std::move(decoded).value();
    } catch (const std::bad_alloc&) {
        fail(where, "the stream asks for more memory than there is");
    } catch (const std::length_error&) {
        fail(where, "the stream asks for more memory than there is");
    }
}

}  // namespace

DracoMesh decode_draco(const std::string& where, std::span<const std::uint8_t> stream,
                       const std::map<std::string, std::pair<Elements, int>>& wanted, Budget& budget) {
    Head(where, stream).check(budget);
    const auto mesh = decode(where, stream);
    DracoMesh result;
    result.indices.reserve(std::size_t{mesh->num_faces()} * 3);
    for (draco::FaceIndex face(0); face < mesh->num_faces(); ++face)
        for (const draco::PointIndex& point : mesh->face(face))
            result.indices.push_back(point.value());
    for (const auto& [name, shape_and_id] : wanted)
        result.attributes.emplace(
            name, unpacked(where, *mesh, name, shape_and_id.first, shape_and_id.second, budget));
    return result;
}

}  // namespace cairn::scenes::gltf
