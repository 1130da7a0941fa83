#include "renderer/shadow/soft_shadow_map.h"

#include <array>
#include <bit>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "gl/context.h"
#include "gl/draw_state.h"
#include "gl/timer.h"

namespace cairn::renderer {
namespace {

constexpr unsigned map_group = 8;  // local_size of the passes over maps

gl::TextureHandle make_map(GLenum format, int size, int levels = 1) {
    GLuint id = 0;
    glCreateTextures(GL_TEXTURE_2D, 1, &id);
    gl::TextureHandle texture(id);
    glTextureStorage2D(id, levels, format, size, size);
    glTextureParameteri(id, GL_TEXTURE_MIN_FILTER, levels > 1 ? GL_NEAREST_MIPMAP_NEAREST : GL_NEAREST);
    glTextureParameteri(id, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTextureParameteri(id, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTextureParameteri(id, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    return texture;
}

gl::FramebufferHandle make_target(const gl::TextureHandle& first, const gl::TextureHandle* second = nullptr) {
    GLuint id = 0;
    glCreateFramebuffers(1, &id);
    gl::FramebufferHandle framebuffer(id);
    glNamedFramebufferTexture(id, GL_COLOR_ATTACHMENT0, first.id(), 0);
    if (second != nullptr) glNamedFramebufferTexture(id, GL_COLOR_ATTACHMENT1, second->id(), 0);
    constexpr std::array<GLenum, 2> buffers = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    glNamedFramebufferDrawBuffers(id, second != nullptr ? 2 : 1, buffers.data());
    if (glCheckNamedFramebufferStatus(id, GL_DRAW_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
        throw Error(Fault::context, "soft shadow map",
                    fmt::format("\"{}\" cannot draw to it", gl::driver_name()),
                    "choose another ContextOptions::kind");
    }
    return framebuffer;
}

void clear(const gl::TextureHandle& texture, float value) {
    glClearTexImage(texture.id(), 0, GL_RED, GL_FLOAT, &value);
}

void dispatch_map(int size) {
    const GLuint groups = (GLuint(size) + map_group - 1) / map_group;
    glDispatchCompute(groups, groups, 1);
}

void require_blending(GLenum format) {
    GLint support = GL_NONE;
    glGetInternalformativ(GL_TEXTURE_2D, format, GL_FRAMEBUFFER_BLEND, 1, &support);
    if (support != GL_NONE) return;
    throw Error(
        Fault::context, "soft shadow map",
        fmt::format("\"{}\" does not blend {}-bit floats", gl::driver_name(), format == GL_R16F ? 16 : 32),
        "choose another ContextOptions::kind");
}

ShadowMapValues read_map(const gl::TextureHandle& texture, int size) {
    ShadowMapValues map;
    map.size = size;
    map.values.resize(std::size_t(size) * std::size_t(size));
    glGetTextureImage(texture.id(), 0, GL_RED, GL_FLOAT, GLsizei(map.values.size() * sizeof(float)),
                      map.values.data());
    return map;
}

glm::vec4 vec_of(const ShadowWindow& window) {
    return {glm::vec2(window.low), glm::vec2(window.high)};
}

void check_options(const SoftShadowOptions& options) {
    for (const int size : {options.occluder_size, options.receiver_size}) {
        if (size >= 1 && size <= max_shadow_map_size) continue;
        throw Error(Fault::usage, "soft shadow map", fmt::format("a map of {} texels per side", size),
                    fmt::format("choose 1 to {}", max_shadow_map_size));
    }
}

void check_frustum(const ShadowFrustum& frustum) {
    const auto spans = [](const ShadowWindow& window) {
        return window.low.x < window.high.x && window.low.y < window.high.y &&
               std::isfinite(window.low.x + window.low.y + window.high.x + window.high.y);
    };
    if (frustum.near_distance > 0.0 && std::isfinite(frustum.near_distance) && spans(frustum.occluders) &&
        spans(frustum.receivers))
        return;
    throw Error(Fault::usage, "soft shadow map", "a frustum needs windows with an extent and a near distance",
                "let fit_shadow_frustum choose");
}

}  // namespace

struct SoftShadowMap::Impl {
    /// One set of micro-patches, and the light that they hide.
    struct Pass {
        gl::TextureHandle occluders;
        gl::TextureHandle hidden;
        gl::FramebufferHandle hidden_target;
        gl::Buffer patches;
        gl::VertexArrayHandle patch_array;
        std::size_t patch_count = 0;
    };

    Impl(const SoftShadowOptions& chosen, const gl::ShaderSource& shaders);
    void build_programs(const gl::ShaderSource& shaders);
    void build_targets();
    [[nodiscard]] int pass_count() const { return options.passes == ShadowPasses::two ? 2 : 1; }

    void compute(const ShadowMesh& occluders, const ShadowMesh& receivers);
    void set_uniforms() const;
    void draw_map(const ShadowMesh& mesh, const ShadowWindow& window, const gl::FramebufferHandle& target,
                  int size) const;
    void draw_maps(const ShadowMesh& occluders, const ShadowMesh& receivers) const;
    void reduce_receivers() const;
    void list_patches(Pass& pass);
    void draw_patches(const Pass& pass, std::size_t first, std::size_t count,
                      const gl::FramebufferHandle& target) const;
    void hide_light(const Pass& pass);
    void find_visible() const;

    SoftShadowOptions options;
    optics::Light light;
    ShadowFrustum frustum;
    SoftShadowStatistics statistics;

    gl::Program draw_map_program, reduce_base_program, reduce_program, count_program, list_program,
        hide_program, add_program, visible_program;
    gl::TextureHandle receivers, pyramid, batch, visible;
    gl::FramebufferHandle occluder_target, receiver_target, batch_target;
    std::array<Pass, 2> passes;
    gl::Buffer counts;
    gl::VertexArrayHandle no_attributes;
    int pyramid_levels = 1;
};

SoftShadowMap::Impl::Impl(const SoftShadowOptions& chosen, const gl::ShaderSource& shaders)
    : options(chosen) {
    check_options(options);
    require_blending(GL_R32F);
    if (options.format != ShadowFormat::fp32) require_blending(GL_R16F);
    build_programs(shaders);
    build_targets();
}

void SoftShadowMap::Impl::build_programs(const gl::ShaderSource& shaders) {
    draw_map_program = gl::build_raster(shaders, "shadow/draw_map.vert.glsl", "shadow/draw_map.frag.glsl");
    reduce_base_program =
        gl::build_compute(shaders, "shadow/reduce_receivers.comp.glsl", {{"REDUCE_BASE", "1"}});
    reduce_program = gl::build_compute(shaders, "shadow/reduce_receivers.comp.glsl", {{"REDUCE_BASE", "0"}});
    count_program = gl::build_compute(shaders, "shadow/list_patches.comp.glsl", {{"LIST_WRITES", "0"}});
    list_program = gl::build_compute(shaders, "shadow/list_patches.comp.glsl", {{"LIST_WRITES", "1"}});
    hide_program = gl::build_raster(shaders, "shadow/hide_light.vert.glsl", "shadow/hide_light.frag.glsl");
    if (options.format == ShadowFormat::fp16_batches)
        add_program = gl::build_raster(shaders, "shadow/cover_map.vert.glsl", "shadow/add_batch.frag.glsl");
    visible_program = gl::build_compute(shaders, "shadow/find_visible.comp.glsl",
                                        {{"SHADOW_PASSES", std::to_string(pass_count())}});
}

void SoftShadowMap::Impl::build_targets() {
    const GLenum sums = options.format == ShadowFormat::fp32 ? GL_R32F : GL_R16F;
    const unsigned base = std::bit_ceil(unsigned(options.receiver_size));
    pyramid_levels = std::bit_width(base);
    receivers = make_map(GL_R32F, options.receiver_size);
    receiver_target = make_target(receivers);
    pyramid = make_map(GL_R32F, int(base), pyramid_levels);
    visible = make_map(GL_R32F, options.receiver_size);
    clear(visible, 1.0F);
    clear(receivers, 0.0F);
    for (int i = 0; i < pass_count(); ++i) {
        Pass& pass = passes[std::size_t(i)];
        pass.occluders = make_map(GL_R32F, options.occluder_size);
        clear(pass.occluders, i == 0 ? 0.0F : float(SHADOW_NONE));
        pass.hidden = make_map(sums, options.receiver_size);
        pass.hidden_target = make_target(pass.hidden);
    }
    occluder_target = make_target(passes[0].occluders, pass_count() == 2 ? &passes[1].occluders : nullptr);
    if (options.format == ShadowFormat::fp16_batches) {
        batch = make_map(sums, options.receiver_size);
        batch_target = make_target(batch);
    }
    counts = gl::Buffer((SHADOW_COUNT_ROWS + std::size_t(options.occluder_size)) * sizeof(std::uint32_t),
                        "rows of an occluder map");
    GLuint id = 0;
    glCreateVertexArrays(1, &id);
    no_attributes = gl::VertexArrayHandle(id);
}

void SoftShadowMap::Impl::set_uniforms() const {
    const glm::vec2 half_light(optics::half_size(light));
    for (const gl::Program* program : {&count_program, &list_program, &hide_program}) {
        program->set("occluder_window", vec_of(frustum.occluders));
        program->set("receiver_window", vec_of(frustum.receivers));
        glProgramUniform2f(program->id(), glGetUniformLocation(program->id(), "light_half"), half_light.x,
                           half_light.y);
        program->set("occluder_size", options.occluder_size);
        program->set("receiver_size", options.receiver_size);
    }
    const glm::dvec2 light_size = 2.0 * optics::half_size(light);
    const ShadowWindow& onto = frustum.receivers;
    hide_program.set("tangents_from_pixel",
                     glm::vec4((onto.high - onto.low) / double(options.receiver_size) / light_size,
                               onto.low / light_size));
    draw_map_program.set("near_distance", float(frustum.near_distance));
}

void SoftShadowMap::Impl::draw_map(const ShadowMesh& mesh, const ShadowWindow& window,
                                   const gl::FramebufferHandle& target, int size) const {
    draw_map_program.use();
    draw_map_program.set("light_from_mesh", mesh.from_mesh(optics::light_from_world(light)));
    draw_map_program.set("window", vec_of(window));
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target.id());
    glViewport(0, 0, size, size);
    mesh.draw(draw_map_program);
}

/// No face is culled. The closest faces of a closed surface are those that look at the light, and the
/// furthest those that look away, as in Atty et al. 2005. Both sides of an open surface hide light.
void SoftShadowMap::Impl::draw_maps(const ShadowMesh& occluders, const ShadowMesh& receiver_mesh) const {
    clear(passes[0].occluders, 0.0F);
    if (pass_count() == 2) clear(passes[1].occluders, float(SHADOW_NONE));
    clear(receivers, 0.0F);
    glEnable(GL_BLEND);
    glBlendEquationi(0, GL_MAX);
    glBlendEquationi(1, GL_MIN);
    draw_map(occluders, frustum.occluders, occluder_target, options.occluder_size);
    draw_map(receiver_mesh, frustum.receivers, receiver_target, options.receiver_size);
}

void SoftShadowMap::Impl::reduce_receivers() const {
    for (int level = 0; level < pyramid_levels; ++level) {
        const gl::Program& program = level == 0 ? reduce_base_program : reduce_program;
        program.use();
        if (level == 0) {
            glBindTextureUnit(TEXTURE_SHADOW_RECEIVERS, receivers.id());
        } else {
            program.set("finer_level", level - 1);
            glBindTextureUnit(TEXTURE_SHADOW_PYRAMID, pyramid.id());
        }
        glBindImageTexture(IMAGE_SHADOW_LEVEL, pyramid.id(), level, GL_FALSE, 0, GL_WRITE_ONLY, GL_R32F);
        dispatch_map(1 << (pyramid_levels - 1 - level));
        glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
    }
}

void SoftShadowMap::Impl::list_patches(Pass& pass) {
    glBindTextureUnit(TEXTURE_SHADOW_OCCLUDERS, pass.occluders.id());
    glBindTextureUnit(TEXTURE_SHADOW_PYRAMID, pyramid.id());
    counts.bind_storage(SSBO_SHADOW_COUNTS);
    counts.fill(0U);
    count_program.use();
    gl::dispatch_threads(std::size_t(options.occluder_size), SHADOW_LIST_GROUP);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    std::uint32_t total = 0;
    counts.read(SHADOW_COUNT_PATCHES * sizeof(total), &total, sizeof(total));
    pass.patch_count = total;
    if (pass.patch_count == 0) return;
    const std::size_t bytes = pass.patch_count * sizeof(interop::MicroPatch);
    if (pass.patches.size_bytes() < bytes) {
        pass.patches = gl::Buffer(bytes, "micro-patches");
        GLuint id = 0;
        glCreateVertexArrays(1, &id);
        pass.patch_array = gl::VertexArrayHandle(id);
        glVertexArrayVertexBuffer(id, 0, pass.patches.id(), 0, sizeof(interop::MicroPatch));
        glEnableVertexArrayAttrib(id, ATTRIBUTE_SHADOW_PATCH);
        glVertexArrayAttribIFormat(id, ATTRIBUTE_SHADOW_PATCH, 4, GL_UNSIGNED_INT, 0);
        glVertexArrayAttribBinding(id, ATTRIBUTE_SHADOW_PATCH, 0);
        glVertexArrayBindingDivisor(id, 0, 1);
    }
    pass.patches.bind_storage(SSBO_SHADOW_PATCHES);
    list_program.use();
    gl::dispatch_threads(std::size_t(options.occluder_size), SHADOW_LIST_GROUP);
    glMemoryBarrier(GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    std::array<std::uint32_t, 2> fragments{};
    counts.read(SHADOW_COUNT_FRAGMENTS * sizeof(std::uint32_t), fragments.data(), sizeof(fragments));
    statistics.fragments += fragments[0] + (std::uint64_t(fragments[1]) << 32U);
}

void SoftShadowMap::Impl::draw_patches(const Pass& pass, std::size_t first, std::size_t count,
                                       const gl::FramebufferHandle& target) const {
    hide_program.use();
    glBindVertexArray(pass.patch_array.id());
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target.id());
    glDrawArraysInstancedBaseInstance(GL_TRIANGLE_STRIP, 0, 4, GLsizei(count), GLuint(first));
}

/// A large sum in FP16 loses small summands. So the patches of each batch are summed alone, and then the sums
/// of the batches, which are larger (appendix A).
void SoftShadowMap::Impl::hide_light(const Pass& pass) {
    clear(pass.hidden, 0.0F);
    if (pass.patch_count == 0) return;
    const std::size_t batches =
        options.format == ShadowFormat::fp16_batches ? std::size_t(std::sqrt(double(pass.patch_count))) : 1;
    statistics.batches += batches;
    for (std::size_t i = 0; i < batches; ++i) {
        const std::size_t first = pass.patch_count * i / batches;
        const std::size_t count = pass.patch_count * (i + 1) / batches - first;
        if (batches == 1) {
            draw_patches(pass, first, count, pass.hidden_target);
            continue;
        }
        clear(batch, 0.0F);
        draw_patches(pass, first, count, batch_target);
        add_program.use();
        glBindVertexArray(no_attributes.id());
        glBindTextureUnit(TEXTURE_SHADOW_HIDDEN, batch.id());
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, pass.hidden_target.id());
        glDrawArrays(GL_TRIANGLES, 0, 3);
    }
}

void SoftShadowMap::Impl::find_visible() const {
    visible_program.use();
    glBindTextureUnit(TEXTURE_SHADOW_HIDDEN, passes[0].hidden.id());
    if (pass_count() == 2) glBindTextureUnit(TEXTURE_SHADOW_HIDDEN_FURTHEST, passes[1].hidden.id());
    glBindImageTexture(IMAGE_SHADOW_LEVEL, visible.id(), 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_R32F);
    dispatch_map(options.receiver_size);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT);
}

void SoftShadowMap::Impl::compute(const ShadowMesh& occluders, const ShadowMesh& receiver_mesh) {
    const gl::DrawStateGuard guard;
    statistics = {};
    set_uniforms();
    const gl::Timer maps, patches, hide, last;
    maps.start();
    draw_maps(occluders, receiver_mesh);
    reduce_receivers();
    maps.stop();
    patches.start();
    for (int i = 0; i < pass_count(); ++i) {
        list_patches(passes[std::size_t(i)]);
        statistics.micro_patches += passes[std::size_t(i)].patch_count;
    }
    patches.stop();

    glBlendEquation(GL_FUNC_ADD);
    glBlendFunc(GL_ONE, GL_ONE);
    glViewport(0, 0, options.receiver_size, options.receiver_size);
    glBindTextureUnit(TEXTURE_SHADOW_RECEIVERS, receivers.id());
    hide.start();
    for (int i = 0; i < pass_count(); ++i)
        hide_light(passes[std::size_t(i)]);
    hide.stop();
    last.start();
    find_visible();
    last.stop();
    statistics.maps_ms = maps.milliseconds();
    statistics.patches_ms = patches.milliseconds();
    statistics.hide_ms = hide.milliseconds();
    statistics.milliseconds =
        statistics.maps_ms + statistics.patches_ms + statistics.hide_ms + last.milliseconds();
}

SoftShadowMap::SoftShadowMap(const SoftShadowOptions& options, const gl::ShaderSource& shaders)
    : impl_(std::make_unique<Impl>(options, shaders)) {}
SoftShadowMap::SoftShadowMap(SoftShadowMap&&) noexcept = default;
SoftShadowMap& SoftShadowMap::operator=(SoftShadowMap&&) noexcept = default;
SoftShadowMap::~SoftShadowMap() = default;

void SoftShadowMap::compute(const optics::Light& light, const ShadowFrustum& frustum,
                            const ShadowMesh& occluders, const ShadowMesh& receivers) {
    check_frustum(frustum);
    static_cast<void>(optics::light_from_world(light));
    impl_->light = light;
    impl_->frustum = frustum;
    impl_->compute(occluders, receivers);
}

const SoftShadowOptions& SoftShadowMap::options() const {
    return impl_->options;
}
const optics::Light& SoftShadowMap::light() const {
    return impl_->light;
}
const ShadowFrustum& SoftShadowMap::frustum() const {
    return impl_->frustum;
}
const SoftShadowStatistics& SoftShadowMap::statistics() const {
    return impl_->statistics;
}
GLuint SoftShadowMap::visible_texture() const {
    return impl_->visible.id();
}
GLuint SoftShadowMap::receiver_texture() const {
    return impl_->receivers.id();
}
ShadowMapValues SoftShadowMap::visible() const {
    return read_map(impl_->visible, impl_->options.receiver_size);
}
ShadowMapValues SoftShadowMap::receiver_inverse_depths() const {
    return read_map(impl_->receivers, impl_->options.receiver_size);
}
ShadowMapValues SoftShadowMap::occluder_inverse_depths(int pass) const {
    return read_map(impl_->passes[std::size_t(pass)].occluders, impl_->options.occluder_size);
}
std::vector<interop::MicroPatch> SoftShadowMap::micro_patches(int pass) const {
    const Impl::Pass& listed = impl_->passes[std::size_t(pass)];
    return listed.patch_count == 0 ? std::vector<interop::MicroPatch>()
                                   : listed.patches.read_all<interop::MicroPatch>(listed.patch_count);
}

}  // namespace cairn::renderer
