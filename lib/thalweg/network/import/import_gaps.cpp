// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <optional>
#include <tuple>
#include <unordered_map>
#include <utility>

#include <thalweg/geometry/nearby.hpp>
#include <thalweg/network/import/internal/import_lines.hpp>

namespace thalweg::network::import_steps {
namespace {

constexpr double near_cells = 0.5;      // an end joins what lies within
constexpr double far_cells = 2.0;       // or within this, where it is clear what
constexpr double times_as_far = 5.0;    // lies the next candidate then
constexpr double share_of_named = 0.1;  // of the shorter line: gap to the line that a link names
constexpr double much_as_drawn = 0.4;   // share above a half by which a drawing is sure
constexpr double vertex_farther = 1.25; // times as far as a point between vertices, and still preferred

/// Whether a line was cut at this end.
bool is_at_edge(std::vector<RiverLine> const& lines, std::size_t e) {
    return e % 2 == 0 ? lines[e / 2].begins_at_edge : lines[e / 2].ends_at_edge;
}

/// By end, as far as it is sure.
std::vector<int> sure_flows(Pieces const& pieces, std::vector<RiverLine>& lines, RiverLines const& file,
                            ImportParams const& params, Left& left, Run const& run) {
    std::vector<Evidence> evidence = evidence_of(pieces, lines, file, params.orientation, left.repairs);
    FoundDirections const found = find_directions(pieces, lines, params, evidence, run);
    std::vector<int> runs = found.said;
    if (is_drawing_sure(found)) {
        for (PieceId k = 0; k < runs.size(); ++k) {
            runs[k] = runs[k] != 0 ? runs[k] : found.runs[k];
        }
    }
    return flows_at_ends(pieces, lines, runs);
}

/// A place to which an end may be joined.
struct Joint {
    std::size_t line = 0;
    std::size_t segment = 0;
    std::optional<std::size_t> vertex = {}; ///< none: within the segment
    double along = 0.0;
    Vec2 at;
    double gap_m = 0.0;
};

/// The place of a segment nearest to a point, a vertex rather than what lies little nearer.
Joint nearest_on(RiverLine const& line, geometry::NearSegment const& s, Vec2 p) {
    Vec2 const a = in_plan(line.vertices[s.segment]);
    Vec2 const b = in_plan(line.vertices[s.segment + 1]);
    geometry::Foot const foot = geometry::foot_on(a, b, p);
    double const gap_m = distance(p, foot.at);
    bool const to_a = distance(p, a) <= distance(p, b);
    Vec2 const end = to_a ? a : b;
    if (foot.along <= 0.0 || foot.along >= 1.0 || distance(p, end) <= vertex_farther * gap_m) {
        return {s.line, s.segment, to_a ? s.segment : s.segment + 1, 0.0, end, distance(p, end)};
    }
    Vec2 const at = rounded(foot.at);
    return {s.line, s.segment, std::nullopt, foot.along, at, distance(p, at)};
}

/// An end and where it may be joined.
struct Proposal {
    std::size_t end = 0;
    Joint joint;
    bool is_named = false; ///< by a link
};

class Gaps {
public:
    Gaps(std::vector<RiverLine>& lines, Parts parts, double cell_m, Left& left)
        : lines_(lines), parts_(std::move(parts)), cell_m_(cell_m), left_(left), joined_(parts_.most) {}

    /// Those that may be closed, in the order in which they are.
    std::vector<Proposal> find(Run const& run) {
        std::vector<Proposal> proposals = named();
        append_nearest(proposals, run);
        std::ranges::stable_sort(
            proposals, {}, [](Proposal const& p) { return std::tuple(p.is_named ? 0 : 1, p.joint.gap_m, p.end); });
        return proposals;
    }

    void close(std::vector<Proposal> const& proposals, std::vector<int> const& flows) {
        for (Proposal const& p : proposals) {
            if (is_allowed(p, flows)) {
                join(p);
            }
        }
        insert(lines_, std::move(additions_));
        drop_repeats(lines_);
    }

private:
    std::size_t part(std::size_t line) { return joined_.of(parts_.of_line[line]); }

    /// The gaps to the lines that links name.
    std::vector<Proposal> named() {
        std::unordered_map<std::int64_t, std::size_t> of_feature; // only looked up, never iterated
        for (std::size_t l = 0; l < lines_.size(); ++l) {
            of_feature.emplace(lines_[l].feature, l);
        }
        std::vector<Proposal> proposals;
        for (std::size_t l = 0; l < lines_.size(); ++l) {
            auto const below = of_feature.find(lines_[l].down);
            if (lines_[l].down == 0 || below == of_feature.end() || part(below->second) == part(l)) {
                continue;
            }
            std::size_t const to = below->second;
            double const most_m =
                share_of_named * std::min(length_in_plan(lines_[l].vertices), length_in_plan(lines_[to].vertices));
            std::optional<Proposal> best;
            for (std::size_t const e : {2 * l, 2 * l + 1}) {
                Vec2 const p = end_of(lines_[l], e);
                if (is_at_edge(lines_, e)) {
                    continue;
                }
                for (std::size_t s = 0; s + 1 < lines_[to].vertices.size(); ++s) {
                    Joint const goal = nearest_on(lines_[to], {to, s}, p);
                    if (goal.gap_m <= most_m && (!best || goal.gap_m < best->joint.gap_m)) {
                        best = Proposal{e, goal, true};
                    }
                }
            }
            if (best) {
                proposals.push_back(*best);
            }
        }
        return proposals;
    }

    /// The gaps between open ends and what lies nearest to them.
    void append_nearest(std::vector<Proposal>& proposals, Run const& run) {
        std::vector<std::size_t> open;
        std::vector<Vec2> at;
        for (std::size_t e = 0; e < parts_.is_open.size(); ++e) {
            if (parts_.is_open[e] != 0) {
                open.push_back(e);
                at.push_back(end_of(lines_[e / 2], e));
            }
        }
        auto const near = geometry::segments_near(at, plan_of(lines_), times_as_far * far_cells * cell_m_, run);
        for (std::size_t k = 0; k < open.size(); ++k) {
            if (auto const goal = clear_goal(open[k], near[k])) {
                proposals.push_back({open[k], *goal});
            }
        }
    }

    /// The nearest place of other parts, where it is near, or clearly nearer than the next.
    std::optional<Joint> clear_goal(std::size_t e, std::vector<geometry::NearSegment> const& near) {
        Vec2 const p = end_of(lines_[e / 2], e);
        std::vector<Joint> goals;
        for (geometry::NearSegment const& s : near) {
            if (parts_.of_line[s.line] != parts_.of_line[e / 2]) {
                goals.push_back(nearest_on(lines_[s.line], s, p));
            }
        }
        auto const best = std::ranges::min_element(goals, {}, &Joint::gap_m);
        if (best == goals.end() || best->gap_m > far_cells * cell_m_) {
            return std::nullopt;
        }
        bool const is_clear = best->gap_m <= near_cells * cell_m_ || std::ranges::all_of(goals, [&](Joint const& g) {
                                  return g.gap_m >= times_as_far * best->gap_m || meet(g.line, best->line, best->at);
                              });
        return is_clear ? std::optional(*best) : std::nullopt;
    }

    /// Whether lines are one, or meet at an end of either or at a place.
    bool meet(std::size_t one, std::size_t other, Vec2 at) const {
        auto const is_on = [&](std::size_t line, Vec2 p) {
            auto const& v = lines_[line].vertices;
            return std::ranges::any_of(v, [&](Vec3 const& q) { return distance(in_plan(q), p) <= same_point_m; });
        };
        return one == other || is_on(one, at) || is_on(one, end_of(lines_[other], 0)) ||
               is_on(one, end_of(lines_[other], 1)) || is_on(other, end_of(lines_[one], 0)) ||
               is_on(other, end_of(lines_[one], 1));
    }

    /// Whether parts are still apart there, and water may run from one to the other: a spring joins nothing but an
    /// end from which water comes.
    bool is_allowed(Proposal const& p, std::vector<int> const& flows) {
        RiverLine const& own = lines_[p.end / 2];
        if (part(p.end / 2) == part(p.joint.line)) {
            return false;
        }
        if (p.is_named || parts_.is_open[p.end] == 0) { // else it has been joined
            return p.is_named;
        }
        if (flows[p.end] < 0) {
            std::optional<std::size_t> const other = end_at(p.joint);
            return other && parts_.is_open[*other] != 0 && flows[*other] >= 0;
        }
        return own.down == 0 || flows[p.end] == 0 || own.down == lines_[p.joint.line].feature;
    }

    /// The end of a line that a place is.
    std::optional<std::size_t> end_at(Joint const& goal) const {
        if (!goal.vertex || (*goal.vertex != 0 && *goal.vertex + 1 != lines_[goal.line].vertices.size())) {
            return std::nullopt;
        }
        return 2 * goal.line + (*goal.vertex == 0 ? 0 : 1);
    }

    void join(Proposal const& p) {
        RiverLine& own = lines_[p.end / 2];
        Vec2 const at = p.joint.vertex ? in_plan(lines_[p.joint.line].vertices[*p.joint.vertex]) : p.joint.at;
        if (!p.joint.vertex) {
            additions_.push_back({p.joint.line, p.joint.segment, p.joint.along, at});
        }
        Vec3& end = p.end % 2 == 0 ? own.vertices.front() : own.vertices.back();
        double const gap_m = distance(in_plan(end), at);
        end.x = at.x;
        end.y = at.y;
        parts_.is_open[p.end] = 0;
        if (auto const other = end_at(p.joint)) {
            parts_.is_open[*other] = 0;
        }
        joined_.join(part(p.end / 2), part(p.joint.line));
        left_.repairs.push_back(moved_onto(own, p.end % 2 == 0, at, gap_m, lines_[p.joint.line].number()));
    }

    std::vector<RiverLine>& lines_;
    Parts parts_;
    double cell_m_;
    Left& left_;
    Sets joined_;
    std::vector<Insertion> additions_;
};

} // namespace

Vec2 end_of(RiverLine const& line, std::size_t e) {
    return in_plan(e % 2 == 0 ? line.vertices.front() : line.vertices.back());
}

Parts parts_of(Pieces const& pieces, std::vector<RiverLine> const& lines) {
    Parts parts{std::vector<std::size_t>(lines.size(), 0), std::vector<char>(2 * lines.size(), 0), pieces.nodes.size()};
    Sets sets(pieces.nodes.size());
    for (Piece const& piece : pieces.pieces) {
        sets.join(piece.from, piece.to);
        if (piece.first == 0) {
            bool const is_alone = pieces.at_node[piece.from].size() == 1;
            parts.is_open[2 * piece.line] = is_alone && !is_at_edge(lines, 2 * piece.line) ? 1 : 0;
        }
        if (piece.last + 1 == lines[piece.line].vertices.size()) {
            bool const is_alone = pieces.at_node[piece.to].size() == 1;
            parts.is_open[2 * piece.line + 1] = is_alone && !is_at_edge(lines, 2 * piece.line + 1) ? 1 : 0;
        }
    }
    for (Piece const& piece : pieces.pieces) {
        parts.of_line[piece.line] = sets.of(piece.from);
    }
    return parts;
}

bool is_drawing_sure(FoundDirections const& found) {
    return std::fabs(found.report.drawn_downstream - 0.5) >= much_as_drawn;
}

std::vector<int> flows_at_ends(Pieces const& pieces, std::vector<RiverLine> const& lines,
                               std::vector<int> const& runs) {
    std::vector<int> flows(2 * lines.size(), 0);
    for (PieceId k = 0; k < pieces.pieces.size(); ++k) {
        Piece const& piece = pieces.pieces[k];
        if (piece.first == 0) {
            flows[2 * piece.line] = -runs[k];
        }
        if (piece.last + 1 == lines[piece.line].vertices.size()) {
            flows[2 * piece.line + 1] = runs[k];
        }
    }
    return flows;
}

bool close_gaps(std::vector<RiverLine>& lines, RiverLines const& file, ImportParams const& params, Left& left,
                Run const& run) {
    std::vector<Finding> notes;
    std::vector<SecondaryLine> secondary;
    Left nothing{notes, secondary};
    Pieces const pieces = cut(lines, nothing);
    Gaps gaps(lines, parts_of(pieces, lines), params.cell_m, left);
    std::vector<Proposal> const proposals = gaps.find(run);
    if (proposals.empty()) {
        return false;
    }
    gaps.close(proposals, sure_flows(pieces, lines, file, params, left, run));
    return true;
}

} // namespace thalweg::network::import_steps
