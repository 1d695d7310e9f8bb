// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <tuple>

#include <fmt/format.h>

#include <thalweg/measure/topology/internal/topology_steps.hpp>

// The numbers that a file holds of its trees: downstream arcs, orders, basins.
namespace thalweg::measure::topology_steps {

namespace {

void check_downstream(NetworkFile const& file, Graph const& g, std::vector<char> const& ambiguous, Findings& findings) {
    for (std::size_t a = 0; a < file.arcs.size(); ++a) {
        if (g.left_out[a] != 0) {
            continue;
        }
        FileArc const& arc = file.arcs[a];
        auto const next = g.out.at(g.ends[a][1]);
        std::int64_t const right = next.empty() ? 0 : file.arcs[next.front()].id;
        bool const agrees = next.empty() ? arc.ds_arc == 0 : std::any_of(next.begin(), next.end(), [&](std::size_t n) {
            return file.arcs[n].id == arc.ds_arc || ambiguous[n] != 0; // whose id may be the wrong one of both
        });
        if (!agrees) {
            findings.push_back({"ds_arc_mismatch", number_of(file, arc), start_of(arc),
                                static_cast<double>(right - file.id_shift),
                                fmt::format("arc {}: its ds_arc is {}, but arc {} leaves its to_node {} ({} for none)",
                                            number_of(file, arc), arc.ds_arc - file.id_shift, right - file.id_shift,
                                            arc.to_node, -file.id_shift)});
        }
    }
}

void check_order(NetworkFile const& file, FileArc const& arc, char const* name, std::int64_t given, std::int64_t right,
                 Findings& findings) {
    if (given != right) {
        findings.push_back(
            {fmt::format("{}_mismatch", name), number_of(file, arc), start_of(arc), static_cast<double>(right),
             fmt::format("arc {}: its {} is {} and should be {}", number_of(file, arc), name, given, right)});
    }
}

struct Orders {
    std::int64_t strahler = 1; ///< Strahler 1957
    std::int64_t shreve = 1;   ///< Shreve 1966
};

Orders orders_below(std::span<std::size_t const> in, std::vector<Orders> const& orders) {
    if (in.empty()) {
        return {};
    }
    Orders below{0, 0};
    std::int64_t of_highest = 0;
    for (std::size_t const a : in) {
        of_highest = orders[a].strahler > below.strahler ? 1 : of_highest + (orders[a].strahler == below.strahler);
        below.strahler = std::max(below.strahler, orders[a].strahler);
        below.shreve += orders[a].shreve;
    }
    below.strahler += of_highest > 1 ? 1 : 0;
    return below;
}

void check_orders(NetworkFile const& file, Graph const& g, std::size_t junctions, Findings& findings) {
    std::vector<Orders> orders(file.arcs.size(), Orders{0, 0}); // 0 while unknown
    std::vector<std::size_t> awaited;                           // by junction
    std::vector<std::size_t> ready;
    for (std::size_t j = 0; j < junctions; ++j) {
        awaited.push_back(g.in.at(j).size());
        if (awaited[j] == 0) {
            ready.push_back(j);
        }
    }
    for (std::size_t i = 0; i < ready.size(); ++i) {
        auto const out = g.out.at(ready[i]);
        if (out.size() != 1) {
            continue; // an outlet, or a river that divides
        }
        orders[out[0]] = orders_below(g.in.at(ready[i]), orders);
        if (std::size_t const to = g.ends[out[0]][1]; --awaited[to] == 0) {
            ready.push_back(to);
        }
    }
    for (std::size_t a = 0; a < file.arcs.size(); ++a) {
        if (orders[a].strahler == 0) {
            continue;
        }
        if (file.says.strahler) {
            check_order(file, file.arcs[a], "strahler", file.arcs[a].strahler, orders[a].strahler, findings);
        }
        if (file.says.shreve) {
            check_order(file, file.arcs[a], "shreve", file.arcs[a].shreve, orders[a].shreve, findings);
        }
    }
}

/// By arc: the junction of the outlet that its water reaches by ways that do not divide, none for no such.
std::vector<std::size_t> outlets_of(std::vector<Ends> const& ends, Graph const& g, std::size_t junctions) {
    std::vector<std::size_t> outlet(ends.size(), none);
    for (std::size_t j = 0; j < junctions; ++j) {
        if (!g.out.at(j).empty()) {
            continue;
        }
        auto const mouths = g.in.at(j);
        std::vector<std::size_t> above(mouths.begin(), mouths.end());
        while (!above.empty()) {
            std::size_t const a = above.back();
            above.pop_back();
            outlet[a] = j;
            if (g.out.at(ends[a][0]).size() == 1) {
                auto const in = g.in.at(ends[a][0]);
                above.insert(above.end(), in.begin(), in.end());
            }
        }
    }
    return outlet;
}

void check_basins(NetworkFile const& file, Graph const& g, std::size_t junctions, Findings& findings) {
    if (std::all_of(file.arcs.begin(), file.arcs.end(), [](FileArc const& arc) { return arc.basin == 0; })) {
        return;
    }
    auto const outlet = outlets_of(g.ends, g, junctions);
    std::vector<std::tuple<std::size_t, std::int64_t, std::size_t>> arcs; // outlet, basin, arc
    for (std::size_t a = 0; a < file.arcs.size(); ++a) {
        if (outlet[a] != none && g.left_out[a] == 0) {
            arcs.emplace_back(outlet[a], file.arcs[a].basin, a);
        }
    }
    std::sort(arcs.begin(), arcs.end());
    std::vector<std::tuple<std::int64_t, std::size_t, std::size_t>> basins; // basin of most arcs, its mouth, outlet
    for (std::size_t i = 0; i < arcs.size();) {
        std::size_t const of = std::get<0>(arcs[i]);
        std::size_t const mouth = g.in.at(of).front();
        std::int64_t const at_mouth = file.arcs[mouth].basin;
        std::int64_t most = 0;
        std::size_t count = 0;
        while (i < arcs.size() && std::get<0>(arcs[i]) == of) {
            std::size_t const first = i;
            std::int64_t const basin = std::get<1>(arcs[i]);
            while (i < arcs.size() && std::get<0>(arcs[i]) == of && std::get<1>(arcs[i]) == basin) {
                ++i;
            }
            if (i - first > count || (i - first == count && basin == at_mouth)) {
                most = basin;
                count = i - first;
            }
        }
        basins.emplace_back(most, mouth, of);
    }
    std::vector<std::int64_t> right(junctions, 0);
    for (auto const& [basin, mouth, of] : basins) {
        right[of] = basin;
    }
    for (std::size_t a = 0; a < file.arcs.size(); ++a) {
        FileArc const& arc = file.arcs[a];
        if (outlet[a] != none && g.left_out[a] == 0 && arc.basin != right[outlet[a]]) {
            findings.push_back({"basin_mismatch", number_of(file, arc), start_of(arc),
                                static_cast<double>(right[outlet[a]]),
                                fmt::format("arc {}: lies in basin {}, but the arcs with which it drains in basin {}",
                                            number_of(file, arc), arc.basin, right[outlet[a]])});
        }
    }
    std::sort(basins.begin(), basins.end());
    for (std::size_t i = 1; i < basins.size(); ++i) {
        auto const [basin, mouth, of] = basins[i];
        auto const [basin_before, mouth_before, of_before] = basins[i - 1];
        if (basin == basin_before) {
            FileArc const& arc = file.arcs[mouth];
            findings.push_back({"basin_mismatch", number_of(file, arc), start_of(arc), static_cast<double>(basin),
                                fmt::format("arc {}: ends in an outlet of its own but shares basin {} with arc {}",
                                            number_of(file, arc), basin, number_of(file, file.arcs[mouth_before]))});
        }
    }
}

} // namespace

void check_numbers(NetworkFile const& file, Joints const& joints, Graph const& meant,
                   std::vector<char> const& ambiguous, Findings& findings) {
    std::size_t const junctions = joints.junctions.ids.size();
    if (file.says.downstream) {
        check_downstream(file, meant, ambiguous, findings);
    }
    check_orders(file, meant, junctions, findings);
    if (file.says.basin) {
        check_basins(file, meant, junctions, findings);
    }
}

} // namespace thalweg::measure::topology_steps
