#include <gtest/gtest.h>

#include "base/error.h"
#include "scenes/snapshot.h"

namespace cairn::scenes {
namespace {

using Wanted = std::vector<std::string>;

/// 0 "ground", 1 "hero" over 2 "arm" over 3 "hand", 4 "arm", 5 "2", 6 without a name. 0, 3 and 4 have a mesh
/// of a triangle at x = node.
Scene make_scene() {
    Scene scene;
    scene.name = "selection";
    Primitive triangle;
    triangle.indices = {0, 1, 2};
    triangle.positions = {{0, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    scene.meshes.emplace_back().primitives.push_back(std::move(triangle));
    for (const char* name : {"ground", "hero", "arm", "hand", "arm", "2", ""}) {
        Node node;
        node.name = name;
        node.trs.translation.x = 1.0;
        scene.nodes.push_back(std::move(node));
    }
    scene.nodes[1].children = {2};
    scene.nodes[2].children = {3};
    for (const std::size_t node : {0U, 3U, 4U})
        scene.nodes[node].mesh = 0;
    scene.scenes.push_back({"", {0, 1, 4, 5, 6}});
    return scene;
}

std::string selected(const Scene& scene, const Wanted& wanted) {
    std::string nodes;
    const NodeSelection selection = select_nodes(scene, wanted);
    for (std::size_t i = 0; i < selection.size(); ++i)
        nodes += selection[i] ? std::to_string(i) + " " : "";
    return nodes;
}

TEST(NodeSelection, TakesNamesAndIndicesWithAllUnderThem) {
    const Scene scene = make_scene();
    EXPECT_EQ(selected(scene, {}), "");
    EXPECT_EQ(selected(scene, {"ground"}), "0 ");
    EXPECT_EQ(selected(scene, {"hero"}), "1 2 3 ");
    EXPECT_EQ(selected(scene, {"1"}), "1 2 3 ");
    EXPECT_EQ(selected(scene, {"6", "0", "0"}), "0 6 ");
    EXPECT_EQ(selected(scene, {"arm"}), "2 3 4 ") << "all that have the name";
    EXPECT_EQ(selected(scene, {"2"}), "5 ") << "a name comes before an index";
}

TEST(NodeSelection, RefusesWhatIsNoNodeAndListsThem) {
    const Scene scene = make_scene();
    for (const char* wrong : {"Hero", "7", "-1", "1.5", "1 ", "", "99999999999999999999999"}) {
        try {
            (void)select_nodes(scene, Wanted{"ground", wrong});
            ADD_FAILURE() << '"' << wrong << "\" was taken";
        } catch (const Error& error) {
            EXPECT_EQ(error.fault(), Fault::usage);
            EXPECT_NE(std::string(error.what()).find('"' + std::string(wrong) + '"'), std::string::npos)
                << error.what();
            EXPECT_NE(error.way_out().find("0 \"ground\", 1 \"hero\", 2 \"arm\""), std::string::npos)
                << error.way_out();
        }
    }
}

TEST(NodeSelection, ListsNoMoreNodesThanOneReads) {
    Scene scene = make_scene();
    for (int i = 0; i < 1000; ++i)
        scene.nodes.emplace_back();
    try {
        (void)select_nodes(scene, Wanted{"nobody"});
        ADD_FAILURE() << "taken";
    } catch (const Error& error) {
        EXPECT_LT(error.way_out().size(), 1000U);
        EXPECT_NE(error.way_out().find("967 more"), std::string::npos) << error.way_out();
    }
}

TEST(NodeSelection, PartsHaveBoundsAndCountsOfTheirOwn) {
    const Scene scene = make_scene();
    const Snapshot whole = take_snapshot(scene);
    const NodeSelection hero = select_nodes(scene, Wanted{"hero"});
    const Snapshot part = part_of(whole, hero);
    const Snapshot rest = part_of(whole, other_nodes(hero));
    EXPECT_EQ(part.triangle_count, 1U);
    EXPECT_EQ(rest.triangle_count, 2U);
    EXPECT_EQ(part.bounds.low, glm::dvec3(3, 0, 0)) << "three translations of 1";
    EXPECT_EQ(part.bounds.high, glm::dvec3(3, 1, 1));
    EXPECT_EQ(rest.bounds.high, glm::dvec3(1, 1, 1));
    EXPECT_TRUE(part_of(whole, NodeSelection(scene.nodes.size(), false)).bounds.empty());
}

}  // namespace
}  // namespace cairn::scenes
