// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <tuple>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/geometry/crossings.hpp>
#include <thalweg/network/import/internal/import_lines.hpp>

namespace thalweg::network::import_steps {
namespace {

using geometry::Crossing;

bool inside(Crossing const& c, std::vector<std::vector<Vec2>> const& plans) {
    return c.at != plans[c.line][c.segment] && c.at != plans[c.line][c.segment + 1];
}

// The vertex where the lines of one crossing shall meet: one of theirs or an earlier crossing where it lies that close,
// so that no segment becomes shorter than coordinates are exact.
Vec2 meeting(std::vector<Crossing const*> const& group, std::vector<std::vector<Vec2>> const& plans,
             std::vector<Vec2> const& earlier) {
    Vec2 const at = group.front()->at;
    Vec2 best = at;
    double least = same_point_m;
    auto const offer = [&](Vec2 p) {
        if (double const d = distance(at, p); d < least) {
            least = d;
            best = p;
        }
    };
    for (auto const* c : group) {
        offer(plans[c->line][c->segment]);
        offer(plans[c->line][c->segment + 1]);
    }
    if (best == at) {
        for (auto p = earlier.rbegin(); p != earlier.rend() && at.x - p->x < 3.0 * same_point_m; ++p) {
            offer(*p);
        }
    }
    return best;
}

} // namespace

void split(std::vector<RiverLine>& lines, Run const& run) {
    // Rounding a crossing bends its lines by less than a millionth of a millimetre, which can only matter where a third
    // line passes as close: each round is nearly always the last but one.
    constexpr int rounds = 16;
    Vec2 unsettled;
    for (int round = 0; round < rounds; ++round) {
        auto const plans = plan_of(lines);
        auto const found = geometry::crossings(plans, run);
        std::vector<Crossing const*> order;
        for (auto const& c : found) {
            order.push_back(&c);
        }
        std::ranges::stable_sort(order, {}, [](Crossing const* c) { return std::tuple(c->at.x, c->at.y); });
        std::vector<Insertion> additions;
        std::vector<Vec2> targets;
        for (std::size_t first = 0; first < order.size();) {
            std::size_t next = first + 1;
            while (next < order.size() && order[next]->at == order[first]->at) {
                ++next;
            }
            std::vector<Crossing const*> const group(order.begin() + static_cast<std::ptrdiff_t>(first),
                                                     order.begin() + static_cast<std::ptrdiff_t>(next));
            first = next;
            if (std::ranges::none_of(group, [&](auto const* c) { return inside(*c, plans); })) {
                continue;
            }
            Vec2 const target = meeting(group, plans, targets);
            targets.push_back(target);
            unsettled = target;
            for (auto const* c : group) {
                if (target != plans[c->line][c->segment] && target != plans[c->line][c->segment + 1]) {
                    additions.push_back({c->line, c->segment, c->along, target});
                }
            }
        }
        if (additions.empty()) {
            return;
        }
        insert(lines, std::move(additions));
        drop_repeats(lines);
    }
    throw BadInput(
        fmt::format("network.import_lines: rivers run so close together at ({:.6f}, {:.6f}) that their crossings "
                    "cannot be told apart; remove one of them there",
                    unsettled.x, unsettled.y));
}

} // namespace thalweg::network::import_steps
