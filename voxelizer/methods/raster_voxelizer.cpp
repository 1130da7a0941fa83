#include "voxelizer/methods/raster_voxelizer.h"

#include <algorithm>
#include <bit>
#include <string_view>

#include <fmt/format.h>

#include "base/error.h"
#include "gl/buffer_offset.h"
#include "gl/draw_state.h"
#include "shaders/interop/surface.h"
#include "shaders/interop/threads.h"
#include "voxelizer/surface/far_clip.h"

namespace cairn::voxelizer {
namespace {

/// Vertex numbers per list of shaders/voxelize/raster_lists.glsl.
std::size_t list_words(const BatchLimits& limits) {
    return 3 * std::size_t(limits.triangles);
}

/// All lists: of each the length, the vertices and the triangles.
std::size_t list_bytes(const BatchLimits& limits) {
    return RASTER_KINDS * (1 + list_words(limits) + limits.triangles) * sizeof(std::uint32_t);
}

int corners_of(unsigned kind) {
    return kind == RASTER_SEGMENTS ? 2 : kind == RASTER_POINTS ? 1 : 3;
}

bool has_extension(std::string_view name) {
    GLint count = 0;
    glGetIntegerv(GL_NUM_EXTENSIONS, &count);
    for (GLint i = 0; i < count; ++i) {
        const GLubyte* const text = glGetStringi(GL_EXTENSIONS, GLuint(i));
        if (name == reinterpret_cast<const char*>(text)) return true;
    }
    return false;
}

bool takes_vertex_path(LayerPath path) {
    if (path == LayerPath::vertex_shader && !RasterVoxelizer::has_vertex_path()) {
        throw Error(Fault::context, "layers by the vertex shader",
                    "the driver lacks ARB_shader_viewport_layer_array, or storage buffers in vertex shaders",
                    "use the geometry shader");
    }
    return path == LayerPath::vertex_shader;
}

/// A power of two, so that scaling by it is exact.
int viewport_side(const glm::ivec2& plane) {
    return int(std::bit_ceil(unsigned(std::max(plane.x, plane.y))));
}

}  // namespace

gl::Defines defines(const RasterVariant& variant) {
    return {{"CORNERS", std::to_string(variant.corners)},
            {"COVER", variant.cover ? "1" : "0"},
            {"AXES", std::to_string(variant.axes)},
            {"MASKED", variant.masked ? "1" : "0"},
            {"TARGETS", std::to_string(variant.targets)}};
}

std::vector<RasterVariant> valid_raster_variants() {
    std::vector<RasterVariant> valid;
    for (const bool masked : {false, true}) {
        for (int targets = 1; targets <= RASTER_TARGETS; targets *= 2) {
            for (const int corners : {3, 2, 1}) {
                for (const int axes : {1, 3}) {
                    valid.push_back({corners, false, axes, masked, targets});
                    // Far triangles are enlarged by every method.
                    if (corners == 3) valid.push_back({corners, true, axes, masked, targets});
                }
                valid.push_back({corners, true, 0, masked, targets});
            }
        }
    }
    return valid;
}

bool RasterVoxelizer::has_vertex_path() {
    GLint blocks = 0;
    glGetIntegerv(GL_MAX_VERTEX_SHADER_STORAGE_BLOCKS, &blocks);
    constexpr GLint needed = 4;  // of the surface three, and the lists
    return blocks >= needed && has_extension("GL_ARB_shader_viewport_layer_array");
}

RasterVoxelizer::RasterVoxelizer(Method method, const gl::ShaderSource& shaders, LayerPath path,
                                 const BatchLimits& limits)
    : Voxelizer(shaders),
      method_(method),
      limits_(limits.usable()),
      vertex_path_(takes_vertex_path(path)),
      list_(gl::build_compute(shaders, "voxelize/list_primitives.comp.glsl")),
      unite_along_x_(gl::build_compute(shaders, "voxelize/unite_slices.comp.glsl", {{"ALONG_X", "1"}})),
      unite_(gl::build_compute(shaders, "voxelize/unite_slices.comp.glsl", {{"ALONG_X", "0"}})),
      programs_([vertex_path = vertex_path_, shaders](const RasterVariant& variant) {
          const gl::Defines macros = defines(variant);
          return vertex_path
                     ? gl::build_raster(shaders, "voxelize/project.vert.glsl", "voxelize/slice.frag.glsl", {},
                                        macros)
                     : gl::build_raster(shaders, "voxelize/feed.vert.glsl", "voxelize/slice.frag.glsl",
                                        "voxelize/project.geom.glsl", macros);
      }),
      lists_(list_bytes(limits_), "primitives to rasterize") {
    GLuint vertex_array = 0;
    glCreateVertexArrays(1, &vertex_array);
    vertex_array_ = gl::VertexArrayHandle(vertex_array);
    if (vertex_path_) return;
    glEnableVertexArrayAttrib(vertex_array, ATTRIBUTE_POSITION);
    glVertexArrayAttribIFormat(vertex_array, ATTRIBUTE_POSITION, 3, GL_INT, 0);
    glVertexArrayAttribBinding(vertex_array, ATTRIBUTE_POSITION, 0);
    glVertexArrayElementBuffer(vertex_array, lists_.id());
}

const gl::Program& RasterVoxelizer::program(unsigned kind, bool cover, bool masked) {
    const int targets = int(std::bit_ceil(unsigned(targets_.target_count())));
    return programs_.get({.corners = corners_of(kind),
                          .cover = cover,
                          .axes = is_conservative() ? 0 : directions(),
                          .masked = masked,
                          .targets = targets});
}

void RasterVoxelizer::mark(const GpuSurface& surface, const Region& region, std::span<const ChunkPart> parts,
                           gl::Buffer& bits) {
    bits.fill(0);
    std::optional<GpuSurfaceChunk> far;
    if (!surface.far_triangles.empty()) far = upload_chunk(clip_far_triangles(surface.far_triangles));
    const gl::DrawStateGuard guard;
    glBindVertexArray(vertex_array_.id());
    glLogicOp(GL_OR);
    for (const RasterTile& tile : raster_tiles(region, directions(), limits_.target_bytes)) {
        const glm::ivec2 plane = tile.plane(directions());
        const int slices = tile.slices(directions());
        if (!targets_.fits(plane, directions(), slices)) {
            targets_ = SliceTargets();  // first, so that both never exist
            targets_ = SliceTargets(plane, directions(), slices);
        }
        targets_.begin();
        const int side = viewport_side(plane);
        glViewport(0, 0, side, side);
        lists_.bind_storage(SSBO_RASTER_LISTS);
        glEnable(GL_COLOR_LOGIC_OP);
        for (std::size_t chunk = 0; chunk < surface.chunks.size(); ++chunk) {
            surface.bind(surface.chunks[chunk]);
            draw_chunk(surface.chunks[chunk].positions, tile, parts[chunk], surface.has_mask);
        }
        if (far) {
            surface.bind(*far);
            draw_chunk(far->positions, tile, {far->triangle_count, std::nullopt}, surface.has_mask);
        }
        glDisable(GL_COLOR_LOGIC_OP);
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
        bits.bind_storage(SSBO_VOXEL_BITS);
        unite(region, tile);
    }
}

void RasterVoxelizer::draw_chunk(const gl::Buffer& positions, const RasterTile& tile, const ChunkPart& part,
                                 bool masked) {
    if (!vertex_path_)
        glVertexArrayVertexBuffer(vertex_array_.id(), 0, positions.id(), 0, 3 * sizeof(std::int32_t));
    const std::size_t batch = limits_.triangles;
    for (std::size_t first = 0; first < part.count; first += batch) {
        if (part.subset) part.subset->bind_storage(SSBO_VOXEL_SUBSET);
        const std::size_t count = std::min(part.count - first, batch);
        const Counts counts = list_batch(tile, first, count, part.subset.has_value());
        for (unsigned kind = 0; kind < RASTER_KINDS; ++kind) {
            if (counts[kind] > 0) draw_list(kind, counts[kind], tile, masked);
        }
    }
}

RasterVoxelizer::Counts RasterVoxelizer::list_batch(const RasterTile& tile, std::size_t first,
                                                    std::size_t count, bool has_subset) {
    // Fragments of the batch before may still read the lists.
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    lists_.fill(0, sizeof(Counts), 0);
    list_.set("first", unsigned(first));
    list_.set("count", unsigned(count));
    list_.set("has_subset", int(has_subset));
    list_.set("tile_low", tile.lattice_low);
    list_.set("tile_size", tile.size);
    list_.set("voxel_shift", tile.voxel_shift);
    list_.set("split_far", int(!is_conservative()));
    list_.use();
    gl::dispatch_threads(count, THREADS_PER_GROUP);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_ELEMENT_ARRAY_BARRIER_BIT |
                    GL_BUFFER_UPDATE_BARRIER_BIT);
    Counts counts{};
    lists_.read(0, counts.data(), sizeof(counts));
    return counts;
}

void RasterVoxelizer::draw_list(unsigned kind, unsigned count, const RasterTile& tile, bool masked) {
    const bool cover = is_conservative() || kind == RASTER_FAR;
    const gl::Program& drawing = program(kind, cover, masked);
    drawing.set("tile_low", tile.lattice_low);
    drawing.set("region_end", tile.region_end);
    drawing.set("voxel_shift", tile.voxel_shift);
    drawing.set("tall", int(tile.tall()));
    drawing.set("tile_middle", 0.5F * float(tile.longest_side()));
    drawing.set("viewport_scale", 2.0F / float(viewport_side(tile.plane(directions()))));
    drawing.set("half_pixel", is_conservative() ? 0.5F : 0.0F);
    drawing.set("slack", is_conservative() ? float(tile.longest_side()) * 0x1p-20F : 0.0F);
    drawing.set("kind", kind);
    drawing.use();
    constexpr std::array<GLenum, 3> modes = {GL_POINTS, GL_LINES, GL_TRIANGLES};
    const GLenum mode = vertex_path_ && cover ? GL_TRIANGLES : modes[corners_of(kind) - 1];
    if (vertex_path_) {
        const unsigned vertices = cover ? 3 : corners_of(kind);
        const int instances = is_conservative() ? 1 : directions();
        glDrawArraysInstanced(mode, 0, GLsizei(count * vertices), instances);
    } else {
        const std::size_t first = (RASTER_KINDS + kind * list_words(limits_)) * sizeof(std::uint32_t);
        glDrawElements(mode, GLsizei(count * corners_of(kind)), GL_UNSIGNED_INT, gl::buffer_offset(first));
    }
}

void RasterVoxelizer::unite(const Region& region, const RasterTile& tile) {
    const int row_words = (tile.size.x + 31) / 32;
    for (int layer = 0; layer < directions(); ++layer) {
        const int axis = directions() == 1 ? 2 : layer;
        const int threads =
            axis == 0 ? tile.size.y * tile.size.z : row_words * (axis == 1 ? tile.size.z : tile.size.y);
        const gl::Program& uniting = axis == 0 ? unite_along_x_ : unite_;
        uniting.set("region_size", region.size);
        uniting.set("tile_place", tile.place);
        uniting.set("tile_size", tile.size);
        uniting.set("axis", axis);
        uniting.set("tall", int(tile.tall()));
        uniting.set("layer", layer);
        uniting.use();
        for (int target = 0; target < targets_.target_count(); ++target) {
            if (target * RASTER_TARGET_SLICES >= tile.size[axis]) break;
            glBindTextureUnit(TEXTURE_SLICES, targets_.texture(target));
            uniting.set("first_slice", target * RASTER_TARGET_SLICES);
            gl::dispatch_threads(std::size_t(threads), THREADS_PER_GROUP);
            // Each dispatch adds to words of the one before.
            glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
        }
    }
}

}  // namespace cairn::voxelizer
