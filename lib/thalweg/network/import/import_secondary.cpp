// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include <thalweg/network/import/internal/import_lines.hpp>

namespace thalweg::network::import_steps {
namespace {

constexpr char const* unfed = "goes on from a minor channel";

/// By node: the pieces out of the network that touch it, rings left aside.
std::vector<std::vector<std::size_t>> outside_at(Pieces const& p, Divided const& divided) {
    std::vector<std::vector<std::size_t>> at(p.nodes.size());
    for (std::size_t k = 0; k < p.pieces.size(); ++k) {
        if (divided.reason[k] != nullptr && p.pieces[k].from != p.pieces[k].to) {
            at[p.pieces[k].from].push_back(k);
            at[p.pieces[k].to].push_back(k);
        }
    }
    return at;
}

} // namespace

void drop_unfed(Pieces& p, Divided& divided, std::vector<PieceId>& leaves) {
    auto const outside = outside_at(p, divided);
    std::vector<int> arriving(p.nodes.size(), 0);
    auto const below = [&](std::size_t n) { return other_end(p.pieces[leaves[n]], n); };
    for (std::size_t n = 0; n < p.nodes.size(); ++n) {
        if (leaves[n] != no_piece) {
            ++arriving[below(n)];
        }
    }
    auto const runs_from = [&](std::size_t k, std::size_t n) {
        return divided.runs[k] != 0 && (divided.runs[k] > 0 ? p.pieces[k].from : p.pieces[k].to) == n;
    };
    for (std::size_t start = 0; start < p.nodes.size(); ++start) {
        bool const is_spring = leaves[start] != no_piece && runs_from(leaves[start], start) &&
                               std::ranges::all_of(outside[start], [&](std::size_t k) { return runs_from(k, start); });
        if (arriving[start] > 0 || outside[start].empty() || is_spring) {
            continue;
        }
        for (std::size_t n = start; leaves[n] != no_piece && arriving[n] == 0;) {
            PieceId const k = leaves[n];
            std::size_t const next = below(n);
            divided.reason[k] = unfed;
            leaves[n] = no_piece;
            std::erase(p.at_node[n], k);
            std::erase(p.at_node[next], k);
            --arriving[next];
            n = next;
        }
    }
}

std::vector<SecondaryLine> secondary_lines(Pieces const& p, Divided const& divided, std::vector<RiverLine> const& lines,
                                           std::vector<Finding>& repairs) {
    std::vector<SecondaryLine> secondary;
    for (std::size_t k = 0; k < p.pieces.size(); ++k) {
        if (divided.reason[k] == nullptr) {
            continue;
        }
        auto const& first = p.pieces[k];
        double length_m = first.length_m;
        std::size_t end = k;
        auto const goes_on = [&] {
            return end + 1 < p.pieces.size() && divided.reason[end + 1] != nullptr &&
                   std::string_view(divided.reason[end + 1]) == divided.reason[k] &&
                   p.pieces[end + 1].line == first.line && p.pieces[end + 1].first == p.pieces[end].last;
        };
        while (goes_on()) {
            length_m += p.pieces[++end].length_m;
        }
        auto const& line = lines[first.line];
        SecondaryLine one{line.feature, {}, divided.reason[k], line.feature};
        one.vertices.assign(line.vertices.begin() + static_cast<std::ptrdiff_t>(first.first),
                            line.vertices.begin() + static_cast<std::ptrdiff_t>(p.pieces[end].last) + 1);
        Vec2 const at{one.vertices.front().x, one.vertices.front().y};
        repairs.push_back({"secondary", line.number(), at, length_m,
                           fmt::format("river {} is secondary for {:.6g} m from ({:.6f}, {:.6f}): {}", line.number(),
                                       length_m, at.x, at.y, one.reason)});
        secondary.push_back(std::move(one));
        k = end;
    }
    return secondary;
}

} // namespace thalweg::network::import_steps
