// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/stream_network.hpp>
#include <thalweg/geometry/polylines.hpp>
#include <thalweg/studio/internal/drawing_steps.hpp>
#include <thalweg/studio/internal/drawn_coasts.hpp>
#include <thalweg/studio/internal/drawn_lines.hpp>
#include <thalweg/studio/internal/drawn_rivers.hpp>

namespace thalweg::studio {
namespace {

DrawnPin& require_pin(Drawing& drawing, std::size_t number) {
    require_part(drawing, {Part::Kind::pin, number});
    return drawing.pins[number];
}

/// Where a pin can stand.
/// \param moved number of a pin that is moved; none for a new one
Vec2 require_pin_place(Drawing const& drawing, Vec2 wanted, std::size_t moved) {
    Grid const& grid = drawing.grid;
    refuse_step_if(!is_finite(wanted), "a place that is not a number");
    Vec2 const at = clip_to_grid(grid, wanted);
    refuse_step_if(lies_in_sea(drawing, at), "this place lies in the sea: a pin stands on land", at);
    refuse_step_if(nearest_on_rivers(drawing, at, no_number, in_river_cells * grid.cell_m).river != no_number,
                   "a river runs here, and its height decides: set the pin beside it", at);
    for (std::size_t i = 0; i < drawing.pins.size(); ++i) {
        refuse_step_if(i != moved && grid.cell_of(drawing.pins[i].at) == grid.cell_of(at),
                       "there is a pin in this cell already: set its height", at);
    }
    return at;
}

void set_end_heights(DrawnRidge& ridge, std::optional<double> from_m, std::optional<double> to_m) {
    for (std::optional<double> const& height_m : {from_m, to_m}) {
        if (height_m) {
            require_height(*height_m, "the height of a ridge");
        }
    }
    ridge.heights_m.resize(ridge.line.size());
    if (!from_m && !to_m) {
        std::ranges::fill(ridge.heights_m, std::nullopt);
    }
    ridge.heights_m.front() = from_m;
    ridge.heights_m.back() = to_m;
}

/// The longest part of a ridge that keeps away from rivers, with a message on what is left out.
/// \throws NotDrawn where that part is short
DrawnLine cut_ridge_at_rivers(DrawResult& result, DrawnLine line) {
    constexpr double most_lost = 1.0 / 3.0;
    constexpr double straight_cells = 0.05;
    double const cell_m = result.drawing.grid.cell_m;
    DrawnLine const places = resample_line(line, sampling_cells * cell_m);
    std::vector<bool> const is_near = find_near_lines(places, result.drawing.rivers, clearance_cells * cell_m);
    auto const first = static_cast<std::size_t>(std::ranges::find(is_near, true) - is_near.begin());
    if (first == places.size()) {
        return line;
    }
    DrawnLine longest;
    DrawnLine part;
    for (std::size_t i = 0; i <= places.size(); ++i) {
        if (i < places.size() && !is_near[i]) {
            part.push_back(places[i]);
            continue;
        }
        longest = length_of(part) > length_of(longest) ? part : longest;
        part.clear();
    }
    double const lost_m = length_of(line) - length_of(longest);
    refuse_step_if(length_of(longest) < least_length_cells * cell_m || lost_m > most_lost * length_of(line),
                   "the ridge would cross or touch a river here: let it end short of it", places[first]);
    result.said.push_back(fmt::format("the ridge ends short of the river: {:.3g} km were left out", lost_m / 1e3));
    return round_line(geometry::simplify(longest, straight_cells * cell_m));
}

} // namespace

void apply_step(DrawResult& result, DrawPin const& step) {
    result.name = fmt::format("a pin at {} m", step.height_m);
    require_height(step.height_m, "the height of a pin");
    result.drawing.pins.push_back({require_pin_place(result.drawing, step.at, no_number), step.height_m});
}

void apply_step(DrawResult& result, SetHeight const& step) {
    result.name = fmt::format("pin height {} m", step.height_m);
    require_height(step.height_m, "the height of a pin");
    require_pin(result.drawing, step.pin).height_m = step.height_m;
}

void move_pin(DrawResult& result, MoveVertex const& step) {
    result.name = "a pin moved";
    DrawnPin& pin = require_pin(result.drawing, step.of.number);
    pin.at = require_pin_place(result.drawing, step.to, step.of.number);
}

void apply_step(DrawResult& result, DrawRidge const& step) {
    result.name = "a ridge";
    DrawnRidge ridge{cut_ridge_at_rivers(result, line_on_land(result, step.points, "ridge")), {}};
    set_end_heights(ridge, step.from_m, step.to_m);
    result.drawing.ridges.push_back(std::move(ridge));
}

void apply_step(DrawResult& result, SetRidgeHeights const& step) {
    line_of_part(result.drawing, {Part::Kind::ridge, step.ridge}, 0);
    set_end_heights(result.drawing.ridges[step.ridge], step.from_m, step.to_m);
    result.name = step.from_m || step.to_m ? "heights of a ridge" : "a ridge with the terrain's heights";
}

} // namespace thalweg::studio
