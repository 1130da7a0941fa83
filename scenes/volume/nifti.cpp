// NIfTI-1 in one file: a header of 348 bytes, then the samples; both may be in a gzip stream.
// Format: Cox et al., "A (sort of) new image data format standard: NIfTI-1", 2004; fields as in its nifti1.h.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <map>

#include <fmt/format.h>

#include "scenes/volume/reader.h"

namespace cairn::scenes::volume {
namespace {

constexpr std::size_t header_bytes = 348;
constexpr std::size_t most_offset = std::size_t(1) << 24U;  // header extensions that are longer are none

class Header {
public:
    Header(const std::string& name, std::span<const std::byte> bytes) : bytes_(bytes) {
        if (bytes.size() < header_bytes)
            fail(name, fmt::format("it holds {} bytes, a NIfTI header takes {}", bytes.size(), header_bytes));
        swap_ = std::endian::native == std::endian::big;
        if (const int dimensions = at<std::int16_t>(40); dimensions < 1 || dimensions > 7) swap_ = !swap_;
        if (const int dimensions = at<std::int16_t>(40); dimensions < 1 || dimensions > 7)
            fail(name, "its number of dimensions is not between 1 and 7", "it may not be NIfTI-1");
        if (std::memcmp(bytes.data() + 344, "n+1", 4) != 0)
            fail(name, "it is not NIfTI-1 in one file", "convert it to one .nii or .nii.gz");
    }
    template <typename T>
    [[nodiscard]] T at(std::size_t place) const {
        std::array<std::byte, sizeof(T)> raw{};
        std::memcpy(raw.data(), bytes_.data() + place, sizeof(T));
        if (swap_) std::reverse(raw.begin(), raw.end());
        return std::bit_cast<T>(raw);
    }
    [[nodiscard]] int dimension(int i) const { return at<std::int16_t>(40 + 2 * std::size_t(i)); }
    [[nodiscard]] double number(std::size_t place) const { return double(at<float>(place)); }
    [[nodiscard]] bool big_endian() const { return swap_ != (std::endian::native == std::endian::big); }

private:
    std::span<const std::byte> bytes_;
    bool swap_ = false;
};

SampleType sample_type(const std::string& name, const Header& header) {
    static const std::map<int, SampleType> types = {
        {2, SampleType::u8},    {256, SampleType::i8}, {512, SampleType::u16},  {4, SampleType::i16},
        {768, SampleType::u32}, {8, SampleType::i32},  {1280, SampleType::u64}, {1024, SampleType::i64},
        {16, SampleType::f32},  {64, SampleType::f64}};
    const int code = header.at<std::int16_t>(70);
    const auto found = types.find(code);
    if (found == types.end())
        fail(name, fmt::format("its data type {} is not supported", code),
             "convert it to 16-bit integers or floats");
    return found->second;
}

/// x to the right, y to the front, z upwards; the world's y is upwards and its z towards the viewer, as of
/// MetaImage.
glm::dvec3 world(const glm::dvec3& p) {
    return {-p.x, p.z, p.y};
}

/// The rotation of the header's quaternion, nifti1.h's method 2.
void take_quaternion(const Header& header, Layout& layout) {
    const double b = header.number(256);
    const double c = header.number(260);
    const double d = header.number(264);
    const double a = std::sqrt(std::max(0.0, 1.0 - (b * b + c * c + d * d)));
    const double flip = header.number(76) < 0.0 ? -1.0 : 1.0;
    layout.axes[0] =
        header.number(80) * world({a * a + b * b - c * c - d * d, 2 * (b * c + a * d), 2 * (b * d - a * c)});
    layout.axes[1] =
        header.number(84) * world({2 * (b * c - a * d), a * a + c * c - b * b - d * d, 2 * (c * d + a * b)});
    layout.axes[2] = flip * header.number(88) *
                     world({2 * (b * d + a * c), 2 * (c * d - a * b), a * a + d * d - c * c - b * b});
    layout.origin = world({header.number(268), header.number(272), header.number(276)});
}

void take_place(const Header& header, Layout& layout) {
    if (header.at<std::int16_t>(254) > 0) {  // sform: rows of an affine matrix
        const auto column = [&](std::size_t i) {
            return world(
                {header.number(280 + 4 * i), header.number(296 + 4 * i), header.number(312 + 4 * i)});
        };
        layout.axes = {column(0), column(1), column(2)};
        layout.origin = column(3);
    } else if (header.at<std::int16_t>(252) > 0) {
        take_quaternion(header, layout);
    } else {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            glm::dvec3 step(0.0);
            step[int(axis)] = header.number(80 + 4 * axis);
            layout.axes[axis] = world(step);
        }
    }
}

}  // namespace

Volume read_nifti(const std::string& path, const LoadOptions& options) {
    std::vector<std::byte> file = read_file(path, path, options.memory_bytes.value_or(usual_memory_bytes));
    const bool packed = file.size() >= 2 && file[0] == std::byte(0x1F) && file[1] == std::byte(0x8B);
    const std::vector<std::byte> unpacked_header =
        packed ? inflate(path, file, header_bytes) : std::vector<std::byte>();
    const Header header(path, packed ? std::span<const std::byte>(unpacked_header) : file);

    Layout layout;
    bool series = false;
    for (int i = 1; i <= header.dimension(0); ++i) {
        if (i <= 3)
            layout.size[i - 1] = header.dimension(i);
        else
            series = series || header.dimension(i) > 1;
    }
    for (int axis = header.dimension(0); axis < 3; ++axis)
        layout.size[axis] = 1;
    layout.type = sample_type(path, header);
    layout.big_endian = header.big_endian();
    if (const double slope = header.number(112); slope != 0.0) {
        layout.slope = slope;
        layout.intercept = header.number(116);
    }
    take_place(header, layout);

    const double offset = header.number(108);
    if (!(offset >= double(header_bytes) && offset <= double(most_offset)))
        fail(path, fmt::format("its samples start at byte {}", offset));
    const std::size_t needed = checked_bytes(path, layout, options.memory_bytes.value_or(usual_memory_bytes));
    const auto first = std::size_t(offset);
    if (packed) {
        check_ratio(path, file.size(), first + needed);
        file = inflate(path, file, first + needed);
    }
    if (file.size() < first)
        fail(path, fmt::format("it ends at byte {}, before its samples at {}", file.size(), first));
    Volume volume = decode(path, layout, std::span<const std::byte>(file).subspan(first));
    if (series) volume.warnings.push_back({path + ": it is a series; the first volume is read", true});
    return volume;
}

}  // namespace cairn::scenes::volume
