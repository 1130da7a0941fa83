// EXT_meshopt_compression,
// https://github.com/KhronosGroup/glTF/tree/main/extensions/2.0/Vendor/EXT_meshopt_compression. The decoders
// are safe on damaged input as long as the sizes obey the extension, which is checked here first.
#include "scenes/gltf/meshopt.h"

#include <fmt/format.h>
#include <meshoptimizer.h>

#include "scenes/gltf/failure.h"

namespace cairn::scenes::gltf {
namespace {

void check_rules(const std::string& where, const MeshoptStream& stream) {
    const bool attributes = stream.mode == "ATTRIBUTES";
    if (!attributes && stream.mode != "TRIANGLES" && stream.mode != "INDICES")
        fail(where, fmt::format("unknown \"mode\" {}", in_quotes(stream.mode)));
    const bool stride_fits = attributes ? stream.stride % 4 == 0 && stream.stride >= 4 && stream.stride <= 256
                                        : stream.stride == 2 || stream.stride == 4;
    if (!stride_fits)
        fail(where, fmt::format("\"byteStride\" {} does not go with mode {}", stream.stride, stream.mode));
    if (stream.mode == "TRIANGLES" && stream.count % 3 != 0)
        fail(where, fmt::format("\"count\" {} is no multiple of 3", stream.count));

    const std::string& filter = stream.filter;
    if (filter.empty() || filter == "NONE") return;
    const bool filter_fits = (filter == "OCTAHEDRAL" && (stream.stride == 4 || stream.stride == 8)) ||
                             (filter == "QUATERNION" && stream.stride == 8) ||
                             (filter == "EXPONENTIAL" && stream.stride % 4 == 0);
    if (!attributes || !filter_fits)
        fail(where, fmt::format("\"filter\" {} does not go with mode {} and stride {}", in_quotes(filter),
                                stream.mode, stream.stride));
}

}  // namespace

std::vector<std::uint8_t> decode_meshopt(const std::string& where, const MeshoptStream& stream) {
    check_rules(where, stream);
    std::vector<std::uint8_t> result(stream.count * stream.stride);
    if (result.empty()) return result;
    const auto with = [&](auto decode) {
        return decode(result.data(), stream.count, stream.stride, stream.bytes.data(), stream.bytes.size());
    };
    using Decoder = int (*)(void*, std::size_t, std::size_t, const unsigned char*, std::size_t);
    const int error = stream.mode == "ATTRIBUTES"  ? with(Decoder{meshopt_decodeVertexBuffer})
                      : stream.mode == "TRIANGLES" ? with(Decoder{meshopt_decodeIndexBuffer})
                                                   : with(Decoder{meshopt_decodeIndexSequence});
    if (error != 0)
        fail(where, fmt::format("the compressed data is broken (meshoptimizer's code {})", error));
    if (stream.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(result.data(), stream.count, stream.stride);
    if (stream.filter == "QUATERNION") meshopt_decodeFilterQuat(result.data(), stream.count, stream.stride);
    if (stream.filter == "EXPONENTIAL") meshopt_decodeFilterExp(result.data(), stream.count, stream.stride);
    return result;
}

}  // namespace cairn::scenes::gltf
