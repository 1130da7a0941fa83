#include "renderer/pool/packed_bricks.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glad/gl.h>

#include "base/error.h"
#include "gl/buffer_texture.h"
#include "gl/limits.h"
#include "shaders/interop/pool.h"
#include "shaders/interop/produce.h"

namespace cairn::renderer {
namespace {

/// Bricks take whole units of this many words, so that free runs of a few words do not pile up.
constexpr std::uint32_t unit_words = 16;
constexpr std::size_t least_slots = 4;
constexpr std::size_t most_slots = std::size_t(1) << 22U;

std::uint32_t units_of(std::uint32_t words) {
    return (words + unit_words - 1) / unit_words;
}

/// Bytes of a brick of few voxels: there are slots for so many.
std::size_t small_brick_bytes(const TreeShape& shape) {
    return std::size_t(shape.head_words()) * sizeof(std::uint32_t) +
           2 * std::size_t(shape.m) * std::size_t(shape.m);
}

}  // namespace

std::size_t most_packed_words(const TreeShape& shape, bool has_color) {
    std::size_t words = std::size_t(shape.head_words());
    for (int mip = 0; mip <= shape.mips; ++mip) {
        const auto border = std::size_t(shape.border_voxels(mip));
        const auto inner =
            std::size_t(shape.m >> mip) * std::size_t(shape.m >> mip) * std::size_t(shape.m >> mip);
        const std::size_t in_table = has_color ? inner : inner + border;
        words += (has_color ? 2 : 1) * (inner + border) + 2 * in_table + 2 * ((in_table + 31) / 32);
    }
    return words;
}

std::size_t least_packed_bytes(const TreeShape& shape, bool has_color) {
    return (most_packed_words(shape, has_color) + unit_words + least_slots) * sizeof(std::uint32_t);
}

PackedBricks::PackedBricks(const TreeShape& shape, bool has_color, std::size_t bytes) {
    const gl::Limits limits = gl::query_limits();
    const std::size_t least = least_packed_bytes(shape, has_color);
    if (bytes < least) {
        throw Error(
            Fault::usage, "brick pool",
            fmt::format("{:.2f} MiB hold no full brick of {}^3 voxels", double(bytes) / 0x1p20, shape.m),
            fmt::format("give it at least {:.2f} MiB", std::ceil(double(least) / 0x1p20 * 100.0) / 100.0));
    }
    // Slots are few bytes, so the words of all bricks may be counted first.
    const std::size_t most_words = std::min(bytes / sizeof(std::uint32_t), limits.texture_buffer_texels);
    const std::size_t full_brick = most_packed_words(shape, has_color) + unit_words;
    if (most_words < full_brick + least_slots) {
        throw Error(Fault::memory, "brick pool",
                    fmt::format("shaders of this driver see {} words of a buffer, and a full brick of {}^3 "
                                "voxels has {}",
                                limits.texture_buffer_texels, shape.m, full_brick),
                    "choose smaller bricks, or another driver");
    }
    const std::size_t slots = std::min(
        std::clamp(most_words * sizeof(std::uint32_t) / small_brick_bytes(shape), least_slots, most_slots),
        most_words - full_brick);
    const std::size_t words = std::min(bytes / sizeof(std::uint32_t) - slots, most_words);
    runs_.resize(slots);
    room_ = RunAllocator(std::uint32_t(words / unit_words));
    words_ = gl::Buffer(words / unit_words * unit_words * sizeof(std::uint32_t), "packed bricks");
    starts_ = gl::Buffer(slots * sizeof(std::uint32_t), "places of packed bricks");
    starts_.fill(0);
    word_texture_ = gl::buffer_texture(GL_R32UI, words_);
    start_texture_ = gl::buffer_texture(GL_R32UI, starts_);
}

bool PackedBricks::reserve(int slot, std::uint32_t words) {
    release(slot);
    const std::optional<std::uint32_t> unit = room_.take(units_of(words));
    if (!unit) return false;
    runs_[std::size_t(slot)] = {{*unit * unit_words, words}, true};
    moved_.push_back(slot);
    ++taken_;
    return true;
}

void PackedBricks::release(int slot) {
    SlotRun& held = runs_[std::size_t(slot)];
    if (!held.is_taken) return;
    held.is_taken = false;
    --taken_;
    room_.release(held.run.first / unit_words, units_of(held.run.words));
}

std::size_t PackedBricks::free_words() const {
    return std::size_t(room_.free_units()) * unit_words;
}

std::size_t PackedBricks::mean_words() const {
    return taken_ == 0 ? 0 : (words_.size_bytes() / sizeof(std::uint32_t) - free_words()) / taken_;
}

void PackedBricks::upload() {
    std::sort(moved_.begin(), moved_.end());
    moved_.erase(std::unique(moved_.begin(), moved_.end()), moved_.end());
    std::vector<std::uint32_t> firsts;
    for (std::size_t i = 0; i < moved_.size();) {
        std::size_t end = i;
        firsts.clear();
        do {
            firsts.push_back(run(moved_[end]).first);
            ++end;
        } while (end < moved_.size() && moved_[end] == moved_[end - 1] + 1);
        starts_.write(std::size_t(moved_[i]) * sizeof(std::uint32_t), firsts.data(),
                      firsts.size() * sizeof(std::uint32_t));
        i = end;
    }
    moved_.clear();
}

void PackedBricks::bind_for_reading() const {
    glBindTextureUnit(TEXTURE_BRICK_WORDS, word_texture_.id());
    glBindTextureUnit(TEXTURE_BRICK_STARTS, start_texture_.id());
}

void PackedBricks::bind_for_writing() const {
    glBindImageTexture(IMAGE_BRICK_WORDS, word_texture_.id(), 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_R32UI);
}

}  // namespace cairn::renderer
