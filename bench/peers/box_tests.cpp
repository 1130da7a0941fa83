#include "bench/peers/box_tests.h"

#include <algorithm>

#include "gl/draw_state.h"

namespace cairn::bench {

using renderer::Box;

namespace {

constexpr double pixels_around = 1.0 / 64.0;
constexpr GLsizei corners_a_box = 36;

glm::vec3 per_unit(const glm::vec3& axis) {
    return glm::vec3(axis) / glm::dot(glm::vec3(axis), glm::vec3(axis));
}

/// State that DrawStateGuard does not restore: set for the tests, then reset to the defaults.
class ReversedDepth {
public:
    ReversedDepth() {
        glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
        glEnable(GL_DEPTH_CLAMP);
        glEnable(GL_DEPTH_TEST);
        glDepthFunc(GL_GEQUAL);
        glDepthMask(GL_FALSE);
    }
    ~ReversedDepth() {
        glDepthMask(GL_TRUE);
        glDepthFunc(GL_LESS);
        glDisable(GL_DEPTH_CLAMP);
        glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
    }
    ReversedDepth(const ReversedDepth&) = delete;
    ReversedDepth& operator=(const ReversedDepth&) = delete;
    ReversedDepth(ReversedDepth&&) = delete;
    ReversedDepth& operator=(ReversedDepth&&) = delete;
};

}  // namespace

BoxTests::BoxTests(const interop::MarchView& view, const gl::ShaderSource& shaders)
    : eye_(view.eye),
      forward_(view.forward),
      across_(per_unit(view.right)),
      down_(-per_unit(view.up)),
      size_(view.width, view.height),
      pixel_(2.0 * glm::length(glm::dvec3(view.up)) / view.height),
      program_(gl::build_raster(shaders, "bench/test_box.vert.glsl", "bench/test_box.frag.glsl")) {
    GLuint id = 0;
    glCreateTextures(GL_TEXTURE_2D, 1, &id);
    depths_ = gl::TextureHandle(id);
    glTextureStorage2D(id, 1, GL_DEPTH_COMPONENT32F, size_.x, size_.y);
    glCreateFramebuffers(1, &id);
    target_ = gl::FramebufferHandle(id);
    glNamedFramebufferTexture(id, GL_DEPTH_ATTACHMENT, depths_.id(), 0);
    glNamedFramebufferDrawBuffer(id, GL_NONE);
    glNamedFramebufferReadBuffer(id, GL_NONE);
    glCreateVertexArrays(1, &id);
    no_attributes_ = gl::VertexArrayHandle(id);
    set_depths(std::vector<float>(std::size_t(size_.x) * std::size_t(size_.y), 0.0F));
}

void BoxTests::set_depths(std::span<const float> inverse_depths) {
    // Depths under a voxel count as one voxel. Boxes are clamped in the same way.
    std::vector<float> clamped(inverse_depths.begin(), inverse_depths.end());
    for (float& depth : clamped)
        depth = std::min(depth, 1.0F);
    glTextureSubImage2D(depths_.id(), 0, 0, 0, size_.x, size_.y, GL_DEPTH_COMPONENT, GL_FLOAT,
                        clamped.data());
}

/// The box relative to the eye, enlarged.
Box BoxTests::around(const Box& box) const {
    const glm::dvec3 low = box.low - eye_;
    const glm::dvec3 high = box.high - eye_;
    const double farthest = glm::length(glm::max(glm::abs(low), glm::abs(high)));
    const double margin = pixels_around * pixel_ * farthest;
    return {low - margin, high + margin};
}

std::size_t BoxTests::begin(std::span<const Box> boxes) {
    const gl::DrawStateGuard state;
    const ReversedDepth reversed;
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target_.id());
    glViewport(0, 0, size_.x, size_.y);
    glBindVertexArray(no_attributes_.id());
    program_.use();
    program_.set("forward", forward_);
    program_.set("across", across_);
    program_.set("down", down_);
    queries_.clear();
    std::size_t begun = 0;
    for (const Box& box : boxes) {
        const Box near = around(box);
        queries_.emplace_back();
        // If the eye is inside, near faces are behind it, and far ones may be hidden.
        if (glm::all(glm::lessThan(near.low, glm::dvec3(0.0))) &&
            glm::all(glm::greaterThan(near.high, glm::dvec3(0.0)))) {
            continue;
        }
        GLuint id = 0;
        glCreateQueries(GL_ANY_SAMPLES_PASSED, 1, &id);
        queries_.back() = gl::QueryHandle(id);
        program_.set("box_low", glm::vec3(near.low));
        program_.set("box_high", glm::vec3(near.high));
        glBeginQuery(GL_ANY_SAMPLES_PASSED, id);
        glDrawArrays(GL_TRIANGLES, 0, corners_a_box);
        glEndQuery(GL_ANY_SAMPLES_PASSED);
        ++begun;
    }
    glFlush();
    return begun;
}

std::vector<bool> BoxTests::visible() const {
    std::vector<bool> visible;
    for (const gl::QueryHandle& query : queries_) {
        GLuint passed = GL_TRUE;
        if (query) glGetQueryObjectuiv(query.id(), GL_QUERY_RESULT, &passed);
        visible.push_back(passed != GL_FALSE);
    }
    return visible;
}

}  // namespace cairn::bench
