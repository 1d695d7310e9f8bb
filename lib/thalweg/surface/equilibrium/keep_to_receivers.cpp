// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/equilibrium/internal/keep_to_receivers.hpp>

#include <algorithm>
#include <vector>

namespace thalweg::surface {

namespace {

constexpr int passes = 4;
constexpr float margin = 0.02F; // of a fall, above what floats may lose

class Keeper {
public:
    Keeper(LandLevel& level, float least)
        : level_(level), rivers_(level.rivers), offsets_(level.offsets()), least_(least) {
        for (std::size_t n = 0; n < rivers_.cell.size(); ++n) {
            if (rivers_.number[n] < 0) {
                beyond_.push_back(rivers_.cell[n]);
            }
        }
        std::sort(beyond_.begin(), beyond_.end());
    }

    void pass() {
        for (std::size_t n = 0; n < rivers_.cell.size(); ++n) {
            if (rivers_.number[n] < 0) {
                continue;
            }
            keep_above(n);
            bool const leaves = rivers_.receiver[n] < 0 || number(receiver(n)) < 0;
            for (std::size_t k = 0; k < offsets_.size(); ++k) {
                std::size_t const q = moved(rivers_.cell[n], offsets_[k]);
                if (level_.cover[q] != Cover::river || std::binary_search(beyond_.begin(), beyond_.end(), q)) {
                    continue;
                }
                if (leaves) {
                    level_.z[q] = std::max(level_.z[q], level_.z[rivers_.cell[n]]);
                } else if (rivers_.level[n] == 0 && static_cast<std::int8_t>(k) != rivers_.way[n]) {
                    keep_off(n, q, step_lengths[k]);
                }
            }
        }
    }

    /// Above what may have been raised below it.
    void keep_above(std::size_t n) {
        if (rivers_.receiver[n] < 0) {
            return;
        }
        float& z = level_.z[rivers_.cell[n]];
        float const below = level_.z[rivers_.cell[receiver(n)]];
        float const length = level_.side * step_lengths[static_cast<std::size_t>(rivers_.way[n])];
        z = rivers_.level[n] != 0 ? below : std::max(z, below + least_ * length);
    }

private:
    std::size_t receiver(std::size_t n) const { return static_cast<std::size_t>(rivers_.receiver[n]); }
    std::int64_t number(std::size_t n) const { return rivers_.number[n]; }

    bool lies_downstream(std::size_t n, std::size_t cell) const {
        constexpr int steps = 8;
        for (int step = 0; step < steps && rivers_.receiver[n] >= 0; ++step) {
            n = receiver(n);
            if (rivers_.cell[n] == cell) {
                return true;
            }
        }
        return false;
    }

    /// Water of cell number n shall not go to q beside it.
    void keep_off(std::size_t n, std::size_t q, float length) {
        float& z = level_.z[rivers_.cell[n]];
        float const below = level_.z[rivers_.cell[receiver(n)]];
        float const own = step_lengths[static_cast<std::size_t>(rivers_.way[n])];
        float const ratio = length / own;
        float const least = z - ratio * (z - below) * (1.0F - margin);
        if (level_.z[q] >= least || lies_downstream(n, q)) {
            return;
        }
        float const most = below + (1.0F - margin) * (level_.z[q] - below) / (1.0F - ratio);
        if (ratio < 1.0F && most >= below + least_ * level_.side * own) {
            z = most;
        } else {
            level_.z[q] = least;
        }
    }

    LandLevel& level_;
    RiverCells const& rivers_;
    std::array<std::int64_t, 8> offsets_;
    float least_;                     ///< tangent towards a receiver
    std::vector<std::size_t> beyond_; ///< river cells outside the caller's grid
};

} // namespace

void keep_to_receivers(LandLevel& level, float least) {
    Keeper keeper(level, least);
    for (int pass = 0; pass < passes; ++pass) {
        keeper.pass();
    }
    // The last word has the law: above the receiver, lakes level with it.
    for (std::size_t n = 0; n < level.rivers.cell.size(); ++n) {
        keeper.keep_above(n);
    }
}

} // namespace thalweg::surface
