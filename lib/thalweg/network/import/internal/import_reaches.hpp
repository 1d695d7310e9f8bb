// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/network/import/internal/import_lines.hpp>

/// Pieces as a graph of reaches, and the score of every possible root of its components:
/// docs/algorithms/river_directions.md.
namespace thalweg::network::import_steps {

/// The pieces between two nodes where not exactly two of them meet, or where water may leave. Which end is `from`
/// follows from the positions alone, so that nothing depends on the order or direction of lines.
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

/// Connected reaches.
struct ReachGroup {
    std::vector<std::size_t> nodes; ///< by position
    std::vector<std::size_t> reaches;
    double length_m = 0.0;
};

/// The graph of the reaches, without closed rings.
struct ReachGraph {
    std::vector<Reach> reaches;
    std::vector<std::vector<Way>> at; ///< by node of Pieces; empty inside reaches
    std::vector<char> is_outlet;      ///< by node: a likely outlet, by the border of file or DEM or by the file's data
    std::vector<char> is_bridge;      ///< by reach: its group is disconnected without it
    std::vector<std::size_t> block;   ///< by node: parts connected without bridges
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

/// A possible root of a group, with its scores: logarithms of odds.
struct Root {
    std::size_t node;
    double shape;   ///< angles, borders, free area ahead
    double climb;   ///< from a DEM, <= 0
    double drawn;   ///< votes of reaches drawn towards it minus those of reaches drawn away; bridges only
    double certain; ///< the same by the file's certain directions
    double geometry() const { return shape + climb; }
};

/// Scores roots, and directs groups towards them.
class RootScores {
public:
    /// dem: null without one.
    RootScores(Pieces const& p, std::vector<RiverLine> const& lines, ReachGraph const& graph, Votes const& certain,
               Raster<float> const* dem);
    /// The candidate roots: every end of a group and every likely outlet, by position; if there are none, the nodes
    /// nearest to its own border.
    std::vector<Root> of(ReachGroup const& group);
    struct Ways {
        std::vector<std::size_t> down; ///< by node: reach by which it is left; none: the root
        std::vector<double> way_m;     ///< by node: distance to the root
    };
    /// Finds the shortest paths to a root, for the nodes of its group; other nodes are unchanged.
    void shortest_paths(std::size_t root, Ways& ways) const;
    /// The gain in score of a second outlet of a tree, and its position; gain < 0: there is none.
    struct Second {
        double gain;
        std::size_t outlet;
    };
    Second second_outlet(ReachGroup const& group, std::size_t root, double drawn_weight);

    /// The same by the file's certain directions.
    std::vector<double> const& certain() const { return certain_; }
    /// By reach [-1, 1]: the share drawn from `from` to `to` minus the share drawn back.
    std::vector<double> const& drawn() const { return drawn_; }
    /// By reach: the most that its drawing may count, 1 for a line of its own.
    std::vector<double> const& voters() const { return voters_; }

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
    double lines_split(std::size_t node, std::size_t left_by) const;
    void measure_votes(Votes const& certain, std::vector<RiverLine> const& lines);
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
    std::vector<std::vector<double>> angle_; ///< by node, by branch
    std::vector<double> rise_m_;             ///< by reach: from `from` to `to` in the DEM
    std::vector<double> drawn_;              ///< by reach [-1, 1]
    std::vector<double> vote_;               ///< by reach: drawn_ by lines, of which each votes once
    std::vector<double> voters_;             ///< by reach: the most vote_ may be
    std::vector<double> certain_;            ///< by reach [-1, 1]
    std::vector<std::size_t> exits_;         ///< by block: number of bridges that touch it
    std::vector<std::size_t> block_reaches_; ///< by block
    std::vector<char> known_;                ///< by node: whether inside_ is computed
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
    std::vector<Second> above_; ///< by node: the best outlet upstream if its water were cut off downstream
};

} // namespace thalweg::network::import_steps
