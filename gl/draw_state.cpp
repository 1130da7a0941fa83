#include "gl/draw_state.h"

namespace cairn::gl {
namespace {

void set_switch(GLenum name, bool on) {
    if (on) {
        glEnable(name);
    } else {
        glDisable(name);
    }
}

}  // namespace

DrawStateGuard::DrawStateGuard() {
    for (std::size_t i = 0; i < switches.size(); ++i) {
        enabled_[i] = glIsEnabled(switches[i]);
        set_switch(switches[i], false);
    }
    glGetIntegerv(GL_LOGIC_OP_MODE, &logic_op_);
    glGetIntegerv(GL_FRONT_FACE, &front_face_);
    for (std::size_t i = 0; i < blending_.size(); ++i) {
        Blending& target = blending_[i];
        glGetIntegeri_v(GL_BLEND_EQUATION_RGB, GLuint(i), &target.equation_rgb);
        glGetIntegeri_v(GL_BLEND_EQUATION_ALPHA, GLuint(i), &target.equation_alpha);
        glGetIntegeri_v(GL_BLEND_SRC_RGB, GLuint(i), &target.source_rgb);
        glGetIntegeri_v(GL_BLEND_SRC_ALPHA, GLuint(i), &target.source_alpha);
        glGetIntegeri_v(GL_BLEND_DST_RGB, GLuint(i), &target.destination_rgb);
        glGetIntegeri_v(GL_BLEND_DST_ALPHA, GLuint(i), &target.destination_alpha);
    }
    glGetBooleanv(GL_COLOR_WRITEMASK, color_mask_.data());
    glGetIntegerv(GL_POLYGON_MODE, &polygon_mode_);
    glGetFloatv(GL_LINE_WIDTH, &line_width_);
    glGetFloatv(GL_POINT_SIZE, &point_size_);
    glGetFloatv(GL_VIEWPORT, viewport_.data());
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &framebuffer_);
    glGetIntegerv(GL_VERTEX_ARRAY_BINDING, &vertex_array_);
    glGetIntegerv(GL_ACTIVE_TEXTURE, &active_texture_);
    glActiveTexture(GL_TEXTURE0);
    glGetIntegerv(GL_TEXTURE_BINDING_2D_ARRAY, &texture_2d_array_);
    glGetIntegerv(GL_SAMPLER_BINDING, &sampler_);
    glBindSampler(0, 0);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    glLineWidth(1.0F);
    glPointSize(1.0F);
}

DrawStateGuard::~DrawStateGuard() {
    for (std::size_t i = 0; i < switches.size(); ++i)
        set_switch(switches[i], enabled_[i] == GL_TRUE);
    glLogicOp(GLenum(logic_op_));
    glFrontFace(GLenum(front_face_));
    for (std::size_t i = 0; i < blending_.size(); ++i) {
        const Blending& target = blending_[i];
        glBlendEquationSeparatei(GLuint(i), GLenum(target.equation_rgb), GLenum(target.equation_alpha));
        glBlendFuncSeparatei(GLuint(i), GLenum(target.source_rgb), GLenum(target.destination_rgb),
                             GLenum(target.source_alpha), GLenum(target.destination_alpha));
    }
    glColorMask(color_mask_[0], color_mask_[1], color_mask_[2], color_mask_[3]);
    glPolygonMode(GL_FRONT_AND_BACK, GLenum(polygon_mode_));
    glLineWidth(line_width_);
    glPointSize(point_size_);
    glViewportIndexedfv(0, viewport_.data());
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, GLuint(framebuffer_));
    glBindVertexArray(GLuint(vertex_array_));
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D_ARRAY, GLuint(texture_2d_array_));
    glBindSampler(0, GLuint(sampler_));
    glActiveTexture(GLenum(active_texture_));
}

}  // namespace cairn::gl
