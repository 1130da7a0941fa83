#include "scenes/volume/reader.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>

#include <fmt/format.h>
#include <zlib.h>

#include "base/error.h"
#include "base/input_file.h"
#include "scenes/memory_budget.h"

namespace cairn::scenes::volume {
namespace {

constexpr double most_value = 65535.0;

template <typename T>
T sample_at(const std::byte* bytes, bool swap) {
    std::array<std::byte, sizeof(T)> raw{};
    std::memcpy(raw.data(), bytes, sizeof(T));
    if (swap) std::reverse(raw.begin(), raw.end());
    return std::bit_cast<T>(raw);
}

/// Calls `use(index of the sample, value)` for all samples.
template <typename T, typename Use>
void for_each_of(std::span<const std::byte> bytes, const Layout& layout, std::size_t count, Use&& use) {
    const bool swap = layout.big_endian != (std::endian::native == std::endian::big);
    for (std::size_t i = 0; i < count; ++i)
        use(i, double(sample_at<T>(bytes.data() + i * sizeof(T), swap)) * layout.slope + layout.intercept);
}

template <typename Use>
void for_each(std::span<const std::byte> bytes, const Layout& layout, std::size_t count, Use&& use) {
    switch (layout.type) {
        case SampleType::u8:
            return for_each_of<std::uint8_t>(bytes, layout, count, use);
        case SampleType::i8:
            return for_each_of<std::int8_t>(bytes, layout, count, use);
        case SampleType::u16:
            return for_each_of<std::uint16_t>(bytes, layout, count, use);
        case SampleType::i16:
            return for_each_of<std::int16_t>(bytes, layout, count, use);
        case SampleType::u32:
            return for_each_of<std::uint32_t>(bytes, layout, count, use);
        case SampleType::i32:
            return for_each_of<std::int32_t>(bytes, layout, count, use);
        case SampleType::u64:
            return for_each_of<std::uint64_t>(bytes, layout, count, use);
        case SampleType::i64:
            return for_each_of<std::int64_t>(bytes, layout, count, use);
        case SampleType::f32:
            return for_each_of<float>(bytes, layout, count, use);
        case SampleType::f64:
            return for_each_of<double>(bytes, layout, count, use);
    }
}

/// Which of the world's axes each axis of the file becomes, and whether it runs backwards there.
struct Turn {
    std::array<int, 3> world{0, 1, 2};
    std::array<bool, 3> backwards{};
    bool exact = true;
};

Turn nearest_turn(const std::array<glm::dvec3, 3>& axes) {
    Turn turn;
    double best = -1.0;
    std::array<int, 3> order{0, 1, 2};
    do {
        double sum = 0.0;
        for (int axis = 0; axis < 3; ++axis)
            sum += std::abs(glm::normalize(axes[std::size_t(axis)])[order[std::size_t(axis)]]);
        if (sum > best + 1e-9) {
            best = sum;
            turn.world = order;
        }
    } while (std::next_permutation(order.begin(), order.end()));
    for (std::size_t axis = 0; axis < 3; ++axis)
        turn.backwards[axis] = axes[axis][turn.world[axis]] < 0.0;
    turn.exact = best > 3.0 - 1e-6;
    return turn;
}

/// A Volume without samples: where it lies, and how far apart in `samples` neighbours along i, j and k are.
struct Placed {
    Volume volume;
    std::array<std::int64_t, 3> strides{};
    std::int64_t first = 0;
};

Placed place(const std::string& name, const Layout& layout) {
    Placed placed;
    const Turn turn = nearest_turn(layout.axes);
    Volume& volume = placed.volume;
    volume.name = name;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        volume.size[turn.world[axis]] = int(layout.size[int(axis)]);
        volume.spacing[turn.world[axis]] = glm::length(layout.axes[axis]);
    }
    const std::array<std::int64_t, 3> of_world{1, volume.size.x, std::int64_t(volume.size.x) * volume.size.y};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::int64_t stride = of_world[std::size_t(turn.world[axis])];
        placed.strides[axis] = turn.backwards[axis] ? -stride : stride;
        if (turn.backwards[axis]) placed.first += stride * (layout.size[int(axis)] - 1);
    }
    // The box keeps its centre, also where turning moves its corners.
    const glm::dvec3 last = glm::dvec3(layout.size) - 1.0;
    const glm::dvec3 centre =
        layout.origin + 0.5 * (layout.axes[0] * last.x + layout.axes[1] * last.y + layout.axes[2] * last.z);
    volume.origin = centre - 0.5 * volume.spacing * (glm::dvec3(volume.size) - 1.0);
    if (!turn.exact)
        volume.warnings.push_back(
            {name + ": its axes are not along the world's; it is shown turned to the nearest", true});
    return placed;
}

void check_place(const std::string& name, const Layout& layout) {
    for (const glm::dvec3& axis : layout.axes) {
        const double length = glm::length(axis);
        if (!std::isfinite(length) || !(length > 1e-30))
            fail(name, "the distance between its samples is not a positive number");
    }
    const double room =
        std::abs(glm::dot(glm::normalize(layout.axes[0]),
                          glm::cross(glm::normalize(layout.axes[1]), glm::normalize(layout.axes[2]))));
    if (!(room > 1e-6)) fail(name, "its axes do not span a box");
    if (!std::isfinite(glm::length(layout.origin))) fail(name, "its origin is not finite");
    if (!std::isfinite(layout.slope) || !std::isfinite(layout.intercept))
        fail(name, "the scale of its values is not finite");
}

/// Whether another member of a gzip stream starts there, and not the zeros that pad some files.
bool begins_member(std::span<const std::byte> rest) {
    return rest.size() >= 2 && rest[0] == std::byte(0x1F) && rest[1] == std::byte(0x8B);
}

}  // namespace

std::size_t bytes_of(SampleType type) {
    switch (type) {
        case SampleType::u8:
        case SampleType::i8:
            return 1;
        case SampleType::u16:
        case SampleType::i16:
            return 2;
        case SampleType::u32:
        case SampleType::i32:
        case SampleType::f32:
            return 4;
        default:
            return 8;
    }
}

void fail(const std::string& name, const std::string& what, const std::string& way_out) {
    throw Error(Fault::input, name, what, way_out);
}

std::size_t checked_bytes(const std::string& name, const Layout& layout, std::uint64_t memory_bytes) {
    std::int64_t count = 1;
    for (int axis = 0; axis < 3; ++axis) {
        const std::int64_t size = layout.size[axis];
        if (size < 1) fail(name, fmt::format("it has {} samples along axis {}", size, "ijk"[axis]));
        if (size > (1 << 20))
            fail(name, fmt::format("it has {} samples along axis {}", size, "ijk"[axis]),
                 "cut or reduce the volume: the limit is 2^20");
        count *= size;  // below 2^60
    }
    const std::size_t each = bytes_of(layout.type);
    MemoryBudget(memory_bytes)
        .charge(name, fmt::format("its {} x {} x {} samples", layout.size.x, layout.size.y, layout.size.z),
                std::uint64_t(count), each + sizeof(Volume::samples[0]));
    return std::size_t(count) * each;
}

Volume decode(const std::string& name, const Layout& layout, std::span<const std::byte> bytes) {
    check_place(name, layout);
    const std::size_t count =
        std::size_t(layout.size.x) * std::size_t(layout.size.y) * std::size_t(layout.size.z);
    const std::size_t needed = count * bytes_of(layout.type);
    if (bytes.size() < needed)
        fail(name, fmt::format("its samples take {} bytes, and it holds {}", needed, bytes.size()));
    Placed placed = place(name, layout);
    Volume& volume = placed.volume;
    const std::array<std::int64_t, 3>& strides = placed.strides;

    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    std::size_t odd = 0;
    for_each(bytes, layout, count, [&](std::size_t, double value) {
        if (!std::isfinite(value)) {
            ++odd;
            return;
        }
        low = std::min(low, value);
        high = std::max(high, value);
    });
    if (layout.type == SampleType::u8 && layout.slope == 1.0 && layout.intercept == 0.0) {
        low = 0.0;
        high = 255.0;
    }
    if (odd == count) fail(name, "none of its values is a finite number", "export it again");
    if (odd > 0)
        volume.warnings.push_back(
            {fmt::format("{}: {} values are not finite; they count as empty", name, odd), true});
    volume.low = low;
    volume.high = high > low ? high : low + 1.0;
    const double scale = most_value / (volume.high - volume.low);
    if (!std::isfinite(scale) || !(scale > 0.0)) fail(name, "its values span more than a double can tell");

    volume.samples.resize(count);
    const std::size_t i_count = std::size_t(layout.size.x);
    const std::size_t j_count = std::size_t(layout.size.y);
    for_each(bytes, layout, count, [&](std::size_t index, double value) {
        const auto i = std::int64_t(index % i_count);
        const auto j = std::int64_t(index / i_count % j_count);
        const auto k = std::int64_t(index / i_count / j_count);
        const double stored =
            std::isfinite(value) ? std::clamp((value - volume.low) * scale, 0.0, most_value) : 0.0;
        volume.samples[std::size_t(placed.first + i * strides[0] + j * strides[1] + k * strides[2])] =
            std::uint16_t(std::lround(stored));
    });
    return std::move(placed.volume);
}

std::vector<std::byte> read_file(const std::string& name, const std::string& path, std::uint64_t most_bytes,
                                 const std::string& folder) {
    InputFile file(name, path, folder);
    MemoryBudget(most_bytes).charge(name, "its bytes", file.size_bytes(), 1);
    std::vector<std::byte> bytes(file.size_bytes());
    file.read(bytes.data(), bytes.size());
    return bytes;
}

void check_ratio(const std::string& name, std::size_t packed, std::size_t needed) {
    constexpr std::size_t most_per_byte = 1032;  // zlib's technical details: deflate reaches 1032 to 1
    if (needed / most_per_byte > packed)
        fail(name,
             fmt::format("its samples take {} bytes, and its {} bytes cannot hold so many", needed, packed));
}

std::vector<std::byte> inflate(const std::string& name, std::span<const std::byte> packed, std::size_t most) {
    z_stream stream{};
    if (inflateInit2(&stream, 15 + 32) != Z_OK)  // zlib or gzip, by its first bytes
        throw Error(Fault::memory, name, "there is no memory to unpack it");
    const std::unique_ptr<z_stream, int (*)(z_stream*)> end(&stream, inflateEnd);
    constexpr std::size_t chunk = std::size_t(1) << 30U;  // zlib counts in 32 bits
    std::vector<std::byte> bytes;
    std::size_t taken = 0;
    std::size_t made = 0;
    while (made < most) {
        if (made == bytes.size()) bytes.resize(std::min(most, std::max<std::size_t>(made * 2, 1U << 16U)));
        if (stream.avail_in == 0 && taken < packed.size()) {
            const std::size_t next = std::min(chunk, packed.size() - taken);
            stream.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(packed.data() + taken));
            stream.avail_in = uInt(next);
            taken += next;
        }
        const std::size_t room = std::min(chunk, bytes.size() - made);
        stream.next_out = reinterpret_cast<Bytef*>(bytes.data() + made);
        stream.avail_out = uInt(room);
        const int result = ::inflate(&stream, Z_NO_FLUSH);
        made += room - stream.avail_out;
        if (result == Z_STREAM_END && begins_member(packed.subspan(taken - stream.avail_in))) {
            inflateReset(&stream);
            continue;
        }
        if (result == Z_STREAM_END || result == Z_BUF_ERROR) break;
        if (result == Z_MEM_ERROR) throw Error(Fault::memory, name, "there is no memory to unpack it");
        if (result != Z_OK)
            fail(name, fmt::format("its compressed data is broken after {} bytes ({})", made,
                                   stream.msg != nullptr ? stream.msg : "no zlib stream"));
    }
    bytes.resize(made);
    return bytes;
}

}  // namespace cairn::scenes::volume
