// Every shader that a program is built from compiles: on the driver, and with the reference compiler, which
// is stricter than drivers are.
//
// An entry point is called <verb>.<stage>.glsl. Where it needs definitions, lines at its top list them, one
// line for each set that the program uses:
//
//     // defines: TREE_N=4 BRICK_M=16
//     // defines: TREE_N=2 BRICK_M=8

#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glad/gl.h>
#include <gtest/gtest.h>

#include "gl/handle.h"
#include "gl/shader_source.h"
#include "shaders/embedded.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/scratch_folder.h"

namespace cairn::gl {
namespace {

using cairn::test::GlTest;
using cairn::test::read_text;
using cairn::test::ScratchFolder;
using cairn::test::write_text;

/// One way in which an entry point is compiled.
struct Case {
    std::string name;
    std::string stage;
    Defines defines;
};

const std::map<std::string, GLenum> stages = {{"comp", GL_COMPUTE_SHADER},
                                              {"vert", GL_VERTEX_SHADER},
                                              {"frag", GL_FRAGMENT_SHADER},
                                              {"geom", GL_GEOMETRY_SHADER}};

/// "comp" of "march/march.comp.glsl"; empty for a fragment such as "march/march.glsl".
std::string stage_of(const std::filesystem::path& name) {
    const std::string inner = name.stem().extension().string();
    return inner.empty() ? "" : inner.substr(1);
}

std::vector<Defines> define_sets(std::string_view text) {
    constexpr std::string_view mark = "// defines:";
    std::vector<Defines> sets;
    std::istringstream lines{std::string(text)};
    for (std::string line; std::getline(lines, line);) {
        if (!line.starts_with(mark)) continue;
        Defines& defines = sets.emplace_back();
        std::istringstream words(line.substr(mark.size()));
        for (std::string word; words >> word;) {
            const std::size_t equals = word.find('=');
            defines.emplace_back(word.substr(0, equals),
                                 equals == std::string::npos ? "" : word.substr(equals + 1));
        }
    }
    if (sets.empty()) sets.emplace_back();
    return sets;
}

std::vector<Case> all_cases() {
    std::vector<Case> cases;
    for (const shaders::EmbeddedFile& file : shaders::embedded_files()) {
        const std::string stage = stage_of(file.name);
        if (stage.empty()) continue;
        for (const Defines& defines : define_sets(file.text))
            cases.push_back({std::string(file.name), stage, defines});
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
    *out << c.name << text_of(c.defines);
}

/// A name of letters, digits and underscores, as GoogleTest wants.
std::string test_name(const ::testing::TestParamInfo<Case>& info) {
    std::string name = info.param.name + text_of(info.param.defines);
    for (char& c : name) {
        if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
    }
    return name;
}

class EveryShader : public GlTest, public ::testing::WithParamInterface<Case> {};

TEST_P(EveryShader, PassesTheReferenceCompiler) {
    const Case& shader = GetParam();
    ASSERT_TRUE(stages.contains(shader.stage)) << shader.name << ": \"" << shader.stage << "\" is no stage";
    const ResolvedSource resolved = ShaderSource().resolve(shader.name, shader.defines);
    const ScratchFolder folder;
    write_text(folder.file("shader.glsl"), resolved.text);
    const int status = std::system(fmt::format("'{}' -S {} '{}' > '{}' 2>&1", CAIRN_GLSLANG_VALIDATOR,
                                               shader.stage, folder.file("shader.glsl"), folder.file("log"))
                                       .c_str());
    std::string files;
    for (std::size_t i = 0; i < resolved.files.size(); ++i)
        files += fmt::format("\n  {}: {}", i, resolved.files[i]);
    EXPECT_EQ(status, 0) << read_text(folder.file("log")) << "files by number:" << files;
}

TEST_P(EveryShader, CompilesOnTheDriver) {
    const Case& shader = GetParam();
    const ResolvedSource resolved = ShaderSource().resolve(shader.name, shader.defines);
    const char* text = resolved.text.c_str();
    const ShaderHandle handle(glCreateShader(stages.at(shader.stage)));
    glShaderSource(handle.id(), 1, &text, nullptr);
    glCompileShader(handle.id());
    GLint compiled = GL_FALSE;
    glGetShaderiv(handle.id(), GL_COMPILE_STATUS, &compiled);
    std::string log(10000, '\0');
    glGetShaderInfoLog(handle.id(), GLsizei(log.size()), nullptr, log.data());
    EXPECT_EQ(compiled, GL_TRUE) << shader.name << " on " << driver_name() << "\n" << log.c_str();
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

TEST(EmbeddedShaders, FragmentsAreAllIncluded) {
    std::set<std::string> used;
    for (const Case& shader : all_cases()) {
        for (const std::string& file : ShaderSource().resolve(shader.name, shader.defines).files)
            used.insert(file);
    }
    for (const shaders::EmbeddedFile& file : shaders::embedded_files()) {
        const std::string name(file.name);
        if (!name.ends_with(".glsl")) continue;
        EXPECT_TRUE(used.contains(name)) << name << " is in no program";
    }
}

}  // namespace
}  // namespace cairn::gl
