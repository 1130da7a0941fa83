#include "renderer/pool/brick_cache.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "gl/buffer_offset.h"

namespace cairn::renderer {
namespace {

/// While it lives, rows of texels are not padded; its end restores OpenGL's default.
class TightRows {
public:
    TightRows() { set(1); }
    ~TightRows() { set(4); }
    TightRows(const TightRows&) = delete;
    TightRows& operator=(const TightRows&) = delete;
    TightRows(TightRows&&) = delete;
    TightRows& operator=(TightRows&&) = delete;

private:
    static void set(int bytes) {
        glPixelStorei(GL_PACK_ALIGNMENT, bytes);
        glPixelStorei(GL_UNPACK_ALIGNMENT, bytes);
    }
};

std::size_t layer_bytes(const BrickPool::Layer& layer) {
    const auto side = std::size_t(layer.side);
    return side * side * side * std::size_t(layer.texel_bytes);
}

/// The next offset at which a layer, or the masks, may start.
std::size_t aligned(std::size_t offset) {
    return (offset + 7) / 8 * 8;
}

/// Producers write the pool as images and storage, and rays read it; transfers come after both.
void wait_for_shaders() {
    glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT | GL_PIXEL_BUFFER_BARRIER_BIT |
                    GL_BUFFER_UPDATE_BARRIER_BIT);
}

}  // namespace

BrickCache::BrickCache(const TreeShape& shape, BrickPool& pool, std::size_t limit_bytes)
    : pool_(pool), limit_bytes_(limit_bytes) {
    std::size_t most_bytes = 0;
    if (pool.packed() != nullptr) {
        most_bytes = most_packed_words(shape, pool.has_color()) * sizeof(std::uint32_t);
    } else {
        layers_ = pool.layers();
        for (const BrickPool::Layer& layer : layers_)
            masks_offset_ = aligned(masks_offset_ + layer_bytes(layer));
        most_bytes = dense_bytes_ = masks_offset_ + pool.mask_bytes_per_slot();
    }
    if (limit_bytes < most_bytes + record_bytes) {
        throw Error(Fault::usage, "brick cache", fmt::format("{} bytes hold no brick", limit_bytes),
                    fmt::format("give it at least {} bytes, or none", most_bytes + record_bytes));
    }
}

std::size_t BrickCache::brick_bytes(int slot) const {
    const PackedBricks* const packed = pool_.packed();
    return packed != nullptr ? packed->run(slot).words * sizeof(std::uint32_t) : dense_bytes_;
}

bool BrickCache::holds(const Tile& tile) const {
    return bricks_.contains(tile) || std::any_of(ring_.begin(), ring_.end(), [&](const Readback& readback) {
               return readback.fence && readback.tile == tile;
           });
}

void BrickCache::store(std::span<const Tree::EvictedBrick> evicted) {
    if (evicted.empty()) return;
    wait_for_shaders();
    const TightRows tight_rows;
    for (const Tree::EvictedBrick& brick : evicted) {
        if (holds(brick.tile)) continue;
        Readback& readback = ring_[next_readback_];
        next_readback_ = (next_readback_ + 1) % ring_.size();
        finish(readback);
        start_readback(readback, brick);
        ++counters_.stored;
    }
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
}

void BrickCache::read_dense(const gl::Buffer& to, int slot) const {
    glBindBuffer(GL_PIXEL_PACK_BUFFER, to.id());
    std::size_t offset = 0;
    for (const BrickPool::Layer& layer : layers_) {
        const glm::ivec3 low = pool_.first_texel(slot, layer.mip);
        glGetTextureSubImage(layer.texture, 0, low.x, low.y, low.z, layer.side, layer.side, layer.side,
                             layer.format, layer.type, GLsizei(layer_bytes(layer)),
                             gl::buffer_offset(offset));
        offset = aligned(offset + layer_bytes(layer));
    }
    const std::size_t mask_bytes = pool_.mask_bytes_per_slot();
    glCopyNamedBufferSubData(pool_.masks().id(), to.id(), GLintptr(std::size_t(slot) * mask_bytes),
                             GLintptr(masks_offset_), GLsizeiptr(mask_bytes));
}

void BrickCache::start_readback(Readback& readback, const Tree::EvictedBrick& evicted) const {
    readback.bytes = brick_bytes(evicted.slot);
    if (readback.buffer.size_bytes() < readback.bytes)
        readback.buffer = gl::Buffer(readback.bytes, "bricks read back");
    if (const PackedBricks* const packed = pool_.packed()) {
        glCopyNamedBufferSubData(packed->words().id(), readback.buffer.id(),
                                 GLintptr(packed->run(evicted.slot).first * sizeof(std::uint32_t)), 0,
                                 GLsizeiptr(readback.bytes));
    } else {
        read_dense(readback.buffer, evicted.slot);
    }
    readback.tile = evicted.tile;
    readback.fence = Fence(glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0));
}

void BrickCache::finish(Readback& readback) {
    if (!readback.fence) return;
    constexpr GLuint64 a_second = 1000000000;
    GLenum state = GL_TIMEOUT_EXPIRED;
    while (state == GL_TIMEOUT_EXPIRED)
        state = glClientWaitSync(readback.fence.get(), GL_SYNC_FLUSH_COMMANDS_BIT, a_second);
    readback.fence.reset();
    if (state == GL_WAIT_FAILED) {
        throw Error(Fault::internal, "brick cache", "the driver does not say when a brick was read back",
                    "render without a brick cache");
    }
    keep(readback.tile, readback.buffer.read_all<std::uint8_t>(readback.bytes));
}

void BrickCache::keep(const Tile& tile, std::vector<std::uint8_t> bytes) {
    kept_bytes_ += bytes.size() + record_bytes;
    order_.push_front({tile, std::move(bytes)});
    bricks_.emplace(tile, order_.begin());
    while (kept_bytes_ > limit_bytes_) {
        kept_bytes_ -= order_.back().bytes.size() + record_bytes;
        bricks_.erase(order_.back().tile);
        order_.pop_back();
    }
}

BrickCache::Restored BrickCache::restore(const Tile& tile, int slot) {
    for (Readback& readback : ring_) {
        if (readback.fence && readback.tile == tile) finish(readback);
    }
    const auto found = bricks_.find(tile);
    if (found == bricks_.end()) return Restored::not_cached;
    order_.splice(order_.begin(), order_, found->second);

    const std::size_t bytes = order_.front().bytes.size();
    if (upload_buffer_.size_bytes() < bytes) upload_buffer_ = gl::Buffer(bytes, "bricks written again");
    upload_buffer_.write(0, order_.front().bytes.data(), bytes);
    if (pool_.packed() != nullptr) {
        if (!write_packed(slot, bytes)) return Restored::no_room;
    } else {
        write_dense(slot);
    }
    ++counters_.restored;
    return Restored::yes;
}

/// Writes the brick in the upload buffer to a slot. The brick may have left this cache when it gets its room,
/// because others come in their stead.
bool BrickCache::write_packed(int slot, std::size_t bytes) {
    if (!pool_.reserve(slot, std::uint32_t(bytes / sizeof(std::uint32_t)))) return false;
    wait_for_shaders();
    const PackedBricks& packed = *pool_.packed();
    glCopyNamedBufferSubData(upload_buffer_.id(), packed.words().id(), 0,
                             GLintptr(packed.run(slot).first * sizeof(std::uint32_t)), GLsizeiptr(bytes));
    return true;
}

void BrickCache::write_dense(int slot) const {
    const TightRows tight_rows;
    wait_for_shaders();
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, upload_buffer_.id());
    std::size_t offset = 0;
    for (const BrickPool::Layer& layer : layers_) {
        const glm::ivec3 low = pool_.first_texel(slot, layer.mip);
        glTextureSubImage3D(layer.texture, 0, low.x, low.y, low.z, layer.side, layer.side, layer.side,
                            layer.format, layer.type, gl::buffer_offset(offset));
        offset = aligned(offset + layer_bytes(layer));
    }
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    const std::size_t mask_bytes = pool_.mask_bytes_per_slot();
    glCopyNamedBufferSubData(upload_buffer_.id(), pool_.masks().id(), GLintptr(masks_offset_),
                             GLintptr(std::size_t(slot) * mask_bytes), GLsizeiptr(mask_bytes));
}

}  // namespace cairn::renderer
