// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <thalweg/core/run/memory.hpp>

// A queue of cells by height. See docs/algorithms/equilibrium_levels.md.

namespace thalweg::surface {

/// Cells in buckets of equal heights, of which the lowest bucket gives its last cell first. Each bucket is a stack of
/// pieces that fill a line of the processor's cache, so that what comes next is known before it is taken.
class HeightBuckets {
public:
    /// \param low, high heights of cells; others go to the outermost buckets
    /// \param cells that may be in it at a time
    HeightBuckets(float low, float high, std::size_t cells) : top_(count, bottom), low_(low) {
        if (high > low) {
            per_height_ = static_cast<float>(count - 1) / (high - low);
            height_ = (high - low) / static_cast<float>(count - 1);
        }
        constexpr std::size_t many = 1 << 20;
        if (cells >= many) { // large pages; fewer cells would cost less than clearing them
            slots_.reserve(cells / (piece - 1) * piece + (count + 2) * piece); // what is never written takes no memory
        }
        slots_.resize(piece);
    }

    /// A cell below the lowest bucket goes there.
    /// \return whether it goes to the bucket of the last take()
    bool push(std::uint32_t cell, float z) {
        float const place = std::min((z - low_) * per_height_, static_cast<float>(count - 1));
        std::size_t const bucket = std::max(at_, static_cast<std::size_t>(std::max(place, 0.0F)));
        put(cell, bucket);
        return bucket == at_;
    }

    using Taken = std::array<std::uint32_t, 15>;

    /// Takes some cells of the lowest bucket, the last first.
    /// \return their number; 0: there are none
    std::uint32_t take(Taken& cells) {
        while (at_ < count && top_[at_] == bottom) {
            ++at_;
        }
        if (at_ == count) {
            return 0;
        }
        std::uint32_t const top = top_[at_];
        std::uint32_t const taken = top % piece;
        for (std::uint32_t n = 0; n < taken; ++n) {
            cells[n] = slots_[top - n];
        }
        std::uint32_t const begin = top - taken;
        rest_ = slots_[begin];
        top_[at_] = rest_;
        slots_[begin] = free_;
        free_ = begin;
        return taken;
    }

    /// Puts the last cells that take() has returned below those that have come to their bucket since.
    void put_back(std::span<std::uint32_t const> cells) {
        std::vector<std::uint32_t> came;
        while (top_[at_] != rest_) {
            std::uint32_t& top = top_[at_];
            came.push_back(slots_[top]);
            if (top % piece == 1) { // the last of its piece
                std::uint32_t const begin = top - 1;
                top = slots_[begin];
                slots_[begin] = free_;
                free_ = begin;
            } else {
                --top;
            }
        }
        std::for_each(cells.rbegin(), cells.rend(), [&](std::uint32_t cell) { put(cell, at_); });
        std::for_each(came.rbegin(), came.rend(), [&](std::uint32_t cell) { put(cell, at_); });
    }

    /// \return what take() returns next if nothing is pushed, in another order; empty where that is not known
    std::span<std::uint32_t const> later() const {
        std::uint32_t top = top_[at_];
        if (top == bottom && at_ + 1 < count) {
            top = top_[at_ + 1];
        }
        std::size_t const listed = top == bottom ? 0 : top % piece;
        return {slots_.data() + (top - listed) + 1, listed};
    }

    /// Whether a height lies above those of cells that take() has returned, plus a rise; false may be wrong.
    bool is_above(float z, float rise) const {
        return at_ + 1 < count && z - low_ > static_cast<float>(at_ + 2) * height_ + rise; // a bucket for rounding
    }

private:
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
    static constexpr std::size_t count = 1 << 16;
    static constexpr std::uint32_t piece = 16;         ///< slots; the first holds the top below the piece
    static constexpr std::uint32_t bottom = piece - 1; ///< top of an empty bucket

    void put(std::uint32_t cell, std::size_t bucket) {
        std::uint32_t& top = top_[bucket];
        top = top % piece == piece - 1 ? new_piece(top) : top + 1;
        slots_[top] = cell;
    }

    /// \return its first slot for a cell
    std::uint32_t new_piece(std::uint32_t below) {
        std::uint32_t begin = free_;
        if (begin == none) {
            begin = static_cast<std::uint32_t>(slots_.size());
            slots_.resize(slots_.size() + piece);
        } else {
            free_ = slots_[begin];
        }
        slots_[begin] = below;
        return begin + 1;
    }

    std::vector<std::uint32_t, LargePages<std::uint32_t>> slots_;
    std::vector<std::uint32_t> top_; ///< by bucket: slot of its last cell
    std::size_t at_ = 0;
    std::uint32_t rest_ = bottom; ///< top of the lowest bucket after take()
    std::uint32_t free_ = none;   ///< first piece without cells, which holds the next one
    float low_ = 0.0F;
    float per_height_ = 0.0F;                               ///< buckets
    float height_ = std::numeric_limits<float>::infinity(); ///< of a bucket
};

} // namespace thalweg::surface
