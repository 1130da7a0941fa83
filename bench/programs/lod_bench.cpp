// Levels of detail: their error against Embree with 8x8 samples a pixel, beside what they cost.
//
//     lod_bench OUT_FOLDER SCENE WIDTHxHEIGHT [SCENE WIDTHxHEIGHT ...]
//
// Scenes are shown white, from their framing camera and from four times as far: Embree tells triangles, not
// colours. Writes lod.csv: a line for each scene, size, distance, level of detail (`tree`: bricks without
// mips) and pixel error. Frames are converged ones, their times the processor's, which hold better than the
// wall's where the machine is shared.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <sys/resource.h>

#include "base/error.h"
#include "base/output_file.h"
#include "gl/context.h"
#include "optics/srgb.h"
#include "reference/image.h"
#include "renderer/renderer.h"
#include "scenes/load.h"
#include "scenes/snapshot.h"

namespace {

using namespace cairn;
using glm::dvec3;

constexpr int samples_a_side = 8;

double cpu_ms() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const auto ms = [](const timeval& t) { return double(t.tv_sec) * 1e3 + double(t.tv_usec) / 1e3; };
    return ms(usage.ru_utime) + ms(usage.ru_stime);
}

/// Without colours and textures; alpha masks, which need their textures, stay.
void whiten(scenes::Scene& scene) {
    for (scenes::Material& material : scene.materials) {
        material.base_color = glm::vec4(1.0F, 1.0F, 1.0F, material.base_color.a);
        if (material.alpha_mode != scenes::AlphaMode::mask) material.texture = -1;
    }
    for (scenes::Mesh& mesh : scene.meshes) {
        for (scenes::Primitive& primitive : mesh.primitives)
            primitive.colors.clear();
    }
}

/// Flat normals in the order of the reference's primitives.
std::vector<dvec3> normals_of(const scenes::Snapshot& snapshot) {
    std::vector<dvec3> normals;
    for (const scenes::Item& item : snapshot.items) {
        if (item.primitive->topology != scenes::Topology::triangles) continue;
        auto corner = [&](std::size_t i) {
            const dvec3 p(item.positions[item.primitive->indices[i]]);
            return dvec3(item.world_from_mesh * glm::dvec4(p, 1.0));
        };
        for (std::size_t i = 0; i + 2 < item.primitive->indices.size(); i += 3) {
            const dvec3 n = glm::cross(corner(i + 1) - corner(i), corner(i + 2) - corner(i));
            const double length = glm::length(n);
            normals.push_back(length > 0.0 ? n / length : dvec3(0.0, 1.0, 0.0));
        }
    }
    return normals;
}

/// sRGB, 0 to 255, three channels a pixel.
std::vector<double> truth(const scenes::Scene& scene, const scenes::Snapshot& snapshot,
                          const renderer::View& view) {
    const reference::ImageTracer tracer(scene, snapshot);
    const int width = view.width * samples_a_side;
    const int height = view.height * samples_a_side;
    const reference::ReferenceImage traced =
        tracer.trace({view.camera.eye, view.camera.target, view.camera.up, view.camera.yfov},
                     {.towards = view.light.towards}, width, height, 2);
    const std::vector<dvec3> normals = normals_of(snapshot);
    const dvec3 forward = glm::normalize(view.camera.target - view.camera.eye);
    const dvec3 right = glm::normalize(glm::cross(forward, view.camera.up));
    const dvec3 up = glm::cross(right, forward);
    const double half_height = std::tan(0.5 * view.camera.yfov);
    const double half_width = half_height * view.width / view.height;
    const dvec3 to_light = glm::normalize(view.light.towards);
    std::vector<double> sums(std::size_t(view.width) * std::size_t(view.height) * 3, 0.0);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const std::size_t sample = std::size_t(y) * std::size_t(width) + std::size_t(x);
            dvec3 color(view.background);
            if (traced.primitive[sample] != reference::ReferenceImage::no_primitive) {
                const dvec3 direction = forward + ((x + 0.5) / width * 2.0 - 1.0) * half_width * right +
                                        (1.0 - (y + 0.5) / height * 2.0) * half_height * up;
                dvec3 normal = normals[traced.primitive[sample]];
                if (glm::dot(normal, direction) > 0.0) normal = -normal;
                const double ambient = view.light.ambient;
                color =
                    dvec3(ambient * (0.75 + 0.25 * normal.y) +
                          (1.0 - ambient) * std::max(glm::dot(normal, to_light), 0.0) * traced.lit[sample]);
            }
            const std::size_t pixel =
                std::size_t(y / samples_a_side) * std::size_t(view.width) + std::size_t(x / samples_a_side);
            for (std::size_t k = 0; k < 3; ++k)
                sums[3 * pixel + k] += std::clamp(color[int(k)], 0.0, 1.0);
        }
    }
    for (double& sum : sums)
        sum = 255.0 * optics::srgb_from_linear(sum / (samples_a_side * samples_a_side));
    return sums;
}

double rmse(const optics::Image& image, const std::vector<double>& expected) {
    double sum = 0.0;
    for (std::size_t pixel = 0; pixel * 3 < expected.size(); ++pixel) {
        for (std::size_t k = 0; k < 3; ++k) {
            const double d = image.rgba[4 * pixel + k] - expected[3 * pixel + k];
            sum += d * d;
        }
    }
    return std::sqrt(sum / double(expected.size()));
}

struct Method {
    const char* name;
    bool mips;
    renderer::LevelOfDetail level_of_detail;
};

std::string measure(const std::string& path, int width, int height) {
    scenes::Scene scene = scenes::load(path);
    whiten(scene);
    const scenes::Snapshot snapshot = scenes::take_snapshot(scene);
    std::string lines;
    for (const double distance : {1.0, 2.0}) {
        renderer::View view;
        view.width = width;
        view.height = height;
        view.camera = optics::framing_camera(snapshot.bounds, double(width) / height);
        view.camera.eye = view.camera.target + distance * (view.camera.eye - view.camera.target);
        const std::vector<double> expected = truth(scene, snapshot, view);
        for (const Method& method : {Method{"nearest", false, renderer::LevelOfDetail::nearest},
                                     Method{"nearest+mips", true, renderer::LevelOfDetail::nearest},
                                     Method{"blended", true, renderer::LevelOfDetail::blended}}) {
            for (const double pixel_error : {0.5, 1.0, 2.0, 4.0}) {
                view.pixel_error = pixel_error;
                view.level_of_detail = method.level_of_detail;
                renderer::TreeOptions options;
                options.mips = method.mips;
                options.brick_pool_bytes = std::size_t(512) << 20U;
                renderer::Renderer ours(scene, snapshot, options);
                double start = cpu_ms();
                const optics::Image image = ours.render(view);
                const double first_ms = cpu_ms() - start;
                const renderer::FrameStatistics first = ours.statistics();
                double frame_ms = std::numeric_limits<double>::infinity();
                for (int i = 0; i < 3; ++i) {
                    start = cpu_ms();
                    (void)ours.render(view);
                    frame_ms = std::min(frame_ms, cpu_ms() - start);
                }
                const double slot_kib = double(first.brick_pool_bytes) / double(first.brick_slots) / 1024.0;
                lines += fmt::format("{},{}x{},{},{},{},{:.3f},{},{:.1f},{:.1f},{:.0f},{:.1f}\n", path, width,
                                     height, distance, method.name, pixel_error, rmse(image, expected),
                                     first.bricks_produced, slot_kib,
                                     slot_kib * double(first.bricks_produced) / 1024.0, first_ms, frame_ms);
                fmt::print("{}", lines.substr(lines.rfind('\n', lines.size() - 2) + 1));
                std::fflush(stdout);
            }
        }
    }
    return lines;
}

}  // namespace

int main(int count, char** words) {
    if (count < 4 || count % 2 != 0) {
        fmt::print(stderr, "lod_bench OUT_FOLDER SCENE WIDTHxHEIGHT [SCENE WIDTHxHEIGHT ...]\n");
        return 2;
    }
    try {
        const auto context = gl::create_context({});
        std::string text =
            "scene,size,distance,level_of_detail,pixel_error,rmse,bricks,kib_a_brick,mib,first_cpu_ms,frame_"
            "cpu_ms\n";
        for (int i = 2; i + 1 < count; i += 2) {
            int width = 0;
            int height = 0;
            if (std::sscanf(words[i + 1], "%dx%d", &width, &height) != 2 || width < 1 || height < 1) {
                fmt::print(stderr, "\"{}\" is no size\n", words[i + 1]);
                return 2;
            }
            text += measure(words[i], width, height);
        }
        OutputFile file(std::string(words[1]) + "/lod.csv");
        file.write(text.data(), text.size());
        file.commit();
    } catch (const Error& error) {
        fmt::print(stderr, "error: {}\n", error.what());
        return 1;
    }
    return 0;
}
