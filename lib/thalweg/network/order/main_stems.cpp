// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/order/main_stems.hpp>

#include <algorithm>
#include <cstddef>
#include <utility>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/network/order/internal/require_trees.hpp>

namespace thalweg::network {
namespace {

using OfArc = StemClues::OfArc;

/// Keeps the candidates that a test holds for, if there are any.
template <class Test> void keep_if_any(std::vector<ArcId>& candidates, Test const& holds) {
    std::vector<ArcId> kept;
    std::ranges::copy_if(candidates, std::back_inserter(kept), holds);
    if (!kept.empty()) {
        candidates = std::move(kept);
    }
}

/// Keeps the candidates of the greatest value.
template <class Value> void keep_greatest(std::vector<ArcId>& candidates, Value const& value) {
    auto const greatest = value(*std::ranges::max_element(candidates, {}, value));
    std::erase_if(candidates, [&](ArcId a) { return value(a) < greatest; });
}

/// Candidates at a node and the arc downstream of it.
class Choice {
public:
    Choice(StemClues const& clues, std::vector<ArcId> candidates, ArcId below)
        : clues_(clues), candidates_(std::move(candidates)), below_(below) {}

    void by_path() {
        if (std::int64_t const path = below_ == no_arc ? 0 : of(below_).path; path != 0) {
            keep_if_any(candidates_, [&](ArcId a) { return of(a).path == path; });
        }
    }
    void by_name() {
        if (below_ != no_arc && !of(below_).name.empty()) {
            keep_if_any(candidates_, [&](ArcId a) { return of(a).name == of(below_).name; });
        }
    }
    void by_level() {
        if (all([&](ArcId a) { return of(a).level > 0.0; })) {
            keep_greatest(candidates_, [&](ArcId a) { return -of(a).level; });
        }
    }
    void by_area() {
        if (all([&](ArcId a) { return of(a).area_m2 > 0.0; })) {
            keep_greatest(candidates_, [&](ArcId a) { return of(a).area_m2; });
        }
    }
    void by_size() {
        std::size_t const fields = of(candidates_.front()).size.size();
        for (std::size_t f = 0; f < fields; ++f) {
            auto const size = [&](ArcId a) { return f < of(a).size.size() ? of(a).size[f] : 0.0; };
            if (all([&](ArcId a) { return size(a) > 0.0; })) {
                keep_greatest(candidates_, size);
            }
        }
    }
    void by(std::vector<double> const& value) {
        keep_greatest(candidates_, [&](ArcId a) { return value[a]; });
    }
    ArcId chosen() const { return candidates_.front(); }

private:
    OfArc const& of(ArcId a) const { return clues_.arcs[a]; }
    template <class Test> bool all(Test const& holds) const { return std::ranges::all_of(candidates_, holds); }

    StemClues const& clues_;
    std::vector<ArcId> candidates_; ///< in ascending order
    ArcId below_;
};

} // namespace

std::vector<ArcId> main_inflows(StreamNetwork const& network, StemClues const& clues, MainBy by) {
    require_trees(network, "network.main_inflows");
    bool const has_clues = !clues.arcs.empty();
    refuse_if<BadInput>(has_clues && clues.arcs.size() != network.arc_count(), "network.main_inflows",
                        "{} clues for {} arcs; give those of this network", clues.arcs.size(), network.arc_count());
    bool const all_clues = has_clues && by == MainBy::file;
    std::vector<double> longest_m(network.arc_count(), 0.0); // flow path from a source to the arc's lower end
    std::vector<double> sum_m(network.arc_count(), 0.0);     // length of all arcs upstream, its own included
    std::vector<ArcId> main(network.node_count(), no_arc);
    for (auto n = network.upstream_order().rbegin(); n != network.upstream_order().rend(); ++n) { // sources first
        ArcId const below = network.out(*n);
        std::span<ArcId const> const in = network.in(*n);
        if (!in.empty()) {
            Choice choice(clues, {in.begin(), in.end()}, below);
            if (all_clues) {
                choice.by_path();
            }
            if (all_clues || (has_clues && by == MainBy::name)) {
                choice.by_name();
            }
            if (all_clues) {
                choice.by_level();
            }
            if (all_clues || (has_clues && by == MainBy::area)) {
                choice.by_area();
            }
            if (all_clues) {
                choice.by_size();
            }
            if (by == MainBy::arbolate || by == MainBy::name) {
                choice.by(sum_m);
            }
            choice.by(longest_m);
            main[*n] = choice.chosen();
        }
        if (below != no_arc) {
            for (ArcId const a : in) {
                longest_m[below] = std::max(longest_m[below], longest_m[a]);
                sum_m[below] += sum_m[a];
            }
            longest_m[below] += network.length_m(below);
            sum_m[below] += network.length_m(below);
        }
    }
    return main;
}

} // namespace thalweg::network
