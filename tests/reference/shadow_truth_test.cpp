// The truth of shadows: which pixels can be shadowed, how errors are counted, and the answers that are kept
// on disk.
#include "reference/shadow_truth.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.h"
#include "reference/light_cache.h"
#include "scenes/load.h"
#include "tests/support/scratch_folder.h"

namespace cairn::reference {
namespace {

namespace fs = std::filesystem;

optics::Light ball_light() {
    return {.positional = true, .position = {3.0, 5.0, 3.0}, .radius = 0.8};
}

/// A knot in a small picture.
struct Knot {
    scenes::Scene scene = scenes::make_builtin("knot");
    scenes::Snapshot snapshot = scenes::take_snapshot(scene);
    scenes::NodeSelection receivers = scenes::NodeSelection(scene.nodes.size(), true);
    optics::Camera camera = optics::framing_camera(snapshot.bounds, 1.0);
    optics::Light light = ball_light();
    ImageTracer tracer{scene, snapshot};

    [[nodiscard]] ShadowQuestion question() const {
        return {scene, snapshot, receivers, camera, light, 40, 40};
    }
    [[nodiscard]] SoftShares soft(const fs::path& cache, const AreaLightOptions& options = {}) const {
        return soft_shares(tracer, question(), shadow_receivers(tracer, question()), options, cache);
    }
};

TEST(ShadowTruth, PixelsThatCanBeShadowedFaceTheEyeAndTheLight) {
    const Knot knot;
    const ShadowReceivers found = shadow_receivers(knot.tracer, knot.question());
    std::size_t seen = 0;
    for (const std::uint32_t face : found.seen.primitive)
        seen += face == ReferenceImage::no_primitive ? 0 : 1;
    EXPECT_GT(found.pixels.size(), 100U);
    EXPECT_LT(found.pixels.size(), seen) << "some turn their back to the light";
    for (std::size_t k = 0; k < found.pixels.size(); ++k) {
        const glm::dvec3& point = found.points[k];
        EXPECT_GT(glm::dot(found.normals[k], knot.camera.eye - point), 0.0) << "pixel " << found.pixels[k];
        EXPECT_GT(glm::dot(found.normals[k], knot.light.position - point), 0.0)
            << "pixel " << found.pixels[k];
        EXPECT_NEAR(glm::distance(point, knot.camera.eye), double(found.seen.depth[found.pixels[k]]), 1e-6);
    }
}

TEST(ShadowTruth, OnlyTheReceiversPixelsCount) {
    Knot knot;
    knot.receivers.assign(knot.receivers.size(), false);
    EXPECT_TRUE(shadow_receivers(knot.tracer, knot.question()).pixels.empty());
}

TEST(ShadowTruth, SoftSharesOfAPointAreTheHardOnes) {
    Knot knot;
    knot.light.radius = 1e-6;
    const ShadowReceivers receivers = shadow_receivers(knot.tracer, knot.question());
    const std::vector<float> hard = hard_shares(receivers);
    const std::vector<float> soft =
        soft_shares(knot.tracer, knot.question(), receivers, {.least_samples = 64, .most_samples = 64})
            .shares;
    const ShadowError error = shadow_error(soft, hard);
    EXPECT_EQ(error.pixels, receivers.pixels.size());
    // Rays of the picture and rays of single points begin at slightly different places.
    EXPECT_LT(error.mean_absolute(), 0.01);
    EXPECT_GT(error.shadowed, 10U);
}

TEST(ShadowTruth, SamplingStopsBelowTheStandardErrorThatTheProjectPromises) {
    const Knot knot;
    const ShadowReceivers receivers = shadow_receivers(knot.tracer, knot.question());
    EXPECT_LT(soft_shares(knot.tracer, knot.question(), receivers).greatest_standard_error, 1.0 / 512.0);
}

TEST(ShadowTruth, ErrorCountsWhatBothHave) {
    const std::vector<float> truth = {1.0F, 0.0F, 0.25F, -1.0F, 0.75F, 1.0F};
    const std::vector<float> shares = {1.0F, 0.5F, 0.25F, 0.5F, -1.0F, 0.25F};
    const ShadowError error = shadow_error(shares, truth);
    EXPECT_EQ(error.pixels, 4U);
    EXPECT_EQ(error.shadowed, 2U);
    EXPECT_EQ(error.in_shadow, 2U);
    EXPECT_EQ(error.too_light, 1U);
    EXPECT_EQ(error.too_dark, 1U);
    EXPECT_DOUBLE_EQ(error.disagreement(), 0.5);
    EXPECT_DOUBLE_EQ(error.mean_absolute(), 1.25 / 4.0);
    EXPECT_DOUBLE_EQ(error.mean_in_shadow(), 1.25 / 2.0);
    EXPECT_DOUBLE_EQ(error.rmse(), std::sqrt((0.25 + 0.5625) / 4.0));
    EXPECT_DOUBLE_EQ(error.greatest, 0.75);
    EXPECT_DOUBLE_EQ(shadow_error({}, {}).rmse(), 0.0);
}

TEST(ShadowTruth, AnswersAreFoundAgainOnDiskUntilWhatTheyDependOnChanges) {
    const test::ScratchFolder folder;
    const fs::path cache = folder.path() / "deep" / "cache";
    const AreaLightOptions options{.least_samples = 64, .most_samples = 64};
    const Knot knot;
    const SoftShares first = knot.soft(cache, options);
    EXPECT_FALSE(first.cached);
    EXPECT_GT(first.milliseconds, 0.0);
    const SoftShares second = knot.soft(cache, options);
    EXPECT_TRUE(second.cached);
    EXPECT_EQ(second.milliseconds, 0.0);
    EXPECT_EQ(second.shares, first.shares);
    EXPECT_EQ(second.greatest_standard_error, first.greatest_standard_error);

    const std::pair<const char*, std::function<void(Knot&, AreaLightOptions&)>> changes[] = {
        {"light", [](Knot& k, AreaLightOptions&) { k.light.radius = 0.81; }},
        {"light's place", [](Knot& k, AreaLightOptions&) { k.light.position.x += 1e-9; }},
        {"camera", [](Knot& k, AreaLightOptions&) { k.camera.eye.y += 1e-3; }},
        {"geometry", [](Knot& k, AreaLightOptions&) { k.snapshot.items[0].world_from_mesh[3].x += 1e-9; }},
        {"samples", [](Knot&, AreaLightOptions& o) { o.most_samples = 128; }},
        {"seed", [](Knot&, AreaLightOptions& o) { o.seed = 2; }}};
    for (const auto& [name, change] : changes) {
        Knot other;
        AreaLightOptions changed = options;
        change(other, changed);
        EXPECT_FALSE(other.soft(cache, changed).cached) << name;
    }
    AreaLightOptions one_thread = options;
    one_thread.threads = 1;
    EXPECT_TRUE(knot.soft(cache, one_thread).cached) << "threads change nothing";
}

TEST(ShadowTruth, DamagedAnswersAreComputedAgainAndReplaced) {
    const test::ScratchFolder folder;
    const AreaLightOptions options{.least_samples = 64, .most_samples = 64};
    const Knot knot;
    const SoftShares whole = knot.soft(folder.path(), options);
    const auto file = [&] { return fs::directory_iterator(folder.path())->path(); };
    const auto damages = {+[](const fs::path& path) { fs::resize_file(path, fs::file_size(path) - 1); },
                          +[](const fs::path& path) { fs::resize_file(path, 0); },
                          +[](const fs::path& path) {
                              std::fstream stream(path, std::ios::in | std::ios::out | std::ios::binary);
                              stream.seekp(100);
                              stream.put('!');
                          }};
    for (const auto damage : damages) {
        damage(file());
        const SoftShares again = knot.soft(folder.path(), options);
        EXPECT_FALSE(again.cached);
        EXPECT_EQ(again.shares, whole.shares);
        EXPECT_TRUE(knot.soft(folder.path(), options).cached);
    }
}

TEST(ShadowTruth, CacheThatCannotBeWrittenIsTold) {
    const test::ScratchFolder folder;
    test::write_text(folder.path() / "file", "not a folder");
    const Knot knot;
    try {
        (void)knot.soft(folder.path() / "file", {.least_samples = 64, .most_samples = 64});
        FAIL() << "nothing was thrown";
    } catch (const Error& error) {
        EXPECT_EQ(error.fault(), Fault::usage);
        EXPECT_NE(std::string(error.what()).find("file"), std::string::npos) << error.what();
        EXPECT_FALSE(error.way_out().empty());
    }
}

// Answers for an exact number of samples, and for packets, are kept apart from others.
TEST(ShadowTruth, ExactSamplesAreAnotherQuestion) {
    Knot knot;
    const std::vector<glm::dvec3> points = {{0, 0, 0}};
    const auto hash = [&](const AreaLightOptions& options) {
        return hash_of({knot.scene, knot.snapshot, points, points, knot.light, options});
    };
    EXPECT_NE(hash({}), hash({.exact_strata = 4}));
    EXPECT_NE(hash({.exact_strata = 2}), hash({.exact_strata = 4}));
    EXPECT_NE(hash({}), hash({.rays = ImageTracer::Rays::packets}));
}

// Answers are found by all fields of a light that its samples depend on, and by no other field.
TEST(ShadowTruth, OfALightWhatItsShapeUsesIsPartOfTheQuestion) {
    const Knot knot;
    const std::vector<glm::dvec3> points = {{0, 0, 0}};
    const auto hash = [&](const optics::Light& light) {
        return hash_of({knot.scene, knot.snapshot, points, points, light, {}});
    };
    optics::Light far{.towards = {1, 2, 3}, .angle = 0.1};
    const LightHash before = hash(far);
    far.radius = 2.0;
    far.ambient = 0.5F;
    EXPECT_EQ(hash(far), before);
    far.angle = 0.2;
    EXPECT_NE(hash(far), before);
    far.angle = 0.1;
    far.towards.x = 1.1;
    EXPECT_NE(hash(far), before);
    optics::Light flat = optics::aimed_light({0, 3, 0}, {0, 0, 0}, 1.0, 1.0);
    const LightHash rectangle = hash(flat);
    flat.radius = 2.0;
    EXPECT_EQ(hash(flat), rectangle);
    flat.shape = optics::LightShape::disk;
    EXPECT_NE(hash(flat), rectangle);
    flat.shape = optics::LightShape::rectangle;
    flat.half_u *= 2.0;
    EXPECT_NE(hash(flat), rectangle);
}

// Answers depend on alpha masks, because a hole in a mask lets light through.
TEST(ShadowTruth, MasksArePartOfTheQuestion) {
    Knot knot;
    const std::vector<glm::dvec3> points = {{0, 0, 0}};
    const AreaLightOptions options;
    const auto hash = [&] {
        return hash_of({knot.scene, knot.snapshot, points, points, knot.light, options});
    };
    const LightHash before = hash();
    scenes::Primitive& primitive = knot.scene.meshes[0].primitives[0];
    if (primitive.material < 0) {
        primitive.material = int(knot.scene.materials.size());
        knot.scene.materials.emplace_back();
    }
    scenes::Material& material = knot.scene.materials[std::size_t(primitive.material)];
    material.base_color.r = 0.1F;
    EXPECT_EQ(hash(), before) << "a colour hides nothing";
    material.alpha_mode = scenes::AlphaMode::mask;
    const LightHash masked = hash();
    EXPECT_NE(masked, before);
    material.alpha_cutoff = 0.3F;
    EXPECT_NE(hash(), masked);
}

}  // namespace
}  // namespace cairn::reference
