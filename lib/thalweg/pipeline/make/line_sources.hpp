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

/// Which features a network's arcs are made of, whatever became of the arcs.
namespace thalweg::pipeline {

/// Remembers by the vertices of a network which feature drew them: stages join, cut and shorten arcs, but keep vertices
/// bit for bit.
class LineSources {
public:
    LineSources() = default;
    /// \pre by arc its stretches.
    /// \param stretches by arc, the stretches of features it is made of
    LineSources(StreamNetwork const& network, std::vector<std::vector<Stretch>> const& stretches);

    bool knows_any() const { return knows_any_; }
    /// What is drawn beyond them (an outlet carried to the border) came from no feature.
    /// \return the stretches of arcs that are made of the network's vertices.
    std::vector<std::vector<Stretch>> of(StreamNetwork const& network) const;
    /// \return [m] of these stretches.
    double length_m(StreamNetwork const& network) const;
    /// The stretches of arcs of which some are cut and some were redrawn, as split_confluences leaves them: what is
    /// redrawn came from the feature of what it replaced.
    /// \return arcs made of features wholly still are so.
    std::vector<std::vector<Stretch>> redrawn(StreamNetwork const& network) const;
    /// \pre the network as it was.
    /// \param before the state before
    /// \param after the state after
    /// \return the same for a network whose arcs are those of this one by number, of other shape: each stretch takes
    /// its share of the arc.
    LineSources bent(StreamNetwork const& before, StreamNetwork const& after) const;
    /// \pre before is the network as it was remembered
    /// \param before the state before
    /// \param after the state after; vertices may have been added within segments, and arcs may begin within one
    /// \param cause,reason of what is found
    /// \return the stretches of features that are gone, in plan: heights are NaN
    std::vector<SecondaryLine> missing(StreamNetwork const& before, StreamNetwork const& after, LeftOut cause,
                                       std::string const& reason) const;

private:
    /// A hash.
    struct Hash {
        std::size_t operator()(Vec2 p) const;
        std::size_t operator()(std::pair<Vec2, Vec2> const& segment) const;
    };
    using ByPlace = std::unordered_map<Vec2, std::int64_t, Hash>; ///< looked up only, never walked

    std::int64_t replaced(Arc const& arc, std::size_t segment) const;

    bool knows_any_ = false;
    std::unordered_map<std::pair<Vec2, Vec2>, std::int64_t, Hash> segments_; ///< likewise; 0 for no feature
    ByPlace arriving_;                                                       ///< by a segment's end; -1 for several
    ByPlace leaving_;                                                        ///< by its beginning
};

} // namespace thalweg::pipeline
