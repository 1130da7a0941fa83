#include "renderer/shadow/shadow_projection.h"

#include <array>
#include <limits>

#include <fmt/format.h>

#include "base/error.h"
#include "gl/context.h"
#include "gl/draw_state.h"
#include "gl/handle.h"
#include "shaders/interop/shadow_map.h"

namespace cairn::renderer {
namespace {

/// The render targets of a picture.
class Targets {
public:
    Targets(int width, int height) : width_(width), height_(height) {
        color_ = make(GL_SRGB8_ALPHA8);
        visible_distance_ = make(GL_RG32F);
        depth_ = make(GL_DEPTH_COMPONENT32F);
        GLuint id = 0;
        glCreateFramebuffers(1, &id);
        framebuffer_ = gl::FramebufferHandle(id);
        glNamedFramebufferTexture(id, GL_COLOR_ATTACHMENT0, color_.id(), 0);
        glNamedFramebufferTexture(id, GL_COLOR_ATTACHMENT1, visible_distance_.id(), 0);
        glNamedFramebufferTexture(id, GL_DEPTH_ATTACHMENT, depth_.id(), 0);
        constexpr std::array<GLenum, 2> buffers = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
        glNamedFramebufferDrawBuffers(id, GLsizei(buffers.size()), buffers.data());
        if (glCheckNamedFramebufferStatus(id, GL_DRAW_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
            throw Error(Fault::context, "shadow projection",
                        fmt::format("\"{}\" cannot draw to it", gl::driver_name()),
                        "choose another ContextOptions::kind");
        }
    }

    void clear(const glm::vec3& background) const {
        const glm::vec4 color(background, 0.0F);
        const glm::vec4 nothing(-1.0F, std::numeric_limits<float>::infinity(), 0.0F, 0.0F);
        const float far = 1.0F;
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_.id());
        glClearBufferfv(GL_COLOR, 0, &color[0]);
        glClearBufferfv(GL_COLOR, 1, &nothing[0]);
        glClearBufferfv(GL_DEPTH, 0, &far);
        glViewport(0, 0, width_, height_);
    }

    [[nodiscard]] ProjectedPixels read() const {
        ProjectedPixels pixels;
        const std::size_t count = std::size_t(width_) * std::size_t(height_);
        pixels.rgba.resize(4 * count);
        glGetTextureImage(color_.id(), 0, GL_RGBA, GL_UNSIGNED_BYTE, GLsizei(pixels.rgba.size()),
                          pixels.rgba.data());
        const auto channel = [&](GLenum format) {
            std::vector<float> values(count);
            glGetTextureImage(visible_distance_.id(), 0, format, GL_FLOAT, GLsizei(count * sizeof(float)),
                              values.data());
            return values;
        };
        pixels.visible = channel(GL_RED);
        pixels.distance = channel(GL_GREEN);
        return pixels;
    }

private:
    [[nodiscard]] gl::TextureHandle make(GLenum format) const {
        GLuint id = 0;
        glCreateTextures(GL_TEXTURE_2D, 1, &id);
        glTextureStorage2D(id, 1, format, width_, height_);
        return gl::TextureHandle(id);
    }

    int width_;
    int height_;
    gl::TextureHandle color_, visible_distance_, depth_;
    gl::FramebufferHandle framebuffer_;
};

}  // namespace

ShadowProjection::ShadowProjection(const gl::ShaderSource& shaders)
    : program_(gl::build_raster(shaders, "shadow/draw_lit.vert.glsl", "shadow/draw_lit.frag.glsl")) {}

ProjectedPixels ShadowProjection::draw(const ProjectionView& view, const SoftShadowMap& map,
                                       const ShadowMesh& occluders, const ShadowMesh& receivers) const {
    const gl::DrawStateGuard guard;
    const bool encoded = glIsEnabled(GL_FRAMEBUFFER_SRGB) == GL_TRUE;
    const Targets targets(view.width, view.height);
    glEnable(GL_FRAMEBUFFER_SRGB);
    glEnable(GL_DEPTH_TEST);
    targets.clear(view.background);
    program_.use();
    glBindTextureUnit(TEXTURE_SHADOW_RECEIVERS, map.receiver_texture());
    glBindTextureUnit(TEXTURE_SHADOW_VISIBLE, map.visible_texture());
    draw_mesh(view, map, receivers, true);
    draw_mesh(view, map, occluders, false);
    if (!encoded) glDisable(GL_FRAMEBUFFER_SRGB);
    return targets.read();
}

void ShadowProjection::draw_mesh(const ProjectionView& view, const SoftShadowMap& map, const ShadowMesh& mesh,
                                 bool is_receiver) const {
    glm::dmat4 top_first(1.0);  // row 0 of the target is the top of the picture
    top_first[1][1] = -1.0;
    const ShadowWindow& window = map.frustum().receivers;
    program_.set("clip_from_mesh", mesh.from_mesh(top_first * view.clip_from_world));
    program_.set("light_from_mesh", mesh.from_mesh(optics::light_from_world(map.light())));
    program_.set("receiver_window", glm::vec4(glm::vec2(window.low), glm::vec2(window.high)));
    program_.set("near_distance", float(map.frustum().near_distance));
    program_.set("is_receiver", is_receiver ? 1 : 0);
    program_.set("eye", glm::vec3(view.eye - mesh.origin()));
    program_.set("light", glm::vec3(map.light().position - mesh.origin()));
    program_.set("light_color", glm::vec4(view.light_color, view.ambient));
    mesh.draw(program_);
}

}  // namespace cairn::renderer
