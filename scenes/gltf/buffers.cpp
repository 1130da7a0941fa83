#include "scenes/gltf/buffers.h"

#include <fmt/format.h>

#include "scenes/gltf/failure.h"
#include "scenes/gltf/meshopt.h"
#include "scenes/gltf/uri.h"

namespace cairn::scenes::gltf {

std::span<const std::uint8_t> Buffers::buffer(int index) {
    const BufferSource& buffer = source_.buffers[static_cast<std::size_t>(index)];
    const std::string where = source_.where(element("buffer", static_cast<std::size_t>(index)));
    std::span<const std::uint8_t> bytes;
    if (buffer.uri) {
        auto found = loaded_.find(index);
        if (found == loaded_.end()) {
            auto loaded = read_uri(where, *buffer.uri, source_.folder, source_.options);
            budget_.grant(loaded.size());
            found = loaded_.emplace(index, std::move(loaded)).first;
        }
        bytes = found->second;
    } else if (index == 0 && source_.glb_chunk.data() != nullptr) {
        bytes = source_.glb_chunk;
    } else {
        fail(where, "it has neither a URI nor the binary chunk of a .glb");
    }
    if (buffer.byte_length > bytes.size())
        fail(where, fmt::format("\"byteLength\" is {}, its data holds {}", buffer.byte_length, bytes.size()));
    return bytes.first(buffer.byte_length);
}

std::span<const std::uint8_t> Buffers::range(const std::string& where, int buffer_index, std::uint64_t offset,
                                             std::uint64_t length) {
    const auto bytes = buffer(buffer_index);
    if (offset > bytes.size() || length > bytes.size() - offset)
        fail(where, fmt::format("it spans bytes {} to {}, buffer {} holds {}", offset, offset + length,
                                buffer_index, bytes.size()));
    return bytes.subspan(offset, length);
}

std::vector<std::uint8_t> Buffers::decompressed(int view, const tinygltf::Value& compression) {
    const std::string where =
        source_.where(element("buffer view", static_cast<std::size_t>(view)) + ", meshopt_compression");
    const auto number = [&](const char* key) {
        return compression.Has(key) ? static_cast<std::uint64_t>(compression.Get(key).GetNumberAsInt()) : 0;
    };
    const auto text = [&](const char* key) {
        return compression.Has(key) ? compression.Get(key).Get<std::string>() : std::string();
    };
    const MeshoptStream stream{
        range(where, static_cast<int>(number("buffer")), number("byteOffset"), number("byteLength")),
        number("count"), number("byteStride"), text("mode"), text("filter")};
    budget_.charge(where, stream.count, stream.stride);
    const std::uint64_t expected = source_.model.bufferViews[static_cast<std::size_t>(view)].byteLength;
    if (stream.count * stream.stride != expected)
        fail(where, fmt::format("it unpacks to {} elements of {} bytes, the buffer view holds {} bytes",
                                stream.count, stream.stride, expected));
    return decode_meshopt(where, stream);
}

std::span<const std::uint8_t> Buffers::view(int index) {
    if (const auto found = decompressed_views_.find(index); found != decompressed_views_.end())
        return found->second;
    const tinygltf::BufferView& view = source_.model.bufferViews[static_cast<std::size_t>(index)];
    for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"})
        if (const auto found = view.extensions.find(name); found != view.extensions.end())
            return decompressed_views_.emplace(index, decompressed(index, found->second)).first->second;
    const std::string where = source_.where(element("buffer view", static_cast<std::size_t>(index)));
    return range(where, view.buffer, view.byteOffset, view.byteLength);
}

}  // namespace cairn::scenes::gltf
