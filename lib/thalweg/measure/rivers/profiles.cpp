// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/rivers/profiles.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/numbers/sums.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/core/same_grid.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/core/vec.hpp>

namespace thalweg::measure {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// A cell of a reach on the way down its lines.
struct Stop {
    std::int64_t cell = 0;
    double at_m = 0.0; ///< along the lines
};

/// The cells under a reach in downstream order, at their places along its lines.
std::vector<Stop> walk(flow::Reach const& reach, Grid const& grid) {
    std::vector<Stop> stops;
    double begun_m = 0.0;
    for (std::size_t part = 0; part < reach.lines.size(); ++part) {
        std::vector<Vec2> const& line = reach.lines[part];
        if (part > 0) { // straight on to where it comes back
            begun_m += distance(reach.lines[part - 1].back(), line.front());
        }
        std::vector<Cell> const cells = cells_along(line, grid, fmt::format("arc {}", reach.id));
        std::vector<double> way{0.0};
        for (std::size_t i = 1; i < cells.size(); ++i) {
            way.push_back(way.back() + std::sqrt(static_cast<double>(squared_cells(cells[i - 1], cells[i]))));
        }
        double const length_m = length_of(line);
        double const scale = way.back() > 0.0 ? length_m / way.back() : 0.0;
        for (std::size_t i = 0; i < cells.size(); ++i) {
            stops.push_back({grid.index(cells[i]), begun_m + way[i] * scale});
        }
        begun_m += length_m;
    }
    return stops;
}

constexpr std::int64_t no_place = -1;

class Builder {
public:
    Builder(flow::Reaches const& reaches, Raster<float> const& dem, flow::FlowField const& drainage, Run const& run)
        : reaches_(reaches), grid_(dem.grid()), steps_(flow::steps_to_outlet(reaches)),
          owners_(flow::river_cells(reaches, dem.grid(), run)), place_(owners_.size(), no_place),
          first_(reaches.size(), no_place) {
        for (flow::Reach const& reach : reaches) {
            profiles_.ds.push_back(reach.ds);
        }
        std::vector<std::size_t> order(reaches.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::ranges::stable_sort(order, {}, [&](std::size_t a) { return steps_[a]; });
        for (std::size_t const a : order) {
            run.check();
            add_reach(a, dem);
        }
        add_areas(drainage, run);
        carve(dem);
        find_main_inflows();
    }

    RiverProfiles take() { return std::move(profiles_); }

private:
    /// The owner of a cell under rivers.
    std::size_t owner_of(std::int64_t cell) const {
        auto const found = std::ranges::lower_bound(owners_, cell, {}, &flow::RiverCell::cell);
        return static_cast<std::size_t>(found - owners_.begin());
    }

    /// The place into which a reach flows: its last cell, if a reach downstream owns it or other rivers end there too,
    /// else the first of the next reach.
    std::int64_t place_below(std::size_t a, std::vector<Stop> const& stops) const {
        std::size_t const last = owner_of(stops.back().cell);
        bool const is_others = owners_[last].reach != a && place_[last] >= 0;
        if (reaches_[a].ds < 0) {
            return is_others && profiles_.receiver[static_cast<std::size_t>(place_[last])] < 0 ? place_[last]
                                                                                               : no_place;
        }
        std::int64_t first = no_place;
        for (flow::ReachId ds = reaches_[a].ds; ds >= 0; ds = reaches_[static_cast<std::size_t>(ds)].ds) {
            auto const below = static_cast<std::size_t>(ds);
            if (owners_[last].reach == below && place_[last] >= 0) {
                return place_[last];
            }
            first = first == no_place ? first_[below] : first;
        }
        return first;
    }

    void add_reach(std::size_t a, Raster<float> const& dem) {
        std::vector<Stop> const stops = walk(reaches_[a], grid_);
        std::vector<Stop> own;
        for (Stop const& stop : stops) {
            std::size_t const owner = owner_of(stop.cell);
            if (owners_[owner].reach == a && place_[owner] == no_place && !std::isnan(dem[stop.cell])) {
                own.push_back(stop);
                place_[owner] = 0; // taken
            }
        }
        if (own.empty()) {
            return;
        }
        std::int64_t receiver = place_below(a, stops);
        double end_m = receiver == no_place ? own.back().at_m : stops.back().at_m;
        for (auto stop = own.rbegin(); stop != own.rend(); ++stop) {
            auto const here = static_cast<std::int64_t>(profiles_.size());
            place_[owner_of(stop->cell)] = here;
            profiles_.cell.push_back(stop->cell);
            profiles_.receiver.push_back(receiver);
            profiles_.reach.push_back(a);
            profiles_.step_m.push_back(end_m - stop->at_m);
            receiver = here;
            end_m = stop->at_m;
        }
        first_[a] = receiver;
    }

    void add_areas(flow::FlowField const& drainage, Run const& run) {
        profiles_.area_m2.assign(profiles_.size(), 0.0);
        profiles_.is_cut.assign(profiles_.size(), 0);
        std::vector<std::int64_t> cells(profiles_.size(), 0);
        Raster<std::int32_t> const met = flow::first_met(owners_, drainage, run);
        for (std::int64_t i = 0; i < met.cells(); ++i) {
            std::int64_t const place = met[i] < 0 ? no_place : place_[static_cast<std::size_t>(met[i])];
            if (place >= 0) {
                ++cells[static_cast<std::size_t>(place)];
                if (at_edge(drainage, i)) {
                    profiles_.is_cut[static_cast<std::size_t>(place)] = 1;
                }
            }
        }
        for (std::size_t i = profiles_.size(); i-- > 0;) {
            profiles_.area_m2[i] = static_cast<double>(cells[i]) * grid_.cell_m * grid_.cell_m;
            if (profiles_.receiver[i] >= 0) {
                auto const below = static_cast<std::size_t>(profiles_.receiver[i]);
                cells[below] += cells[i];
                profiles_.is_cut[below] = std::max(profiles_.is_cut[below], profiles_.is_cut[i]);
            }
        }
    }

    bool at_edge(flow::FlowField const& drainage, std::int64_t cell) const {
        Cell const at = grid_.at(cell);
        return !std::ranges::all_of(d8_steps, [&](Cell step) {
            Cell const n{at.col + step.col, at.row + step.row};
            return grid_.contains(n) && drainage.direction[n] != flow::Direction::no_data;
        });
    }

    void carve(Raster<float> const& dem) {
        for (std::int64_t const cell : profiles_.cell) {
            profiles_.z_m.push_back(static_cast<double>(dem[cell]));
        }
        for (std::size_t i = profiles_.size(); i-- > 0;) {
            if (profiles_.receiver[i] >= 0) {
                double& below = profiles_.z_m[static_cast<std::size_t>(profiles_.receiver[i])];
                below = std::min(below, profiles_.z_m[i]);
            }
        }
    }

    void find_main_inflows() {
        profiles_.main_in.assign(profiles_.size(), no_place);
        for (std::size_t i = 0; i < profiles_.size(); ++i) {
            if (profiles_.receiver[i] < 0) {
                continue;
            }
            std::int64_t& main = profiles_.main_in[static_cast<std::size_t>(profiles_.receiver[i])];
            if (main == no_place || profiles_.area_m2[i] > profiles_.area_m2[static_cast<std::size_t>(main)]) {
                main = static_cast<std::int64_t>(i);
            }
        }
    }

    flow::Reaches const& reaches_;
    Grid const& grid_;
    std::vector<std::int64_t> steps_;
    std::vector<flow::RiverCell> owners_;
    std::vector<std::int64_t> place_; ///< by owner: its place in the profiles
    std::vector<std::int64_t> first_; ///< by reach: place of its first cell
    RiverProfiles profiles_;
};

void require_profiles(RiverProfiles const& rivers, char const* who) {
    std::size_t const cells = rivers.size();
    bool const is_whole = rivers.receiver.size() == cells && rivers.reach.size() == cells &&
                          rivers.step_m.size() == cells && rivers.area_m2.size() == cells &&
                          rivers.z_m.size() == cells && rivers.main_in.size() == cells && rivers.is_cut.size() == cells;
    refuse_if<BadInput>(!is_whole, who, "the profiles have values for different numbers of cells; give all of {}",
                        cells);
    for (std::size_t i = 0; i < cells; ++i) {
        auto const here = static_cast<std::int64_t>(i);
        bool const is_tree = rivers.receiver[i] >= no_place && rivers.receiver[i] < here &&
                             (rivers.main_in[i] == no_place || rivers.main_in[i] > here) &&
                             rivers.main_in[i] < static_cast<std::int64_t>(cells) && rivers.reach[i] < rivers.ds.size();
        refuse_if<BadInput>(
            !is_tree, who,
            "cell {} of the profiles does not belong to their tree; give them as river_profiles returns them", i);
    }
    for (flow::ReachId const ds : rivers.ds) {
        refuse_if<BadInput>(ds < no_place || ds >= std::ssize(rivers.ds), who, "reach {} does not exist", ds);
    }
}

void require_chi(RiverProfiles const& rivers, std::vector<double> const& chi, char const* who) {
    require_profiles(rivers, who);
    bool const are_known = std::ranges::all_of(chi, [](double x) { return std::isfinite(x); });
    refuse_if<BadInput>(chi.size() != rivers.size() || !are_known, who,
                        "{} values of chi for {} cells; give one number a cell, as chi_along does", chi.size(),
                        rivers.size());
}

/// Sums for the lines of height against chi, one for each basin.
struct BasinMoments {
    double n = 0.0;
    double x = 0.0;
    double y = 0.0;
    double xx = 0.0;
    double xy = 0.0;
    double yy = 0.0;
};

/// The share of the variance that lines through each basin explain; NaN: nothing varies.
double collinearity(RiverProfiles const& rivers, std::vector<double> const& chi) {
    std::vector<std::size_t> basin(rivers.size());
    std::vector<BasinMoments> basins;
    for (std::size_t i = 0; i < rivers.size(); ++i) {
        if (rivers.receiver[i] < 0) {
            basin[i] = basins.size();
            basins.emplace_back();
        } else {
            basin[i] = basin[static_cast<std::size_t>(rivers.receiver[i])];
        }
        BasinMoments& m = basins[basin[i]];
        m.n += 1.0;
        m.x += (chi[i] - m.x) / m.n;
        m.y += (rivers.z_m[i] - m.y) / m.n;
    }
    for (std::size_t i = 0; i < rivers.size(); ++i) {
        BasinMoments& m = basins[basin[i]];
        m.xx += (chi[i] - m.x) * (chi[i] - m.x);
        m.xy += (chi[i] - m.x) * (rivers.z_m[i] - m.y);
        m.yy += (rivers.z_m[i] - m.y) * (rivers.z_m[i] - m.y);
    }
    CompensatedSum explained;
    CompensatedSum all;
    for (BasinMoments const& m : basins) {
        if (m.n >= 3.0 && m.xx > 0.0 && m.yy > 0.0) {
            explained.add(m.xy * m.xy / m.xx);
            all.add(m.yy);
        }
    }
    return all.value() > 0.0 ? explained.value() / all.value() : nan;
}

/// Reaches without cells of their own, in those of their neighbours, carry what flows into them.
void pass_through(std::vector<flow::ReachId> const& ds, std::vector<ReachProfile>& profiles) {
    std::vector<std::int64_t> missing(ds.size(), 0); // inflows that have not been seen
    for (flow::ReachId const below : ds) {
        missing[static_cast<std::size_t>(below < 0 ? 0 : below)] += below < 0 ? 0 : 1;
    }
    for (std::size_t source = 0; source < ds.size(); ++source) {
        for (auto a = static_cast<flow::ReachId>(source); a >= 0 && missing[static_cast<std::size_t>(a)] == 0;) {
            auto const here = static_cast<std::size_t>(a);
            missing[here] = -1; // done
            a = ds[here];
            if (a < 0) {
                break;
            }
            ReachProfile const& from = profiles[here];
            ReachProfile& to = profiles[static_cast<std::size_t>(a)];
            if (to.cells == 0) {
                to.area_m2 += from.area_m2;
                to.is_cut = to.is_cut || from.is_cut;
                to.z_up_m = to.z_down_m = from.z_down_m;
                to.chi_up = to.chi_down = from.chi_down;
            }
            --missing[static_cast<std::size_t>(a)];
        }
    }
}

/// The place of a stem that stands highest above its lower convex hull.
struct Highest {
    std::size_t at = 0; ///< in the stem
    double above_m = 0.0;
};

/// \param line chi and height, chi not descending
Highest highest_above_hull(std::vector<Vec2> const& line, std::size_t begin, std::size_t end) {
    std::vector<std::size_t> hull;
    for (std::size_t i = begin; i <= end; ++i) {
        while (hull.size() >= 2) {
            Vec2 const a = line[hull[hull.size() - 2]];
            Vec2 const b = line[hull.back()];
            if ((b.x - a.x) * (line[i].y - a.y) - (b.y - a.y) * (line[i].x - a.x) > 0.0) {
                break; // b lies below the chord
            }
            hull.pop_back();
        }
        hull.push_back(i);
    }
    Highest highest{begin, 0.0};
    for (std::size_t h = 1; h < hull.size(); ++h) {
        Vec2 const a = line[hull[h - 1]];
        Vec2 const b = line[hull[h]];
        for (std::size_t i = hull[h - 1] + 1; i < hull[h]; ++i) {
            double const chord = b.x > a.x ? a.y + (b.y - a.y) * (line[i].x - a.x) / (b.x - a.x) : a.y;
            if (line[i].y - chord > highest.above_m) {
                highest = {i, line[i].y - chord};
            }
        }
    }
    return highest;
}

double slope_between(Vec2 a, Vec2 b) {
    return b.x > a.x ? (b.y - a.y) / (b.x - a.x) : nan;
}

} // namespace

RiverProfiles river_profiles(flow::Reaches const& reaches, Raster<float> const& dem, flow::FlowField const& drainage,
                             Run const& run) {
    require_same_grid(dem.grid(), drainage.grid(), "measure.river_profiles", "the DEM and its drainage",
                      "drain this DEM");
    return Builder(reaches, dem, drainage, run).take();
}

std::vector<double> chi_along(RiverProfiles const& rivers, double theta) {
    require_in("measure.chi_along", "theta", theta, Range::between(0.0, 2.0));
    require_profiles(rivers, "measure.chi_along");
    std::vector<double> chi(rivers.size(), 0.0);
    for (std::size_t i = 0; i < rivers.size(); ++i) {
        if (rivers.receiver[i] >= 0) {
            chi[i] = chi[static_cast<std::size_t>(rivers.receiver[i])] +
                     rivers.step_m[i] * portable::pow(rivers.area_m2[i], -theta);
        }
    }
    return chi;
}

std::optional<FittedTheta> fit_theta(RiverProfiles const& rivers, Run const& run) {
    constexpr double fine = 0.005;
    constexpr int steps_in_coarse = 10;
    constexpr int lowest = 20;   // 0.1
    constexpr int highest = 180; // 0.9
    std::optional<FittedTheta> best;
    int at = lowest;
    auto const try_step = [&](int step) {
        run.check();
        double const theta = fine * step;
        double const r2 = collinearity(rivers, chi_along(rivers, theta));
        if (!std::isnan(r2) && (!best || r2 > best->r2)) {
            best = FittedTheta{theta, r2};
            at = step;
        }
    };
    for (int step = lowest; step <= highest; step += steps_in_coarse) {
        try_step(step);
    }
    int const middle = at;
    for (int step = std::max(lowest, middle - steps_in_coarse); step <= std::min(highest, middle + steps_in_coarse);
         ++step) {
        try_step(step);
    }
    return best;
}

std::vector<double> steepness_along(RiverProfiles const& rivers, std::vector<double> const& chi,
                                    SteepnessParams const& params, Run const& run) {
    require_in("measure.steepness_along", "window_m", params.window_m, Range::above(0.0), "m");
    require_chi(rivers, chi, "measure.steepness_along");
    std::vector<double> steepness(rivers.size(), nan);
    parallel_ranges(run, static_cast<std::int64_t>(rivers.size()), 1024, [&](std::int64_t begin, std::int64_t end) {
        std::vector<Vec2> window;
        for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
            window.assign(1, {chi[i], rivers.z_m[i]});
            double way_m = 0.0;
            for (std::size_t at = i; rivers.receiver[at] >= 0;) {
                way_m += rivers.step_m[at];
                if (way_m > 0.5 * params.window_m) {
                    break;
                }
                at = static_cast<std::size_t>(rivers.receiver[at]);
                window.push_back({chi[at], rivers.z_m[at]});
            }
            way_m = 0.0;
            for (std::int64_t at = rivers.main_in[i]; at >= 0; at = rivers.main_in[static_cast<std::size_t>(at)]) {
                auto const above = static_cast<std::size_t>(at);
                way_m += rivers.step_m[above];
                if (way_m > 0.5 * params.window_m) {
                    break;
                }
                window.push_back({chi[above], rivers.z_m[above]});
            }
            if (auto const fit = fit_line(window)) {
                steepness[i] = fit->slope;
            }
        }
    });
    return steepness;
}

std::vector<ReachProfile> reach_profiles(RiverProfiles const& rivers, std::vector<double> const& chi) {
    require_chi(rivers, chi, "measure.reach_profiles");
    std::vector<ReachProfile> profiles(rivers.ds.size(), ReachProfile{0, 0.0, nan, nan, nan, nan});
    std::vector<std::vector<Vec2>> points(rivers.ds.size());
    for (std::size_t i = 0; i < rivers.size(); ++i) { // a reach's cells stand in upstream order
        ReachProfile& p = profiles[rivers.reach[i]];
        if (p.cells == 0) {
            std::size_t const end = rivers.receiver[i] < 0 ? i : static_cast<std::size_t>(rivers.receiver[i]);
            p.area_m2 += rivers.area_m2[i];
            p.z_down_m = rivers.z_m[end];
            p.chi_down = chi[end];
            p.is_cut = rivers.is_cut[i] != 0;
            if (end != i && rivers.ds[rivers.reach[i]] < 0) { // to an outlet that another river owns
                profiles[rivers.reach[end]].area_m2 -= rivers.area_m2[i];
            }
            if (end != i) {
                points[rivers.reach[i]].push_back({chi[end], rivers.z_m[end]});
            }
        }
        ++p.cells;
        p.z_up_m = rivers.z_m[i];
        p.chi_up = chi[i];
        points[rivers.reach[i]].push_back({chi[i], rivers.z_m[i]});
    }
    for (std::size_t a = 0; a < profiles.size(); ++a) {
        profiles[a].k_sn = fit_line(points[a]);
    }
    pass_through(rivers.ds, profiles);
    return profiles;
}

std::vector<Knickpoint> knickpoints(RiverProfiles const& rivers, std::vector<double> const& chi,
                                    KnickpointParams const& params, Run const& run) {
    require_in("measure.knickpoints", "drop_m", params.drop_m, Range::above(0.0), "m");
    require_chi(rivers, chi, "measure.knickpoints");
    std::vector<double> outlet_m(rivers.size(), 0.0);
    for (std::size_t i = 0; i < rivers.size(); ++i) {
        outlet_m[i] =
            rivers.receiver[i] < 0 ? 0.0 : outlet_m[static_cast<std::size_t>(rivers.receiver[i])] + rivers.step_m[i];
    }
    std::vector<Knickpoint> found;
    for (std::size_t mouth = 0; mouth < rivers.size(); ++mouth) {
        run.check();
        std::int64_t const below = rivers.receiver[mouth];
        if (below >= 0 && rivers.main_in[static_cast<std::size_t>(below)] == static_cast<std::int64_t>(mouth)) {
            continue; // in the course of a stem
        }
        std::vector<std::size_t> stem;
        if (below >= 0) {
            stem.push_back(static_cast<std::size_t>(below));
        }
        for (auto at = static_cast<std::int64_t>(mouth); at >= 0; at = rivers.main_in[static_cast<std::size_t>(at)]) {
            stem.push_back(static_cast<std::size_t>(at));
        }
        std::vector<Vec2> line;
        for (std::size_t const place : stem) {
            line.push_back({chi[place], rivers.z_m[place]});
        }
        std::vector<Highest> breaks;
        std::vector<std::pair<std::size_t, std::size_t>> open{{0, line.size() - 1}};
        while (!open.empty()) {
            auto const [begin, end] = open.back();
            open.pop_back();
            Highest const highest = highest_above_hull(line, begin, end);
            if (highest.above_m >= params.drop_m) {
                breaks.push_back(highest);
                open.emplace_back(begin, highest.at);
                open.emplace_back(highest.at, end);
            }
        }
        std::ranges::sort(breaks, {}, &Highest::at);
        for (std::size_t k = 0; k < breaks.size(); ++k) {
            std::size_t const at = breaks[k].at;
            std::size_t const lower = k == 0 ? 0 : breaks[k - 1].at;
            std::size_t const upper = k + 1 == breaks.size() ? line.size() - 1 : breaks[k + 1].at;
            found.push_back({stem[at], breaks[k].above_m, slope_between(line[at], line[upper]),
                             slope_between(line[lower], line[at]), outlet_m[stem[at]]});
        }
    }
    std::ranges::sort(found, {}, &Knickpoint::place);
    return found;
}

} // namespace thalweg::measure
