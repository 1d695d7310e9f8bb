// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <map>
#include <optional>
#include <queue>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/append.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/geometry/diagram.hpp>
#include <thalweg/geometry/nearby.hpp>
#include <thalweg/geometry/polylines.hpp>
#include <thalweg/network/import/internal/import_lines.hpp>
#include <thalweg/network/import/internal/lake_findings.hpp>
#include <thalweg/network/import/internal/lake_middle.hpp>

namespace thalweg::network::import_steps {
namespace {

constexpr double shore_cells = 0.5;     // an end lies at a shore that is within
constexpr double inflow_cells = 2.0;    // or within this, where water leaves its line, or no river begins nearer
constexpr double frame_cells = 2.0;     // lines through lakes keep from the border of the grid
constexpr double tolerance_cells = 0.1; // of a line through a lake

/// What is known of the ends of lines.
struct Flows {
    std::vector<int> of_end;        ///< as flows_at_ends
    std::vector<char> is_part_said; ///< by connected part: by more than the drawing
};

/// As the rivers would run without their lakes; nothing where that is not sure.
Flows flows_without_lakes(Pieces const& pieces, Parts const& parts, std::vector<RiverLine>& lines,
                          RiverLines const& file, ImportParams const& params, Left& left, Run const& run) {
    std::vector<Evidence> evidence = evidence_of(pieces, lines, file, params.orientation, left.repairs);
    FoundDirections const found = find_directions(pieces, lines, params, evidence, run);
    ImportParams undivided = params;
    undivided.divergences = Divergences::main;
    Pieces forest = pieces;
    DividedPieces const divided = divide(forest, lines, file, params.orientation, evidence, found.runs, run);
    std::vector<PieceId> const leaves = orient(forest, lines, file, undivided, evidence, found.runs);
    auto const part = [&](PieceId k) { return parts.of_line[pieces.pieces[k].line]; };
    std::vector<char> is_sure(parts.most, is_drawing_sure(found) ? 1 : 0); // by part
    std::vector<char> is_said(parts.most, 0);
    for (Evidence const& e : evidence) {
        for (PieceId k = 0; k < pieces.pieces.size(); ++k) {
            if (e.votes[k] != 0) {
                is_sure[part(k)] = 1;
                is_said[part(k)] = e.kind != Evidence::Kind::drawn ? 1 : is_said[part(k)];
            }
        }
    }
    std::vector<int> runs(pieces.pieces.size(), 0);
    for (PieceId k = 0; k < runs.size(); ++k) {
        if (is_sure[part(k)] != 0) {
            runs[k] = divided.reason[k] != nullptr ? divided.runs[k] : leaves[pieces.pieces[k].from] == k ? 1 : -1;
        }
    }
    return {flows_at_ends(pieces, lines, runs), std::move(is_said)};
}

/// Whether lines meet as they are drawn, away from lakes.
bool meets_as_drawn(Pieces const& pieces) {
    std::vector<int> arriving(pieces.nodes.size(), 0);
    std::vector<int> leaving(pieces.nodes.size(), 0);
    for (Piece const& piece : pieces.pieces) {
        ++arriving[piece.to];
        ++leaving[piece.from];
    }
    for (std::size_t n = 0; n < arriving.size(); ++n) {
        if (arriving[n] > 1 && leaving[n] > 0) {
            return true;
        }
    }
    return false;
}

/// Joins the parts of a network that meet lakes.
class Lakes {
public:
    Lakes(std::vector<RiverLine>& lines, Parts parts, Flows flows, ImportParams const& params, bool has_z, Left& left)
        : lines_(lines), parts_(std::move(parts)), flows_(std::move(flows)), params_(params), has_z_(has_z),
          left_(left), joined_(parts_.most), near_m_(params.cell_m > 0.0 ? shore_cells * params.cell_m : params.snap_m),
          far_m_(params.cell_m > 0.0 ? inflow_cells * params.cell_m : params.snap_m),
          tolerance_m_(tolerance_cells * std::max(params.cell_m, params.snap_m)), noise_m_(noise_of(lines)) {
        for (RiverLine const& line : lines) {
            Vec2 low = in_plan(line.vertices.front());
            Vec2 high = low;
            for (Vec3 const& v : line.vertices) {
                low = {std::min(low.x, v.x), std::min(low.y, v.y)};
                high = {std::max(high.x, v.x), std::max(high.y, v.y)};
            }
            boxes_.emplace_back(low, high);
        }
        for (std::size_t e = 0; e < parts_.is_open.size(); ++e) {
            if (parts_.is_open[e] != 0) {
                open_.emplace_back(end_of(lines[e / 2], e).x, e);
            }
        }
        std::ranges::sort(open_);
    }

    /// Lines that nowhere meet as they are drawn, neither elsewhere nor at a lake, but fork at one: all of them are
    /// drawn upstream.
    void look_for_upstream(std::vector<Polygon> const& lakes) {
        bool is_forked = false;
        for (Polygon const& lake : lakes) {
            if (lake.rings.empty() || lake.rings.front().size() < 3) {
                continue;
            }
            LakeOutline const outline(lake);
            AtLake const at = rivers_at(outline);
            std::vector<Mouth> const& mouths = at.mouths;
            if (std::ranges::any_of(mouths, &Mouth::is_said)) {
                continue;
            }
            auto const through = at.passing.empty() ? 0 : 1;
            auto const in = through + std::ranges::count_if(mouths, [](Mouth const& m) { return m.flow > 0; });
            auto const out = through + std::ranges::count_if(mouths, [](Mouth const& m) { return m.flow < 0; });
            if (in > 1) {
                return;
            }
            is_forked = is_forked || (in == 1 && out > 1);
        }
        if (!is_forked) {
            return;
        }
        is_drawn_upstream_ = true;
        for (std::size_t e = 0; e < flows_.of_end.size(); ++e) {
            flows_.of_end[e] = is_said(e / 2) ? flows_.of_end[e] : -flows_.of_end[e];
        }
    }

    void cross(Polygon const& lake, Run const& run) {
        if (lake.rings.empty() || lake.rings.front().size() < 3) {
            return;
        }
        LakeOutline const outline(lake);
        auto [mouths, afloat, passing] = rivers_at(outline);
        if (mouths.empty() && (passing.empty() || afloat.empty())) {
            return;
        }
        std::size_t const first = added_.size();
        added_m_ = 0.0;
        rivers_ = 0;
        out_ = nowhere;
        if (passing.empty() && std::ranges::all_of(mouths, [](Mouth const& mouth) { return mouth.flow > 0; })) {
            note_closed(outline, lake.feature, mouths);
            bool const may_drain = mouths.size() > 1 && params_.drains_lakes && params_.frame != nullptr;
            std::optional<Mouth> const made = may_drain ? made_outflow(outline, mouths) : std::nullopt;
            if (!made) {
                return; // its water stays in it
            }
            closed_.back().out = made->begin();
            mouths.push_back(*made);
            along_shore(mouths);
        }
        std::int64_t const others = keep_one_outflow(lake.feature, mouths, !passing.empty());
        std::optional<Mouth> const root = passing.empty() ? std::optional(mouths[root_of(mouths)]) : std::nullopt;
        if (!passing.empty()) {
            join_to(outline, passing, mouths);
        }
        try {
            join_along_middle(outline, passing, mouths, run);
        } catch (BadInput const& cannot) {
            left_.repairs.push_back(
                {"lake_left_out", lake.feature, mouths.front().tip, 0.0,
                 fmt::format("rivers do not run through lake {}: {}", lake.feature, cannot.what())});
        }
        join_afloat(outline, passing, root, first, lake.feature, afloat);
        simplify_from(first);
        if (rivers_ > 0) {
            std::string const more = others == 0   ? ""
                                     : others == 1 ? "; another one begins at its shore"
                                                   : fmt::format("; {} others begin at its shore", others);
            left_.repairs.push_back(
                {"lake_crossed", lake.feature, out_, added_m_,
                 fmt::format("lake {}: {} on through it, to ({:.0f}, {:.0f}), over {:.0f} m{}", lake.feature,
                             rivers_ == 1 ? "1 river that ends at its shore runs"
                                          : fmt::format("{} rivers that end at its shore run", rivers_),
                             out_.x, out_.y, added_m_, more)});
        }
    }

    bool finish() {
        append(left_.repairs, findings_of_lakes(closed_, low_, second_));
        if (added_.empty()) {
            return false;
        }
        insert(lines_, std::move(insertions_));
        lines_.insert(lines_.end(), std::make_move_iterator(added_.begin()), std::make_move_iterator(added_.end()));
        drop_repeats(lines_);
        return true;
    }

private:
    std::size_t part(std::size_t line) { return joined_.of(parts_.of_line[line]); }
    bool is_said(std::size_t line) const { return flows_.is_part_said[parts_.of_line[line]] != 0; }

    /// The rivers that meet a lake.
    struct AtLake {
        std::vector<Mouth> mouths;        ///< along its shore
        std::vector<Mouth> afloat;        ///< ends in the lake of lines all in it, and at its islands
        std::vector<std::size_t> passing; ///< lines in the lake that do not end in it
    };

    /// A river that begins beside a lake leaves it, if no other does.
    AtLake rivers_at(LakeOutline const& outline) {
        AtLake at;
        at.mouths = mouths_of(outline, at.afloat);
        follow_links(at.mouths);
        follow_ranks(at.mouths);
        std::vector<Mouth> beside;
        std::erase_if(at.mouths, [&](Mouth const& mouth) {
            bool const is_beside = mouth.flow < 0 && mouth.ashore_m > near_m_;
            if (is_beside) {
                beside.push_back(mouth);
            }
            return is_beside;
        });
        at.passing = lines_through(outline, at);
        bool const has_outflow = std::ranges::any_of(at.mouths, [](Mouth const& m) { return m.flow <= 0; });
        if (!beside.empty() && !at.mouths.empty() && at.passing.empty() && !has_outflow) {
            at.mouths.push_back(*std::ranges::min_element(beside, {}, &Mouth::ashore_m));
            along_shore(at.mouths);
        }
        return at;
    }

    /// Where the link or node of one line names another at the same lake, water runs from that one to this.
    void follow_links(std::vector<Mouth>& mouths) const {
        if (params_.orientation != Orientation::automatic && params_.orientation != Orientation::links) {
            return;
        }
        for (Mouth& above : mouths) {
            for (Mouth& below : mouths) {
                RiverLine const& upper = lines_[above.line];
                RiverLine const& lower = lines_[below.line];
                bool const is_linked = upper.down != 0 && upper.down == lower.feature;
                bool const is_node = upper.to_node != 0 && upper.to_node == lower.from_node;
                if (above.line != below.line && (is_linked || is_node)) {
                    above.flow = 1;
                    below.flow = -1;
                    above.is_said = below.is_said = true;
                }
            }
        }
    }

    /// Where only ranks say something, water runs to the least one.
    void follow_ranks(std::vector<Mouth>& mouths) const {
        auto const rank = [&](Mouth const& m) { return lines_[m.line].rank; };
        bool const has_ranks =
            params_.orientation == Orientation::automatic || params_.orientation == Orientation::rank;
        if (!has_ranks || mouths.size() < 2 ||
            std::ranges::any_of(mouths, [&](Mouth const& m) { return m.is_said || rank(m) == 0; })) {
            return;
        }
        auto const least = std::ranges::min_element(mouths, {}, rank);
        if (std::ranges::count(mouths, rank(*least), rank) != 1) {
            return;
        }
        for (Mouth& mouth : mouths) {
            mouth.flow = &mouth == &*least ? -1 : 1;
            mouth.is_said = true;
        }
    }

    /// The open ends at a shore or within a lake, along its shore; of several at one place the first.
    std::vector<Mouth> mouths_of(LakeOutline const& lake, std::vector<Mouth>& afloat) {
        std::vector<Mouth> mouths;
        auto at = std::ranges::lower_bound(open_, lake.low().x - far_m_, {}, &std::pair<double, std::size_t>::first);
        for (; at != open_.end() && at->first <= lake.high().x + far_m_; ++at) {
            std::size_t const e = at->second;
            Vec2 const tip = end_of(lines_[e / 2], e);
            if (parts_.is_open[e] == 0 || !lake.is_about(tip, far_m_)) {
                continue;
            }
            Mouth mouth{e / 2, tip, flows_.of_end[e], is_said(e / 2), lake.nearest(tip), {}};
            bool const is_inside = mouth.shore.distance_m > same_point_m && lake.contains(tip);
            if (is_inside && !goes_ashore(lake, e, mouth)) {
                mouth.inside = {tip};
                afloat.push_back(std::move(mouth));
                continue;
            }
            if (!is_inside && mouth.shore.distance_m > far_m_) {
                if (ShorePlace const island = lake.nearest_on_island(tip); island.distance_m <= far_m_) {
                    mouth.inside = {island.distance_m <= same_point_m ? tip : rounded(island.at)};
                    afloat.push_back(std::move(mouth));
                }
                continue;
            }
            mouth.ashore_m = is_inside ? 0.0 : mouth.shore.distance_m;
            if (!is_inside) {
                mouth.shore.at = mouth.shore.distance_m <= same_point_m ? tip : rounded(mouth.shore.at);
                mouth.inside = {mouth.shore.at};
            }
            mouths.push_back(std::move(mouth));
        }
        along_shore(mouths);
        return mouths;
    }

    static void along_shore(std::vector<Mouth>& mouths) {
        std::ranges::sort(mouths, {},
                          [](Mouth const& m) { return std::tuple(m.shore.segment, m.shore.along, m.tip.x, m.tip.y); });
        auto const is_repeat = [](Mouth const& a, Mouth const& b) {
            return distance(a.shore.at, b.shore.at) <= apart_m;
        };
        mouths.erase(std::unique(mouths.begin(), mouths.end(), is_repeat), mouths.end());
        if (mouths.size() > 1 && distance(mouths.front().shore.at, mouths.back().shore.at) <= apart_m) {
            mouths.pop_back();
        }
    }

    /// Follows a line from its end in the lake to the shore. \return false: all of it is in the lake
    bool goes_ashore(LakeOutline const& lake, std::size_t e, Mouth& mouth) const {
        std::vector<Vec2> line = in_plan(lines_[e / 2].vertices);
        if (e % 2 == 1) {
            std::ranges::reverse(line);
        }
        mouth.inside = {line.front()};
        for (std::size_t i = 1; i < line.size(); ++i) {
            if (auto const out = lake.way_out(line[i - 1], line[i])) {
                mouth.shore = *out;
                mouth.shore.at = rounded(out->at);
                if (distance(mouth.inside.back(), mouth.shore.at) > same_point_m) {
                    mouth.inside.push_back(mouth.shore.at);
                }
                return true;
            }
            mouth.inside.push_back(line[i]);
        }
        return false;
    }

    /// The lines in a lake that do not end in it.
    std::vector<std::size_t> lines_through(LakeOutline const& lake, AtLake const& at) {
        std::vector<std::size_t> through;
        for (std::size_t l = 0; l < boxes_.size(); ++l) {
            auto const& [low, high] = boxes_[l];
            bool const is_about =
                low.x <= lake.high().x && high.x >= lake.low().x && low.y <= lake.high().y && high.y >= lake.low().y;
            auto const is_of = [&](Mouth const& m) { return part(m.line) == part(l); };
            if (!is_about || std::ranges::any_of(at.mouths, is_of) || std::ranges::any_of(at.afloat, is_of)) {
                continue;
            }
            auto const& v = lines_[l].vertices;
            for (std::size_t i = 0; i + 1 < v.size(); ++i) {
                Vec2 const a = in_plan(v[i]);
                Vec2 const b = in_plan(v[i + 1]);
                if (lake.contains(a + 0.5 * (b - a)) || lake.contains(b) || lake.way_out(a, b)) {
                    through.push_back(l);
                    break;
                }
            }
        }
        return through;
    }

    /// Of several rivers that leave a lake its water takes the one that most inflows name, the lowest, of least rank,
    /// of an inflow's name, else the first of the file. Others keep beginning at its shore.
    /// \return how many others there are
    std::int64_t keep_one_outflow(std::int64_t lake, std::vector<Mouth>& mouths, bool is_passed) {
        auto const key = [&](Mouth const& m) {
            RiverLine const& own = lines_[m.line];
            std::ptrdiff_t named = 0;
            bool has_name = false;
            for (Mouth const& other : mouths) {
                RiverLine const& inflow = lines_[other.line];
                named += other.flow > 0 && inflow.down != 0 && inflow.down == own.feature ? 1 : 0;
                has_name = has_name || (other.flow > 0 && !own.name.empty() && inflow.name == own.name);
            }
            std::int64_t const rank = own.rank == 0 ? std::numeric_limits<std::int64_t>::max() : own.rank;
            return std::tuple(-named, has_z_ ? height_at(m) : 0.0, rank, has_name ? 0 : 1, m.line);
        };
        std::vector<Mouth> outflows = mouths;
        std::erase_if(outflows, [](Mouth const& m) { return m.flow >= 0; });
        if (outflows.empty() || (outflows.size() == 1 && !is_passed)) {
            return 0;
        }
        std::optional<Vec2> kept;
        if (!is_passed) {
            kept = std::ranges::min_element(outflows, {}, key)->tip;
        }
        std::erase_if(outflows, [&](Mouth const& m) { return m.tip == kept; });
        std::erase_if(mouths, [&](Mouth const& m) { return m.flow < 0 && m.tip != kept; });
        for (Mouth const& m : outflows) {
            if (!m.is_said) {
                second_.push_back({lake, lines_[m.line].number(), m.tip});
            }
        }
        return std::ssize(outflows);
    }

    static std::size_t root_of(std::vector<Mouth> const& mouths) {
        auto const rank = [](Mouth const& m) { return m.on ? -2 : m.flow; };
        return static_cast<std::size_t>(std::ranges::min_element(mouths, {}, rank) - mouths.begin());
    }

    /// Remembers a lake that no river leaves, and where one begins near it.
    void note_closed(LakeOutline const& outline, std::int64_t lake, std::vector<Mouth> const& mouths) {
        constexpr double most_times = 10.0; // as far as an inflow may end
        LakeWithoutOutflow closed{lake, mouths.front().tip, std::ssize(mouths), nowhere,
                                  std::numeric_limits<double>::infinity()};
        double const most_m = most_times * far_m_;
        auto at = std::ranges::lower_bound(open_, outline.low().x - most_m, {}, &std::pair<double, std::size_t>::first);
        for (; at != open_.end() && at->first <= outline.high().x + most_m; ++at) {
            std::size_t const e = at->second;
            Vec2 const tip = end_of(lines_[e / 2], e);
            if (flows_.of_end[e] < 0 && outline.is_about(tip, most_m) && !outline.contains(tip)) {
                double const m = outline.nearest(tip).distance_m;
                if (m <= most_m && m < closed.next_m) {
                    closed.next = tip;
                    closed.next_m = m;
                }
            }
        }
        closed_.push_back(closed);
    }

    /// The place of the shore nearest to the border, and two cells away from mouths, as one where water leaves.
    std::optional<Mouth> made_outflow(LakeOutline const& outline, std::vector<Mouth> const& mouths) const {
        Grid const& grid = *params_.frame;
        std::vector<Vec2> const& shore = outline.shore();
        ShorePlace best;
        for (std::size_t i = 0; i < shore.size(); ++i) {
            for (double const along : {0.0, 0.5}) {
                Vec2 const at = shore[i] + along * (shore[(i + 1) % shore.size()] - shore[i]);
                double const border_m = std::max(
                    0.0, std::min({at.x - grid.west, grid.east() - at.x, at.y - grid.south(), grid.north - at.y}));
                bool const is_apart = std::ranges::all_of(
                    mouths, [&](Mouth const& m) { return distance(m.shore.at, at) > inflow_cells * grid.cell_m; });
                if (is_apart && border_m < best.distance_m) {
                    best = {i, along, rounded(at), border_m};
                }
            }
        }
        if (!std::isfinite(best.distance_m)) {
            return std::nullopt;
        }
        double least_z = std::numeric_limits<double>::infinity();
        for (Mouth const& m : mouths) {
            least_z = std::min(least_z, height_at(m));
        }
        Vec2 const at = rounded(within_frame(best.at));
        Mouth out{mouths.front().line, at, -1, true, best, {at}};
        out.made_z = least_z;
        return out;
    }

    /// Whether water runs from a mouth to a height, by the file's; those may be off by noise.
    bool runs_down(Mouth const& mouth, double to_z) const {
        return !has_z_ || mouth.flow < 0 || height_at(mouth) >= to_z - noise_m_;
    }

    /// Remembers a river that is not led through a lake because it ends far below it.
    void note_low(Mouth const& mouth, double lake_z) {
        low_.push_back({lines_[mouth.line].number(), mouth.tip, lake_z - height_at(mouth)});
    }

    /// Joins mouths straight to the rivers that pass through, where the way is in the water; these mouths are removed.
    void join_to(LakeOutline const& lake, std::vector<std::size_t> const& passing, std::vector<Mouth>& mouths) {
        std::erase_if(mouths, [&](Mouth const& mouth) {
            std::optional<Insertion> goal;
            double least_m = std::numeric_limits<double>::infinity();
            for (std::size_t const l : passing) {
                auto const& v = lines_[l].vertices;
                for (std::size_t i = 0; i + 1 < v.size(); ++i) {
                    geometry::Foot const foot = geometry::foot_on(in_plan(v[i]), in_plan(v[i + 1]), mouth.begin());
                    double const m = distance(mouth.begin(), foot.at);
                    if (m < least_m && lake.contains(foot.at) && lake.sees(mouth.begin(), foot.at)) {
                        least_m = m;
                        goal = Insertion{l, i, foot.along, foot.at};
                    }
                }
            }
            if (!goal || part(mouth.line) == part(goal->line)) {
                return false;
            }
            if (!runs_down(mouth, height_on(*goal))) {
                note_low(mouth, height_on(*goal));
                return true;
            }
            add(mouth, {mouth.begin(), end_on(*goal)}, height_on(*goal));
            joined_.join(part(mouth.line), part(goal->line));
            return true;
        });
    }

    /// The place on a line as a vertex, which is inserted where there is none.
    Vec2 end_on(Insertion goal) {
        auto const& v = lines_[goal.line].vertices;
        for (std::size_t const i : {goal.segment, goal.segment + 1}) {
            if (distance(in_plan(v[i]), goal.at) <= apart_m) {
                return in_plan(v[i]);
            }
        }
        goal.at = rounded(goal.at);
        insertions_.push_back(goal);
        return goal.at;
    }

    double height_on(Insertion const& goal) const {
        auto const& v = lines_[goal.line].vertices;
        return v[goal.segment].z + goal.along * (v[goal.segment + 1].z - v[goal.segment].z);
    }

    double height_at(Mouth const& mouth) const {
        if (mouth.made_z) {
            return *mouth.made_z;
        }
        auto const& v = lines_[mouth.line].vertices;
        return in_plan(v.front()) == mouth.tip ? v.front().z : v.back().z;
    }

    /// Joins what is still apart along the lake's medial lines, to its outflow or to a river that passes through.
    void join_along_middle(LakeOutline const& lake, std::vector<std::size_t> const& passing, std::vector<Mouth>& mouths,
                           Run const& run) {
        if (mouths.empty()) {
            return;
        }
        std::vector<std::size_t> parts;
        for (std::size_t const l : passing) {
            if (std::ranges::find(parts, part(l)) == parts.end() && append_passing(lake, l, mouths)) {
                parts.push_back(part(l));
            }
        }
        along_shore(mouths);
        if (mouths.size() < 2) {
            return;
        }
        std::size_t const root = root_of(mouths);
        LakeMiddle tree(lake, mouths, tolerance_m_, run);
        double z = height_at(mouths[root]);
        if (mouths[root].on) {
            z = height_on(*mouths[root].on);
        }
        bool const has_middle = tree.is_whole();
        if (has_middle) {
            tree.root_at(root);
        }
        for (std::size_t m = 0; m < mouths.size(); ++m) {
            Mouth const& mouth = mouths[m];
            bool const is_joined = !mouths[root].made_z && part(mouth.line) == part(mouths[root].line);
            if (m == root || mouth.on || is_joined) {
                continue;
            }
            if (!runs_down(mouth, z)) {
                note_low(mouth, z);
                continue;
            }
            LakeMiddle::Way way;
            if (has_middle) {
                way = tree.way_from(m);
                std::ranges::for_each(way.line, [&](Vec2& p) { p = within_frame(p); });
            } else if (lake.sees(mouth.begin(), mouths[root].begin())) { // both end far within a small lake
                way.ends_at_root = true;
            } else {
                throw BadInput("network.import_lines", "no line lies between its shores");
            }
            bool const is_stopped = stop_at(passing, way.line);
            if (has_middle) {
                tree.take(way, is_stopped ? way.line.size() - 1 : way.line.size());
            }
            way.line.insert(way.line.begin(), mouth.begin());
            if (!is_stopped && way.ends_at_root) {
                way.line.push_back(mouths[root].on ? end_on(*mouths[root].on) : mouths[root].begin());
                if (!mouths[root].on && mouths[root].tip != mouths[root].begin()) {
                    way.line.push_back(mouths[root].tip);
                }
            }
            add(mouth, std::move(way.line), z);
            joined_.join(part(mouth.line), part(mouths[root].line));
            out_ = mouths[root].begin();
            if (!mouths[root].on && !mouths[root].made_z) {
                close(mouths[root]);
            }
        }
    }

    /// A lake may lie beyond the grid, its rivers do not.
    Vec2 within_frame(Vec2 p) const {
        if (params_.frame == nullptr) {
            return p;
        }
        Grid const& grid = *params_.frame;
        double const margin_m = frame_cells * grid.cell_m;
        return {std::clamp(p.x, grid.west + margin_m, std::max(grid.west + margin_m, grid.east() - margin_m)),
                std::clamp(p.y, grid.south() + margin_m, std::max(grid.south() + margin_m, grid.north - margin_m))};
    }

    /// Joins lines in the lake that reach no shore, and those of islands, straight to the nearest way of its water that
    /// is in sight.
    void join_afloat(LakeOutline const& lake, std::vector<std::size_t> const& passing, std::optional<Mouth> const& root,
                     std::size_t first, std::int64_t number, std::vector<Mouth> const& afloat) {
        struct Goal {
            Vec2 at;
            double m = std::numeric_limits<double>::infinity();
            double z = 0.0;
            std::optional<Insertion> on = {}; ///< a line of the file
            std::size_t added = 0;            ///< else a line through the lake, if `segment` says where
            std::optional<std::size_t> segment = {};
        };
        for (Mouth const& mouth : afloat) {
            Vec2 const from = mouth.begin();
            bool const is_joined = (root && part(mouth.line) == part(root->line)) ||
                                   std::ranges::any_of(passing, [&](auto l) { return part(l) == part(mouth.line); });
            if (mouth.flow < 0 || is_joined) {
                continue;
            }
            Goal goal;
            auto const offer = [&](Vec2 at, double z) {
                double const m = distance(from, at);
                bool const is_nearer = m < goal.m && m > same_point_m && lake.sees(from, at);
                if (is_nearer) {
                    goal = {at, m, z};
                }
                return is_nearer;
            };
            for (std::size_t const l : passing) {
                auto const& v = lines_[l].vertices;
                for (std::size_t i = 0; i + 1 < v.size(); ++i) {
                    geometry::Foot const foot = geometry::foot_on(in_plan(v[i]), in_plan(v[i + 1]), from);
                    Insertion const on{l, i, foot.along, foot.at};
                    if (lake.contains(foot.at) && offer(foot.at, height_on(on))) {
                        goal.on = on;
                    }
                }
            }
            for (std::size_t l = first; l < added_.size(); ++l) {
                auto const& v = added_[l].vertices;
                for (std::size_t i = 0; i + 1 < v.size(); ++i) {
                    geometry::Foot const foot = geometry::foot_on(in_plan(v[i]), in_plan(v[i + 1]), from);
                    if (offer(rounded(foot.at), v[i].z)) {
                        goal.added = l;
                        goal.segment = i;
                    }
                }
            }
            bool const to_root = root && offer(root->begin(), height_at(*root));
            if (!std::isfinite(goal.m)) {
                left_.repairs.push_back({"lake_left_out", number, mouth.tip, 0.0,
                                         fmt::format("river {} ends in lake {} at ({:.0f}, {:.0f}) out of sight of the "
                                                     "ways through it, and is not led through it",
                                                     lines_[mouth.line].number(), number, mouth.tip.x, mouth.tip.y)});
                continue;
            }
            if (!runs_down(mouth, goal.z)) {
                note_low(mouth, goal.z);
                continue;
            }
            std::size_t const into = goal.on ? goal.on->line : root ? root->line : passing.front();
            if (goal.on) {
                goal.at = end_on(*goal.on);
            } else if (goal.segment) {
                auto& v = added_[goal.added].vertices;
                v.insert(v.begin() + static_cast<std::ptrdiff_t>(*goal.segment) + 1,
                         {goal.at.x, goal.at.y, v.front().z});
            }
            std::vector<Vec2> way{from, goal.at};
            if (to_root && root->tip != root->begin()) {
                way.push_back(root->tip);
            }
            add(mouth, std::move(way), goal.z);
            joined_.join(part(mouth.line), part(into));
        }
    }

    /// Where a river that passes through crosses the shore, as a mouth.
    bool append_passing(LakeOutline const& lake, std::size_t l, std::vector<Mouth>& mouths) const {
        auto const& v = lines_[l].vertices;
        for (std::size_t i = 0; i + 1 < v.size(); ++i) {
            Vec2 const a = in_plan(v[i]);
            Vec2 const b = in_plan(v[i + 1]);
            if (auto out = lake.way_out(a, b)) {
                out->at = rounded(out->at);
                double const along = distance(a, out->at) / distance(a, b);
                mouths.push_back({l, out->at, -1, true, *out, {out->at}, Insertion{l, i, along, out->at}});
                return true;
            }
        }
        return false;
    }

    /// Ends a way where it first meets a river that passes through.
    bool stop_at(std::vector<std::size_t> const& passing, std::vector<Vec2>& way) {
        for (std::size_t k = 0; k + 1 < way.size(); ++k) {
            std::optional<Insertion> first;
            for (std::size_t const l : passing) {
                auto const& v = lines_[l].vertices;
                for (std::size_t i = 0; i + 1 < v.size(); ++i) {
                    auto const along = meeting_along(way[k], way[k + 1], in_plan(v[i]), in_plan(v[i + 1]));
                    if (along) {
                        Vec2 const at = way[k] + *along * (way[k + 1] - way[k]);
                        if (!first || distance(way[k], at) < distance(way[k], first->at)) {
                            double const on = geometry::foot_on(in_plan(v[i]), in_plan(v[i + 1]), at).along;
                            first = Insertion{l, i, on, at};
                        }
                    }
                }
            }
            if (first) {
                way.resize(k + 1);
                way.push_back(end_on(*first));
                return true;
            }
        }
        return false;
    }

    /// Adds the way from a mouth, or to it where water leaves the lake there.
    void add(Mouth const& mouth, std::vector<Vec2> way, double z) {
        if (mouth.tip != way.front()) {
            way.insert(way.begin(), mouth.tip);
        }
        for (Vec2& p : way) { // those of the file are
            p = rounded(p);
        }
        RiverLine& line = added_.emplace_back();
        line.type = lines_[mouth.line].type;
        line.id_shift = lines_.front().id_shift;
        line.size.assign(lines_.front().size.size(), 0.0);
        if ((mouth.flow < 0) != is_drawn_upstream_) {
            std::ranges::reverse(way);
        }
        for (Vec2 const p : way) {
            line.vertices.push_back({p.x, p.y, has_z_ ? z : std::numeric_limits<double>::quiet_NaN()});
        }
        rivers_ += mouth.flow < 0 ? 0 : 1;
        out_ = is_drawn_upstream_ ? way.front() : way.back();
        close(mouth);
    }

    /// Leaves out vertices of the lines through a lake, but none where they meet.
    void simplify_from(std::size_t first) {
        std::vector<Vec2> ends;
        for (std::size_t l = first; l < added_.size(); ++l) {
            ends.push_back(in_plan(added_[l].vertices.front()));
            ends.push_back(in_plan(added_[l].vertices.back()));
        }
        for (std::size_t l = first; l < added_.size(); ++l) {
            std::vector<Vec3>& v = added_[l].vertices;
            double const z = v.front().z;
            std::vector<Vec2> section;
            std::vector<Vec3> kept{v.front()};
            for (Vec3 const& p : v) {
                section.push_back(in_plan(p));
                bool const is_joint = section.size() > 1 && std::ranges::find(ends, section.back()) != ends.end();
                if (is_joint || &p == &v.back()) {
                    for (Vec2 const q : geometry::simplify(section, tolerance_m_)) {
                        if (q != in_plan(kept.back())) {
                            kept.push_back({q.x, q.y, z});
                        }
                    }
                    section = {section.back()};
                }
            }
            v = std::move(kept);
            added_m_ += length_in_plan(v);
        }
    }

    void close(Mouth const& mouth) {
        auto const& v = lines_[mouth.line].vertices;
        parts_.is_open[2 * mouth.line + (in_plan(v.front()) == mouth.tip ? 0 : 1)] = 0;
    }

    std::vector<RiverLine>& lines_;
    Parts parts_;
    Flows flows_;
    ImportParams const& params_;
    bool has_z_;
    Left& left_;
    Sets joined_;
    double near_m_;
    double far_m_;
    double tolerance_m_;
    double noise_m_;
    bool is_drawn_upstream_ = false;
    std::vector<std::pair<Vec2, Vec2>> boxes_;         ///< by line
    std::vector<std::pair<double, std::size_t>> open_; ///< x and number of open ends, sorted
    std::vector<RiverLine> added_;
    std::vector<Insertion> insertions_;
    double added_m_ = 0.0;
    std::int64_t rivers_ = 0;
    Vec2 out_ = nowhere;

    std::vector<LakeWithoutOutflow> closed_;
    std::vector<SecondOutflow> second_;
    std::vector<RiverBelowLake> low_;
};

} // namespace

bool cross_lakes(std::vector<RiverLine>& lines, RiverLines const& file, ImportParams const& params, Left& left,
                 Run const& run) {
    if (file.lakes.empty()) {
        return false;
    }
    std::vector<Finding> notes;
    std::vector<SecondaryLine> secondary;
    Left nothing{notes, secondary};
    Pieces const pieces = cut(lines, nothing);
    Parts const parts = parts_of(pieces, lines);
    Lakes lakes(lines, parts, flows_without_lakes(pieces, parts, lines, file, params, left, run), params, file.has_z,
                left);
    if (params.orientation == Orientation::automatic && !meets_as_drawn(pieces)) {
        lakes.look_for_upstream(file.lakes);
    }
    for (Polygon const& lake : file.lakes) {
        run.check();
        lakes.cross(lake, run);
    }
    return lakes.finish();
}

} // namespace thalweg::network::import_steps
