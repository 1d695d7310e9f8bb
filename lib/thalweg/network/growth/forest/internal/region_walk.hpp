// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/network/growth/dla/internal/walk.hpp>
#include <thalweg/network/growth/forest/internal/grow_forest.hpp>

namespace thalweg::network {

/// The simple random walk in a region among trees, without its unit steps where there is room: a walker jumps to the
/// boundary of the largest square known to be free of trees and of the region's border. A step that would leave the
/// region is not made. Law: walkers arrive beside the trees as they do by unit steps.
class RegionWalk {
public:
    explicit RegionWalk(Mask const& region);

    bool inside(Cell c) const { return room_[framed(c)] > 0; }
    bool occupied(Cell c) const { return trees_.occupied(site(c)); }
    /// Occupies a cell of the region.
    void occupy(Cell c) { trees_.occupy(site(c)); }

    /// Whether a 4-neighbour is occupied.
    bool beside_a_tree(Cell c) const;

    /// Walks until the walker stands on a free cell with an occupied 4-neighbour; there it may be already.
    /// Takes: a free cell of a part of the region in which some cell is occupied.
    /// Gives: whether it is there; not yet after some thousand jumps, so that who walks far can be stopped.
    bool approach(Cell& at, RandomStream& random) const;

    /// One step to a 4-neighbour, each as likely; none where that is occupied or outside the region.
    void step(Cell& at, RandomStream& random) const;

private:
    Site site(Cell c) const {
        return {static_cast<std::int32_t>(c.col - middle_.col), static_cast<std::int32_t>(c.row - middle_.row)};
    }
    static Cell framed(Cell c) { return {c.col + 1, c.row + 1}; }

    Raster<std::uint8_t> room_; ///< in a frame: Chebyshev distance to the nearest cell outside the region, up to 255
    Cell middle_;
    FreeSquares trees_;
    ExitLaw law_;
};

} // namespace thalweg::network
