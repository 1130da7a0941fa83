// Every shader that a program is built from compiles: on the driver, and with the reference compiler, which
// is stricter than drivers. The libraries list the definitions that they compile each entry point
// (<verb>.<stage>.glsl) with.

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glad/gl.h>
#include <gtest/gtest.h>

#include "gl/handle.h"
#include "gl/shader_source.h"
#include "gl/shader_variants.h"
#include "renderer/shader_variants.h"
#include "shaders/embedded.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/scratch_folder.h"
#include "voxelizer/shader_variants.h"

namespace cairn::gl {
namespace {

using cairn::test::GlTest;
using cairn::test::read_text;
using cairn::test::ScratchFolder;
using cairn::test::write_text;

/// An entry point, and some of the sets of definitions that it is compiled with.
struct Case {
    std::string name;
    std::string stage;
    std::vector<Defines> sets;
    /// Number of the first set among those of the entry point.
    std::size_t number = 0;
};

/// Sets per test. With a process per set, starting would take longer than compiling.
constexpr std::size_t sets_per_case = 6;

const std::map<std::string, GLenum> stages = {{"comp", GL_COMPUTE_SHADER},
                                              {"vert", GL_VERTEX_SHADER},
                                              {"frag", GL_FRAGMENT_SHADER},
                                              {"geom", GL_GEOMETRY_SHADER}};

/// The stage of a file, "comp" of "march/march.comp.glsl"; empty if it is included, as "march/march.glsl".
std::string stage_of(const std::filesystem::path& name) {
    const std::string inner = name.stem().extension().string();
    return inner.empty() ? "" : inner.substr(1);
}

/// The sets of rays of surfaces, for a chart's shader that takes the place of the primary one.
std::vector<ShaderVariants> of_charts() {
    std::vector<Defines> sets;
    for (const renderer::MarchSetting& setting : renderer::march_settings()) {
        if (!setting.content.is_surface() || setting.content.has_constant) continue;
        for (const bool progressive : {false, true}) {
            if (progressive && setting.tile_queries == renderer::TileQueries::blocks) continue;
            sets.push_back(renderer::defines(setting));
            for (const auto& define : renderer::defines(renderer::MarchVariant{.progressive = progressive}))
                sets.back().push_back(define);
        }
    }
    return {{"bench/saturate.comp.glsl", sets}, {"bench/test_box.frag.glsl"}, {"bench/test_box.vert.glsl"}};
}

/// The text of an entry point with what it includes, without the definitions: these stand before the first
/// #line. It does not depend on their values, so one set stands for all. Every process of these tests lists
/// all cases, which is why a text is resolved once here.
std::string body_of(const ShaderVariants& entry) {
    if (entry.defines.empty()) return "";
    const std::string text = ShaderSource().resolve(entry.name, entry.defines.front()).text;
    return text.substr(text.find("#line"));
}

/// All sets, by entry point. Sets that differ only in macros that the text does not name count as one.
std::map<std::string, std::vector<Defines>> all_variants() {
    std::map<std::string, std::vector<Defines>> all;
    for (const auto& list : {voxelizer::shader_variants(), renderer::shader_variants(), of_charts()}) {
        for (const ShaderVariants& entry : list) {
            const std::string body = body_of(entry);
            std::map<std::string, bool> names;
            std::set<std::string> keys;
            for (const Defines& defines : entry.defines) {
                Defines named;
                std::string key;
                for (const auto& define : defines) {
                    const auto [name, is_new] = names.try_emplace(define.first);
                    if (is_new) name->second = body.find(define.first) != std::string::npos;
                    if (!name->second) continue;
                    named.push_back(define);
                    key += define.first + "=" + define.second + " ";
                }
                if (keys.insert(key).second) all[entry.name].push_back(named);
            }
        }
    }
    return all;
}

std::vector<Case> all_cases() {
    std::vector<Case> cases;
    for (const auto& [name, sets] : all_variants()) {
        for (std::size_t first = 0; first < sets.size(); first += sets_per_case) {
            const std::size_t last = std::min(first + sets_per_case, sets.size());
            cases.push_back({name,
                             stage_of(name),
                             {sets.begin() + std::ptrdiff_t(first), sets.begin() + std::ptrdiff_t(last)},
                             first / sets_per_case});
        }
    }
    return cases;
}

std::string text_of(const Defines& defines) {
    std::string text;
    for (const auto& [name, value] : defines)
        text += fmt::format(" {}={}", name, value);
    return text;
}

void PrintTo(const Case& c, std::ostream* out) {
    *out << c.name;
    for (const Defines& defines : c.sets)
        *out << "\n " << text_of(defines);
}

/// A name of letters, digits and underscores, as GoogleTest requires.
std::string test_name(const ::testing::TestParamInfo<Case>& info) {
    std::string name = fmt::format("{}_{}", info.param.name, info.param.number);
    for (char& c : name) {
        if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
    }
    return name;
}

class EveryShader : public GlTest, public ::testing::WithParamInterface<Case> {};

TEST_P(EveryShader, PassesTheReferenceCompiler) {
    const Case& shader = GetParam();
    ASSERT_TRUE(stages.contains(shader.stage)) << shader.name << ": \"" << shader.stage << "\" is no stage";
    const ScratchFolder folder;
    std::string paths;
    std::string legend;
    for (std::size_t i = 0; i < shader.sets.size(); ++i) {
        const ResolvedSource resolved = ShaderSource().resolve(shader.name, shader.sets[i]);
        const std::string path = folder.file(fmt::format("{}.glsl", i));
        write_text(path, resolved.text);
        paths += " '" + path + "'";
        legend += fmt::format("\n{}.glsl:{}", i, text_of(shader.sets[i]));
        for (std::size_t file = 0; file < resolved.files.size(); ++file)
            legend += fmt::format("\n  {}: {}", file, resolved.files[file]);
    }
    const int status = std::system(fmt::format("'{}' -S {}{} > '{}' 2>&1", CAIRN_GLSLANG_VALIDATOR,
                                               shader.stage, paths, folder.file("log"))
                                       .c_str());
    EXPECT_EQ(status, 0) << read_text(folder.file("log")) << "files by number:" << legend;
}

TEST_P(EveryShader, CompilesOnTheDriver) {
    const Case& shader = GetParam();
    for (const Defines& defines : shader.sets) {
        const ResolvedSource resolved = ShaderSource().resolve(shader.name, defines);
        const char* text = resolved.text.c_str();
        const ShaderHandle handle(glCreateShader(stages.at(shader.stage)));
        glShaderSource(handle.id(), 1, &text, nullptr);
        glCompileShader(handle.id());
        GLint compiled = GL_FALSE;
        glGetShaderiv(handle.id(), GL_COMPILE_STATUS, &compiled);
        std::string log(10000, '\0');
        glGetShaderInfoLog(handle.id(), GLsizei(log.size()), nullptr, log.data());
        EXPECT_EQ(compiled, GL_TRUE) << shader.name << text_of(defines) << " on " << driver_name() << "\n"
                                     << log.c_str();
    }
}

INSTANTIATE_TEST_SUITE_P(Shaders, EveryShader, ::testing::ValuesIn(all_cases()), test_name);

TEST(EmbeddedShaders, AreTheFilesOfTheFolder) {
    const std::filesystem::path folder = CAIRN_SHADER_DIR;
    std::set<std::string> names;
    for (const shaders::EmbeddedFile& file : shaders::embedded_files()) {
        names.insert(std::string(file.name));
        EXPECT_TRUE(file.text == read_text(folder / file.name))
            << file.name << " has changed since the build";
    }
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        if (entry.path().extension() != ".glsl") continue;
        EXPECT_TRUE(names.contains(entry.path().lexically_relative(folder).string()))
            << entry.path() << " is not embedded";
    }
}

TEST(EmbeddedShaders, EntryPointsAllHaveAListOfDefinitions) {
    const auto listed = all_variants();
    for (const shaders::EmbeddedFile& file : shaders::embedded_files()) {
        const std::string name(file.name);
        if (stage_of(name).empty()) continue;
        EXPECT_TRUE(listed.contains(name)) << name << " is in no library's shader_variants()";
    }
}

TEST(EmbeddedShaders, FragmentsAreAllIncluded) {
    std::set<std::string> used;
    for (const auto& [name, sets] : all_variants()) {
        for (const Defines& defines : sets) {
            for (const std::string& file : ShaderSource().resolve(name, defines).files)
                used.insert(file);
        }
    }
    for (const shaders::EmbeddedFile& file : shaders::embedded_files()) {
        const std::string name(file.name);
        if (!name.ends_with(".glsl")) continue;
        EXPECT_TRUE(used.contains(name)) << name << " is in no program";
    }
}

}  // namespace
}  // namespace cairn::gl
