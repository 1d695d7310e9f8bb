// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/network/import/internal/import_reaches.hpp>

namespace thalweg::network::import_steps {
namespace {

// Constants of the evaluation, see docs/algorithms/river_directions.md.
constexpr std::array<double, 9> shares_drawn{0.03, 0.06, 0.1, 0.15, 0.5, 0.85, 0.9, 0.94, 0.97};
constexpr double vote_weight = 0.5; // of a reach's drawn direction: neighbours are usually drawn alike
constexpr double most_votes = 3.0;  // drawings are wrong for whole rivers
constexpr double belief = 0.25;     // prior probability that lines are drawn downstream
constexpr double most_wrong = 0.05; // expected share of a group
constexpr double second_gain = 5.0;
constexpr double conflict_gain = 8.0;
constexpr double telling = 0.85; // share drawn downstream from which the drawn direction is used inside loops
constexpr std::size_t telling_confluences = 3;
constexpr double most_contradicted = 0.1;   // share of the length with this evidence
constexpr double most_distributaries = 0.2; // the same for evidence that may lead away from one place

constexpr char const* by_angles = "angles at confluences";
constexpr char const* by_dem = "the DEM";
constexpr char const* by_drawing = "the drawn direction";
constexpr char const* by_upstream = "the drawn direction, which is upstream";

double logit(double p) {
    return portable::log(p / (1.0 - p));
}

/// Consistency of the drawn lines of a group.
struct Drawing {
    std::size_t sources = 0;
    std::size_t sinks = 0;
    std::size_t confluences = 0; ///< nodes where more lines arrive than leave
    std::size_t divergences = 0; ///< nodes where more leave than arrive
    std::size_t inner = 0;       ///< nodes at which lines end that none passes: no drawing contradicts itself elsewhere
    std::size_t contradicted = 0; ///< of these: nothing leaves or nothing reaches them
    bool leads_down = true;       ///< a sink can be reached from everywhere
    bool leads_up = true;         ///< everything can be reached from a source
    bool is_downstream() const { return leads_down && sinks == 1; }
    bool is_upstream() const { return leads_up && sources == 1 && confluences == 0; }
};

/// The drawings of the groups of nodes; visits their pieces.
class Drawings {
public:
    explicit Drawings(Pieces const& p) : p_(p), in_(p.nodes.size(), 0), out_(p.nodes.size(), 0) {
        for (Piece const& piece : p.pieces) {
            if (piece.from != piece.to) {
                ++out_[piece.from];
                ++in_[piece.to];
            }
        }
        find();
    }
    Drawing const& of(std::size_t node) const { return groups_[group_[node]]; }
    std::vector<Drawing> const& groups() const { return groups_; }
    std::size_t group(std::size_t node) const { return group_[node]; }

private:
    void find() {
        Sets sets(p_.nodes.size());
        for (Piece const& piece : p_.pieces) {
            sets.join(piece.from, piece.to);
        }
        constexpr std::size_t unknown = std::numeric_limits<std::size_t>::max();
        group_.assign(p_.nodes.size(), unknown);
        for (std::size_t n = 0; n < p_.nodes.size(); ++n) {
            if (sets.of(n) == n) {
                group_[n] = groups_.size();
                groups_.emplace_back();
            }
            group_[n] = group_[sets.of(n)]; // the first of its set
            Drawing& g = groups_[group_[n]];
            g.sources += in_[n] == 0 && out_[n] > 0 ? 1 : 0;
            g.sinks += out_[n] == 0 && in_[n] > 0 ? 1 : 0;
            g.confluences += out_[n] > 0 && in_[n] > 1 ? 1 : 0;
            g.divergences += in_[n] > 0 && out_[n] > 1 ? 1 : 0;
            bool const is_inner = in_[n] + out_[n] > 1 && !is_passed(n);
            g.inner += is_inner ? 1 : 0;
            g.contradicted += is_inner && (in_[n] == 0 || out_[n] == 0) ? 1 : 0;
        }
        reach(-1, &Drawing::leads_down);
        reach(1, &Drawing::leads_up);
    }

    /// Whether a drawn line runs through a node.
    bool is_passed(std::size_t n) const {
        return std::ranges::any_of(p_.at_node[n], [&](PieceId k) {
            Piece const& one = p_.pieces[k];
            return one.to == n && std::ranges::any_of(p_.at_node[n], [&](PieceId other) {
                       Piece const& next = p_.pieces[other];
                       return next.from == n && next.line == one.line && next.first == one.last;
                   });
        });
    }

    /// Records whether some node lies on no path to an end (-1: sinks, 1: sources) of its group.
    void reach(int way, bool Drawing::*leads) {
        auto const& last = way < 0 ? out_ : in_;
        std::vector<char> seen(p_.nodes.size(), 0);
        std::vector<std::size_t> reached;
        for (std::size_t n = 0; n < seen.size(); ++n) {
            if (last[n] == 0) {
                seen[n] = 1;
                reached.push_back(n);
            }
        }
        for (std::size_t i = 0; i < reached.size(); ++i) {
            for (std::size_t const k : p_.at_node[reached[i]]) {
                Piece const& piece = p_.pieces[k];
                auto const [here, next] = way < 0 ? std::pair(piece.to, piece.from) : std::pair(piece.from, piece.to);
                if (here == reached[i] && seen[next] == 0) {
                    seen[next] = 1;
                    reached.push_back(next);
                }
            }
        }
        for (std::size_t n = 0; n < seen.size(); ++n) {
            groups_[group_[n]].*leads = groups_[group_[n]].*leads && seen[n] != 0;
        }
    }

    Pieces const& p_;
    std::vector<int> in_;
    std::vector<int> out_;
    std::vector<std::size_t> group_;
    std::vector<Drawing> groups_;
};

/// A group of reaches, its roots and their probabilities.
struct RootedGroup {
    ReachGroup const* reaches;
    std::vector<Root> roots;
    double votes = 0.0;   ///< lines whose drawn direction counts
    double said = 0.0;    ///< the same for reaches whose direction the file gives
    bool is_said = false; ///< the file gives the direction of all of it
    std::vector<double> score = {};
};

/// log sum exp.
double log_sum(std::vector<double> const& x) {
    double const high = *std::ranges::max_element(x);
    double sum = 0.0;
    for (double const v : x) {
        sum += portable::exp(v - high);
    }
    return high + portable::log(sum);
}

/// Estimates the share of reaches drawn downstream, from their geometry.
double share_drawn(std::vector<RootedGroup> const& groups, double certain_weight) {
    double best = -std::numeric_limits<double>::infinity();
    double share = 0.5;
    for (double const p : shares_drawn) {
        double of_p = belief * logit(p);
        for (RootedGroup const& g : groups) {
            std::vector<double> prior;
            std::vector<double> joint;
            for (Root const& r : g.roots) {
                double const with = 0.5 * (g.votes + r.drawn);
                double const against = 0.5 * (g.votes - r.drawn);
                prior.push_back(r.geometry() + certain_weight * r.certain);
                joint.push_back(prior.back() +
                                vote_weight * (with * portable::log(p) + against * portable::log(1.0 - p)));
            }
            of_p += log_sum(joint) - log_sum(prior);
        }
        if (of_p > best) {
            best = of_p;
            share = p;
        }
    }
    return share;
}

class Director {
public:
    Director(Pieces const& p, std::vector<RiverLine> const& lines, ImportParams const& params,
             std::vector<Evidence>& evidence, FoundDirections& found)
        : p_(p), lines_(lines), params_(params), evidence_(evidence), found_(found), drawings_(p) {
        take_said(evidence);
    }

    void find(Run const& run) {
        judge_drawing();
        if (is_drawn_well_ && !any_said_) {
            found_.report.drawn_downstream = 1.0;
            return;
        }
        ReachGraph const graph = reaches_of(p_, lines_, found_.said, params_.dem);
        RootScores scores(p_, lines_, graph, found_.said, params_.dem);
        std::vector<RootedGroup> groups;
        for (ReachGroup const& group : graph.groups) {
            run.check();
            RootedGroup& g = groups.emplace_back(RootedGroup{&group, scores.of(group)});
            g.is_said = true;
            for (std::size_t const k : group.reaches) {
                g.votes += graph.is_bridge[k] != 0 ? scores.voters()[k] : 0.0;
                g.said += graph.is_bridge[k] != 0 ? std::fabs(scores.certain()[k]) : 0.0;
                g.is_said = g.is_said && std::ranges::all_of(graph.reaches[k].steps, [&](Reach::Step const& s) {
                                return found_.said[s.piece] != 0;
                            });
            }
        }
        doubt_evidence(groups);
        share_ = is_drawn_well_       ? shares_drawn.back()
                 : is_drawn_upstream_ ? shares_drawn.front()
                                      : share_drawn(groups, certain_weight_);
        found_.report.drawn_downstream = share_;
        for (RootedGroup& g : groups) {
            run.check();
            direct(g, graph, scores);
        }
        if (is_drawn_upstream_) {
            doubt_upstream(groups);
        }
    }

private:
    void take_said(std::vector<Evidence> const& evidence) {
        speaks_.assign(drawings_.groups().size(), nullptr);
        is_silent_.assign(drawings_.groups().size(), 0);
        for (Evidence const& e : evidence) {
            std::vector<char const*> now = speaks_;
            for (std::size_t k = 0; k < p_.pieces.size(); ++k) {
                std::size_t const g = drawings_.group(p_.pieces[k].from);
                if (e.votes[k] != 0 && speaks_[g] == nullptr) {
                    now[g] = e.name;
                    found_.said[k] = e.votes[k];
                    found_.by[k] = e.name;
                    any_said_ = true;
                }
            }
            speaks_ = std::move(now);
        }
        std::vector<std::pair<double, double>> drawn_m(speaks_.size()); // with the file's direction, and against it
        for (std::size_t k = 0; k < p_.pieces.size(); ++k) {
            std::size_t const g = drawings_.group(p_.pieces[k].from);
            (found_.said[k] > 0 ? drawn_m[g].first : drawn_m[g].second) +=
                found_.said[k] == 0 ? 0.0 : p_.pieces[k].length_m;
        }
        for (auto const& [with_m, against_m] : drawn_m) {
            confirms_.push_back(with_m > 0.0 && against_m <= most_contradicted * with_m ? 1 : 0);
        }
        for (std::size_t k = 0; k < p_.pieces.size(); ++k) {
            std::size_t const g = drawings_.group(p_.pieces[k].from);
            if (found_.said[k] == 0 && p_.pieces[k].from != p_.pieces[k].to && confirms_[g] == 0) {
                is_silent_[g] = 1;
            }
        }
    }

    /// Whether a test holds for every group with an unknown direction.
    template <class Test> bool holds_for_undirected(Test const& test) const {
        for (std::size_t g = 0; g < is_silent_.size(); ++g) {
            if (is_silent_[g] != 0 && !test(drawings_.groups()[g])) {
                return false;
            }
        }
        return true;
    }

    /// Reports evidence of which a large part contradicts the rest. A direction column then counts as one vote among
    /// others; links, heights and ranks stay, because they also lead away from one place at distributaries.
    void doubt_evidence(std::vector<RootedGroup>& groups) {
        for (Evidence const& e : std::vector<Evidence>(evidence_)) {
            double said = 0.0;
            double against = 0.0;
            for (RootedGroup const& g : groups) {
                if (speaks_[drawings_.group(g.roots.front().node)] == e.name) {
                    said += g.said;
                    against += 0.5 * (g.said - std::ranges::max_element(g.roots, {}, &Root::certain)->certain);
                }
            }
            bool const is_column = e.kind == Evidence::Kind::column;
            if (against <= (is_column ? most_contradicted : most_distributaries) * said) {
                continue;
            }
            double const share = against / said;
            found_.contradicted.push_back(e.name);
            found_.report.doubts.push_back(
                {"contradicted_direction", 0, p_.nodes.front(), share,
                 fmt::format("{:.3g} % of the reaches that are oriented by {} contradict the others{}", 100.0 * share,
                             e.name, is_column ? ": it is weighed with the angles at confluences" : "")});
            if (is_column) {
                distrust_column(groups, share, e.name);
            }
        }
    }

    void distrust_column(std::vector<RootedGroup>& groups, double share, char const* name) {
        certain_weight_ = vote_weight * logit(std::clamp(1.0 - share, 0.5, shares_drawn.back()));
        std::erase_if(evidence_, [](Evidence const& e) { return e.kind == Evidence::Kind::column; });
        for (RootedGroup& g : groups) {
            std::size_t const group = drawings_.group(g.roots.front().node);
            if (speaks_[group] == name) {
                g.is_said = false;
                speaks_[group] = nullptr;
                confirms_[group] = 0;
                is_silent_[group] = 1;
            }
        }
        judge_drawing();
        for (std::size_t k = 0; k < p_.pieces.size(); ++k) {
            if (speaks_[drawings_.group(p_.pieces[k].from)] == nullptr) {
                found_.said[k] = 0;
                found_.by[k] = by_angles;
            }
        }
    }

    /// A DEM is used regardless of the drawing.
    void judge_drawing() {
        is_drawn_well_ = params_.dem == nullptr &&
                         (is_consistent() || holds_for_undirected([](Drawing const& g) { return g.is_downstream(); }));
        is_drawn_upstream_ = params_.dem == nullptr && !is_drawn_well_ && is_drawn_upstream();
    }

    /// Whether lines were consistently drawn downstream, with loops. Of nodes of three lines drawn at random a quarter
    /// is contradicted, of two lines a half; lines drawn upstream fork more often than they meet.
    bool is_consistent() const {
        constexpr std::size_t enough = 5;
        constexpr std::size_t one_in = 40;
        Drawing sum;
        for (std::size_t g = 0; g < is_silent_.size(); ++g) {
            if (is_silent_[g] != 0) {
                Drawing const& one = drawings_.groups()[g];
                sum.inner += one.inner;
                sum.contradicted += one.contradicted;
                sum.confluences += one.confluences;
                sum.divergences += one.divergences;
            }
        }
        return sum.inner >= enough && one_in * sum.contradicted <= sum.inner && 2 * sum.confluences >= sum.divergences;
    }

    bool is_drawn_upstream() const {
        std::size_t divergences = 0;
        bool const all = holds_for_undirected([&](Drawing const& g) {
            divergences += g.divergences;
            return g.is_upstream();
        });
        return all && divergences > 0;
    }

    void score(RootedGroup& g) const {
        double const weight = vote_weight * logit(share_);
        double most = -std::numeric_limits<double>::infinity();
        for (Root const& r : g.roots) {
            most = std::max(most, weight * r.drawn);
        }
        for (Root const& r : g.roots) {
            double const behind = most - weight * r.drawn;
            g.score.push_back(r.geometry() + certain_weight_ * r.certain -
                              (is_drawn_upstream_ ? behind : std::min(most_votes, behind)));
        }
    }

    static std::size_t best_of(std::vector<double> const& score) {
        return static_cast<std::size_t>(std::ranges::max_element(score) - score.begin());
    }

    void direct(RootedGroup& g, ReachGraph const& graph, RootScores& scores) {
        score(g);
        Root const& root = g.roots[best_of(g.score)];
        scores.shortest_paths(root.node, ways_);
        Drawing const& drawing = drawings_.of(root.node);
        bool const agrees = share_ >= telling && drawing.is_downstream() && params_.dem == nullptr;
        bool const stays = is_drawn_well_ || confirms_[drawings_.group(root.node)] != 0 ||
                           (agrees && drawing.confluences >= telling_confluences);
        if (!stays) {
            turn(g, graph, scores);
        }
        if (g.is_said) {
            find_conflict(g);
        } else if (!stays && !is_drawn_upstream_) {
            doubt(g, root, scores);
        }
    }

    /// Sets the directions of a group's pieces along the paths to its root; in loops as drawn if that is consistent.
    void turn(RootedGroup const& g, ReachGraph const& graph, RootScores const& scores) {
        char const* const by = params_.dem != nullptr ? by_dem : share_ <= 1.0 - telling ? by_upstream : by_angles;
        int const drawn = share_ >= telling ? 1 : share_ <= 1.0 - telling ? -1 : 0;
        if (drawn != 0) {
            keep_drawn_blocks(g, graph, scores, drawn);
        }
        for (std::size_t const k : g.reaches->reaches) {
            Reach const& r = graph.reaches[k];
            bool const is_way = ways_.down[r.from] == k;
            bool const is_back = ways_.down[r.to] == k;
            bool forth = is_way || (!is_back && ways_.way_m[r.from] > ways_.way_m[r.to]);
            if (drawn != 0 && graph.is_bridge[k] == 0 && is_drawn_[k] != 0) {
                forth = drawn * scores.drawn()[k] > 0.0;
            }
            for (auto const& [piece, runs] : r.steps) {
                found_.runs[piece] = forth ? runs : -runs;
                if (found_.said[piece] == 0) {
                    found_.by[piece] = by;
                }
            }
        }
    }

    /// Marks the reaches whose block as drawn (or all reversed) leads from everywhere to the exit of its water.
    void keep_drawn_blocks(RootedGroup const& g, ReachGraph const& graph, RootScores const& scores, int drawn) {
        is_drawn_.resize(graph.reaches.size(), 0);
        std::vector<std::size_t> blocks;
        for (std::size_t const n : g.reaches->nodes) {
            blocks.push_back(graph.block[n]);
        }
        std::ranges::sort(blocks);
        blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
        auto const forth = [&](Way const& way) { return way.sign * drawn * scores.drawn()[way.reach] > 0.0; };
        for (std::size_t const b : blocks) {
            auto const& nodes = graph.block_nodes[b];
            std::size_t ends = 0; // nodes without an outflow in the block
            std::vector<std::pair<std::size_t, int>> arriving;
            bool is_whole = nodes.size() > 1;
            for (std::size_t const n : nodes) {
                int in = 0;
                int out = 0;
                for (Way const& way : graph.at[n]) {
                    if (graph.is_bridge[way.reach] == 0) {
                        is_whole = is_whole && std::fabs(scores.drawn()[way.reach]) == 1.0;
                        out += forth(way) ? 1 : 0;
                        in += forth(way) ? 0 : 1;
                    }
                }
                bool const is_exit = ways_.down[n] == RootScores::none || graph.is_bridge[ways_.down[n]] != 0;
                is_whole = is_whole && (out > 0) != is_exit;
                ends += out == 0 ? 1 : 0;
                arriving.emplace_back(n, in);
            }
            if (!is_whole || ends != 1 || !empties(graph, arriving, forth)) {
                continue;
            }
            for (std::size_t const n : nodes) {
                for (Way const& way : graph.at[n]) {
                    is_drawn_[way.reach] = graph.is_bridge[way.reach] == 0 ? 1 : 0;
                }
            }
        }
    }

    /// Whether a block has no cycle.
    template <class Forth>
    static bool empties(ReachGraph const& graph, std::vector<std::pair<std::size_t, int>> arriving,
                        Forth const& forth) {
        std::ranges::sort(arriving);
        std::vector<std::size_t> free;
        for (auto const& [n, in] : arriving) {
            if (in == 0) {
                free.push_back(n);
            }
        }
        for (std::size_t i = 0; i < free.size(); ++i) {
            for (Way const& way : graph.at[free[i]]) {
                if (graph.is_bridge[way.reach] == 0 && forth(way)) {
                    auto const to = std::ranges::lower_bound(arriving, std::pair(way.to, 0));
                    if (--to->second == 0) {
                        free.push_back(way.to);
                    }
                }
            }
        }
        return free.size() == arriving.size();
    }

    void doubt(RootedGroup const& g, Root const& root, RootScores& scores) {
        double const sum = log_sum(g.score);
        double wrong_m = 0.0;
        for (std::size_t i = 0; i < g.roots.size(); ++i) {
            wrong_m += portable::exp(g.score[i] - sum) * ways_.way_m[g.roots[i].node];
        }
        Directions& report = found_.report;
        Vec2 const at = p_.nodes[root.node];
        std::int64_t const feature = feature_at(root.node);
        double const length_m = g.reaches->length_m;
        if (wrong_m > most_wrong * length_m) {
            report.uncertain_m += length_m;
            report.expected_wrong_m += wrong_m;
            report.doubts.push_back(
                {"uncertain_direction", feature, at, wrong_m / length_m,
                 fmt::format("{:.6g} m of rivers run to ({:.6f}, {:.6f}); {:.3g} % of their length is expected to run "
                             "the other way",
                             length_m, at.x, at.y, 100.0 * wrong_m / length_m)});
        }
        auto const second = scores.second_outlet(*g.reaches, root.node, vote_weight * logit(share_));
        if (second.gain > second_gain) {
            Vec2 const there = p_.nodes[second.outlet];
            report.doubts.push_back({"second_outlet", feature_at(second.outlet), there, second.gain,
                                     fmt::format("rivers that run to ({:.6f}, {:.6f}) may have a second outlet at "
                                                 "({:.6f}, {:.6f})",
                                                 at.x, at.y, there.x, there.y)});
        }
    }

    /// Reports a conflict if the file's outlet is clearly not that of the geometry.
    void find_conflict(RootedGroup const& g) {
        std::vector<double> geometry;
        std::vector<double> said;
        for (Root const& r : g.roots) {
            geometry.push_back(r.geometry());
            said.push_back(r.certain);
        }
        std::size_t const one = best_of(said);
        std::size_t const other = best_of(geometry);
        if (one == other || geometry[other] - geometry[one] < conflict_gain) {
            return;
        }
        // The paths lead to the root of the highest score, here the file's outlet or one close to it.
        double const share =
            std::fabs(ways_.way_m[g.roots[other].node] - ways_.way_m[g.roots[one].node]) / g.reaches->length_m;
        if (share < most_wrong) {
            return;
        }
        Vec2 const at = p_.nodes[g.roots[one].node];
        Vec2 const there = p_.nodes[g.roots[other].node];
        found_.report.doubts.push_back(
            {"conflicting_direction", feature_at(g.roots[one].node), at, share,
             fmt::format("rivers run to ({:.6f}, {:.6f}) by {}, but by their {} they would run to ({:.6f}, {:.6f})",
                         at.x, at.y, speaks_[drawings_.group(g.roots[one].node)],
                         params_.dem != nullptr ? "angles and the DEM" : "angles", there.x, there.y)});
    }

    /// Lines that fork and nowhere meet are those of a delta as well, if they are few.
    void doubt_upstream(std::vector<RootedGroup> const& groups) {
        constexpr std::size_t most_forks = 8;
        for (RootedGroup const& g : groups) {
            Drawing const& drawing = drawings_.of(g.roots.front().node);
            if (is_silent_[drawings_.group(g.roots.front().node)] == 0 || drawing.divergences == 0 ||
                drawing.divergences > most_forks) {
                continue;
            }
            std::size_t const root = g.roots[best_of(g.score)].node;
            Vec2 const at = p_.nodes[root];
            found_.report.uncertain_m += g.reaches->length_m;
            found_.report.expected_wrong_m += 0.5 * g.reaches->length_m;
            found_.report.doubts.push_back(
                {"uncertain_direction", feature_at(root), at, 0.5,
                 fmt::format("{:.6g} m of rivers fork as they are drawn, and nowhere meet: they are taken for drawn "
                             "upstream and run to ({:.6f}, {:.6f}); those of a delta would run as drawn",
                             g.reaches->length_m, at.x, at.y)});
        }
    }

    std::int64_t feature_at(std::size_t node) const {
        return lines_[p_.pieces[p_.at_node[node].front()].line].number();
    }

    Pieces const& p_;
    std::vector<RiverLine> const& lines_;
    ImportParams const& params_;
    std::vector<Evidence>& evidence_;
    FoundDirections& found_;
    Drawings drawings_;
    std::vector<char const*> speaks_; ///< by group of drawings: evidence
    std::vector<char> confirms_;      ///< by group of drawings: evidence confirms the drawn direction of some lines
    std::vector<char> is_silent_;     ///< by group of drawings: some lines have neither evidence
    bool any_said_ = false;
    bool is_drawn_well_ = false;
    bool is_drawn_upstream_ = false;
    double share_ = 0.5;
    double certain_weight_ = vote_weight * logit(shares_drawn.back()); ///< of a reach whose direction the file gives
    RootScores::Ways ways_;
    std::vector<char> is_drawn_; ///< by reach
};

} // namespace

FoundDirections find_directions(Pieces const& p, std::vector<RiverLine> const& lines, ImportParams const& params,
                                std::vector<Evidence>& evidence, Run const& run) {
    std::size_t const pieces = p.pieces.size();
    FoundDirections found{
        std::vector<int>(pieces, 1), std::vector<int>(pieces, 0), std::vector<char const*>(pieces, by_drawing), {}, {}};
    if (params.orientation == Orientation::automatic || params.orientation == Orientation::links) {
        Director(p, lines, params, evidence, found).find(run);
    }
    return found;
}

Directions review_directions(Pieces const& p, std::vector<RiverLine> const& lines, FoundDirections const& found,
                             std::vector<PieceId> const& leaves) {
    Directions report = found.report;
    struct Tally {
        char const* by;
        double turned_m = 0.0;
        double said_m = 0.0;
        double against_m = 0.0;
        std::size_t against = no_piece; ///< the first piece that contradicts it
    };
    std::vector<Tally> tallies;
    for (std::size_t n = 0; n < p.nodes.size(); ++n) {
        PieceId const k = leaves[n];
        if (k == no_piece) {
            continue;
        }
        auto tally = std::ranges::find(tallies, found.by[k], &Tally::by);
        if (tally == tallies.end()) {
            tally = tallies.insert(tally, Tally{found.by[k]});
        }
        Piece const& piece = p.pieces[k];
        int const runs = piece.from == n ? 1 : -1;
        tally->turned_m += runs < 0 && lines[piece.line].feature != 0 ? piece.length_m : 0.0;
        if (found.said[k] != 0) {
            tally->said_m += piece.length_m;
            if (found.said[k] != runs) {
                tally->against_m += piece.length_m;
                tally->against = tally->against == no_piece ? k : tally->against;
            }
        }
    }
    std::ranges::stable_sort(tallies, std::greater(), &Tally::turned_m);
    for (Tally const& t : tallies) {
        if (t.turned_m > 0.0) {
            report.turned.push_back({t.by, t.turned_m});
        }
        bool const is_known = std::ranges::count(found.contradicted, t.by) > 0;
        if (!is_known && t.against_m > most_contradicted * t.said_m) {
            Piece const& piece = p.pieces[t.against];
            report.doubts.push_back({"contradicted_direction", lines[piece.line].number(), p.nodes[piece.from],
                                     t.against_m / t.said_m,
                                     fmt::format("{:.3g} % of the length that is oriented by {} runs against it",
                                                 100.0 * t.against_m / t.said_m, t.by)});
        }
    }
    return report;
}

} // namespace thalweg::network::import_steps
