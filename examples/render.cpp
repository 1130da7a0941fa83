// render SCENE OUTPUT.ppm: a picture of a scene, a volume or "builtin:NAME", without a window.

#include <cstdio>

#include <cairn/base/error.h>
#include <cairn/gl/context.h>
#include <cairn/optics/camera.h>
#include <cairn/renderer/open_content.h>
#include <cairn/renderer/renderer.h>

#include "image_file.h"

int main(int argc, char** argv) try {
    if (argc != 3) {
        std::fprintf(stderr, "usage: %s SCENE OUTPUT.ppm\n", argv[0]);
        return 2;
    }
    const char* scene = argv[1];
    // [README]
    const auto context = cairn::gl::create_context();  // or adopt_context() in a program that has one
    const cairn::renderer::ContentSource source(scene);
    cairn::renderer::Renderer renderer(source.content());
    cairn::renderer::View view;  // 512 x 512 pixels, one light with hard shadows
    view.camera = cairn::optics::framing_camera(source.bounds(), view.size.aspect());
    const cairn::renderer::Frame frame = renderer.render(view);  // frame.image: sRGB, RGBA
    // [/README]
    return write_ppm(argv[2], frame.image) ? 0 : 1;
} catch (const cairn::Error& error) {
    std::fprintf(stderr, "%s\n  %s\n", error.what(), error.way_out().c_str());
    return 1;
}
