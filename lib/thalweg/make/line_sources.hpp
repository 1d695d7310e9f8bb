// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include <thalweg/core/river_files.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/network/order/main_stems.hpp>

/// Tracks the features of which a network's arcs consist, through changes of the arcs.
namespace thalweg::make {

/// By feature of a river file, as far as any tells something: what tells the main ones of rivers that meet.
using RiverClues = std::vector<network::StemClues::OfArc>;

/// Records by the vertices of a network which feature drew them: stages join, cut and shorten arcs, but keep vertices
/// bit for bit.
class LineSources {
public:
    LineSources() = default;
    /// Records a network.
    /// \param network the imported network
    /// \param stretches by arc: the stretches of features it consists of
    LineSources(StreamNetwork const& network, std::vector<std::vector<Stretch>> const& stretches);

    bool knows_any() const { return knows_any_; }
    /// Finds the stretches of a network whose vertices are among those recorded. Additions (an outlet extended to the
    /// border) come from no feature.
    /// \param network a later state
    /// \return by arc
    std::vector<std::vector<Stretch>> of(StreamNetwork const& network) const;
    /// \return [m] total length of the stretches
    double length_m(StreamNetwork const& network) const;
    /// Finds the stretches of a network after split_confluences, which cuts and redraws arcs: a redrawn part belongs to
    /// the feature of the part it replaced.
    /// \param network the later state
    /// \return by arc; arcs completely from features remain so
    std::vector<std::vector<Stretch>> redrawn(StreamNetwork const& network) const;
    /// Transfers the record to a network with the same arcs, by number, in another shape: each stretch keeps its share
    /// of the arc.
    /// \param before the recorded network
    /// \param after the changed network
    /// \return the record of `after`
    LineSources bent(StreamNetwork const& before, StreamNetwork const& after) const;
    /// Finds the stretches of features that a later network lacks.
    /// \param before the recorded network
    /// \param after the later network; vertices may have been inserted, and arcs may begin within a segment
    /// \param cause,reason of the result
    /// \return in plan: heights are NaN
    std::vector<SecondaryLine> missing(StreamNetwork const& before, StreamNetwork const& after, LeftOut cause,
                                       std::string const& reason) const;

private:
    /// Hashes positions by their bits.
    struct Hash {
        std::size_t operator()(Vec2 p) const;
        std::size_t operator()(std::pair<Vec2, Vec2> const& segment) const;
    };
    using ByPlace = std::unordered_map<Vec2, std::int64_t, Hash>; ///< only looked up, never iterated

    std::int64_t replaced(Arc const& arc, std::size_t segment) const;

    bool knows_any_ = false;
    /// only looked up, never iterated; 0: no feature
    std::unordered_map<std::pair<Vec2, Vec2>, std::int64_t, Hash> segments_;
    ByPlace arriving_; ///< by a segment's end; -1: several
    ByPlace leaving_;  ///< by a segment's beginning
};

} // namespace thalweg::make
