// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/recipe/internal/conversions.hpp>

#include <thalweg/io/crs/crs.hpp>
#include <thalweg/io/gdal/sources.hpp>
#include <thalweg/pipeline/recipe/internal/recipe_files.hpp>

#include <fmt/format.h>

#include <string>

namespace thalweg::pipeline {

namespace {

/// Far from its central meridian a UTM zone measures other lengths than the ground has, as other projections do.
std::vector<Finding> warn_of_stretch(Grid const& grid, Run const& run) {
    constexpr double much = 0.01;
    constexpr double percent = 100.0;
    if (io::is_distorted(grid) && !io::utm_number(grid.crs)) {
        io::GroundCell const ground = io::ground_cell(grid);
        double const metre = ground.side_m / grid.cell_m;
        std::string const words =
            fmt::format("metres of the grid's CRS, {:.60}, are {:.3g} m on the ground there. Name another CRS: --crs "
                        "{:.60}",
                        grid.crs, metre, ground.crs);
        run.say("warning: " + words);
        return {{"stretched", 0, {}, 1.0 / metre - 1.0, words}};
    }
    double const stretch = io::zone_stretch(grid);
    if (!(stretch > much)) {
        return {};
    }
    std::string const words =
        fmt::format("the grid reaches far beyond its UTM zone {}: lengths are up to {:.1f} % too long there. Name "
                    "another CRS: --crs EPSG:n",
                    grid.crs, percent * stretch);
    run.say("warning: " + words);
    return {{"stretched", 0, {}, stretch, words}};
}

} // namespace

std::vector<Finding> report_conversions(Recipe const& recipe, Grid const& grid, Run const& run) {
    std::vector<Finding> notes;
    for (NamedFile const& file : files_of(recipe)) {
        bool const is_lines = file.key->help.path == "network.lines.path";
        std::string const source_crs = is_lines ? recipe.network->lines.source_crs : "";
        for (std::string const& words :
             io::conversions_of(file_in(recipe, file.name), file.layer, grid.crs, source_crs)) {
            run.say(fmt::format("{:<6} {}", "units", words));
            notes.push_back({"converted", 0, {}, 0.0, words});
        }
    }
    std::vector<Finding> const stretched = warn_of_stretch(grid, run);
    notes.insert(notes.end(), stretched.begin(), stretched.end());
    return notes;
}

} // namespace thalweg::pipeline
