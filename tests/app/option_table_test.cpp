// Options of the command line: printed options are read as the same options again.

#include "app/options/option_table.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "app/options/options.h"
#include "app/options/shadow_options.h"
#include "app/options/view_options.h"
#include "base/error.h"
#include "shaders/interop/pool.h"
#include "shaders/interop/shadow_rays.h"
#include "shaders/interop/volume.h"

namespace cairn::test {
namespace {

using app::OptionRow;
using app::OptionTable;
using app::SceneOptions;
using app::ViewOptions;

/// Random texts of values, as the command prints them.
class RandomTexts {
public:
    explicit RandomTexts(unsigned seed) : random_(seed) {}

    [[nodiscard]] bool coin() { return random_() % 2 == 0; }
    [[nodiscard]] std::string whole(int low, int high) {
        return std::to_string(low + int(random_() % unsigned(high - low + 1)));
    }
    /// A number in thousandths.
    [[nodiscard]] std::string number(double low, double high) {
        const auto steps = unsigned((high - low) * 1000.0);
        return fmt::format("{}", (std::round(low * 1000.0) + double(random_() % steps)) / 1000.0);
    }
    [[nodiscard]] std::string numbers(int count, double low, double high) {
        std::string text = number(low, high);
        for (int i = 1; i < count; ++i)
            text += "," + number(low, high);
        return text;
    }
    [[nodiscard]] std::string any_of(const std::vector<std::string>& texts) {
        return texts[random_() % texts.size()];
    }
    /// A text for an option; empty if it is a flag. The test fails if the option is unknown here.
    [[nodiscard]] std::string of(const std::string& option);

private:
    std::mt19937 random_;
};

std::string RandomTexts::of(const std::string& option) {
    const std::map<std::string, std::function<std::string()>> texts = {
        {"--time", [&] { return number(-5.0, 50.0); }},
        {"--animation",
         [&] {
             return any_of({"walk", "0", "it's $HOME; a \"dance\""});
         }},
        {"--scene-index", [&] { return whole(0, 9); }},
        {"--trust-paths", [] { return std::string(); }},
        {"--strict", [] { return std::string(); }},
        {"--memory", [&] { return whole(1, 1 << 24); }},
        {"--limit",
         [&] {
             return coin() ? "elements=" + whole(0, 999999)
                           : "image-bytes=" + whole(0, 99999) + ",json-values=" + whole(0, 99999);
         }},
        {"--resolution",
         [&] {
             return coin() ? whole(1, 65536) : whole(1, 9) + "," + whole(10, 20) + "," + whole(1, 65536);
         }},
        {"--voxel-size", [&] { return number(0.001, 10.0); }},
        {"--bounds", [&] { return numbers(3, -9.0, 0.0) + "," + numbers(3, 0.001, 9.0); }},
        {"--size", [&] { return whole(1, 16384) + "x" + whole(1, 16384); }},
        {"--camera",
         [&] { return numbers(3, -9.0, 0.0) + "," + numbers(3, 0.001, 9.0) + "," + number(0.001, 179.999); }},
        {"--light", [&] { return numbers(3, -9.0, 9.0) + (coin() ? "" : "," + number(0.001, 2.0)); }},
        {"--shadow",
         [&] {
             return any_of({"none", "hard", "soft"});
         }},
        {"--cones", [] { return std::string(); }},
        {"--max-resolution", [&] { return whole(16, 1 << MAX_RESOLUTION_BITS); }},
        {"--brick-pool", [&] { return whole(1, 4096); }},
        {"--brick-cache", [&] { return whole(0, 4096); }},
        {"--pixel-error", [&] { return number(0.001, 1000.0); }},
        {"--samples", [&] { return whole(1, 256); }},
        {"--tree-n", [&] { return whole(2, 8); }},
        {"--brick-m", [&] { return whole(8, 81); }},
        {"--traversal",
         [&] {
             return any_of({"restart", "stackless", "mini-stack"});
         }},
        {"--tile-queries",
         [&] {
             return any_of({"list", "blocks"});
         }},
        {"--frame-budget", [&] { return number(0.0, 1000.0); }},
        {"--steps-per-voxel", [&] { return whole(1, VOLUME_MOST_STEPS); }},
        {"--gradient-threshold", [&] { return number(0.0, 1.0); }},
        {"--level-of-detail",
         [&] {
             return any_of({"nearest", "blended"});
         }},
        {"--transfer",
         [&] {
             return any_of({"solid", "haze", "0.2:1,1,1:0;1:1,0.5,1:0.5"});
         }},
        {"--copies", [&] { return whole(1, 4096); }},
        {"--show",
         [&] {
             return any_of({"surface", "levels", "bricks"});
         }},
        {"--zoom", [&] { return whole(0, 46); }},
        {"--method",
         [&] {
             return any_of({"voxel", "pyramid", "soft-shadow-map", "embree"});
         }},
        {"--compare", [] { return std::string("embree"); }},
        {"--light-direction",
         [&] { return numbers(3, 0.001, 9.0) + (coin() ? "" : "," + number(0.001, 89.0)); }},
        {"--light-size", [&] { return numbers(2, 0.001, 9.0); }},
        {"--light-disk", [&] { return number(0.001, 9.0); }},
        {"--light-target", [&] { return numbers(3, -9.0, 9.0); }},
        {"--rays", [&] { return whole(1, MAX_SHADOW_RAYS); }},
        {"--map-size", [&] { return whole(2, renderer::max_shadow_map_size); }},
        {"--passes",
         [&] {
             return any_of({"one", "two"});
         }},
        {"--format",
         [&] {
             return any_of({"fp16", "fp16-batches", "fp32"});
         }},
        {"--ground", [] { return std::string(); }},
        {"--truth-samples", [&] { return whole(64, 65536); }},
        {"--truth-cache",
         [&] {
             return any_of({"cache", "/a folder/of mine"});
         }},
    };
    const auto found = texts.find(option);
    if (found != texts.end()) return found->second();
    ADD_FAILURE() << "add a way to make texts for " << option;
    return "";
}

/// The options that the command line reads from these words.
template <typename Options>
Options parsed(const OptionTable<Options>& table, std::vector<std::string> words) {
    CLI::App verb;
    Options options;
    app::add_table(verb, table, options);
    std::reverse(words.begin(), words.end());  // CLI11 takes them from the back
    verb.parse(words);
    return options;
}

/// The words that a POSIX shell makes of a line.
std::vector<std::string> shell_words(const std::string& line) {
    std::FILE* const shell =
        popen(("for word in " + line + "; do printf '%s\\0' \"$word\"; done").c_str(), "r");
    std::string text;
    for (int c = std::fgetc(shell); c != EOF; c = std::fgetc(shell))
        text += char(c);
    pclose(shell);
    std::vector<std::string> words;
    for (std::size_t start = 0; start < text.size();) {
        const std::size_t end = text.find('\0', start);
        words.push_back(text.substr(start, end - start));
        start = end + 1;
    }
    return words;
}

template <typename Options>
void expect_round_trips(const OptionTable<Options>& table) {
    RandomTexts random(7);
    for (const OptionRow<Options>& row : table) {
        const std::string name = row.long_name();
        for (int i = 0; i < 50; ++i) {
            const std::string text = random.of(name);
            Options options;
            row.parse(options, name.c_str(), text);
            ASSERT_EQ(row.print(options), text) << name;
        }
    }
    // Random options together, through the command line.
    for (int i = 0; i < 50; ++i) {
        std::vector<std::string> words;
        for (const OptionRow<Options>& row : table) {
            if (random.coin()) continue;
            words.push_back(row.long_name() + (row.is_flag() ? "" : "=" + random.of(row.long_name())));
        }
        const Options options = parsed(table, words);
        const std::string line = app::command_line(table, options);
        const Options again = parsed(table, shell_words(line));
        for (const OptionRow<Options>& row : table)
            ASSERT_EQ(row.print(again), row.print(options)) << row.name << " of " << line;
    }
}

TEST(OptionTable, MomentsArePrintedAsTheyAreRead) {
    expect_round_trips(app::moment_table());
    expect_round_trips(app::load_table());
}

TEST(OptionTable, GridsArePrintedAsTheyAreRead) {
    expect_round_trips(app::grid_table());
}

TEST(OptionTable, ViewsArePrintedAsTheyAreRead) {
    expect_round_trips(app::view_table());
    expect_round_trips(app::frame_table());
    expect_round_trips(app::zoom_table());
}

TEST(OptionTable, ShadowsArePrintedAsTheyAreRead) {
    expect_round_trips(app::shadow_option_table());
}

TEST(OptionTable, DefaultsAreLeftOutAndNamedInTheHelp) {
    EXPECT_EQ(app::command_line(app::view_table(), ViewOptions{}), "");
    CLI::App verb;
    ViewOptions options;
    options.view.size.width = 123;
    app::add_table(verb, app::view_table(), options);
    EXPECT_NE(verb.help().find("pixels (default: 123x512)"), std::string::npos) << verb.help();
    EXPECT_NE(verb.help().find("none|hard|soft"), std::string::npos) << verb.help();
}

TEST(OptionTable, AShellReadsAWordAsItWas) {
    for (const std::string& word :
         {std::string("plain"), std::string(), std::string("it's"), std::string("$HOME `ls` \"x\" \\ *;&|\n"),
          std::string("-5,3"), std::string("~")}) {
        EXPECT_EQ(shell_words(app::shell_word(word)), std::vector<std::string>{word});
    }
}

TEST(OptionTable, ANameThatIsNotKnownIsAnErrorThatListsTheNames) {
    ViewOptions options;
    const OptionTable<ViewOptions> table = app::view_table();
    const auto row = std::ranges::find(table, "--level-of-detail", &OptionRow<ViewOptions>::name);
    ASSERT_NE(row, table.end());
    try {
        row->parse(options, "--level-of-detail", "finest");
        FAIL() << "it was taken";
    } catch (const Error& error) {
        EXPECT_EQ(error.fault(), Fault::usage);
        EXPECT_STREQ(error.what(), "--level-of-detail: there is no \"finest\"");
        EXPECT_EQ(error.way_out(), "choose nearest or blended");
    }
}

TEST(OptionTable, TheCommandOfAPictureIsReadAsTheSameView) {
    RandomTexts random(11);
    for (int i = 0; i < 20; ++i) {
        std::vector<std::string> words;
        for (const OptionRow<ViewOptions>& row : app::view_table()) {
            if (random.coin()) continue;
            words.push_back(row.long_name() + (row.is_flag() ? "" : "=" + random.of(row.long_name())));
        }
        const ViewOptions options = parsed(app::view_table(), words);
        renderer::View view = options.view;
        view.shadow = app::shadow_of(options);
        view.camera = app::snapped(view.camera);
        SceneOptions scene;
        scene.scene = "it's a \"scene\" of $HOME.glb";
        scene.seconds = -0.25;
        const std::string line = app::render_command(scene, options, view, "a picture.png");

        ViewOptions again;
        SceneOptions scene_again;
        std::string output;
        CLI::App verb;
        app::add_table(verb, app::view_table(), again);
        app::add_table(verb, app::zoom_table(), again);
        app::add_scene_argument(verb, scene_again);
        app::add_moment_options(verb, scene_again);
        verb.add_option("-o,--output", output);
        std::vector<std::string> typed = shell_words(line);
        ASSERT_GT(typed.size(), 2U);
        EXPECT_EQ(typed[0] + " " + typed[1], "cairn render");
        typed.erase(typed.begin(), typed.begin() + 2);
        std::reverse(typed.begin(), typed.end());
        verb.parse(typed);
        again.view.shadow = app::shadow_of(again);
        EXPECT_TRUE(again.view == view) << line;
        EXPECT_EQ(again.tree_n, options.tree_n);
        EXPECT_EQ(again.brick_m, options.brick_m);
        EXPECT_EQ(again.max_resolution, options.max_resolution);
        EXPECT_TRUE(again.pools == options.pools) << line;
        EXPECT_TRUE(again.march == options.march) << line;
        EXPECT_EQ(again.steps_per_voxel, options.steps_per_voxel);
        EXPECT_EQ(again.gradient_threshold, options.gradient_threshold);
        EXPECT_EQ(again.copies, options.copies);
        EXPECT_EQ(scene_again.scene, scene.scene);
        EXPECT_EQ(scene_again.seconds, scene.seconds);
        EXPECT_EQ(output, "a picture.png");
    }
}

}  // namespace
}  // namespace cairn::test
