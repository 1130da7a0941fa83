// The OpenGL layer, on whatever driver this machine offers.

#include <array>
#include <compare>
#include <cstdint>
#include <memory>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/clock.h"
#include "base/error.h"
#include "gl/buffer.h"
#include "gl/context.h"
#include "gl/limits.h"
#include "gl/program.h"
#include "gl/program_family.h"
#include "gl/shader_source.h"
#include "gl/timer.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/scratch_folder.h"

namespace cairn::gl {
namespace {

using cairn::test::GlTest;
using cairn::test::ScratchFolder;
using cairn::test::write_text;

/// The error that `work` throws. The test fails if it throws none.
template <typename Work>
Error error_of(Work work) {
    try {
        work();
    } catch (const Error& error) {
        return error;
    }
    ADD_FAILURE() << "no cairn::Error was thrown";
    return Error(Fault::usage, "", "");
}

void expect_works(Context& context, const std::string& backend) {
    EXPECT_EQ(context.backend(), backend);
    EXPECT_NE(driver_name().find("OpenGL 4."), std::string::npos) << driver_name();
    const std::vector<std::uint32_t> numbers = {3, 1, 4, 1, 5};
    EXPECT_EQ(Buffer::of<std::uint32_t>(numbers, "numbers").read_all<std::uint32_t>(5), numbers);
    EXPECT_EQ(context.debug_log().take(), std::vector<std::string>());
}

TEST(Context, EglWorksWithoutADisplay) {
    expect_works(*create_context({.kind = ContextKind::egl, .debug = true}), "egl");
}

#ifdef CAIRN_HAS_OSMESA
TEST(Context, OsmesaWorks) {
    expect_works(*create_context({.kind = ContextKind::osmesa, .debug = true}), "osmesa");
}

TEST(Context, OneAfterAnotherWorks) {
    for (const ContextKind kind :
         {ContextKind::osmesa, ContextKind::egl, ContextKind::osmesa, ContextKind::egl}) {
        expect_works(*create_context({.kind = kind, .debug = true}),
                     kind == ContextKind::egl ? "egl" : "osmesa");
    }
}
#endif

TEST(Context, AutomaticFindsOne) {
    const std::unique_ptr<Context> context = create_context();
    EXPECT_TRUE(context->backend() == "egl" || context->backend() == "osmesa") << context->backend();
}

TEST_F(GlTest, OffersWhatTheProgramNeeds) {
    const Limits limits = query_limits();
    EXPECT_GE(limits.shader_storage_bytes, std::size_t(1) << 27U) << driver_name();
    EXPECT_GE(limits.texture_3d_size, 2048) << driver_name();
}

TEST_F(GlTest, DebugLogCatchesAnError) {
    glBindBuffer(GL_ARRAY_BUFFER, 12345);  // core profiles accept only names that they made
    const std::vector<std::string> messages = context().debug_log().take();
    EXPECT_FALSE(messages.empty());
    EXPECT_TRUE(context().debug_log().take().empty()) << "take() must empty the log";
}

TEST_F(GlTest, BufferGivesBackWhatItWasGiven) {
    std::vector<std::uint32_t> numbers(1000);
    std::iota(numbers.begin(), numbers.end(), 7U);
    Buffer buffer = Buffer::of<std::uint32_t>(numbers, "numbers");
    EXPECT_EQ(buffer.size_bytes(), 4000U);
    EXPECT_EQ(buffer.read_all<std::uint32_t>(1000), numbers);

    const std::array<std::uint32_t, 2> patch = {0xFFFFFFFFU, 0U};
    buffer.write(40, patch.data(), sizeof(patch));
    buffer.fill(400, 8, 0xABCDU);
    numbers[10] = patch[0];
    numbers[11] = patch[1];
    numbers[100] = numbers[101] = 0xABCDU;
    EXPECT_EQ(buffer.read_all<std::uint32_t>(1000), numbers);
    EXPECT_EQ(buffer.read_all<std::uint32_t>(3, 396), (std::vector<std::uint32_t>{106, 0xABCD, 0xABCD}));

    buffer.fill(9U);
    EXPECT_EQ(buffer.read_all<std::uint32_t>(1000), std::vector<std::uint32_t>(1000, 9U));
}

TEST_F(GlTest, EmptyBufferCanBeBound) {
    const Buffer buffer = Buffer::of<std::uint32_t>({}, "nothing");
    EXPECT_GT(buffer.size_bytes(), 0U);
    buffer.bind_storage(0);
    EXPECT_TRUE(buffer.read_all<std::uint32_t>(0).empty());
}

TEST_F(GlTest, MovedBufferOwnsItsNameOnce) {
    Buffer first(64, "moved");
    const GLuint id = first.id();
    const Buffer second = std::move(first);
    EXPECT_EQ(second.id(), id);
    EXPECT_EQ(glIsBuffer(id), GL_TRUE);
}

TEST_F(GlTest, BufferThatDoesNotFitSaysSo) {
    const Error error = error_of([] { const Buffer buffer(std::size_t(1) << 60U, "brick pool"); });
    EXPECT_EQ(error.fault(), Fault::memory);
    EXPECT_NE(std::string(error.what()).find("brick pool"), std::string::npos) << error.what();
    EXPECT_FALSE(error.way_out().empty());
    (void)context().debug_log().take();  // KHR_debug reports it too
}

TEST_F(GlTest, TimerMeasuresNoMoreThanPasses) {
    const Timer timer;
    Buffer buffer(std::size_t(8) << 20U, "timed");
    glFinish();
    const Clock::time_point start = Clock::now();
    timer.start();
    buffer.fill(1U);
    timer.stop();
    glFinish();
    const double passed = milliseconds_since(start);
    EXPECT_GE(timer.milliseconds(), 0.0);
    EXPECT_LE(timer.milliseconds(), passed);
}

/// A folder of shaders, as for --shader-dir.
class Shaders : public GlTest {
protected:
    void write(const std::string& name, const std::string& text) { write_text(folder_.path() / name, text); }
    [[nodiscard]] ShaderSource source() const { return ShaderSource(folder_.path()); }

private:
    ScratchFolder folder_;
};

TEST_F(Shaders, ComputeRunsWithUniformsAndDefines) {
    write("add.comp.glsl", R"(
layout(local_size_x = 64) in;
layout(std430, binding = 3) buffer Numbers { uint numbers[]; };
uniform uint count;
uniform ivec3 addend;
void main() {
    uint i = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * 64u;
    if (i < count) numbers[i] += uint(addend.z) * FACTOR;
}
)");
    const Program program = build_compute(source(), "add.comp.glsl", {{"FACTOR", "10u"}});
    const Buffer buffer = Buffer::of<std::uint32_t>(std::vector<std::uint32_t>(1000, 1U), "numbers");
    program.use();
    program.set("count", 999U);
    program.set("addend", glm::ivec3(1, 2, 3));
    program.set("no_such_uniform", 1);  // allowed: drivers remove what is not used
    buffer.bind_storage(3);
    dispatch_threads(1000, 64);
    std::vector<std::uint32_t> expected(1000, 31U);
    expected.back() = 1U;
    EXPECT_EQ(buffer.read_all<std::uint32_t>(1000), expected);
}

TEST_F(Shaders, DispatchFoldsWhatIsTooLongForOneAxis) {
    write("mark.comp.glsl", R"(
layout(local_size_x = 1) in;
layout(std430, binding = 0) buffer Marks { uint marks[]; };
uniform uint count;
void main() {
    uint i = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x;
    if (i < count) atomicAdd(marks[i], 1u);
}
)");
    const std::size_t count = 65535 + 3;
    const Program program = build_compute(source(), "mark.comp.glsl");
    Buffer marks(count * 4, "marks");
    marks.fill(0U);
    program.use();
    program.set("count", unsigned(count));
    marks.bind_storage(0);
    dispatch_threads(count, 1);
    EXPECT_EQ(marks.read_all<std::uint32_t>(count), std::vector<std::uint32_t>(count, 1U));
}

TEST_F(Shaders, ErrorNamesFileAndLineThroughIncludes) {
    write("parts/deep.glsl", "float fine(float x) { return x; }\nfloat bad() { return no_such_name; }\n");
    write("parts/middle.glsl", "// one\n#include \"parts/deep.glsl\"\nfloat after() { return 1.0; }\n");
    write("top.comp.glsl", "layout(local_size_x = 1) in;\n#include \"parts/middle.glsl\"\nvoid main() {}\n");
    const Error error = error_of([&] { (void)build_compute(source(), "top.comp.glsl"); });
    const std::string what = error.what();
    EXPECT_EQ(error.fault(), Fault::context);
    EXPECT_NE(what.find("top.comp.glsl"), std::string::npos) << what;
    EXPECT_NE(what.find("parts/deep.glsl:2"), std::string::npos) << what;
    EXPECT_NE(what.find("parts/middle.glsl:2"), std::string::npos) << "who included it: " << what;
    EXPECT_NE(what.find(driver_name()), std::string::npos) << what;
    (void)context().debug_log().take();  // some drivers report compile errors there too
}

TEST_F(Shaders, LinesAfterAnIncludeKeepTheirNumbers) {
    write("part.glsl", "float a() { return 1.0; }\n// two\n// three\n");
    write("top.comp.glsl",
          "layout(local_size_x = 1) in;\n#include \"part.glsl\"\n#include \"part.glsl\"\nvoid main() { oops; "
          "}\n");
    const Error error = error_of([&] { (void)build_compute(source(), "top.comp.glsl"); });
    EXPECT_NE(std::string(error.what()).find("top.comp.glsl:4"), std::string::npos) << error.what();
    (void)context().debug_log().take();
}

/// The text of an entry point, resolved with these definitions.
class Macros : public testing::Test {
protected:
    std::string resolve(const std::string& text, const Defines& defines = {}) {
        write_text(folder_.file("top.comp.glsl"), text);
        return ShaderSource(folder_.path()).resolve("top.comp.glsl", defines).text;
    }
    std::string fault_of(const std::string& text, const Defines& defines = {}) {
        return error_of([&] { (void)resolve(text, defines); }).what();
    }
    ScratchFolder folder_;
};

TEST_F(Macros, ANameThatNobodyDefinedIsAnErrorInIf) {
    EXPECT_EQ(fault_of("// one\n#if SHADOW_CONE\n#endif\n", {{"SHADOW_CONES", "1"}}),
              "top.comp.glsl:2: \"SHADOW_CONE\" is not defined");
    EXPECT_EQ(fault_of("#if A\n#elif A && (B > 1)  // C\n#endif\n", {{"A", "0"}}),
              "top.comp.glsl:2: \"B\" is not defined");
    EXPECT_EQ(fault_of("#if defined(A)\n#endif\n", {{"A", "0"}}),
              "top.comp.glsl:1: \"defined\" is not defined");
    // A name is defined from its definition on.
    EXPECT_EQ(fault_of("#if LATE\n#endif\n#define LATE 1\n"), "top.comp.glsl:1: \"LATE\" is not defined");
}

TEST_F(Macros, TheErrorNamesTheFileThatIsIncluded) {
    write_text(folder_.file("part.glsl"), "#define HERE 1\n#if HERE\n#endif\n\n#if NOT_HERE\n#endif\n");
    EXPECT_EQ(fault_of("#include \"part.glsl\"\n"), "part.glsl:5: \"NOT_HERE\" is not defined");
}

TEST_F(Macros, DefinedNamesPass) {
    EXPECT_NE(resolve("#define B 0x3\n  # if A == 1 || !B\n#endif\n#define C(x) (x)\n#if C(A) > 0\n#endif\n",
                      {{"A", "1"}})
                  .find("C(A)"),
              std::string::npos);
}

TEST_F(Macros, AFeatureIsNotTestedByIfdef) {
    EXPECT_EQ(fault_of("\n#ifdef WITH_MESHES\n#endif\n", {{"WITH_MESHES", "1"}}),
              "top.comp.glsl:2: \"WITH_MESHES\" is tested by #ifdef: a feature is always defined, and tested "
              "by #if");
    EXPECT_EQ(fault_of("#ifndef MIPS\n// a default\n#define MIPS 0\n#endif\n"),
              "top.comp.glsl:1: \"MIPS\" is tested by #ifndef, and guards no file");
}

TEST_F(Macros, WhatIsForCppIsLeftOut) {
    const std::string text = resolve(
        "#ifndef GUARD_H\n#define GUARD_H\n#ifdef __cplusplus\n#include <glm/glm.hpp>\n#if NO_MACRO_OF_OURS\n"
        "static_assert(true);\n#endif\n#include \"no/such.h\"\n#endif\nfloat kept;\n#endif\n");
    EXPECT_EQ(text,
              "#version 450 core\n#line 1 0\n#ifndef GUARD_H\n#define GUARD_H\n\n\n\n\n\n\n\nfloat "
              "kept;\n#endif\n");
}

TEST_F(Shaders, AFamilyBuildsEachProgramOnce) {
    struct Variant {
        bool doubled = false;
        int offset = 0;
        auto operator<=>(const Variant&) const = default;
    };
    write("variant.comp.glsl",
          "layout(local_size_x = 1) in;\nlayout(std430, binding = 0) buffer B { int value; };\n"
          "void main() {\n#if DOUBLED\n    value *= 2;\n#endif\n    value += OFFSET;\n}\n");
    int built = 0;
    ProgramFamily<Variant> family([&built, shaders = source()](const Variant& variant) {
        ++built;
        return build_compute(
            shaders, "variant.comp.glsl",
            {{"DOUBLED", variant.doubled ? "1" : "0"}, {"OFFSET", std::to_string(variant.offset)}});
    });
    EXPECT_EQ(built, 0);
    const std::array<int, 1> start = {10};
    const Buffer buffer = Buffer::of(std::span<const int>(start), "value");
    buffer.bind_storage(0);
    for (const Variant& variant : {Variant{true, 3}, Variant{false, 1}, Variant{true, 3}}) {
        family.get(variant).use();
        dispatch_threads(1, 1);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    }
    EXPECT_EQ(buffer.read_all<int>(1).front(), ((10 * 2 + 3) + 1) * 2 + 3);
    EXPECT_EQ(built, 2);
    EXPECT_EQ(family.size(), 2U);
}

TEST_F(Shaders, AFamilyKeepsNothingOfAProgramThatDoesNotBuild) {
    write("broken.comp.glsl", "#if BROKEN\noops\n#endif\nlayout(local_size_x = 1) in;\nvoid main() {}\n");
    ProgramFamily<bool> family([shaders = source()](bool broken) {
        return build_compute(shaders, "broken.comp.glsl", {{"BROKEN", broken ? "1" : "0"}});
    });
    (void)error_of([&] { (void)family.get(true); });
    EXPECT_EQ(family.size(), 0U);
    EXPECT_NE(family.get(false).id(), 0U);
    (void)context().debug_log().take();
}

TEST_F(Shaders, RasterStagesLink) {
    write("fill.vert.glsl",
          "void main() { gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1), 0.0, 1.0); }\n");
    write("fill.frag.glsl", "layout(location = 0) out vec4 color;\nvoid main() { color = vec4(1.0); }\n");
    EXPECT_NE(build_raster(source(), "fill.vert.glsl", "fill.frag.glsl").id(), 0U);
}

TEST(ShaderSource, EachFileIsIncludedOnce) {
    const ScratchFolder folder;
    write_text(folder.path() / "shared.glsl", "const int marker_of_shared = 1;\n");
    write_text(folder.path() / "a.glsl", "#include \"shared.glsl\"\n");
    write_text(folder.path() / "top.comp.glsl",
               "#include \"shared.glsl\"\n#include \"a.glsl\"\n  #include \"a.glsl\"\n");
    const ResolvedSource resolved = ShaderSource(folder.path()).resolve("top.comp.glsl", {{"SIZE", "4"}});
    const std::size_t first = resolved.text.find("marker_of_shared");
    ASSERT_NE(first, std::string::npos) << resolved.text;
    EXPECT_EQ(resolved.text.find("marker_of_shared", first + 1), std::string::npos) << resolved.text;
    EXPECT_EQ(resolved.files, (std::vector<std::string>{"top.comp.glsl", "shared.glsl", "a.glsl"}));
    EXPECT_EQ(resolved.included_from[2], "top.comp.glsl:2");
    EXPECT_TRUE(resolved.text.starts_with("#version 450 core\n#define SIZE 4\n")) << resolved.text;
}

TEST(ShaderSource, FilesThatIncludeEachOtherEnd) {
    const ScratchFolder folder;
    write_text(folder.path() / "a.glsl", "#include \"b.glsl\"\n");
    write_text(folder.path() / "b.glsl", "#include \"a.glsl\"\nint in_b;\n");
    EXPECT_NE(ShaderSource(folder.path()).resolve("a.glsl").text.find("in_b"), std::string::npos);
}

TEST(ShaderSource, MissingIncludeNamesThePlace) {
    const ScratchFolder folder;
    write_text(folder.path() / "top.comp.glsl", "// one\n// two\n#include \"absent.glsl\"\n");
    const Error error = error_of([&] { (void)ShaderSource(folder.path()).resolve("top.comp.glsl"); });
    EXPECT_EQ(error.fault(), Fault::input);
    const std::string what = error.what();
    EXPECT_NE(what.find("top.comp.glsl:3"), std::string::npos) << what;
    EXPECT_NE(what.find("absent.glsl"), std::string::npos) << what;
}

TEST(ShaderSource, MissingShaderIsNamed) {
    const Error error = error_of([] { (void)ShaderSource().resolve("no/such.comp.glsl"); });
    EXPECT_NE(std::string(error.what()).find("no/such.comp.glsl"), std::string::npos) << error.what();
}

}  // namespace
}  // namespace cairn::gl
