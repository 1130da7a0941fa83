#include "reference/light_cache.h"

#include <cstring>
#include <fstream>
#include <system_error>
#include <type_traits>

#include <fmt/format.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/error.h"
#include "base/output_file.h"

namespace cairn::reference {
namespace {

/// Version of the files and of the sampling. Answers of older versions are not found.
constexpr std::uint64_t version = 2;

struct FileHead {
    std::array<char, 8> magic{'C', 'A', 'I', 'R', 'N', 'L', 'V', '1'};
    std::uint64_t points = 0;
    std::uint64_t sum = 0;  // of what follows
};
static_assert(sizeof(FileHead) == 24);

/// An entry per point, after the header.
struct Entry {
    double visible = 0.0;
    double standard_error = 0.0;
    std::int64_t samples = 0;
};
static_assert(sizeof(Entry) == 24);

class Hasher {
public:
    Hasher() { XXH3_128bits_reset(&state_); }
    template <typename Value>
    void add(const Value& value) {
        static_assert(std::has_unique_object_representations_v<Value> || std::is_floating_point_v<Value>);
        XXH3_128bits_update(&state_, &value, sizeof(value));
    }
    /// Their count too, so that one list does not run on into the next. Of numbers without padding.
    template <typename Value>
    void add_list(std::span<const Value> values) {
        add(std::uint64_t(values.size()));
        if (!values.empty()) XXH3_128bits_update(&state_, values.data(), values.size_bytes());
    }
    template <typename Vector>
    void add_vector(const Vector& vector) {
        XXH3_128bits_update(&state_, &vector, sizeof(vector));
    }
    [[nodiscard]] LightHash result() const {
        const XXH128_hash_t hash = XXH3_128bits_digest(&state_);
        return {hash.high64, hash.low64};
    }

private:
    XXH3_state_t state_;
};

void add_mask(Hasher& hasher, const scenes::Scene& scene, const scenes::Primitive& primitive) {
    const scenes::Material* const material =
        primitive.material < 0 ? nullptr : &scene.materials[std::size_t(primitive.material)];
    const bool masked = material != nullptr && material->alpha_mode == scenes::AlphaMode::mask;
    hasher.add(std::uint8_t(masked));
    if (!masked) return;
    hasher.add(material->alpha_cutoff);
    hasher.add(material->base_color.a);
    hasher.add_vector(material->uv_from_mesh);
    hasher.add_list(std::span(primitive.texcoords));
    hasher.add_list(std::span(primitive.colors));
    if (material->texture < 0) return;
    const scenes::Texture& texture = scene.textures[std::size_t(material->texture)];
    hasher.add(texture.wrap_s);
    hasher.add(texture.wrap_t);
    if (texture.image < 0) return;
    const scenes::Image& image = scene.images[std::size_t(texture.image)];
    hasher.add(image.width);
    hasher.add(image.height);
    hasher.add_list(std::span(image.rgba));
}

/// Adds the fields that the light's shape uses.
void add_light(Hasher& hasher, const optics::Light& light) {
    hasher.add(std::uint8_t(light.positional));
    if (!light.positional) {
        hasher.add_vector(light.towards);
        hasher.add(light.angle);
        return;
    }
    hasher.add(light.shape);
    hasher.add_vector(light.position);
    if (light.shape == optics::LightShape::sphere) {
        hasher.add(light.radius);
        return;
    }
    hasher.add_vector(light.half_u);
    hasher.add_vector(light.half_v);
}

std::uint64_t sum_of(std::span<const Entry> entries) {
    return XXH3_64bits(entries.data(), entries.size_bytes());
}

}  // namespace

LightHash hash_of(const LightQuestion& question) {
    Hasher hasher;
    hasher.add(version);
    for (const scenes::Item& item : question.snapshot.items) {
        if (item.primitive->topology != scenes::Topology::triangles) continue;
        hasher.add_vector(item.world_from_mesh);
        hasher.add_list(item.positions);
        hasher.add_list(item.placed);
        hasher.add_list(std::span(item.primitive->indices));
        add_mask(hasher, question.scene, *item.primitive);
    }
    // Rays begin and end at a share of the bounds' diagonal, and directional lights stand as far from it.
    hasher.add_vector(question.snapshot.bounds.low);
    hasher.add_vector(question.snapshot.bounds.high);
    hasher.add_list(question.points);
    hasher.add_list(question.normals);
    add_light(hasher, question.light);
    hasher.add(question.options.standard_error);
    hasher.add(question.options.least_samples);
    hasher.add(question.options.most_samples);
    hasher.add(question.options.seed);
    hasher.add(question.options.exact_strata);
    hasher.add(question.options.rays);
    return hasher.result();
}

LightCache::LightCache(const std::filesystem::path& folder, const LightHash& hash)
    : path_(folder / fmt::format("{:016x}{:016x}.light", hash[0], hash[1])) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (!std::filesystem::is_directory(folder))
        throw Error(Fault::usage, folder.string(), "it is no folder, and cannot be made: " + error.message(),
                    "name one that can be written");
}

std::optional<std::vector<LightVisibility>> LightCache::load(std::size_t points) const {
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(path_, error);
    if (error || size != sizeof(FileHead) + points * sizeof(Entry)) return std::nullopt;
    std::ifstream file(path_, std::ios::binary);
    FileHead head;
    std::vector<Entry> entries(points);
    file.read(reinterpret_cast<char*>(&head), sizeof(head));
    file.read(reinterpret_cast<char*>(entries.data()), std::streamsize(points * sizeof(Entry)));
    if (!file || head.magic != FileHead{}.magic || head.points != points || head.sum != sum_of(entries))
        return std::nullopt;
    std::vector<LightVisibility> answer;
    answer.reserve(points);
    for (const Entry& entry : entries)
        answer.push_back({entry.visible, entry.standard_error, int(entry.samples)});
    return answer;
}

void LightCache::save(std::span<const LightVisibility> answer) const {
    std::vector<Entry> entries;
    entries.reserve(answer.size());
    for (const LightVisibility& point : answer)
        entries.push_back({point.visible, point.standard_error, point.samples});
    FileHead head;
    head.points = entries.size();
    head.sum = sum_of(entries);
    OutputFile file(path_);
    file.write(&head, sizeof(head));
    file.write(entries.data(), entries.size() * sizeof(Entry));
    file.commit();
}

}  // namespace cairn::reference
