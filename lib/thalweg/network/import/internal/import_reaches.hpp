// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/network/import/internal/import_lines.hpp>

/// Pieces as a graph of reaches, and the score of every root that its components could have:
/// docs/algorithms/river_directions.md.
namespace thalweg::network::import_steps {

/// The pieces between two places where not just two of them meet, or where water may leave. Which end is `from` follows
/// from the positions alone, so that nothing here depends on how lines are drawn or in which order.
struct Reach {
    struct Step {
        PieceId piece;
        int runs; ///< 1: drawn from `from` to `to`
    };
    std::size_t from = 0; ///< node of Pieces
    std::size_t to = 0;
    std::vector<Step> steps;
    std::vector<Vec2> line;
    double length_m = 0.0;
};

/// A reach as it leaves a node.
struct Way {
    std::size_t reach;
    std::size_t to;
    int sign; ///< 1 at its `from`
};

/// Reaches that hang together.
struct ReachGroup {
    std::vector<std::size_t> nodes; ///< by position
    std::vector<std::size_t> reaches;
    double length_m = 0.0;
};

/// The graph of the reaches; closed rings are left aside.
struct ReachGraph {
    std::vector<Reach> reaches;
    std::vector<std::vector<Way>> at; ///< by node of Pieces; empty inside reaches
    std::vector<char> is_outlet;      ///< by node: likely one, by the border of file or DEM or by what the file says
    std::vector<char> is_bridge;      ///< by reach: without it its group falls apart
    std::vector<std::size_t> block;   ///< by node: parts that hang together without bridges
    std::vector<std::vector<std::size_t>> block_nodes;
    std::vector<ReachGroup> groups;
    double median_m = 0.0;  ///< length of a reach
    double segment_m = 0.0; ///< median length of a segment
};

/// dem: null without one.
ReachGraph reaches_of(Pieces const& p, std::vector<RiverLine> const& lines, Votes const& certain,
                      Raster<float> const* dem);

/// The point at a distance [m] along a line, its end beyond.
Vec2 point_along(std::vector<Vec2> const& line, double along_m);

/// A node that a group could drain to, and what speaks for it. Scores are logarithms of odds.
struct Root {
    std::size_t node;
    double shape;   ///< angles, borders, free land ahead
    double climb;   ///< of a DEM, <= 0
    double drawn;   ///< reaches drawn towards it, less those drawn away; of bridges
    double certain; ///< likewise, of what the file says
    double geometry() const { return shape + climb; }
};

/// Scores roots, and turns groups towards them.
class RootScores {
public:
    /// dem: null without one.
    RootScores(Pieces const& p, std::vector<RiverLine> const& lines, ReachGraph const& graph, Votes const& certain,
               Raster<float> const* dem);
    /// Every end of a group and every likely outlet, by position; where it has none, the nodes
    /// nearest to its own border.
    std::vector<Root> of(ReachGroup const& group);
    struct Ways {
        std::vector<std::size_t> down; ///< by node: reach that it leaves by; none at the root
        std::vector<double> way_m;     ///< by node: to the root
    };
    /// The shortest ways to a root, for the nodes of its group; others are left as they are.
    void ways_to(std::size_t root, Ways& ways) const;
    /// How far a second outlet of a tree would raise the score, and where it would be; gain < 0 where there is none.
    struct Second {
        double gain;
        std::size_t outlet;
    };
    Second second_outlet(ReachGroup const& group, std::size_t root, double drawn_weight);

    /// Likewise of what the file says.
    std::vector<double> const& certain() const { return certain_; }
    /// By reach [-1, 1]: the share drawn from `from` to `to`, less that drawn back.
    std::vector<double> const& drawn() const { return drawn_; }

    static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

private:
    struct Sums { // whole numbers: exact in any order
        std::int64_t shape = 0;
        std::int64_t climb = 0;
        std::int64_t drawn = 0;
        std::int64_t certain = 0;
        Sums& operator+=(Sums const& o);
        Sums& operator-=(Sums const& o);
    };
    void measure_angles();
    void measure_heights(Raster<float> const& dem);
    void measure_votes(Votes const& certain);
    void sample();
    double leaf_terms(std::size_t node, Vec2 low, Vec2 high) const;
    bool is_free_ahead(std::size_t node) const;
    Sums along(std::size_t reach, int sign) const;
    Sums const& inside(std::size_t exit);
    void search(std::size_t from, bool in_block, Ways& ways, std::vector<std::size_t>& reached) const;
    Sums leaving(std::size_t node, std::size_t reach, int sign);
    double angle(std::size_t node, std::size_t reach) const;

    Pieces const& p_;
    ReachGraph const& graph_;
    std::vector<double> border_m_;
    std::vector<std::vector<double>> angle_; ///< by node, by way
    std::vector<double> rise_m_;             ///< by reach: from `from` to `to` by the DEM
    std::vector<double> drawn_;              ///< by reach [-1, 1]
    std::vector<double> certain_;            ///< likewise
    std::vector<std::size_t> exits_;         ///< by block: bridges that touch it
    std::vector<std::size_t> block_reaches_; ///< by block
    std::vector<char> known_;                ///< by node: inside_ is
    std::vector<Sums> inside_;
    struct Sample {
        std::int64_t col;
        std::int64_t row;
        std::size_t reach;
        Vec2 at;
    };
    std::vector<Sample> samples_; ///< along reaches, by col, then row
    Ways scratch_;
    std::vector<std::size_t> reached_;
    std::vector<Second> above_; ///< by node: the best end above it, were its water cut off below
};

} // namespace thalweg::network::import_steps
