// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/core/same_grid.hpp>
#include <thalweg/measure/drainage/internal/agreement.hpp>

namespace thalweg::measure {
namespace {

constexpr std::uint8_t far_away = 3;

/// Calls visit(index, ring) for the 5 x 5 cells around a cell, ring 0, 1 or 2.
template <class Visit> void around(std::int64_t centre, Grid const& grid, Visit visit) {
    Cell const at = grid.at(centre);
    for (std::int64_t dr = -2; dr <= 2; ++dr) {
        for (std::int64_t dc = -2; dc <= 2; ++dc) {
            if (Cell const c{at.col + dc, at.row + dr}; grid.contains(c)) {
                visit(grid.index(c), static_cast<std::size_t>(std::max(std::abs(dr), std::abs(dc))));
            }
        }
    }
}

/// By cell: the ring of the nearest of some cells: 0, 1, 2 or far_away.
Raster<std::uint8_t> rings(std::vector<std::int64_t> const& cells, Grid const& grid) {
    Raster<std::uint8_t> near(grid, far_away);
    for (std::int64_t const i : cells) {
        around(i, grid,
               [&](std::int64_t n, std::size_t ring) { near[n] = std::min(near[n], static_cast<std::uint8_t>(ring)); });
    }
    return near;
}

using Counts = std::array<std::int64_t, 3>; ///< within 0, 1, 2 cells

double share(std::int64_t part, std::int64_t whole) {
    return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

Agreements of_counts(Counts const& hits, std::int64_t found, Counts const& met, std::int64_t rivers) {
    Agreements out;
    for (std::size_t k = 0; k < out.size(); ++k) {
        out[k] = {share(hits[k], found), share(met[k], rivers)};
    }
    return out;
}

Counts within(std::vector<std::int64_t> const& cells, std::vector<std::int64_t> const& of, Grid const& grid) {
    Raster<std::uint8_t> const near = rings(of, grid);
    Counts counts{};
    for (std::int64_t const i : cells) {
        for (std::size_t k = near[i]; k < counts.size(); ++k) {
            ++counts[k];
        }
    }
    return counts;
}

std::vector<std::int64_t> thresholds_to(std::int64_t most) {
    std::vector<std::int64_t> out;
    for (std::int64_t t = 16; t <= most; t *= 2) {
        out.push_back(t);
        if (t / 2 * 3 <= most) {
            out.push_back(t / 2 * 3);
        }
    }
    return out;
}

constexpr flow::ReachId no_reach = -1;
constexpr std::int64_t listed = 1000; ///< most findings of a kind that are listed

bool are_neighbours(Cell a, Cell b) {
    return std::max(std::abs(a.col - b.col), std::abs(a.row - b.row)) <= 1;
}

/// Adds the cells of a line to a mask, without corners: cells between two neighbours of each other.
void mark_without_corners(std::vector<Vec2> const& line, Mask& marked) {
    std::vector<Cell> const cells = cells_along(line, marked.grid());
    Cell last{};
    for (std::size_t i = 0; i < cells.size(); ++i) {
        if (i == 0 || i + 1 == cells.size() || !are_neighbours(last, cells[i + 1])) {
            marked[cells[i]] = 1;
            last = cells[i];
        }
    }
}

class Certifier {
public:
    Certifier(Raster<float> const& dem, flow::FlowField const& drainage, flow::Reaches const& reaches,
              Claims const& claims, Run const& run)
        : dem_(dem), drainage_(drainage), reaches_(reaches), claims_(claims), run_(run), grid_(dem.grid()),
          honoured_(flow::river_cells(reaches, grid_, run)), fed_(reaches.size(), 0) {
        out_.waived_cells = static_cast<std::int64_t>(
            std::erase_if(honoured_, [this](flow::RiverCell const& c) { return !is_honoured(c.cell); }));
        find_corners();
        for (flow::Reach const& reach : reaches) {
            ends_.push_back(ends_of(reach));
        }
        for (std::size_t r = 0; r < reaches.size(); ++r) {
            if (reaches[r].ds >= 0 && brings_water(ends_[r])) {
                fed_[reaches[r].ds] = 1;
            }
        }
    }

    Certificate certify() {
        report_depressions();
        find_lakes();
        follow_rivers();
        compare_traced(trace());
        auto const [cells, agreement] = best_threshold(drainage_.area_cells, with_data(), run_);
        out_.threshold_cells = cells;
        out_.extracted = agreement;
        compare_areas();
        return std::move(out_);
    }

private:
    /// First and last cell where a reach is honoured; -1: no part of it lies in the grid.
    struct Ends {
        std::int64_t first = -1;
        std::int64_t last = -1;
        bool waived = false; ///< its upper part is waived
    };

    bool is_honoured(std::int64_t cell) const { return claims_.honoured.cells() == 0 || claims_.honoured[cell] != 0; }

    Ends ends_of(flow::Reach const& reach) const {
        Ends ends;
        for (auto const& line : reach.lines) {
            for (Cell const cell : claims_.honoured.cells() == 0 ? cells_of_ends(line) : cells_along(line, grid_)) {
                std::int64_t const i = grid_.index(cell);
                ends.last = i;
                ends.waived = ends.waived || (ends.first < 0 && !is_honoured(i));
                ends.first = ends.first < 0 && is_honoured(i) ? i : ends.first;
            }
        }
        return ends;
    }

    std::vector<Cell> cells_of_ends(std::vector<Vec2> const& line) const {
        return line.empty() ? std::vector<Cell>{} : cells_of_vertices({line.front(), line.back()}, grid_);
    }

    /// False for a reach that is waived up to its last cell, the next one's first.
    static bool brings_water(Ends const& ends) { return !ends.waived || (ends.first >= 0 && ends.first != ends.last); }

    void find_corners() {
        Mask kept(grid_);
        for (flow::Reach const& reach : reaches_) {
            for (auto const& line : reach.lines) {
                mark_without_corners(line, kept);
            }
        }
        for (flow::RiverCell const& c : honoured_) {
            if (kept[c.cell] != 0) {
                rivers_.push_back(c);
            } else {
                corners_.push_back(c.cell);
            }
        }
    }

    /// The reach that owns a cell, corners too; no_reach: none.
    flow::ReachId owner_of(std::int64_t cell) const {
        auto const at = std::ranges::lower_bound(honoured_, cell, {}, &flow::RiverCell::cell);
        return at != honoured_.end() && at->cell == cell ? static_cast<flow::ReachId>(at->reach) : no_reach;
    }

    bool is_corner(std::int64_t cell) const { return std::ranges::binary_search(corners_, cell); }
    bool in_lake(std::int64_t cell) const { return lake_.cells() > 0 && lake_[cell] != 0; }

    void find(FindingKind kind, std::int64_t feature, Cell at, double amount, std::string text) {
        if (++told_[kind] <= listed) {
            Vec2 const where = grid_.centre(at);
            out_.findings.push_back({kind, feature, where, amount, std::move(text)});
        }
    }

    std::string place(Cell at) const {
        Vec2 const p = grid_.centre(at);
        return fmt::format("({:.1f}, {:.1f})", p.x, p.y);
    }

    std::int64_t next_of(std::int64_t i) const { return drainage_.receiver(i); }

    std::vector<std::int64_t> with_data() const {
        std::vector<std::int64_t> cells;
        for (flow::RiverCell const& c : rivers_) {
            if (!std::isnan(dem_[c.cell])) {
                cells.push_back(c.cell);
            }
        }
        return cells;
    }

    /// Whether a cell has a neighbour at its height.
    bool is_level(Cell at) const {
        return std::any_of(d8_steps.begin(), d8_steps.end(), [&](Cell step) {
            Cell const n{at.col + step.col, at.row + step.row};
            return grid_.contains(n) && dem_[n] == dem_[at]; // never NaN
        });
    }

    /// Marks the level cells around rivers in still water.
    void find_lakes() {
        if (claims_.still.cells() == 0) {
            return;
        }
        lake_ = Mask(grid_);
        std::vector<std::int64_t> level;
        for (std::int64_t i = 0; i < grid_.cells(); ++i) {
            if (claims_.still[i] != 0 && is_level(grid_.at(i))) {
                lake_[i] = 1;
                level.push_back(i);
            }
        }
        while (!level.empty()) {
            Cell const at = grid_.at(level.back());
            level.pop_back();
            for (Cell const step : d8_steps) {
                Cell const to{at.col + step.col, at.row + step.row};
                if (grid_.contains(to) && lake_[to] == 0 && dem_[to] == dem_[at]) {
                    lake_[to] = 1;
                    level.push_back(grid_.index(to));
                }
            }
        }
        for (flow::RiverCell const& c : rivers_) {
            out_.lake_cells += lake_[c.cell];
        }
    }

    /// Removes cells where it is undetermined whether water passes.
    std::vector<std::int64_t> plain(std::vector<std::int64_t> cells) const {
        std::erase_if(cells, [this](std::int64_t cell) { return in_lake(cell) || is_corner(cell); });
        return cells;
    }

    void report_depressions() {
        out_.depressions = static_cast<std::int64_t>(drainage_.depressions.size());
        out_.pit_cells = drainage_.pits;
        out_.pit_volume_m3 = drainage_.pit_volume_m3;
        for (flow::Depression const& d : drainage_.depressions) {
            out_.max_depth_m = std::max(out_.max_depth_m, d.max_depth_m);
            find("depression", 0, d.lowest, d.max_depth_m,
                 fmt::format("depression of {} cells, {:.3g} m deep, lowest at {}", d.cells, d.max_depth_m,
                             place(d.lowest)));
        }
    }

    /// Whether a reach is another one, or lies downstream of it.
    bool leads_to(std::size_t from, flow::ReachId to) const {
        for (auto at = static_cast<flow::ReachId>(from); at >= 0; at = reaches_[at].ds) {
            if (at == to) {
                return true;
            }
        }
        return false;
    }

    bool ends_river(flow::RiverCell const& c) const {
        return reaches_[c.reach].ds < 0 && ends_[c.reach].last == c.cell;
    }

    bool begins_river(flow::RiverCell const& c) const { return fed_[c.reach] == 0 && ends_[c.reach].first == c.cell; }

    void follow_rivers() {
        std::vector<std::int64_t> without(reaches_.size(), 0);
        std::vector<std::int64_t> first_without(reaches_.size(), -1);
        for (flow::RiverCell const& c : rivers_) {
            Cell const at = grid_.at(c.cell);
            if (std::isnan(dem_[c.cell])) {
                first_without[c.reach] = without[c.reach]++ == 0 ? c.cell : first_without[c.reach];
                continue;
            }
            ++out_.river_cells;
            if (grid_.on_border(at) && !ends_river(c) && !begins_river(c)) {
                ++out_.border_cells;
                find("border_cell", reaches_[c.reach].id, at, 0.0,
                     fmt::format("arc {} runs along the border of the DEM at {}", reaches_[c.reach].id, place(at)));
            }
            std::int64_t const next = next_of(c.cell);
            flow::ReachId const owner = next >= 0 ? owner_of(next) : no_reach;
            bool const on = ends_river(c) || in_lake(c.cell) || (owner != no_reach && leads_to(c.reach, owner));
            out_.following_cells += on ? 1 : 0;
            if (!on) {
                double const drop =
                    next < 0 ? 0.0 : static_cast<double>(dem_[c.cell]) - static_cast<double>(dem_[next]);
                find("water_leaves", reaches_[c.reach].id, at, drop,
                     fmt::format("arc {}: its water leaves it at {}", reaches_[c.reach].id, place(at)));
            }
        }
        for (std::size_t r = 0; r < reaches_.size(); ++r) {
            if (without[r] > 0) {
                Cell const at = grid_.at(first_without[r]);
                find("outside_dem", reaches_[r].id, at, static_cast<double>(without[r]),
                     fmt::format("arc {}: {} of its cells have no height in the DEM, the first at {}", reaches_[r].id,
                                 without[r], place(at)));
            }
        }
    }

    /// The outlet of a reach's water according to the network: the last cell of the last reach inside the grid.
    std::int64_t outlet_of(std::size_t reach) const {
        std::int64_t outlet = -1;
        for (auto at = static_cast<flow::ReachId>(reach); at >= 0; at = reaches_[at].ds) {
            Ends const& ends = ends_[at];
            outlet = ends.last >= 0 ? ends.last : outlet;
        }
        return outlet;
    }

    /// \return the cells of the ways of all sources' water, each once
    std::vector<std::int64_t> trace() {
        Mask passed(grid_);
        std::vector<std::int64_t> traced;
        for (std::size_t r = 0; r < reaches_.size(); ++r) {
            std::int64_t const source = ends_[r].first;
            if (fed_[r] != 0 || source < 0 || !brings_water(ends_[r]) || std::isnan(dem_[source])) {
                continue;
            }
            run_.check();
            ++out_.sources;
            std::int64_t const outlet = outlet_of(r);
            Cell const goal = grid_.at(outlet);
            bool arrives = false;
            std::int64_t last = source;
            for (std::int64_t at = source; at >= 0; at = next_of(at)) {
                last = at;
                if (passed[at] == 0) {
                    passed[at] = 1;
                    traced.push_back(at);
                }
                Cell const here = grid_.at(at);
                arrives = arrives || (std::abs(here.col - goal.col) <= 1 && std::abs(here.row - goal.row) <= 1);
                if (at == outlet) {
                    break;
                }
            }
            out_.arriving_sources += arrives ? 1 : 0;
            if (!arrives) {
                Vec2 const a = grid_.centre(grid_.at(last));
                Vec2 const b = grid_.centre(goal);
                find("source_astray", reaches_[r].id, grid_.at(source),
                     std::sqrt((a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y)),
                     fmt::format("arc {}: water from its source at {} does not come to its outlet at {}",
                                 reaches_[r].id, place(grid_.at(source)), place(goal)));
            }
        }
        return traced;
    }

    void compare_traced(std::vector<std::int64_t> const& traced) {
        std::vector<std::int64_t> const rivers = with_data();
        std::vector<std::int64_t> const running = plain(rivers);
        if (running.empty() && !rivers.empty()) {
            out_.traced.fill({1.0, 1.0}); // all river cells lie in lakes: nothing to trace
        } else {
            out_.traced = agreement(plain(traced), running, grid_);
            if (claims_.drawn.cells() > 0) {
                std::vector<std::int64_t> drawn;
                for (std::int64_t i = 0; i < grid_.cells(); ++i) {
                    if (claims_.drawn[i] != 0 && !std::isnan(dem_[i])) {
                        drawn.push_back(i);
                    }
                }
                out_.traced[0] = agreement(plain(traced), plain(std::move(drawn)), grid_)[0];
            }
        }
    }

    void compare_areas() {
        std::vector<double> const& ds_area_m2 = claims_.ds_area_m2;
        if (ds_area_m2.empty()) {
            return;
        }
        std::vector<std::int64_t> most(reaches_.size(), 0);
        for (flow::RiverCell const& c : rivers_) {
            most[c.reach] = std::max<std::int64_t>(most[c.reach], drainage_.area_cells[c.cell]);
        }
        double const cell_m2 = grid_.cell_m * grid_.cell_m;
        for (std::size_t r = 0; r < reaches_.size(); ++r) {
            if (most[r] > 0 && ds_area_m2[r] > 0.0) { // never NaN
                double const here = static_cast<double>(most[r]) * cell_m2;
                double const difference = std::fabs(here - ds_area_m2[r]) / ds_area_m2[r];
                ++out_.compared_areas;
                out_.close_areas += difference <= 0.05 ? 1 : 0;
                out_.max_area_difference = std::max(out_.max_area_difference, difference);
            }
        }
    }

    Raster<float> const& dem_;
    flow::FlowField const& drainage_;
    flow::Reaches const& reaches_;
    Claims const& claims_;
    Run const& run_;
    Grid const& grid_;
    std::vector<flow::RiverCell> honoured_; ///< ascending
    std::vector<flow::RiverCell> rivers_;   ///< of these without corners
    std::vector<std::int64_t> corners_;     ///< cells of these, ascending
    Mask lake_;                             ///< without cells: no lakes
    std::vector<Ends> ends_;
    std::vector<std::uint8_t> fed_; ///< another reach flows into it
    std::map<std::string, std::int64_t> told_;
    Certificate out_;
};

Check at_most(char const* name, std::int64_t value) {
    return {name, static_cast<double>(value), 0.0, value == 0};
}

Check at_least(char const* name, double value, double limit) {
    return {name, value, limit, value >= limit, Bound::at_least};
}

/// The cells with data under ridges, ascending, without duplicates.
std::vector<std::int64_t> cells_under(RidgeLines const& ridges, Raster<float> const& dem) {
    std::vector<std::int64_t> cells;
    for (RidgeLine const& ridge : ridges.lines) {
        for (Cell const c : cells_along(in_plan(ridge.line), dem.grid(), "a ridge")) {
            if (!std::isnan(dem[c])) {
                cells.push_back(dem.grid().index(c));
            }
        }
    }
    std::sort(cells.begin(), cells.end());
    cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
    return cells;
}

} // namespace

Agreements agreement(std::vector<std::int64_t> const& found, std::vector<std::int64_t> const& rivers,
                     Grid const& grid) {
    return of_counts(within(found, rivers, grid), static_cast<std::int64_t>(found.size()), within(rivers, found, grid),
                     static_cast<std::int64_t>(rivers.size()));
}

std::pair<std::int64_t, Agreements> best_threshold(Raster<flow::CellCount> const& area_cells,
                                                   std::vector<std::int64_t> const& rivers, Run const& run) {
    auto const areas = area_cells.values();
    std::vector<std::int64_t> const thresholds =
        thresholds_to(areas.empty() ? 0 : *std::max_element(areas.begin(), areas.end()));
    if (thresholds.empty()) {
        return {0, {}};
    }
    // Counts thresholds up to an area; counts are stored there and accumulated from above.
    auto const reached = [&](std::int64_t area) {
        return static_cast<std::size_t>(std::upper_bound(thresholds.begin(), thresholds.end(), area) -
                                        thresholds.begin());
    };
    std::vector<std::int64_t> found(thresholds.size() + 1, 0);
    std::vector<Counts> hits(thresholds.size() + 1, Counts{});
    std::vector<Counts> met(thresholds.size() + 1, Counts{});
    Raster<std::uint8_t> const near = rings(rivers, area_cells.grid());
    for (std::int64_t i = 0; i < area_cells.cells(); ++i) {
        if (area_cells[i] >= thresholds.front()) {
            std::size_t const bin = reached(area_cells[i]);
            ++found[bin];
            for (std::size_t k = near[i]; k < 3; ++k) {
                ++hits[bin][k];
            }
        }
    }
    run.check();
    for (std::int64_t const i : rivers) {
        std::array<std::int64_t, 3> most{};
        around(i, area_cells.grid(), [&](std::int64_t n, std::size_t ring) {
            for (std::size_t k = ring; k < most.size(); ++k) {
                most[k] = std::max<std::int64_t>(most[k], area_cells[n]);
            }
        });
        for (std::size_t k = 0; k < most.size(); ++k) {
            ++met[reached(most[k])][k];
        }
    }
    std::pair<std::int64_t, Agreements> best{0, {}};
    std::int64_t found_here = 0;
    Counts hits_here{};
    Counts met_here{};
    for (std::size_t bin = thresholds.size(); bin > 0; --bin) {
        found_here += found[bin];
        for (std::size_t k = 0; k < hits_here.size(); ++k) {
            hits_here[k] += hits[bin][k];
            met_here[k] += met[bin][k];
        }
        Agreements const here = of_counts(hits_here, found_here, met_here, static_cast<std::int64_t>(rivers.size()));
        if (best.first == 0 || here[1].f() >= best.second[1].f()) {
            best = {thresholds[bin - 1], here};
        }
    }
    return best;
}

std::vector<Check> Certificate::checks() const {
    std::vector<Check> all = {at_most("depressions", depressions), at_most("border_cells", border_cells),
                              at_most("sources_astray", sources - arriving_sources)};
    if (sources > 0) {
        all.push_back(at_least("trace_precision", traced[1].precision, 0.99));
        all.push_back(at_least("trace_recall", traced[1].recall, 0.95));
        all.push_back(at_least("trace_f_same_cell", traced[0].f(), 0.98));
    }
    return all;
}

Certificate certify(Raster<float> const& dem, flow::FlowField const& drainage, flow::Reaches const& reaches,
                    Claims const& claims, Run const& run) {
    require_same_grid(dem.grid(), drainage.direction.grid(), "measure.certify", "the DEM and its drainage",
                      "drain this DEM");
    refuse_if<BadInput>(!claims.ds_area_m2.empty() && claims.ds_area_m2.size() != reaches.size(), "measure.certify",
                        "{} areas for {} reaches", claims.ds_area_m2.size(), reaches.size());
    for (Mask const* const mask : {&claims.still, &claims.drawn, &claims.honoured}) {
        if (mask->cells() > 0) {
            require_same_grid(mask->grid(), dem.grid(), "measure.certify",
                              "what stands, is drawn or honoured and the DEM", "make both on one grid");
        }
    }
    return Certifier(dem, drainage, reaches, claims, run).certify();
}

ExtractedRidges extract_ridges(Raster<float> const& dem, RidgeLines const& ridges, Run const& run) {
    ExtractedRidges found;
    std::vector<std::int64_t> const asked = cells_under(ridges, dem);
    found.ridge_cells = static_cast<std::int64_t>(asked.size());
    if (asked.empty()) {
        return found;
    }
    Raster<float> upside_down = dem;
    for (float& z : upside_down.values()) {
        z = -z;
    }
    auto const [threshold, agreements] = best_threshold(flow::route(upside_down, run).area_cells, asked, run);
    found.threshold_cells = threshold;
    found.extracted = agreements;
    return found;
}

} // namespace thalweg::measure
