// The documents: docs/decisions/ names what holds each decision, and every link leads to something.

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/scratch_folder.h"

namespace {

namespace fs = std::filesystem;
using cairn::test::read_text;

constexpr std::string_view decisions_folder = "docs/decisions";

struct Link {
    std::string text;
    std::string target;
};

/// The links [text](target) in a line of Markdown.
std::vector<Link> links_of(const std::string& line) {
    static const std::regex link(R"(\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^)\s]+)\))");
    std::vector<Link> links;
    for (std::sregex_iterator it(line.begin(), line.end(), link); it != std::sregex_iterator(); ++it)
        links.push_back({(*it)[1], (*it)[2]});
    return links;
}

/// The lines of a Markdown file. Lines of code blocks are empty, so that line numbers stay.
std::vector<std::string> prose_of(const fs::path& file) {
    std::istringstream text(read_text(file));
    std::vector<std::string> lines;
    bool in_code = false;
    for (std::string line; std::getline(text, line);) {
        const bool is_fence = line.starts_with("```");
        if (is_fence) in_code = !in_code;
        lines.push_back(in_code || is_fence || line.starts_with("    ") ? "" : line);
    }
    return lines;
}

/// The anchor that GitHub gives to a heading: lower case, spaces as hyphens, without punctuation.
std::string anchor_of(std::string_view heading) {
    std::string anchor;
    for (const char c : heading) {
        const auto byte = static_cast<unsigned char>(c);
        if (std::isalnum(byte) != 0 || c == '-' || c == '_') anchor += char(std::tolower(byte));
        if (c == ' ') anchor += '-';
    }
    return anchor;
}

std::vector<std::string> anchors_of(const fs::path& file) {
    static const std::regex heading(R"(^#+ (.*)$)");
    std::vector<std::string> anchors;
    for (const std::string& line : prose_of(file)) {
        std::smatch parts;
        if (std::regex_match(line, parts, heading)) anchors.push_back(anchor_of(parts[1].str()));
    }
    return anchors;
}

bool holds(const std::vector<std::string>& all, const std::string& one) {
    return std::find(all.begin(), all.end(), one) != all.end();
}

/// One entry of docs/decisions/. Its places are "file.md#anchor".
struct Decision {
    std::string file;
    std::string title;
    std::map<std::string, std::string> fields;

    [[nodiscard]] std::string place() const { return file + "#" + anchor_of(title); }
    [[nodiscard]] std::string field(const std::string& name) const {
        const auto found = fields.find(name);
        return found != fields.end() ? found->second : "";
    }
    /// The place that a field links to, or an empty text.
    [[nodiscard]] std::string linked(const std::string& name) const {
        const std::vector<Link> links = links_of(field(name));
        if (links.size() != 1) return {};
        return links[0].target.starts_with('#') ? file + links[0].target : links[0].target;
    }
};

std::vector<Decision> read_decisions(const fs::path& root) {
    static const std::regex field(R"(^- ([a-z ]+): (.*)$)");
    std::vector<Decision> decisions;
    for (const fs::directory_entry& entry : fs::directory_iterator(root / decisions_folder)) {
        const std::string file = entry.path().filename().string();
        if (!file.ends_with(".md") || file == "README.md") continue;
        bool in_fields = false;
        for (const std::string& line : prose_of(entry.path())) {
            std::smatch parts;
            if (line.starts_with("## ")) {
                decisions.push_back({file, line.substr(3), {}});
                in_fields = true;
            } else if (in_fields && std::regex_match(line, parts, field)) {
                decisions.back().fields.emplace(parts[1], parts[2]);
            } else if (!line.empty()) {
                in_fields = false;
            }
        }
    }
    std::sort(decisions.begin(), decisions.end(),
              [](const Decision& a, const Decision& b) { return a.place() < b.place(); });
    return decisions;
}

/// The fault of a place that holds a decision, "path" or "path::Suite.Name"; empty if there is none.
std::string holder_fault(const fs::path& root, const std::string& holder) {
    static const std::regex form(R"(^([^:]+?)(?:::(\w+)\.(\w+))?$)");
    std::smatch parts;
    if (!std::regex_match(holder, parts, form)) return "names nothing that holds it";
    if (!fs::is_regular_file(root / parts[1].str())) return fmt::format("{} does not exist", parts[1].str());
    if (!parts[2].matched) return {};
    const std::regex test(
        fmt::format(R"(TEST(_F|_P)?\(\s*{}\s*,\s*{}\s*\))", parts[2].str(), parts[3].str()));
    if (std::regex_search(read_text(root / parts[1].str()), test)) return {};
    return fmt::format("{} has no test {}.{}", parts[1].str(), parts[2].str(), parts[3].str());
}

/// The faults of the links between a decision and the one that replaces it, or that it replaces.
std::string succession_fault(const Decision& decision, const std::vector<Decision>& all) {
    auto answers = [&](const std::string& place, const std::string& name) {
        return std::any_of(all.begin(), all.end(), [&](const Decision& other) {
            return other.place() == place && other.linked(name) == decision.place();
        });
    };
    const std::string status = decision.field("status");
    if (status.starts_with("superseded by ")) {
        if (!answers(decision.linked("status"), "supersedes")) return "what supersedes it does not link back";
    } else if (status != "accepted") {
        return fmt::format("its status is \"{}\"", status);
    }
    if (!decision.field("supersedes").empty() && !answers(decision.linked("supersedes"), "status"))
        return "what it supersedes does not link back";
    return {};
}

/// The number of links from the index to a place.
std::map<std::string, int> index_of(const fs::path& root) {
    std::map<std::string, int> index;
    for (const std::string& line : prose_of(root / decisions_folder / "README.md"))
        for (const Link& link : links_of(line))
            ++index[link.target];
    return index;
}

/// All faults of docs/decisions/, as "place: fault".
std::vector<std::string> decision_faults(const fs::path& root, std::size_t* count = nullptr) {
    static const std::regex day(R"(\d{4}-\d{2}-\d{2})");
    const std::vector<Decision> decisions = read_decisions(root);
    if (count != nullptr) *count = decisions.size();
    std::map<std::string, int> index = index_of(root);
    std::vector<std::string> faults;
    for (const Decision& decision : decisions) {
        auto fault = [&](const std::string& what) {
            if (!what.empty()) faults.push_back(decision.place() + ": " + what);
        };
        fault(succession_fault(decision, decisions));
        fault(std::regex_match(decision.field("since"), day) ? "" : "no day since which it holds");
        fault(holder_fault(root, decision.field("held by")));
        const int lines = index[decision.place()];
        fault(lines == 1 ? "" : fmt::format("{} lines of the index", lines));
        index.erase(decision.place());
    }
    for (const auto& [target, lines] : index)
        faults.push_back(fmt::format("README.md: {} is no decision", target));
    return faults;
}

/// The fault of a link of a file; empty if there is none. If the link's text is one `name` and its target is
/// source code, the name must occur there.
std::string link_fault(const fs::path& root, const fs::path& file, const Link& link) {
    static const std::regex code(R"(^`(?:\w+(?:::|\.|->))*(\w+)(?:\(\))?`$)");
    if (link.target.starts_with("http://") || link.target.starts_with("https://")) return {};
    const std::size_t hash = link.target.find('#');
    const std::string path = link.target.substr(0, hash);
    const fs::path target = path.empty() ? root / file : root / file.parent_path() / path;
    if (!fs::exists(target)) return fmt::format("{} does not exist", link.target);
    const bool is_markdown = target.extension() == ".md";
    if (hash != std::string::npos && is_markdown && !holds(anchors_of(target), link.target.substr(hash + 1)))
        return fmt::format("{} has no such heading", link.target);
    std::smatch name;
    if (is_markdown || !fs::is_regular_file(target) || !std::regex_match(link.text, name, code)) return {};
    const std::regex word(fmt::format(R"(\b{}\b)", name[1].str()));
    if (std::regex_search(read_text(target), word)) return {};
    return fmt::format("{} does not name {}", link.target, name[1].str());
}

/// The documents of the project, as paths from its root.
std::vector<fs::path> documents(const fs::path& root) {
    std::vector<fs::path> files;
    auto add = [&](const fs::directory_entry& entry) {
        if (entry.path().extension() == ".md") files.push_back(fs::relative(entry.path(), root));
    };
    for (const fs::directory_entry& entry : fs::directory_iterator(root))
        add(entry);
    for (const char* folder : {"docs", "bench", "examples", "fuzz", ".github"}) {
        if (!fs::exists(root / folder)) continue;
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / folder))
            add(entry);
    }
    std::sort(files.begin(), files.end());
    return files;
}

/// Every broken link of the documents, as "file:line: fault".
std::vector<std::string> link_faults(const fs::path& root, int* count = nullptr) {
    std::vector<std::string> faults;
    for (const fs::path& file : documents(root)) {
        const std::vector<std::string> lines = prose_of(root / file);
        for (std::size_t i = 0; i < lines.size(); ++i) {
            for (const Link& link : links_of(lines[i])) {
                if (count != nullptr) ++*count;
                const std::string fault = link_fault(root, file, link);
                if (!fault.empty())
                    faults.push_back(fmt::format("{}:{}: {}", file.generic_string(), i + 1, fault));
            }
        }
    }
    return faults;
}

TEST(Decisions, AreHeldByWhatTheyNameAndStandInTheIndexOnce) {
    std::size_t count = 0;
    for (const std::string& fault : decision_faults(CAIRN_SOURCE_DIR, &count))
        ADD_FAILURE() << fault;
    EXPECT_GT(count, 50U) << "the decisions were not found under " << CAIRN_SOURCE_DIR;
}

TEST(Documents, LinkToWhatExists) {
    int count = 0;
    for (const std::string& fault : link_faults(CAIRN_SOURCE_DIR, &count))
        ADD_FAILURE() << fault;
    EXPECT_GT(count, 100) << "the documents were not found under " << CAIRN_SOURCE_DIR;
}

/// A small project on disk with two decisions, the second in place of the first.
class FakeDocuments : public testing::Test {
protected:
    FakeDocuments() {
        add("tests/a_test.cpp", "TEST_F(Suite, HoldsIt) {}\nvoid used();\n");
        add("docs/decisions/room.md",
            decision("Walls: of stone", "superseded by [Walls: of wood](#walls-of-wood)", "") +
                decision("Walls: of wood", "accepted",
                         "- supersedes: [Walls: of stone](room.md#walls-of-stone)\n"));
        add("docs/decisions/README.md",
            "# All\n\n- [Walls: of stone](room.md#walls-of-stone)\n- [Walls: of "
            "wood](room.md#walls-of-wood)\n");
    }
    static std::string decision(const std::string& title, const std::string& status, const std::string& more,
                                const std::string& holder = "tests/a_test.cpp::Suite.HoldsIt") {
        return fmt::format("## {}\n\n- status: {}\n- since: 2026-01-31\n{}- held by: {}\n\nWhy.\n\n", title,
                           status, more, holder);
    }
    void add(const std::string& file, const std::string& text) const {
        cairn::test::write_text(folder_.path() / file, text);
    }
    [[nodiscard]] std::vector<std::string> faults() const { return decision_faults(folder_.path()); }
    [[nodiscard]] std::vector<std::string> broken_links() const { return link_faults(folder_.path()); }
    using Faults = std::vector<std::string>;

private:
    cairn::test::ScratchFolder folder_;
};

TEST_F(FakeDocuments, ThatAreInOrderHaveNoFault) {
    EXPECT_EQ(faults(), Faults{});
    EXPECT_EQ(broken_links(), Faults{});
}

TEST_F(FakeDocuments, WithADecisionThatNothingHoldsNameIt) {
    add("docs/decisions/room.md", decision("A", "accepted", "", "tests/gone_test.cpp") +
                                      decision("B", "accepted", "", "tests/a_test.cpp::Suite.Holds") +
                                      decision("C", "accepted", "", "") + "## D\n\nWhy.\n");
    add("docs/decisions/README.md",
        "- [A](room.md#a)\n- [B](room.md#b)\n- [C](room.md#c)\n- [D](room.md#d)\n");
    const Faults expected = {
        "room.md#a: tests/gone_test.cpp does not exist",
        "room.md#b: tests/a_test.cpp has no test Suite.Holds",
        "room.md#c: names nothing that holds it",
        "room.md#d: its status is \"\"",
        "room.md#d: no day since which it holds",
        "room.md#d: names nothing that holds it",
    };
    EXPECT_EQ(faults(), expected);
}

TEST_F(FakeDocuments, WithASuccessionThatLinksOneWayNameIt) {
    add("docs/decisions/room.md", decision("Walls: of stone", "superseded by [wood](#walls-of-wood)", "") +
                                      decision("Walls: of wood", "accepted", ""));
    EXPECT_EQ(faults(), Faults{"room.md#walls-of-stone: what supersedes it does not link back"});
    add("docs/decisions/room.md",
        decision("Walls: of stone", "accepted", "") +
            decision("Walls: of wood", "accepted", "- supersedes: [stone](#walls-of-stone)\n"));
    EXPECT_EQ(faults(), Faults{"room.md#walls-of-wood: what it supersedes does not link back"});
}

TEST_F(FakeDocuments, WithAnIndexThatIsNotTheListNameIt) {
    add("docs/decisions/README.md",
        "- [wood](room.md#walls-of-wood)\n- [wood](room.md#walls-of-wood)\n- [roof](room.md#roof)\n");
    const Faults expected = {
        "room.md#walls-of-stone: 0 lines of the index",
        "room.md#walls-of-wood: 2 lines of the index",
        "README.md: room.md#roof is no decision",
    };
    EXPECT_EQ(faults(), expected);
}

TEST_F(FakeDocuments, WithLinksThatLeadNowhereNameFileAndLine) {
    add("README.md",
        "[`here::used`](tests/a_test.cpp) and [there](docs/gone.md)\n\n```\n[code](gone)\n```\n"
        "    [code](gone)\n[web](https://example.org/gone) [`lost()`](tests/a_test.cpp)\n");
    add("docs/a.md",
        "# A title: its `anchor`\n\n[up](../README.md) [self](#a-title-its-anchor)\n[none](#anchor)\n");
    const Faults expected = {
        "README.md:1: docs/gone.md does not exist",
        "README.md:7: tests/a_test.cpp does not name lost",
        "docs/a.md:4: #anchor has no such heading",
    };
    EXPECT_EQ(broken_links(), expected);
}

}  // namespace
