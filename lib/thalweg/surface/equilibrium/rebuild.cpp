// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <utility>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/surface/equilibrium/internal/erodibility.hpp>
#include <thalweg/surface/equilibrium/internal/extract_terrain.hpp>
#include <thalweg/surface/equilibrium/internal/given_rivers.hpp>
#include <thalweg/surface/equilibrium/internal/known_features.hpp>
#include <thalweg/surface/equilibrium/internal/land.hpp>
#include <thalweg/surface/equilibrium/internal/rebuild_steps.hpp>
#include <thalweg/surface/equilibrium/internal/start_level.hpp>
#include <thalweg/surface/equilibrium/rebuild.hpp>

// Described in docs/rebuild.md.

namespace thalweg::surface {
namespace {

constexpr double per_degree = portable::pi / 180.0;
constexpr float steepest = 0.7F;  // tangent of threshold slopes
constexpr double of_smooth = 0.8; // mean slope of smooth terrain relative to that of textured terrain

void check_params(RebuildParams const& params) {
    constexpr char const* self = "surface.rebuild";
    require_in(self, "theta", params.theta, Range::between(0.1, 0.9));
    require_in(self, "hillslope_m", params.hillslope_m, Range::at_least(0.0), "m");
    require_in(self, "debris_area_m2", params.debris_area_m2, Range::at_least(0.0), "m²");
    require_in(self, "floor_width_km", params.floor_width_km, Range::between(0.0, 1.0), "km");
    require_in(self, "roughness", params.roughness, Range::between(0.0, 1.0));
    require_in(self, "longest_wave_m", params.longest_wave_m, Range::above(0.0), "m");
    if (params.relief_m) {
        require_in(self, "relief_m", *params.relief_m, Range::above(0.0), "m");
    }
    if (params.mean_slope_deg) {
        require_in(self, "mean_slope_deg", *params.mean_slope_deg, Range{0.0, 60.0, false, true}, "degrees");
    }
}

/// Lets no water leave at the frame but where the sea lies.
void close_frame(TerrainLevel& level) {
    for (std::int64_t row = 0; row < level.height; ++row) {
        for (std::int64_t col = 0; col < level.width; ++col) {
            std::int64_t const inner = std::clamp<std::int64_t>(row, 1, level.height - 2) * level.width +
                                       std::clamp<std::int64_t>(col, 1, level.width - 2);
            std::int64_t const i = row * level.width + col;
            if (inner != i && level.type[inner] != CellType::sea) {
                level.type[i] = CellType::outside;
            }
        }
    }
    each_inner(level, [&, offsets = level.offsets()](std::size_t i) {
        bool const rim = std::any_of(offsets.begin(), offsets.end(), [&](std::int64_t offset) {
            return level.type[moved(i, offset)] == CellType::outside;
        });
        if (rim) {
            level.type[i] = level.type[i] == CellType::land   ? CellType::rim
                            : level.type[i] == CellType::bank ? CellType::rim_bank
                                                              : level.type[i];
        }
    });
}

/// By channel: number of its link, the reach between two junctions.
std::vector<std::int32_t> links_of_channels(Channels const& rivers) {
    std::vector<std::int32_t> donors(rivers.cell.size(), 0);
    for (std::int64_t const r : rivers.receiver) {
        if (r >= 0) {
            ++donors[r];
        }
    }
    std::vector<std::int32_t> link(donors.size(), -1);
    std::int32_t count = 0;
    for (std::size_t n = link.size(); n-- > 0;) {
        link[n] = donors[n] == 1 ? link[n] : count++;
        if (std::int64_t const r = rivers.receiver[n]; r >= 0 && donors[r] == 1) {
            link[r] = link[n];
        }
    }
    return link;
}

/// Prescribed heights that fall at every step.
Channels falling(Channels rivers) {
    constexpr float least_m = 0.002F;
    for (std::size_t n = 0; n < rivers.cell.size(); ++n) {
        if (std::int64_t const r = rivers.receiver[n]; r >= 0) {
            bool const lake = !rivers.level.empty() && rivers.level[n] != 0;
            rivers.z[n] = lake ? rivers.z[r] : std::max(rivers.z[n], rivers.z[r] + least_m);
        }
    }
    return rivers;
}

double tangent_of(double degrees) {
    return portable::sin(degrees * per_degree) / portable::cos(degrees * per_degree);
}

double area_km2_of(double cell_m) {
    return cell_m * cell_m * 1e-6;
}

/// \param bend_km2 area below which slopes approach a constant
LandLaw land_law(double theta, double bend_km2, double hillslope_m, double cell_m) {
    double const k = portable::pow(area_km2_of(cell_m), theta);
    double const bend = bend_km2 / area_km2_of(cell_m);
    double const creep = hillslope_m / cell_m;
    double const power = k * AreaPower::of(creep * creep, theta, bend);
    return {AreaPower(theta, bend, k), static_cast<float>(power * creep)};
}

/// Smooth terrain of a level, and what the texture is held to.
struct SmoothLevel {
    Cells<float> z;
    Cells<float> boost;     ///< [log] of uplift below perched rivers; of the coarsest of these levels only
    Cells<float> to_divide; ///< [cells of the level]
};

class Rebuilder {
public:
    /// \param rivers, features heights in cells
    Rebuilder(Channels const& rivers, std::vector<FeatureCell> features, EquilibriumFields const& fields,
              RebuildParams const& params, RiverSurvey const& survey, double smooth_deg, Run const& run)
        : params_(params), run_(run), grid_(rivers.grid), features_(std::move(features)),
          spacing_(survey.spacing_m / rivers.grid.cell_m), target_deg_(smooth_deg),
          gentleness_(static_cast<float>(tangent_of(target_deg_) / usual_tangent)),
          least_(std::min(least_tangent, least_tangent * gentleness_)), link_(links_of_channels(rivers)) {
        EquilibriumParams padding;
        padding.edge = Edge::closed;
        EquilibriumFields given = fields;
        given.uplift = survey.steepness;
        for (std::int64_t i = 0; i < fields.uplift.cells(); ++i) {
            given.uplift[i] *= fields.uplift[i];
        }
        land_ = padded(rivers, given, padding);
        levels_ = level_inputs(land_, {}, rivers.grid, params.seed);
    }

    /// Mean slope of the smooth terrain that was wanted last.
    double smooth_deg() const { return target_deg_; }

    /// The finest level.
    TerrainLevel solve() {
        double const spacing_km = spacing_ * grid_.cell_m * 1e-3;
        double const spacing_km2 = spacing_km * spacing_km;
        double const hillslope_m = std::min(params_.hillslope_m, 50.0 * spacing_km);
        double const debris_km2 =
            std::max(std::min(params_.debris_area_m2 * 1e-6, 0.1 * spacing_km2), 5.0 * area_km2_of(grid_.cell_m));
        smooth(land_law(0.15, std::max(debris_km2, std::min(0.15, spacing_km2)), hillslope_m, grid_.cell_m));
        factor_ *= 0.5;
        return textured(land_law(params_.theta, debris_km2, hillslope_m, grid_.cell_m));
    }

private:
    static constexpr double usual_tangent = 0.31;
    static constexpr std::size_t textured_levels = 3;
    static constexpr int more_for_heights = 6;         ///< rounds
    static constexpr float most_boost = 2.0F;          ///< [log]
    static constexpr float least_correction = 0.1353F; ///< e^-2
    static constexpr float most_correction = 20.09F;   ///< e^3

    /// A level before its first round, without heights.
    TerrainLevel empty_level(std::size_t number, double roughness) const {
        LevelInput const& input = levels_[number];
        TerrainLevel level;
        level.width = input.extent.width + 2;
        level.height = input.extent.height + 2;
        level.corner = input.extent.corner;
        level.side = static_cast<float>(std::int64_t{1} << number);
        level.least = least_;
        level.rivers = input.rivers;
        set_cell_types(level, input.land, has_sea(params_.edge) ? Edge::coast : Edge::closed,
                       number == 0 ? RiverBanks::kept : RiverBanks::none);
        if (has_sea(params_.edge)) {
            close_frame(level);
        }
        set_crests(level, features_, grid_);
        ErodibilityParams rock;
        rock.roughness = roughness;
        rock.noise.seed = params_.seed;
        rock.noise.longest_wave =
            roughness > 0.0 ? std::max(std::min(params_.longest_wave_m / grid_.cell_m, 5.0 * spacing_), 3.0) : 0.0;
        rock.noise.octaves = 0;
        for (double wave = rock.noise.longest_wave; wave >= 2.0; wave /= 2.0) {
            ++rock.noise.octaves;
        }
        set_erodibility(level, land_.fields, rock, run_);
        level.rock.limit_by_half(steepest);
        level.jitter = params_.seed;
        run_.check();
        return level;
    }

    /// Gives rivers their heights.
    static void hold_rivers(TerrainLevel& level) {
        start_rivers(level);
        for (std::size_t n = 0; n < level.rivers.cell.size(); ++n) {
            level.z[level.rivers.cell[n]] = level.rivers.asked[n];
        }
    }

    /// The rivers, and the sea where it is, that land rises from.
    NearestRiver nearest_base(TerrainLevel const& level) const {
        std::vector<std::uint32_t> base(level.rivers.cell.begin(), level.rivers.cell.end());
        for (std::size_t i = 0; has_sea(params_.edge) && i < level.type.size(); ++i) {
            if (level.type[i] == CellType::sea) {
                base.push_back(static_cast<std::uint32_t>(i));
            }
        }
        return straight_to(level, base, run_);
    }

    /// Height of the river cell nearest to each cell; 0 at the sea.
    static Cells<float> valley_heights(TerrainLevel const& level, NearestRiver const& near) {
        Cells<float> heights(near.number.size(), 0.0F);
        for (std::size_t i = 0; i < heights.size(); ++i) {
            if (near.number[i] < level.rivers.asked.size()) {
                heights[i] = level.rivers.asked[near.number[i]];
            }
        }
        return heights;
    }

    /// Copies the boost of a coarser level.
    static Cells<float> boost_from(TerrainLevel const& level, TerrainLevel const& coarser, Cells<float> const& boost) {
        Cells<float> out(level.z.size(), 0.0F);
        each_inner(level, [&](std::size_t i) {
            Cell const c = level.at(i);
            out[i] = value_at(coarser, boost, place_in(coarser, level, c.col, c.row));
        });
        return out;
    }

    /// Multiplies what holds a level's terrain up.
    static void lift(TerrainLevel& level, Cells<float>& uplift, Cells<float> const& boost) {
        for (std::size_t i = 0; i < boost.size(); ++i) {
            if (boost[i] != 0.0F) {
                auto const factor = static_cast<float>(portable::exp(static_cast<double>(boost[i])));
                uplift[i] *= factor;
                level.rock.set_cap(i, level.rock.cap(i) * factor);
            }
        }
    }

    /// Share of the land that lies lower than the river nearest to it.
    double sunken_share(TerrainLevel const& level, Cells<float> const& valleys) const {
        float const tolerance = 0.05F * gentleness_ * level.side;
        std::int64_t land = 0;
        std::int64_t sunken = 0;
        for (std::size_t i = 0; i < level.z.size(); ++i) {
            if (is_land(level.type[i])) {
                ++land;
                sunken += level.z[i] < valleys[i] - tolerance ? 1 : 0;
            }
        }
        return land > 0 ? static_cast<double>(sunken) / static_cast<double>(land) : 0.0;
    }

    /// Raises land beside perched rivers and on the lower sides of crests, and moves it to known heights.
    void raise_where_wanted(TerrainLevel& level, KnownHeights const& known, Cells<float>& uplift,
                            Cells<float>& boost) const {
        WallParams walls;
        walls.tolerance *= gentleness_;
        walls.least_height *= gentleness_;
        walls.reach = static_cast<float>(std::min(90.0 / grid_.cell_m, 0.2 * spacing_)) / level.side;
        std::array lacks = {land_below_rivers(level, walls, run_), land_off_crests(level, walls, run_),
                            land_off_known(level, known, walls, run_)};
        for (Cells<float>& lack : lacks) {
            for (std::size_t i = 0; i < lack.size(); ++i) {
                lack[i] = std::clamp(lack[i], -most_boost - boost[i], most_boost - boost[i]);
                boost[i] += lack[i];
            }
            lift(level, uplift, lack);
            release(lack);
        }
    }

    /// Least heights: none.
    static Cells<float> no_floor(TerrainLevel const& level) {
        Cells<float> floor(level.z.size(), -std::numeric_limits<float>::infinity());
        return floor;
    }

    void scale_uplift(TerrainLevel& level, Cells<float> const& uplift) const {
        auto const k = static_cast<float>(factor_);
        std::transform(uplift.begin(), uplift.end(), level.uplift.begin(), [k](float of) { return k * of; });
    }

    void hold_mean_slope(TerrainLevel const& level) {
        double const now = mean_slope_deg(level, run_);
        double const step = std::clamp(target_deg_ / std::max(now, 1e-3), 0.5, 2.0);
        factor_ = std::clamp(factor_ * portable::pow(step, 0.7), 0.02 * first_factor, 20.0 * first_factor);
    }

    int rounds_of(std::size_t number) const {
        constexpr int fine = 6;
        constexpr int coarse = 30;
        auto const all = static_cast<int>(levels_.size()) - 1;
        return all > 0 ? fine + (coarse - fine) * static_cast<int>(number) / all : coarse;
    }

    /// Frees what neither the next level nor divides need.
    static void free_all_but_water(TerrainLevel& level) {
        level.rock = {};
        release(level.uplift);
        release(level.area);
    }

    void smooth(LandLaw const& law) {
        constexpr double most_sunken = 0.1; // real land: .03 or less
        constexpr double most_deg = 40.0;
        TerrainLevel coarser;
        Cells<float> coarse_boost;
        for (std::size_t number = levels_.size(); number-- > 0;) {
            TerrainLevel level = empty_level(number, 0.0);
            bool const first = coarser.z.empty();
            NearestRiver near = nearest_base(level);
            Cells<float> const valleys = valley_heights(level, near);
            if (first) {
                level.z.assign(static_cast<std::size_t>(level.cells()), 0.0F);
                for (std::size_t i = 0; i < level.z.size(); ++i) {
                    float const far = std::isinf(near.distance[i]) ? 0.0F : near.distance[i] * level.side;
                    level.z[i] = valleys[i] + 0.8F * static_cast<float>(factor_) * far;
                }
                roughen(level, params_.seed, 0.1F * gentleness_, run_);
            } else {
                start_from(level, coarser, params_.seed, {0.05F * gentleness_, 0.6F}, run_);
            }
            near = {};
            hold_rivers(level);
            Cells<float> uplift = level.uplift;
            Cells<float> boost = first ? Cells<float>(level.z.size(), 0.0F) : boost_from(level, coarser, coarse_boost);
            coarser = {};
            lift(level, uplift, boost);
            flood_terrain(level);
            Pull pull;
            if (!level.crests.empty()) {
                pull.floor = no_floor(level);
            }
            int const rounds = rounds_of(number);
            for (int round = 0; round < rounds; ++round) {
                run_.at(share_done(number, round, rounds) * 0.5, "fill");
                if (round > 0) { // with other nodes each time, whose chance is averaged
                    level.jitter = params_.seed + 1000 * static_cast<std::uint64_t>(round);
                    set_steepest_receivers(level, run_);
                }
                accumulate_areas(level, run_);
                scale_uplift(level, uplift);
                raise_crests(level, pull.floor);
                relax_terrain(level, law, pull, run_);
                if (round % 2 == 1) {
                    raise_where_wanted(level, {}, uplift, boost);
                    if (sunken_share(level, valleys) > most_sunken) {
                        double const more = std::max(1.08 * target_deg_, mean_slope_deg(level, run_));
                        target_deg_ = std::min(std::max(most_deg, target_deg_), more);
                    }
                }
                if (round >= 2 || first) {
                    hold_mean_slope(level);
                }
                run_.check();
            }
            release(uplift);
            free_all_but_water(level);
            if (number < textured_levels) {
                SmoothLevel& kept = smooth_[number];
                kept.to_divide = distance_to_divides(level, link_, run_);
                kept.z = number > 0 ? level.z : std::move(level.z);
                kept.boost = number + 1 == std::min(textured_levels, levels_.size()) ? boost : Cells<float>{};
            }
            coarse_boost = std::move(boost);
            coarser = std::move(level);
        }
    }

    /// Spring stiffness of a level's cells: weaker where rivers are far apart and valleys between them unknown, and
    /// here and there along divides, where gullies may reach them; greatest at known heights.
    Cells<float> springs(TerrainLevel const& level, LandLaw const& law, NearestRiver const& near,
                         Cells<float> const& to_divide, KnownHeights const& known) const {
        constexpr double everywhere = 0.1;
        constexpr double dense_m = 420.0; // spacing of rivers
        constexpr double firmer = 30.0;
        constexpr double firmest = 3000.0;
        constexpr double divide_cells = 2.25;
        constexpr double river_cells = 1.5;
        constexpr double wave = 12.0; // [finest cells]
        double const least = everywhere * std::min(1.0, dense_m / (spacing_ * grid_.cell_m)) *
                             static_cast<double>(law.power(level.side * level.side) / level.side);
        auto const fading = [&](float far, double reach) {
            double const t = static_cast<double>(far * level.side) / reach;
            return t < 3.0 ? portable::exp(-t * t) : 0.0;
        };
        auto const side = static_cast<std::int64_t>(level.side);
        auto const firm = [&](std::size_t i) {
            Cell const c = level.at(i);
            return std::clamp(1.0 + 1.5 * value_noise(params_.seed, {c.col * side, c.row * side}, wave), 0.0, 1.0);
        };
        Cells<float> out(level.type.size(), 0.0F);
        each_cell(level, [&](std::size_t i) {
            double const near_these =
                std::max(fading(to_divide[i], divide_cells), fading(near.distance[i], river_cells));
            double const more = near_these > 0.0 ? firmer * near_these * firm(i) : 0.0;
            out[i] = static_cast<float>(least * (1.0 + more));
        });
        if (!known.cell.empty()) {
            NearestRiver const to_known = straight_to(level, known.cell, run_);
            each_cell(level, [&](std::size_t i) {
                auto const far = static_cast<double>(to_known.distance[i]);
                double const more = far == 0.0 ? firmest : firmer * fading(to_known.distance[i], divide_cells);
                out[i] = std::max(out[i], static_cast<float>(least * (1.0 + more)));
            });
        }
        return out;
    }

    /// Land close to a river is not lower than it, unless the smooth terrain is.
    static Cells<float> floors(TerrainLevel const& level, Cells<float> const& smooth_z) {
        Cells<float> out = no_floor(level);
        auto const offsets = level.offsets();
        for (std::uint32_t const river : level.rivers.cell) {
            float const z = level.z[river];
            auto const raise = [&](std::size_t i) { out[i] = std::max(out[i], std::min(smooth_z[i], z)); };
            std::for_each(offsets.begin(), offsets.end(), [&](std::int64_t offset) { raise(moved(river, offset)); });
            each_of_second_ring(level, river, raise);
        }
        return out;
    }

    TerrainLevel textured(LandLaw const& law) {
        TerrainLevel level;
        Cells<float> boost;
        Cells<float> correction; // factor of uplift
        for (std::size_t number = std::min(textured_levels, levels_.size()); number-- > 0;) {
            SmoothLevel& like = smooth_[number];
            TerrainLevel coarser = std::exchange(level, empty_level(number, params_.roughness));
            land_.fields = number > 0 ? std::move(land_.fields) : ErodibilityFields{};
            NearestRiver near = straight_to(level, level.rivers.cell, run_);
            Cells<float> const valleys = valley_heights(level, near);
            KnownHeights const known = known_heights(level, features_, grid_);
            like.z = through_known(level, std::move(like.z), known, near, run_);
            Pull pull;
            pull.stiffness = springs(level, law, near, like.to_divide, known);
            release(like.to_divide);
            near = {};
            if (coarser.z.empty()) {
                level.z = like.z;
                roughen(level, params_.seed, 0.2F * gentleness_, run_);
                boost = std::move(like.boost);
                correction.assign(level.z.size(), 1.0F);
            } else {
                start_from(level, coarser, params_.seed, {0.02F * gentleness_, 0.6F}, run_);
                boost = boost_from(level, coarser, boost);
                correction = boost_from(level, coarser, correction);
            }
            coarser = {};
            hold_rivers(level);
            Cells<float> uplift = level.uplift;
            lift(level, uplift, boost);
            flood_terrain(level);
            if (number == 0 || !level.crests.empty()) {
                pull.floor = number == 0 ? floors(level, like.z) : no_floor(level);
            }
            Rows const inner{level.width - 2, level.height - 2, level.width};
            auto const first = static_cast<std::size_t>(level.width + 1);
            BlurParams const window{
                std::max<std::int64_t>(1, static_cast<std::int64_t>(std::min(500.0 / grid_.cell_m, 1.2 * spacing_) /
                                                                    static_cast<double>(level.side))),
                2};
            auto const blurred_heights = [&](Cells<float> const& z) {
                Cells<float> out(z.size(), 0.0F);
                each_cell(level, [&, above = out.data()](std::size_t i) {
                    above[i] = std::isinf(z[i]) ? 0.0F : std::max(z[i] - valleys[i], 0.0F);
                });
                blur(&out[first], inner, window, run_);
                return out;
            };
            Cells<float> const wanted = blurred_heights(like.z);
            auto const correct = [&](float some) {
                Cells<float> const has = blurred_heights(level.z);
                each_cell(level, [&](std::size_t i) {
                    float const step = std::sqrt((wanted[i] + some) / (has[i] + some));
                    correction[i] = std::clamp(correction[i] * step, least_correction, most_correction);
                });
            };
            int const rounds = rounds_of(number) + (known.cell.empty() ? 0 : more_for_heights);
            for (int round = 0; round < rounds; ++round) {
                run_.at(0.5 + share_done(number, round, rounds) * 0.5, "fill");
                if (round > 0) {
                    set_steepest_receivers(level, run_);
                }
                accumulate_areas(level, run_);
                if (number == 0 && round == floors_after && params_.floor_width_km > 0.0) {
                    valley_floors(level, {params_.floor_width_km, grid_.cell_m, params_.seed}, run_);
                }
                auto const k = static_cast<float>(factor_);
                level.uplift.resize(level.z.size());
                each_cell(level, [&, z = like.z.data()](std::size_t i) {
                    float const force = pull.stiffness[i] > 0.0F ? pull.stiffness[i] * z[i] : 0.0F;
                    level.uplift[i] = k * uplift[i] * correction[i] + force;
                });
                raise_crests(level, pull.floor);
                relax_terrain(level, law, pull, run_);
                release(level.area); // both follow anew in each round
                release(level.uplift);
                correct(0.5F * gentleness_);
                if (round % 2 == 1 || number == 0) {
                    raise_where_wanted(level, known, uplift, boost);
                }
                run_.check();
            }
            like = {};
        }
        open_crests(level);
        set_steepest_receivers(level, run_);
        accumulate_areas(level, run_);
        return level;
    }

    /// Calls visit(cell) on all workers.
    template <class Visit> void each_cell(TerrainLevel const& level, Visit visit) const {
        parallel_ranges(run_, level.height, least_rows(level.width), [&](std::int64_t begin, std::int64_t end) {
            for (std::int64_t i = begin * level.width; i < end * level.width; ++i) {
                visit(static_cast<std::size_t>(i));
            }
        });
    }

    static constexpr double first_factor = 0.2;

    RebuildParams const& params_;
    Run const& run_;
    Grid const& grid_;
    std::vector<FeatureCell> features_;
    double spacing_;    ///< [cells]
    double target_deg_; ///< mean slope of smooth terrain
    float gentleness_;  ///< scales small heights: 1 in mountains
    float least_;
    std::vector<std::int32_t> link_; ///< by channel
    PaddedTerrain land_;
    std::vector<LevelInput> levels_;
    double factor_ = first_factor; ///< of uplift
    std::array<SmoothLevel, textured_levels> smooth_;
};

struct BetweenRivers {
    EquilibriumTerrain terrain;
    double smooth_deg = 0.0; ///< as wanted, or more where rivers would stand above the land
};

/// The terrain around rivers with heights everywhere.
/// \param smooth_deg mean slope of smooth terrain
BetweenRivers terrain_between(Channels const& rivers, EquilibriumFields const& fields, RebuildParams const& params,
                              RiverSurvey const& survey, double smooth_deg, Run const& run) {
    double base_m = 0.0; // of the sea
    if (!has_sea(params.edge)) {
        base_m = static_cast<double>(*std::min_element(rivers.z.begin(), rivers.z.end()));
    }
    Channels drawn = rivers;
    double const cell_m = rivers.grid.cell_m;
    for (std::vector<float>* heights : {&drawn.z, &drawn.lake_z}) {
        for (float& z : *heights) {
            z = static_cast<float>((static_cast<double>(z) - base_m) / cell_m);
        }
    }
    std::vector<FeatureCell> features = fields.features;
    for (FeatureCell& feature : features) {
        feature.z = static_cast<float>((static_cast<double>(feature.z) - base_m) / cell_m);
    }
    Rebuilder rebuilder(drawn, std::move(features), fields, params, survey, smooth_deg, run);
    TerrainLevel level = rebuilder.solve();
    HeightConversion const raise{cell_m, base_m,
                                 tangent_of(params.mean_slope_deg.value_or(rebuilder.smooth_deg() / of_smooth))};
    return {extract_rebuilt(std::move(level), rivers, {rivers.grid, fields.land, 0}, raise, run),
            rebuilder.smooth_deg()};
}

/// What the mean slope of smooth terrain has to be multiplied by to have the mean slope or relief asked for.
double wanted_step(EquilibriumTerrain const& land, Channels const& rivers, RebuildParams const& params) {
    double step = 1.0 / std::max(land.target_share, 1e-3);
    if (params.relief_m) { // above the rivers, which are as high as they are
        auto const [low, high] = std::minmax_element(rivers.z.begin(), rivers.z.end());
        double const range_m = static_cast<double>(*high) - static_cast<double>(*low);
        double const now_m = land.target_share * *params.relief_m;
        step = (*params.relief_m - range_m) / std::max(now_m - range_m, 1e-3 * now_m);
    }
    return std::clamp(step, 0.25, 4.0);
}

/// The ratio of the terrain's relief or mean slope to what is asked for; 1 where nothing is.
double share_reached(EquilibriumTerrain const& land, RebuildParams const& params, Run const& run) {
    EquilibriumParams target;
    target.relief_m = params.relief_m;
    target.mean_slope_deg = params.mean_slope_deg.value_or(target.mean_slope_deg);
    bool const asked = params.mean_slope_deg || params.relief_m;
    return asked ? share_of_target(land.dem, 1.0 / land.dem.grid().cell_m, target, run) : 1.0;
}

} // namespace

RebuiltTerrain rebuild(Channels const& given, EquilibriumFields const& fields, RebuildParams const& params,
                       Run const& run) {
    check_params(params);
    check_rivers(given, fields);
    refuse_layers(fields, "heights of rivers", R"(network.heights = "graded" does without)");
    Channels rivers = with_heights(given);
    rivers = falling(has_levels(rivers) ? with_levels(std::move(rivers)) : std::move(rivers));
    RebuiltTerrain out;
    out.survey = survey_rivers(rivers, run);
    constexpr int most_solves = 6;
    constexpr double near_enough = 0.02;
    constexpr double steepest_deg = 45.0;
    double smooth_deg = params.mean_slope_deg ? of_smooth * *params.mean_slope_deg : out.survey.mean_slope_deg;
    double step = 1.0;
    double off = std::numeric_limits<double>::infinity();
    for (int solve = 0; solve < most_solves && off > near_enough; ++solve) {
        double const tried_deg = std::min(steepest_deg, smooth_deg * step);
        BetweenRivers next = terrain_between(rivers, fields, params, out.survey, tried_deg, run);
        next.terrain.target_share = share_reached(next.terrain, params, run);
        if (std::fabs(next.terrain.target_share - 1.0) < off) {
            off = std::fabs(next.terrain.target_share - 1.0);
            smooth_deg = tried_deg;
            out.smooth_slope_deg = next.smooth_deg;
            out.terrain = std::move(next.terrain);
            step = wanted_step(out.terrain, rivers, params);
        } else {
            step = std::sqrt(step);
        }
    }
    return out;
}

} // namespace thalweg::surface
