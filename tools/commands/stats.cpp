// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <thalweg/commands/stats.hpp>
#include <thalweg/core/run/messages.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/report/report.hpp>

#include "commands/commands.hpp"
#include "commands/options.hpp"
#include "commands/print.hpp"

namespace thalweg::tools {

namespace {

std::string known(double figure, int digits) {
    return std::isnan(figure) ? "unknown" : fmt::format("{:.{}f}", figure, digits);
}

std::string length(solver::CorrelationLength const& l) {
    return known(l.cells, 2) + (l.extrapolated ? " (extrapolated)" : "");
}

std::string value_of(make::LawRow const& row) {
    return row.value ? fmt::format("{:.4g}{}{}", *row.value, row.unit.empty() ? "" : " ", row.unit) : "unknown";
}

/// inside: laws of the rivers whose areas the edge does not cut, or null.
void print_rows(measure::NetworkLaws const& laws, measure::NetworkLaws const* inside = nullptr) {
    auto const rows_inside = inside == nullptr ? std::vector<make::LawRow>{} : make::law_rows(*inside);
    fmt::print("{:58}  {}in nature\n", "", inside == nullptr ? "" : "inside            ");
    for (std::size_t i = 0; make::LawRow const& row : make::law_rows(laws)) {
        std::string const within = inside == nullptr ? "" : fmt::format("{:<16}  ", value_of(rows_inside[i++]));
        std::string const range =
            row.nature != nullptr ? fmt::format("{:g} to {:g}", row.nature->low, row.nature->high) : "";
        std::string fit;
        for (auto const& [name, figure] : row.details) {
            if (name == "r2" && !std::isnan(figure)) {
                fit = fmt::format("r2 {:.3f}", figure);
            }
        }
        fmt::print("{:<28}  {:<16}  {:<10}  {}{}\n", row.name, value_of(row), fit, within, range);
    }
}

void print_laws(make::DemLaws const& found) {
    fmt::print("\nrivers where at least {} cells ({:.3g} km²) drain\n"
               "inside: {} of {} arcs, whose areas lie whole inside the data\n",
               found.support_cells, found.support_m2 / 1e6, found.arcs_inside, found.arcs);
    print_rows(found.laws, found.inside ? &*found.inside : nullptr);
}

void print_line_laws(make::LineLaws const& found) {
    fmt::print("{} arcs of {:.1f} km, {} outlets", found.arcs, found.length_m / 1e3, found.outlets);
    if (found.left_out > 0) {
        fmt::print("; {} lines of {:.1f} km are not in the tree", found.left_out, found.left_out_m / 1e3);
    }
    fmt::print("\n\n{:>5}  {:>8}  {:>12}  {:>12}  {}\n", "order", "streams", "length, km", "area, km²",
               "side branches one, two ... orders lower, of all");
    for (measure::StreamOrder const& order : found.laws.horton.orders) {
        std::string branches;
        for (std::int64_t const count : found.streams.branches[static_cast<std::size_t>(order.order) - 1]) {
            branches += fmt::format("{} ", count);
        }
        fmt::print("{:>5}  {:>8}  {:>12.4g}  {:>12}  {}\n", order.order, order.streams, order.length_m / 1e3,
                   order.area_m2 > 0.0 ? fmt::format("{:.4g}", order.area_m2 / 1e6) : "unknown", branches);
    }
    fmt::print("\n");
    print_rows(found.laws);
}

void print_relief(make::TerrainRelief const& found) {
    fmt::print("\n{:<42}{:>8}", "relief", "here");
    for (measure::ReferenceDem const& land : measure::reference_dems()) {
        fmt::print("  {:>11}", land.name);
    }
    fmt::print("  reference range\n");
    for (make::ReliefRow const& row : make::relief_rows(found)) {
        fmt::print("{:<42}{:>8}", row.name, row.value ? fmt::format("{:.3g}", *row.value) : "unknown");
        for (double const figure : row.beside) {
            fmt::print("  {:>11.3g}", figure);
        }
        if (row.range) {
            fmt::print("  {:.3g} to {:.3g}{}", row.range->low, row.range->high, row.ok() ? "" : ": outside");
        }
        fmt::print("\n");
    }
}

void print_recipe(recipe::DemRecipe const& made) {
    for (std::string const& note : made.notes) {
        fmt::print("# {}\n", printable(note));
    }
    fmt::print("{}", recipe::write_recipe(made.recipe));
}

int stats(commands::StatsParams const& params, Session const& session) {
    refuse_if<BadParameter>(params.recipe && session.json, "commands.run_stats",
                            "thalweg stats prints a recipe or JSON: give --recipe or --json, not both");
    commands::StatsResult const found = commands::run_stats(params, session.run);
    if (found.recipe) {
        print_recipe(*found.recipe);
        return Exit::done;
    }
    if (found.lines) {
        if (session.json) {
            print_result(session, nlohmann::ordered_json::parse(report::line_laws_json(*found.lines)), {}, -1);
        } else {
            print_line_laws(*found.lines);
        }
        return Exit::done;
    }
    measure::Statistics const& s = found.statistics;
    if (session.json) {
        print_result(session,
                     nlohmann::ordered_json::parse(report::statistics_json(s, found.laws ? &*found.laws : nullptr,
                                                                           found.relief ? &*found.relief : nullptr)),
                     {}, -1);
        return Exit::done;
    }
    fmt::print("cells      {} with data, {} without ({} x {})\n", s.cells, s.nodata, found.grid.width,
               found.grid.height);
    fmt::print("mean       {:.3f} m\n", s.mean);
    fmt::print("std        {:.3f} m\n", s.std);
    fmt::print("min        {:.3f} m at column {}, row {}\n", s.min.z, s.min.cell.col, s.min.cell.row);
    fmt::print("max        {:.3f} m at column {}, row {}\n", s.max.z, s.max.cell.col, s.max.cell.row);
    fmt::print("slope      {:.4f} rad in metres per cell, {:.2f} degrees on the ground\n", s.slope_rad,
               s.slope_true_deg);
    fmt::print("shape      skew {}, kurtosis {} (both 0 for a normal distribution)\n", known(s.skew, 3),
               known(s.kurtosis, 3));
    fmt::print("roughness  {} m between neighbours\n", known(s.roughness_m, 3));
    fmt::print("length     {} cells along rows, {} along columns\n", length(s.lx), length(s.ly));
    fmt::print("dimension  {} from lags 1 to 5, {} from lags 1 to 32\n", known(s.dimension, 3),
               known(s.dimension_dyadic, 3));
    if (found.laws) {
        print_laws(*found.laws);
    }
    if (found.relief) {
        print_relief(*found.relief);
    }
    return Exit::done;
}

} // namespace

Command add_stats(CLI::App& app, Session& session) {
    auto const params = std::make_shared<commands::StatsParams>();
    app.add_option("DEM", params->path, "Any height raster GDAL reads; for --laws also a file of river lines.")
        ->type_name("FILE")
        ->required();
    add_dem_options(app, params->reading);
    add_json_option(app, session);
    CLI::Option* const recipe =
        app.add_flag("--recipe", params->recipe, "Print a recipe of other terrain with the same statistics, for make.");
    CLI::Option* const laws =
        app.add_flag("--laws", params->laws,
                     "Print network laws of the streams extracted from the DEM, or of river lines, with natural "
                     "ranges.")
            ->excludes(recipe);
    app.add_flag("--relief", params->relief, "Print morphometric indices, with those of reference DEMs.")
        ->excludes(recipe);
    app.add_option("--support", params->support_cells, "Start a stream where this many cells drain.")
        ->type_name("CELLS")
        ->check(CLI::Range(std::int64_t{1}, std::numeric_limits<std::int64_t>::max()))
        ->capture_default_str()
        ->needs(laws);
    app.footer("Prints count, mean, standard deviation, lowest and highest cell, mean slope, skewness and kurtosis, "
               "roughness, correlation lengths and fractal dimension. Cells without data are left out. With --laws: "
               "Horton's ratios, "
               "Tokunaga's a and c, Hack's exponent, concavity, drainage density, junction angles and links. "
               "With --relief: slopes, slope against area, pits, geomorphons, aspects (docs/relief_measures.md).\n\n"
               "Examples:\n"
               "  thalweg stats valley/dem.tif\n"
               "  thalweg stats samples/bigtujunga_srtm1.tif --laws --support 500\n"
               "  thalweg stats samples/new_hope_nhdplus.gpkg --laws\n"
               "  thalweg stats samples/jacksboro_srtm3.tif --recipe > alike.toml\n");
    return [params, &session] { return stats(*params, session); };
}

} // namespace thalweg::tools
