// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/import/internal/import_channels.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <tuple>

#include <thalweg/network/import/internal/import_lines.hpp>

namespace thalweg::network::import_steps {
namespace {

bool arrives(Pieces const& p, Divided const& divided, std::size_t k, std::size_t node) {
    auto const& piece = p.pieces[k];
    return divided.reason[k] == nullptr && piece.from != piece.to &&
           (divided.runs[k] > 0 ? piece.to : piece.from) == node;
}

bool departs(Pieces const& p, Divided const& divided, std::size_t k, std::size_t node) {
    auto const& piece = p.pieces[k];
    return divided.reason[k] == nullptr && piece.from != piece.to &&
           (divided.runs[k] > 0 ? piece.from : piece.to) == node;
}

template <class Test> std::size_t count_if(Pieces const& p, std::size_t node, Test const& test) {
    return static_cast<std::size_t>(std::ranges::count_if(p.at_node[node], test));
}

/// From a node along a piece, as far as a length: the direction in which it leads there.
Vec2 chord(Piece const& piece, RiverLine const& line, std::size_t node, double length_m) {
    auto const at = [&](std::size_t i) {
        auto const& v = line.vertices[piece.from == node ? piece.first + i : piece.last - i];
        return Vec2{v.x, v.y};
    };
    Vec2 const begin = at(0);
    double left = length_m;
    Vec2 end = begin;
    for (std::size_t i = 1; i <= piece.last - piece.first && left > 0.0; ++i) {
        double const step = distance(at(i - 1), at(i));
        double const share = step > left ? left / step : 1.0;
        end = {at(i - 1).x + share * (at(i).x - at(i - 1).x), at(i - 1).y + share * (at(i).y - at(i - 1).y)};
        left -= step;
    }
    return {end.x - begin.x, end.y - begin.y};
}

/// 1 straight on, -1 straight back.
double straightness(Pieces const& p, std::vector<RiverLine> const& lines, std::size_t node, std::size_t in,
                    std::size_t out) {
    auto const& a = p.pieces[in];
    auto const& b = p.pieces[out];
    double const along_m = 0.5 * std::min(a.length_m, b.length_m);
    Vec2 const back = chord(a, lines[a.line], node, along_m);
    Vec2 const on = chord(b, lines[b.line], node, along_m);
    double const product = std::sqrt((back.x * back.x + back.y * back.y) * (on.x * on.x + on.y * on.y));
    return product > 0.0 ? -(back.x * on.x + back.y * on.y) / product : 0.0;
}

} // namespace

std::vector<double> lengths_above(Pieces const& p, Divided const& divided) {
    std::vector<double> above(p.nodes.size(), 0.0);
    std::vector<std::size_t> awaited(p.nodes.size(), 0);
    std::vector<std::size_t> ready;
    for (std::size_t n = 0; n < p.nodes.size(); ++n) {
        awaited[n] = count_if(p, n, [&](std::size_t k) { return arrives(p, divided, k, n); });
        if (awaited[n] == 0) {
            ready.push_back(n);
        }
    }
    for (std::size_t i = 0; i < ready.size(); ++i) {
        std::size_t const n = ready[i];
        auto const ways = static_cast<double>(count_if(p, n, [&](std::size_t k) { return departs(p, divided, k, n); }));
        for (std::size_t const k : p.at_node[n]) {
            if (departs(p, divided, k, n)) {
                std::size_t const below = other_end(p.pieces[k], n);
                above[below] += above[n] / ways + p.pieces[k].length_m;
                if (--awaited[below] == 0) {
                    ready.push_back(below);
                }
            }
        }
    }
    return above;
}

std::size_t main_of(Pieces const& p, std::vector<RiverLine> const& lines, Divided const& divided,
                    std::vector<double> const& length_above, std::size_t node,
                    std::vector<std::size_t> const& branches) {
    if (branches.size() == 1) {
        return branches.front();
    }
    std::vector<std::size_t> in;
    std::ranges::copy_if(p.at_node[node], std::back_inserter(in),
                         [&](std::size_t k) { return arrives(p, divided, k, node); });
    auto const line = [&](std::size_t k) -> RiverLine const& { return lines[p.pieces[k].line]; };
    auto const greatest = std::ranges::max_element(in, {}, [&](std::size_t k) {
        return std::tuple(line(k).size, length_above[other_end(p.pieces[k], node)] + p.pieces[k].length_m);
    });
    auto const any_in = [&](auto const& test) {
        return std::ranges::any_of(in, [&](std::size_t k) { return test(line(k)); });
    };
    auto const key = [&](std::size_t k) {
        RiverLine const& own = line(k);
        int const marked = own.channel == Channel::main ? 1 : own.channel == Channel::minor ? -1 : 0;
        bool const named = any_in([&](RiverLine const& up) { return up.down == own.feature && own.feature != 0; });
        bool const goes_on = any_in([&](RiverLine const& up) { return &up == &own; });
        bool const same_name = any_in([&](RiverLine const& up) { return !own.name.empty() && up.name == own.name; });
        std::int64_t const low = own.rank == 0 ? std::numeric_limits<std::int64_t>::min() : -own.rank;
        double const straight = in.empty() ? 0.0 : straightness(p, lines, node, *greatest, k);
        Vec2 const end = p.nodes[other_end(p.pieces[k], node)];
        return std::tuple(marked, named, goes_on, own.size, same_name, low, straight, -end.x, -end.y);
    };
    return *std::ranges::max_element(branches, {}, key);
}

} // namespace thalweg::network::import_steps
