#pragma once

#include <cstdint>
#include <cstring>
#include <vector>

#include <fmt/format.h>
#include <glad/gl.h>
#include <gtest/gtest.h>

#include "renderer/pool/tree.h"
#include "shaders/interop/pool.h"

/// A Tree seen from outside: its entries, in the mirror and on the GPU.
namespace cairn::test {

inline std::size_t bytes_of_blocks(const renderer::TreeShape& shape, int blocks) {
    return std::size_t(blocks) * std::size_t(shape.child_count()) * sizeof(interop::NodeEntry);
}

/// The entries in the buffer that the marcher reads.
inline std::vector<interop::NodeEntry> nodes_on_gpu(const renderer::Tree& tree) {
    tree.bind_for_reading();
    glActiveTexture(GL_TEXTURE0 + TEXTURE_NODES);
    GLint texture = 0;
    GLint buffer = 0;
    glGetIntegerv(GL_TEXTURE_BINDING_BUFFER, &texture);
    glGetTextureLevelParameteriv(GLuint(texture), 0, GL_TEXTURE_BUFFER_DATA_STORE_BINDING, &buffer);
    std::vector<interop::NodeEntry> nodes(tree.entry_count());
    glGetNamedBufferSubData(GLuint(buffer), 0, GLsizeiptr(nodes.size() * sizeof(interop::NodeEntry)),
                            nodes.data());
    return nodes;
}

inline ::testing::AssertionResult gpu_equals_mirror(const renderer::Tree& tree) {
    const std::vector<interop::NodeEntry> gpu = nodes_on_gpu(tree);
    for (std::uint32_t entry = 0; entry < tree.entry_count(); ++entry) {
        const interop::NodeEntry& mirror = tree.node(entry);
        if (std::memcmp(&gpu[entry], &mirror, sizeof(mirror)) == 0) continue;
        return ::testing::AssertionFailure() << fmt::format(
                   "entry {}: mask {:x} {:x}, children {}, brick {} on the GPU; {:x} {:x}, {}, {} here",
                   entry, gpu[entry].child_mask.x, gpu[entry].child_mask.y, gpu[entry].children,
                   gpu[entry].brick, mirror.child_mask.x, mirror.child_mask.y, mirror.children, mirror.brick);
    }
    return ::testing::AssertionSuccess();
}

/// Result of a walk from the root.
struct Reached {
    std::vector<std::uint32_t> entries;  ///< entries that are reached, the root first
    int blocks = 1;                      ///< blocks that are reached, the root's included
    int bricks = 0;
};

/// Walks the whole tree. Fails the test if a block or a slot has two owners, or if a child is not the tile
/// that the regular subdivision has at its place.
inline Reached walk(const renderer::Tree& tree, int slot_count) {
    const auto child_count = std::uint32_t(tree.shape().child_count());
    Reached reached;
    reached.entries.push_back(0);
    std::vector<bool> block_seen(tree.entry_count() / child_count, false);
    std::vector<bool> slot_seen(std::size_t(slot_count), false);
    block_seen[0] = true;
    for (std::size_t i = 0; i < reached.entries.size(); ++i) {
        const std::uint32_t entry = reached.entries[i];
        const interop::NodeEntry& node = tree.node(entry);
        if (tree.slot(entry)) {
            const auto slot = std::size_t(*tree.slot(entry));
            if (slot >= slot_seen.size() || slot_seen[slot]) {
                ADD_FAILURE() << "slot " << slot << " of entry " << entry << " has another owner";
                return reached;
            }
            slot_seen[slot] = true;
            ++reached.bricks;
        }
        if (node.children == 0) continue;
        const std::uint32_t block = node.children / child_count;
        if (node.children % child_count != 0 || block >= block_seen.size() || block_seen[block]) {
            ADD_FAILURE() << "children " << node.children << " of entry " << entry << " have another parent";
            return reached;
        }
        block_seen[block] = true;
        ++reached.blocks;
        for (std::uint32_t child = 0; child < child_count; ++child) {
            EXPECT_EQ(tree.tile(node.children + child),
                      child_of(tree.tile(entry), tree.shape().n, int(child)))
                << "child " << child << " of entry " << entry;
            reached.entries.push_back(node.children + child);
        }
    }
    return reached;
}

}  // namespace cairn::test
