// No text of a library names an option of the command. It names what the caller can change by its name in the
// library, and the command replaces that name by its option (app/terminal/option_names.cpp).

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/scratch_folder.h"

namespace {

namespace fs = std::filesystem;

constexpr std::array libraries = {"base",      "gl",        "scenes",   "optics",
                                  "voxelizer", "reference", "renderer", "shaders"};

struct Literal {
    int line = 0;  ///< line where it begins, from 1
    std::string text;
};

/// Reads string literals out of C++, past comments and character literals.
class LiteralReader {
public:
    explicit LiteralReader(std::string_view source) : source_(source) {}

    std::vector<Literal> read() {
        while (at_ < source_.size()) {
            if (begins_with("//"))
                skip_past("\n");
            else if (begins_with("/*"))
                skip_past("*/");
            else if (begins_with("R\"") && !follows_a_word())
                read_raw();
            else if (source_[at_] == '"')
                read_quoted('"');
            else if (source_[at_] == '\'' && !follows_a_word())  // not the mark in 1'000'000
                read_quoted('\'');
            else
                ++at_;
        }
        return std::move(literals_);
    }

private:
    [[nodiscard]] bool begins_with(std::string_view text) const {
        return source_.substr(at_).starts_with(text);
    }
    [[nodiscard]] bool follows_a_word() const {
        return at_ > 0 &&
               (std::isalnum(static_cast<unsigned char>(source_[at_ - 1])) != 0 || source_[at_ - 1] == '_');
    }
    void skip_past(std::string_view end) {
        const std::size_t found = source_.find(end, at_);
        at_ = found == std::string_view::npos ? source_.size() : found + end.size();
    }
    void add(std::size_t from, std::size_t to) {
        const auto line = std::count(source_.begin(), source_.begin() + std::ptrdiff_t(from), '\n') + 1;
        literals_.push_back({int(line), std::string(source_.substr(from, to - from))});
    }
    void read_quoted(char quote) {
        const std::size_t from = ++at_;
        while (at_ < source_.size() && source_[at_] != quote && source_[at_] != '\n')
            at_ += source_[at_] == '\\' ? 2 : 1;
        const std::size_t to = std::min(at_, source_.size());
        if (quote == '"') add(from, to);
        at_ = to + 1;
    }
    void read_raw() {
        const std::size_t open = source_.find('(', at_);
        const std::string end = fmt::format("){}\"", source_.substr(at_ + 2, open - at_ - 2));
        at_ = open + 1;
        const std::size_t from = at_;
        skip_past(end);
        add(from, at_ >= end.size() ? at_ - end.size() : at_);
    }

    std::string_view source_;
    std::size_t at_ = 0;
    std::vector<Literal> literals_;
};

std::string text_of(const fs::path& path) {
    std::ifstream stream(path);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// Calls `visit(file, literal)` for all string literals of the libraries.
template <typename Visit>
void for_each_literal(const fs::path& root, const Visit& visit) {
    for (const char* library : libraries) {
        if (!fs::exists(root / library)) continue;
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / library)) {
            if (entry.path().extension() != ".h" && entry.path().extension() != ".cpp") continue;
            const std::string text = text_of(entry.path());
            for (const Literal& literal : LiteralReader(text).read())
                visit(fs::relative(entry.path(), root).generic_string(), literal);
        }
    }
}

/// Every literal of a library that names an option, as "file:line: text".
std::vector<std::string> options_named(const fs::path& root, int* literal_count = nullptr) {
    static const std::regex option(R"((^|[^-\w]|\\[nt])--[a-z])");
    std::vector<std::string> found;
    for_each_literal(root, [&](const std::string& file, const Literal& literal) {
        if (literal_count != nullptr) ++*literal_count;
        if (std::regex_search(literal.text, option))
            found.push_back(fmt::format("{}:{}: {}", file, literal.line, literal.text));
    });
    std::sort(found.begin(), found.end());
    return found;
}

/// The library's own names that its literals hold: "LoadOptions::trust_paths", "grid_over()".
std::set<std::string> names_in(const std::string& text) {
    static const std::regex name(R"(\b[A-Z]\w+::\w+|\b[a-z]\w*\(\))");
    return {std::sregex_token_iterator(text.begin(), text.end(), name), std::sregex_token_iterator()};
}

TEST(LibraryStrings, NameNoOptionOfTheCommand) {
    int literal_count = 0;
    for (const std::string& named : options_named(CAIRN_SOURCE_DIR, &literal_count))
        ADD_FAILURE() << named;
    EXPECT_GT(literal_count, 500) << "the project was not found under " << CAIRN_SOURCE_DIR;
}

TEST(LibraryStrings, NameWhatTheCommandHasAnOptionFor) {
    const fs::path root = CAIRN_SOURCE_DIR;
    std::set<std::string> named;
    for_each_literal(root, [&](const std::string&, const Literal& literal) {
        if (literal.text.find(' ') != std::string::npos) named.merge(names_in(literal.text));
    });
    std::set<std::string> translated;
    const std::string table = text_of(root / "app/terminal/option_names.cpp");
    for (const Literal& literal : LiteralReader(table).read())
        translated.merge(names_in(literal.text));
    // The command always sets these as they must be.
    for (const char* kept : {"SurfaceOptions::attributes", "TreeOptions::mips"})
        EXPECT_EQ(named.erase(kept), 1U) << kept;
    EXPECT_EQ(named, translated)
        << "app/terminal/option_names.cpp lists other names than the libraries' texts";
}

TEST(LibraryStrings, AreReadPastCommentsAndMarks) {
    const std::string source = R"~(
// "a comment"  /* "another" */
const char* a = "one \"quoted\"";  /* "two
lines" */ const char* b = R"x(raw "text" --option)x";
char quote = '"'; int count = 1'000; auto c = "last" "joined";
)~";
    std::vector<std::string> texts;
    std::vector<int> lines;
    for (const Literal& literal : LiteralReader(source).read()) {
        texts.push_back(literal.text);
        lines.push_back(literal.line);
    }
    EXPECT_EQ(texts,
              (std::vector<std::string>{R"(one \"quoted\")", R"(raw "text" --option)", "last", "joined"}));
    EXPECT_EQ(lines, (std::vector<int>{3, 4, 5, 5}));
}

TEST(LibraryStrings, OfAFakeTreeAreFoundWithFileAndLine) {
    const cairn::test::ScratchFolder folder;
    const auto add = [&](const char* file, const std::string& text) {
        cairn::test::write_text(folder.path() / file, text);
    };
    add("gl/context.cpp", "// --context is the command's\nthrow Error(\"choose another --context\");\n");
    add("scenes/gltf/uri.h", "const char* a = \"allow it with\\n--trust-paths\";\n");
    add("voxelizer/grid.cpp", "const char* a = \"a -- b, i--, x--y and --- and --1\";\n");
    add("app/main.cpp", "const char* a = \"--json\";\n");
    const std::vector<std::string> expected = {
        "gl/context.cpp:2: choose another --context",
        "scenes/gltf/uri.h:1: allow it with\\n--trust-paths",
    };
    EXPECT_EQ(options_named(folder.path()), expected);
}

}  // namespace
