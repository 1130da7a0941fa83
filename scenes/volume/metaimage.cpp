// MetaImage: a header of "Key = Value" lines, then the samples, or the name of the file that has them.
// Format: the MetaIO library's documentation, "MetaIO/Documentation" of ITK; keys as its reader takes them.
#include <algorithm>
#include <charconv>
#include <filesystem>
#include <map>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "scenes/volume/reader.h"

namespace cairn::scenes::volume {
namespace {

/// A header that is longer is none.
constexpr std::size_t longest_header = 1U << 16U;

using Keys = std::map<std::string, std::string, std::less<>>;

struct Header {
    Keys keys;
    std::size_t bytes = 0;  ///< length of the header, from the file's start
};

std::string_view trimmed(std::string_view text) {
    constexpr std::string_view blanks = " \t\r";
    const std::size_t first = text.find_first_not_of(blanks);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

Header read_header(const std::string& name, std::span<const std::byte> bytes) {
    Header header;
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()),
                                std::min(bytes.size(), longest_header));
    std::size_t at = 0;
    while (at < text.size()) {
        const std::size_t end = text.find('\n', at);
        if (end == std::string_view::npos) break;
        const std::string_view line = text.substr(at, end - at);
        at = end + 1;
        const std::size_t equals = line.find('=');
        if (equals == std::string_view::npos) {
            if (trimmed(line).empty()) continue;
            fail(name, "its header has a line without \"=\"");
        }
        const std::string key(trimmed(line.substr(0, equals)));
        header.keys[key] = trimmed(line.substr(equals + 1));
        if (key != "ElementDataFile") continue;
        header.bytes = at;
        return header;
    }
    fail(name, "its header does not end with ElementDataFile", "it may not be a MetaImage");
}

std::optional<std::string> find(const Keys& keys, std::initializer_list<const char*> names) {
    for (const char* key : names) {
        if (const auto found = keys.find(key); found != keys.end()) return found->second;
    }
    return std::nullopt;
}

std::vector<double> numbers(const std::string& name, const std::string& key, std::string_view text,
                            std::size_t count) {
    std::vector<double> values;
    while (!(text = trimmed(text)).empty()) {
        double value = 0.0;
        const auto [stop, failed] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (failed != std::errc() || values.size() == count) break;
        values.push_back(value);
        text.remove_prefix(std::size_t(stop - text.data()));
        if (!text.empty() && trimmed(text.substr(0, 1)).empty()) continue;
        break;
    }
    if (values.size() != count || !text.empty()) fail(name, fmt::format("{} is not {} numbers", key, count));
    return values;
}

bool flag(const Keys& keys, std::initializer_list<const char*> names, bool otherwise) {
    const std::optional<std::string> value = find(keys, names);
    return value ? !value->empty() && ((*value)[0] == 'T' || (*value)[0] == 't' || (*value)[0] == '1')
                 : otherwise;
}

SampleType sample_type(const std::string& name, const std::string& type) {
    static const std::map<std::string, SampleType, std::less<>> types = {
        {"MET_UCHAR", SampleType::u8},       {"MET_CHAR", SampleType::i8},
        {"MET_USHORT", SampleType::u16},     {"MET_SHORT", SampleType::i16},
        {"MET_UINT", SampleType::u32},       {"MET_INT", SampleType::i32},
        {"MET_ULONG", SampleType::u32},      {"MET_LONG", SampleType::i32},
        {"MET_ULONG_LONG", SampleType::u64}, {"MET_LONG_LONG", SampleType::i64},
        {"MET_FLOAT", SampleType::f32},      {"MET_DOUBLE", SampleType::f64}};
    const auto found = types.find(type);
    if (found == types.end())
        fail(name, fmt::format("its ElementType \"{:.40}\" is not supported", type),
             "convert it to MET_SHORT or MET_FLOAT");
    return found->second;
}

Layout layout_of(const std::string& name, const Keys& keys) {
    auto required = [&](const char* key) {
        const std::optional<std::string> value = find(keys, {key});
        if (!value) fail(name, fmt::format("its header has no {}", key));
        return *value;
    };
    Layout layout;
    if (numbers(name, "NDims", required("NDims"), 1)[0] != 3.0)
        fail(name, "it does not have 3 dimensions", "only volumes are read");
    if (const auto channels = find(keys, {"ElementNumberOfChannels"});
        channels && numbers(name, "ElementNumberOfChannels", *channels, 1)[0] != 1.0)
        fail(name, "it has more than one value a sample", "export one channel");
    if (!flag(keys, {"BinaryData"}, true))
        fail(name, "its samples are written as text", "write them as binary data");
    layout.type = sample_type(name, required("ElementType"));
    layout.big_endian = flag(keys, {"BinaryDataByteOrderMSB", "ElementByteOrderMSB"}, false);
    const std::vector<double> size = numbers(name, "DimSize", required("DimSize"), 3);
    for (int axis = 0; axis < 3; ++axis) {
        const double count = size[std::size_t(axis)];
        if (!(count >= 1.0 && count < 1e9 && count == double(std::int64_t(count))))
            fail(name, fmt::format("DimSize {} is no number of samples", count));
        layout.size[axis] = std::int64_t(count);
    }
    std::vector<double> spacing{1.0, 1.0, 1.0};
    if (const auto text = find(keys, {"ElementSpacing", "ElementSize"}))
        spacing = numbers(name, "ElementSpacing", *text, 3);
    std::vector<double> matrix{1, 0, 0, 0, 1, 0, 0, 0, 1};  // a row is the direction of one axis of the file
    if (const auto text = find(keys, {"TransformMatrix", "Rotation", "Orientation"}))
        matrix = numbers(name, "TransformMatrix", *text, 9);
    std::vector<double> offset{0.0, 0.0, 0.0};
    if (const auto text = find(keys, {"Offset", "Position", "Origin"}))
        offset = numbers(name, "Offset", *text, 3);
    // x to the left, y to the back, z upwards; the world's y is upwards and its z towards the viewer.
    const auto world = [](double x, double y, double z) { return glm::dvec3(x, z, -y); };
    for (std::size_t axis = 0; axis < 3; ++axis)
        layout.axes[axis] =
            spacing[axis] * world(matrix[3 * axis], matrix[3 * axis + 1], matrix[3 * axis + 2]);
    layout.origin = world(offset[0], offset[1], offset[2]);
    return layout;
}

/// The samples' bytes, still packed if they are.
std::vector<std::byte> data_bytes(const std::string& path, const Header& header, std::vector<std::byte> file,
                                  std::size_t needed, const LoadOptions& options) {
    const std::string data_file = header.keys.at("ElementDataFile");
    if (data_file == "LOCAL" || data_file == "Local" || data_file == "local") {
        file.erase(file.begin(), file.begin() + std::ptrdiff_t(header.bytes));
        return file;
    }
    const std::filesystem::path other(data_file);
    if (data_file.starts_with("LIST") || data_file.find('%') != std::string::npos)
        fail(path, "its samples are in a series of files", "write it as one .mha");
    if (data_file.empty() || other.filename() != other || other == "..")
        fail(path, fmt::format("its samples are in \"{:.80}\", which is not a file beside it", data_file),
             "write it as one .mha");
    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    const std::string inside = folder.empty() ? "." : folder.string();
    std::vector<std::byte> data = read_file(fmt::format("{}: its data file", path), (folder / other).string(),
                                            options.memory_bytes.value_or(usual_memory_bytes),
                                            options.trust_paths ? std::string() : inside);
    const auto skip_text = find(header.keys, {"HeaderSize"});
    const double skip = skip_text ? numbers(path, "HeaderSize", *skip_text, 1)[0] : 0.0;
    if (skip == -1.0) {  // the samples are the file's end
        if (data.size() > needed) data.erase(data.begin(), data.end() - std::ptrdiff_t(needed));
    } else if (!(skip >= 0.0 && skip <= double(data.size()))) {
        fail(path, fmt::format("HeaderSize {} is not within \"{:.80}\"", skip, data_file));
    } else {
        data.erase(data.begin(), data.begin() + std::ptrdiff_t(skip));
    }
    return data;
}

}  // namespace

Volume read_metaimage(const std::string& path, const LoadOptions& options) {
    std::vector<std::byte> file = read_file(path, path, options.memory_bytes.value_or(usual_memory_bytes));
    const Header header = read_header(path, file);
    const Layout layout = layout_of(path, header.keys);
    const std::size_t needed = checked_bytes(path, layout, options.memory_bytes.value_or(usual_memory_bytes));
    std::vector<std::byte> data = data_bytes(path, header, std::move(file), needed, options);
    if (flag(header.keys, {"CompressedData"}, false)) {
        check_ratio(path, data.size(), needed);
        data = inflate(path, data, needed);
    }
    return decode(path, layout, data);
}

}  // namespace cairn::scenes::volume
