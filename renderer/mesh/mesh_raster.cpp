#include "renderer/mesh/mesh_raster.h"

#include <algorithm>
#include <array>
#include <compare>
#include <optional>
#include <string>
#include <utility>

#include "gl/buffer.h"
#include "gl/buffer_offset.h"
#include "gl/draw_state.h"
#include "gl/handle.h"
#include "gl/program_family.h"
#include "renderer/mesh/mesh_targets.h"
#include "renderer/mesh/mix.h"
#include "shaders/interop/grid.h"
#include "shaders/interop/mesh.h"
#include "shaders/interop/surface.h"
#include "shaders/interop/threads.h"
#include "voxelizer/surface/surface.h"

namespace cairn::renderer {
namespace {

/// What distinguishes the programs that draw a mesh.
struct MeshVariant {
    std::string fragment;  ///< the fragment shader
    bool is_masked = false;
    [[nodiscard]] auto operator<=>(const MeshVariant&) const = default;
};

/// Some rows of a picture, as the rays of a camera see them: what a drawing depends on.
struct Strip {
    glm::vec3 eye, forward, right, up;
    float skipped;
    glm::vec2 pixel_place;
    glm::ivec2 picture;
    ViewSpace space;
    int first_row;
    int rows;
    bool operator==(const Strip&) const = default;
};

Strip strip_of(const interop::MarchView& view, const ViewSpace& space, int row, int strip_pixels) {
    const glm::ivec2 picture(view.width, view.height);
    const int most = std::max(strip_pixels / picture.x, 1);
    const int first = row / most * most;
    return {view.eye,     view.forward,
            view.right,   view.up,
            view.skipped, {view.pixel_x, view.pixel_y},
            picture,      space,
            first,        std::min(most, picture.y - first)};
}

/// Inverts pixel_ray(): a point `p` from the moved eye is x * w * right - y * w * up + along * forward, with
/// w = along + the distance that the eye was moved by.
interop::MeshView mesh_view(const Strip& strip, const voxelizer::Grid& lattice) {
    const glm::dvec3 right(strip.right);
    const glm::dvec3 down(-strip.up);
    const glm::dvec3 forward(strip.forward);
    const glm::dmat3 rows = glm::transpose(glm::inverse(glm::dmat3(right, down, forward)));
    const double unit = lattice.lattice_unit() / strip.space.unit;
    const glm::dvec3 origin =
        (lattice.origin - strip.space.origin) / strip.space.unit - glm::dvec3(strip.eye);
    const double side = unit * double(1 << LATTICE_BITS);
    interop::MeshView out{};
    out.origin = origin;
    out.lattice_unit = unit;
    out.across = rows[0];
    out.down = rows[1];
    out.nearest = side * MESH_NEAREST_PART;
    out.along = rows[2];
    out.skipped = double(strip.skipped);
    // The driver draws what lies in the middle of a pixel.
    const glm::dvec2 beside_middle = glm::dvec2(strip.pixel_place) - 0.5;
    out.moved_across = -2.0 * beside_middle.x / strip.picture.x;
    out.moved_down = -2.0 * beside_middle.y / strip.picture.y;
    return out;
}

gl::Buffer index_buffer(const voxelizer::GpuSurfaceChunk& chunk) {
    const auto triangles = chunk.triangles.read_all<interop::SurfaceTriangle>(chunk.triangle_count);
    std::vector<std::uint32_t> indices;
    indices.reserve(3 * triangles.size());
    for (const interop::SurfaceTriangle& triangle : triangles) {
        for (int corner = 0; corner < 3; ++corner)
            indices.push_back(triangle.vertices[corner]);
    }
    return gl::Buffer::of(std::span<const std::uint32_t>(indices), "indices of a mesh");
}

}  // namespace

struct MeshRaster::Impl {
    Impl(const voxelizer::Grid& grid, const gl::ShaderSource& shaders, const MeshRasterLimits& wanted)
        : limits{std::max(wanted.triangles, 1U), wanted.strip_pixels},
          lattice(grid),
          view_buffer(sizeof(interop::MarchView), "view of a mesh"),
          mesh_view_buffer(sizeof(interop::MeshView), "place of a mesh"),
          place_triangles(gl::build_compute(shaders, "mesh/place_triangles.comp.glsl")),
          drawings([shaders](const MeshVariant& variant) {
              return gl::build_raster(shaders, "mesh/project.vert.glsl", variant.fragment, {},
                                      {{"MASKED", variant.is_masked ? "1" : "0"}});
          }) {
        GLuint name = 0;
        glCreateVertexArrays(1, &name);
        vertex_array = gl::VertexArrayHandle(name);
        glEnableVertexArrayAttrib(name, ATTRIBUTE_POSITION);
        glVertexArrayAttribIFormat(name, ATTRIBUTE_POSITION, 3, GL_INT, 0);
        glVertexArrayAttribBinding(name, ATTRIBUTE_POSITION, 0);
    }

    void show(const voxelizer::GpuSurface& shown) {
        surface = &shown;
        indices.clear();
        triangle_count = shown.far_triangles.size();
        std::size_t largest = 1;
        for (const voxelizer::GpuSurfaceChunk& chunk : shown.chunks) {
            indices.push_back(index_buffer(chunk));
            triangle_count += chunk.triangle_count;
            largest = std::max<std::size_t>(largest, chunk.triangle_count);
        }
        largest = std::min<std::size_t>(largest, limits.triangles);
        if (placed.size_bytes() < largest * sizeof(interop::MeshTriangle))
            placed = gl::Buffer(largest * sizeof(interop::MeshTriangle), "triangles of a mesh");
        forget_drawn();
    }

    void forget_drawn() {
        placed_strip.reset();
        placed_of.reset();
        surface_strip.reset();
        span_strip.reset();
    }

    /// The program of a fragment shader, for the surface that is shown.
    const gl::Program& program(const char* fragment) { return drawings.get({fragment, surface->has_mask}); }

    void begin(const Strip& strip, const MeshTargets& targets);
    void place(std::size_t chunk, unsigned first, unsigned count);
    void draw_all(const gl::Program& drawing);
    void draw_nearest(const Strip& strip);
    void draw_look(const Strip& strip);
    void draw_span(const Strip& strip);

    MeshRasterLimits limits;
    voxelizer::Grid lattice;
    std::uint64_t triangle_count = 0;
    voxelizer::GpuSurface scene_surface;             ///< empty if the surface is the caller's
    const voxelizer::GpuSurface* surface = nullptr;  ///< the surface that is shown
    std::vector<gl::Buffer> indices;                 ///< one buffer per chunk
    gl::Buffer placed;                               ///< MeshTriangle
    std::optional<Strip> placed_strip;               ///< the strip whose rays `placed` is for
    /// Chunk and first triangle of the batch in `placed`.
    std::optional<std::pair<std::size_t, unsigned>> placed_of;
    gl::Buffer view_buffer;
    gl::Buffer mesh_view_buffer;
    gl::VertexArrayHandle vertex_array;
    gl::Program place_triangles;
    gl::ProgramFamily<MeshVariant> drawings;
    MeshTargets nearest, look, span;
    std::optional<Strip> surface_strip, span_strip;  ///< what the targets hold
};

/// Sets the view and the render targets. The viewport is that of the whole picture; the targets hold some of
/// its rows.
void MeshRaster::Impl::begin(const Strip& strip, const MeshTargets& targets) {
    if (placed_strip != strip) placed_of.reset();
    placed_strip = strip;
    interop::MarchView view{};
    view.eye = strip.eye;
    view.forward = strip.forward;
    view.right = strip.right;
    view.up = strip.up;
    view.skipped = strip.skipped;
    view.pixel_x = strip.pixel_place.x;
    view.pixel_y = strip.pixel_place.y;
    view.width = strip.picture.x;
    view.height = strip.picture.y;
    view.first_row = strip.first_row;
    view.row_count = strip.rows;
    view_buffer.write(0, &view, sizeof(view));
    const interop::MeshView placing = mesh_view(strip, lattice);
    mesh_view_buffer.write(0, &placing, sizeof(placing));
    view_buffer.bind_uniform(UBO_VIEW);
    mesh_view_buffer.bind_uniform(UBO_MESH_VIEW);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, targets.framebuffer());
    glViewport(0, -strip.first_row, strip.picture.x, strip.picture.y);
    glFrontFace(GL_CW);  // rows go downwards
}

/// Fills `placed` from the bound chunk. Most meshes are one batch, which their second pass finds as the first
/// left it.
void MeshRaster::Impl::place(std::size_t chunk, unsigned first, unsigned count) {
    if (placed_of == std::pair(chunk, first)) return;
    place_triangles.set("first", first);
    place_triangles.set("count", count);
    place_triangles.use();
    // Fragments of the batch before may still read what this overwrites.
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    gl::dispatch_threads(count, THREADS_PER_GROUP);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    placed_of = std::pair(chunk, first);
}

void MeshRaster::Impl::draw_all(const gl::Program& drawing) {
    glBindVertexArray(vertex_array.id());
    placed.bind_storage(SSBO_MESH_TRIANGLES);
    for (std::size_t chunk = 0; chunk < surface->chunks.size(); ++chunk) {
        const voxelizer::GpuSurfaceChunk& mesh = surface->chunks[chunk];
        surface->bind(chunk);
        glVertexArrayVertexBuffer(vertex_array.id(), 0, mesh.positions.id(), 0, 3 * sizeof(std::int32_t));
        glVertexArrayElementBuffer(vertex_array.id(), indices[chunk].id());
        for (unsigned first = 0; first < mesh.triangle_count; first += limits.triangles) {
            const unsigned count = std::min(mesh.triangle_count - first, limits.triangles);
            place(chunk, first, count);
            drawing.set("first", first);
            drawing.use();
            glDrawElements(GL_TRIANGLES, GLsizei(3 * count), GL_UNSIGNED_INT,
                           gl::buffer_offset(std::size_t(first) * 3 * sizeof(std::uint32_t)));
        }
    }
}

void MeshRaster::Impl::draw_nearest(const Strip& strip) {
    const glm::ivec2 size(strip.picture.x, strip.rows);
    if (nearest.size() != size) {
        nearest = MeshTargets();  // first, so that both never exist
        nearest = MeshTargets(size, {GL_R32F});
    }
    const gl::DrawStateGuard guard;
    begin(strip, nearest);
    constexpr std::array<float, 4> nothing = {MESH_MISS, 0.0F, 0.0F, 0.0F};
    glClearNamedFramebufferfv(nearest.framebuffer(), GL_COLOR, 0, nothing.data());
    glEnable(GL_BLEND);
    glBlendEquationi(0, GL_MIN);
    draw_all(program("mesh/find_nearest.frag.glsl"));
}

void MeshRaster::Impl::draw_look(const Strip& strip) {
    const glm::ivec2 size(strip.picture.x, strip.rows);
    if (look.size() != size) {
        look = MeshTargets();
        look = MeshTargets(size, {GL_RGBA32UI});
    }
    const gl::DrawStateGuard guard;
    begin(strip, look);
    constexpr std::array<GLuint, 4> nothing{};
    glClearNamedFramebufferuiv(look.framebuffer(), GL_COLOR, 0, nothing.data());
    glBindTextureUnit(TEXTURE_MESH_NEAREST, nearest.texture(0));
    draw_all(program("mesh/draw_surface.frag.glsl"));
}

void MeshRaster::Impl::draw_span(const Strip& strip) {
    const glm::ivec2 size(strip.picture.x, strip.rows);
    if (span.size() != size) {
        span = MeshTargets();
        span = MeshTargets(size, {GL_RG32F, GL_R32F});
    }
    const gl::DrawStateGuard guard;
    begin(strip, span);
    constexpr std::array<float, 4> nothing = {MESH_MISS, MESH_MISS, 0.0F, 0.0F};
    constexpr std::array<float, 4> none{};
    glClearNamedFramebufferfv(span.framebuffer(), GL_COLOR, 0, nothing.data());
    glClearNamedFramebufferfv(span.framebuffer(), GL_COLOR, 1, none.data());
    glEnable(GL_BLEND);
    glBlendEquationi(0, GL_MIN);
    glBlendEquationi(1, GL_FUNC_ADD);
    glBlendFunci(1, GL_ONE, GL_ONE);
    draw_all(program("mesh/find_span.frag.glsl"));
}

namespace {

/// A grid of which only the lattice is used. Its voxels are small, so that its margin is small too.
voxelizer::Grid lattice_around(const scenes::Bounds& bounds) {
    constexpr int resolution = 1024;
    return voxelizer::grid_around(bounds, resolution);
}

}  // namespace

MeshRaster::MeshRaster(const scenes::Scene& scene, const scenes::Snapshot& snapshot,
                       const gl::ShaderSource& shaders)
    : impl_(std::make_unique<Impl>(lattice_around(snapshot.bounds), shaders, MeshRasterLimits())) {
    impl_->scene_surface =
        voxelizer::upload(voxelizer::build_surface(scene, snapshot, impl_->lattice, {.attributes = true}));
    impl_->show(impl_->scene_surface);
}
MeshRaster::MeshRaster(const voxelizer::GpuSurface& surface, const voxelizer::Grid& lattice,
                       const gl::ShaderSource& shaders, const MeshRasterLimits& limits)
    : impl_(std::make_unique<Impl>(lattice, shaders, limits)) {
    impl_->show(surface);
}
MeshRaster::MeshRaster(MeshRaster&&) noexcept = default;
MeshRaster& MeshRaster::operator=(MeshRaster&&) noexcept = default;
MeshRaster::~MeshRaster() = default;

std::shared_ptr<MeshRaster> make_mesh_raster(const scenes::Scene& scene, const scenes::Snapshot& snapshot,
                                             const gl::ShaderSource& shaders) {
    return std::make_shared<MeshRaster>(scene, snapshot, shaders);
}

void MeshRaster::surface_moved() {
    glMemoryBarrier(GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT);
    impl_->forget_drawn();
}

void MeshRaster::show(const voxelizer::GpuSurface& surface) {
    impl_->show(surface);
}

MeshSurface MeshRaster::draw_surface(const interop::MarchView& view, const ViewSpace& space, int row) {
    const Strip strip = strip_of(view, space, row, impl_->limits.strip_pixels);
    if (impl_->surface_strip != strip) {
        impl_->surface_strip.reset();
        impl_->draw_nearest(strip);
        impl_->draw_look(strip);
        impl_->surface_strip = strip;
    }
    return {strip.first_row, strip.rows, impl_->nearest.texture(0), impl_->look.texture(0)};
}

MeshSpan MeshRaster::draw_span(const interop::MarchView& view, const ViewSpace& space, int row) {
    const Strip strip = strip_of(view, space, row, impl_->limits.strip_pixels);
    if (impl_->span_strip != strip) {
        impl_->span_strip.reset();
        impl_->draw_span(strip);
        impl_->span_strip = strip;
    }
    return {strip.first_row, strip.rows, impl_->span.texture(0), impl_->span.texture(1)};
}

std::uint64_t MeshRaster::triangle_count() const {
    return impl_->triangle_count;
}

std::size_t MeshRaster::size_bytes() const {
    std::size_t sum = impl_->scene_surface.size_bytes() + impl_->placed.size_bytes();
    for (const gl::Buffer& buffer : impl_->indices)
        sum += buffer.size_bytes();
    return sum;
}

}  // namespace cairn::renderer
