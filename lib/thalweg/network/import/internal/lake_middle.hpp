// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include <thalweg/core/run/run.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/geometry/diagram.hpp>
#include <thalweg/network/import/internal/import_lines.hpp>

namespace thalweg::network::import_steps {

inline constexpr double apart_m = 0.05; ///< between places on a shore, at least

/// A place on the outer ring of a lake.
struct ShorePlace {
    std::size_t segment = 0;
    double along = 0.0;
    Vec2 at;
    double distance_m = std::numeric_limits<double>::infinity();
};

/// [0, 1] where segment ab meets segment cd, if it does; parallel ones do not.
std::optional<double> meeting_along(Vec2 a, Vec2 b, Vec2 c, Vec2 d);

/// The outline of a lake: its shore, and its islands.
class LakeOutline {
public:
    explicit LakeOutline(Polygon const& lake);

    Vec2 low() const { return low_; }
    Vec2 high() const { return high_; }
    std::vector<Vec2> const& shore() const { return rings_.front(); }
    std::vector<std::vector<Vec2>> const& rings() const { return rings_; }

    bool is_about(Vec2 p, double m) const;

    bool contains(Vec2 p) const;

    ShorePlace nearest(Vec2 p) const;

    /// The nearest point of an island's shore.
    ShorePlace nearest_on_island(Vec2 p) const;

    /// Where a segment from within the lake first meets the outer shore.
    std::optional<ShorePlace> way_out(Vec2 from, Vec2 to) const;

    /// Whether the straight way between two places is in the water; the first may lie on the shore.
    bool sees(Vec2 a, Vec2 b) const;

private:
    std::vector<std::vector<Vec2>> const& rings_;
    Vec2 low_{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    Vec2 high_{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
};

/// Where a river meets the shore of a lake.
struct Mouth {
    std::size_t line = 0;
    Vec2 tip;                 ///< end of the line
    int flow = 0;             ///< 1: water leaves the line there, -1: it begins there, 0: unknown
    bool is_said = false;     ///< that is by more than the drawing
    ShorePlace shore;         ///< where the line crosses the shore
    std::vector<Vec2> inside; ///< the line from its tip to the shore, both included; where it ends ashore the shore
    std::optional<Insertion> on = {};  ///< of a river that passes through: its own vertex at the shore
    double ashore_m = 0.0;             ///< from the tip to the shore, where it lies on land
    std::optional<double> made_z = {}; ///< [m] of a place where water leaves that is of no line

    /// Where the way through the lake begins.
    Vec2 begin() const { return inside.front(); }
};

/// The medial lines of a lake between the pieces of shore from one mouth to the next: a tree whose leaves are mouths.
class LakeMiddle {
public:
    /// \param mouths along the shore, two or more
    LakeMiddle(LakeOutline const& lake, std::vector<Mouth> const& mouths, double tolerance_m, Run const& run);

    /// Ways from every mouth to one of them.
    void root_at(std::size_t mouth);

    /// A way to the root, as far as no other has been taken.
    struct Way {
        std::vector<Vec2> line;
        std::vector<std::pair<std::size_t, std::size_t>> vertices; ///< of the tree, and their places in the line
        bool ends_at_root = false;
    };

    /// The way from a mouth's leaf.
    Way way_from(std::size_t mouth) const;

    /// Takes the first vertices of a way's line.
    void take(Way const& way, std::size_t vertices);

    bool is_whole() const;

private:
    static constexpr double gap_m = 0.02; ///< between the pieces of shore at a mouth, half of it
    static constexpr std::size_t no_edge = std::numeric_limits<std::size_t>::max();

    std::size_t other_end(std::size_t e, std::size_t v) const;

    double length_of(std::size_t e) const;

    /// One label a piece; what a river has in the lake belongs to both sides. At a mouth the pieces end a little before
    /// it, and a point behind it that belongs to both keeps the middle between them in the lake.
    static std::vector<geometry::LabelledLine> pieces_of_shore(LakeOutline const& lake,
                                                               std::vector<Mouth> const& mouths);

    /// Moves an end of a line back along it. \return where it is then
    static Vec2 moved_back(std::vector<Vec2>& line, bool is_start);

    static std::vector<Vec2> shore_between(std::vector<Vec2> const& shore, Mouth const& from, Mouth const& to);

    /// An island belongs to what is nearest to it, so that the tree stays one: the piece of shore, or an island that
    /// belongs to it. Of many the largest count.
    static void append_islands(LakeOutline const& lake, std::vector<geometry::LabelledLine>& shores);

    /// [m] Between lines that do not meet.
    static double distance_between(std::vector<Vec2> const& one, std::vector<Vec2> const& other);

    std::size_t nearest_leaf(Vec2 p) const;

    geometry::Diagram diagram_;
    std::vector<std::vector<std::size_t>> at_; ///< by vertex: edges within the lake
    std::vector<std::size_t> leaf_;            ///< by mouth
    std::vector<std::size_t> towards_;         ///< by vertex: edge towards the root
    std::vector<char> is_taken_;               ///< by vertex
};

} // namespace thalweg::network::import_steps
