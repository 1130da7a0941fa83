#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include <glm/glm.hpp>

#include "scenes/memory_budget.h"
#include "scenes/scene.h"
#include "scenes/snapshot.h"
#include "shaders/interop/surface.h"

namespace cairn::voxelizer {

/// The part of a triangle that an alpha mask leaves.
enum class Shown : std::uint8_t { whole, cut, nothing };

/// The materials of a snapshot as the shaders read them, with the texels they use.
///
/// Material 0 is white and opaque. The scene's materials follow, and then, for each masked one, a twin
/// without its mask, for triangles that are wholly shown.
class SurfaceMaterials {
public:
    /// @param all_textures  whether to upload every base-colour image in use, with its mip levels, or only
    ///                      those of masks, without.
    /// @throws Error  Fault::memory if the images hold more texels than 32 bits can number, or than
    ///                Scene::placing allows.
    SurfaceMaterials(const scenes::Scene& scene, const scenes::Snapshot& snapshot, bool all_textures);

    [[nodiscard]] bool is_masked(int scene_material) const;
    [[nodiscard]] Shown shown(int scene_material, const std::array<glm::vec2, 3>& texcoords,
                              const std::array<std::uint16_t, 3>& alphas) const;
    /// Index into `materials`.
    [[nodiscard]] std::uint32_t number(int scene_material, Shown shown) const;

    std::vector<interop::SurfaceMaterial> materials;
    std::vector<std::uint32_t> texels;
    bool has_color = false;         ///< there is a texture, or factors differ
    glm::vec3 uniform_color{1.0F};  ///< the one factor, if has_color is false
    bool any_masked = false;

private:
    struct Mask {
        std::uint32_t twin = 0;
        std::uint32_t lowest_alpha = 255;
        std::uint32_t highest_alpha = 255;
    };

    void add_material(const scenes::Scene& scene, const scenes::Material& material, bool textured);
    [[nodiscard]] std::uint32_t place_image(const scenes::Image& image, int index);
    void add_twin(std::size_t scene_material);
    /// The lowest and the highest alpha of a material's texels.
    std::pair<std::uint32_t, std::uint32_t> alpha_range(const interop::SurfaceMaterial& material);
    /// Counts the texels that pass, from the top left corner of the image (SurfaceMaterial::passing_offset).
    [[nodiscard]] std::uint32_t add_passing_counts(const interop::SurfaceMaterial& material);
    /// Adds the mip levels of every texture (SurfaceMaterial::mip_offset).
    void add_mips();
    /// Makes room in `texels` for so many more words. @return the first.
    /// @throws Error  Fault::memory if 32 bits cannot number them.
    std::uint32_t grow_texels(std::size_t count);

    scenes::MemoryBudget budget_;  ///< of `texels`
    std::vector<std::int64_t> image_offsets_;
    std::vector<Mask> masks_;  ///< one per material of the scene
    // Many materials may share a picture. The keys are the place of its texels, and with it the lowest alpha
    // that passes.
    std::map<std::uint32_t, std::pair<std::uint32_t, std::uint32_t>> alpha_ranges_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> passing_offsets_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> mip_offsets_;
};

}  // namespace cairn::voxelizer
