#pragma once

#include <cstddef>
#include <vector>

#include "renderer/pool/round.h"

namespace cairn::renderer {

/// Which of a fixed number of places are free, and in which round each was last used: a cache recycles the
/// place that was not used for longest (Crassin et al. 2008, section 4.3).
class Lru {
public:
    explicit Lru(int count) : stamps_(std::size_t(count)), taken_(std::size_t(count), false) {
        free_.reserve(std::size_t(count));
        for (int i = count - 1; i >= 0; --i)
            free_.push_back(i);
    }

    [[nodiscard]] int count() const { return int(stamps_.size()); }
    [[nodiscard]] int used_count() const { return count() - int(free_.size()); }

    /// Marks the place as used in this round.
    void touch(int place, Round round) { stamps_[std::size_t(place)] = round; }
    [[nodiscard]] Round stamp(int place) const { return stamps_[std::size_t(place)]; }

    /// Takes a free place; returns -1 if there is none.
    [[nodiscard]] int take_free() {
        if (free_.empty()) return -1;
        const int place = free_.back();
        free_.pop_back();
        taken_[std::size_t(place)] = true;
        return place;
    }
    void release(int place) {
        free_.push_back(place);
        taken_[std::size_t(place)] = false;
    }
    [[nodiscard]] bool is_taken(int place) const { return taken_[std::size_t(place)]; }

private:
    std::vector<Round> stamps_;
    std::vector<bool> taken_;
    std::vector<int> free_;
};

}  // namespace cairn::renderer
