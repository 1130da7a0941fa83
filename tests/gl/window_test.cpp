// Windows, on a display that tests/support/with_xvfb.sh provides.

#include "gl/window.h"

#include <glad/gl.h>
#include <gtest/gtest.h>

#include "gl/handle.h"

namespace cairn::gl {
namespace {

TEST(Window, OpensDrawsAndCloses) {
    for (int round = 0; round < 2; ++round) {  // GLFW must start again after the last window is closed
        const std::unique_ptr<Window> window = create_window("cairn test", {320, 240}, true);
        EXPECT_EQ(window->backend(), "glfw");
        EXPECT_NE(window->native(), nullptr);
        EXPECT_FALSE(window->should_close());
        const glm::ivec2 size = window->framebuffer_size();
        EXPECT_EQ(size.x, 320) << "round " << round;
        EXPECT_EQ(size.y, 240) << "round " << round;

        glClearColor(1.0F, 0.0F, 0.0F, 1.0F);
        glClear(GL_COLOR_BUFFER_BIT);
        unsigned char pixel[4] = {};
        glReadPixels(160, 120, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel);
        EXPECT_EQ(pixel[0], 255) << driver_name();
        EXPECT_EQ(pixel[1], 0) << driver_name();
        window->swap_and_poll();
        for (const std::string& message : window->debug_log().take())
            ADD_FAILURE() << "OpenGL: " << message;
    }
}

}  // namespace
}  // namespace cairn::gl
