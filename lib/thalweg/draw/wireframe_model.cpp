// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/draw/internal/wireframe_model.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <thalweg/draw/internal/axes.hpp>

namespace thalweg::draw {
namespace {

// The base lies below the lowest knot by the larger of these.
constexpr double base_of_relief = 0.06;
constexpr double base_of_side = 0.015; ///< as drawn

/// Relief of about a fifth of the land's greater side: 1, 2, 3, 5 times a power of ten, not below 1 unless the land is
/// steeper than that altogether.
double choose_exaggeration(double relief_m, double side_m) {
    if (!(relief_m > 0.0)) {
        return 1.0;
    }
    double const most = 0.22 * side_m / relief_m;
    if (most < 1.0 && most > 0.25) {
        return 1.0;
    }
    double const power = round_down(most) > 0.0 ? std::pow(10.0, std::floor(std::log10(most))) : 1.0;
    double chosen = power;
    for (double const factor : {2.0, 3.0, 5.0}) {
        chosen = factor * power <= most ? factor * power : chosen;
    }
    return std::clamp(chosen, 1e-6, 1e6);
}

Vec2 ground_of(Grid const& grid, double col, double row) {
    return {(col + 0.5) * grid.cell_m, -(row + 0.5) * grid.cell_m};
}

Net net_over(Fishnet const& knots, View const& view) {
    Net net;
    net.columns = knots.columns;
    net.rows = knots.rows;
    net.away_col = view.sine > 0.0 ? 1 : -1;
    net.away_row = view.cosine > 0.0 ? -1 : 1;
    return net;
}

Box box_around(std::vector<Vec2> const& places) {
    Vec2 least = places.front();
    Vec2 most = least;
    for (Vec2 const p : places) {
        if (std::isfinite(p.y)) {
            least = {std::min(least.x, p.x), std::min(least.y, p.y)};
            most = {std::max(most.x, p.x), std::max(most.y, p.y)};
        }
    }
    return {least.x, least.y, most.x - least.x, most.y - least.y};
}

} // namespace

View::View(double azimuth_deg, double elevation_deg, double exaggeration) {
    double bearing = azimuth_deg - 90.0 * std::floor(azimuth_deg / 90.0);
    // Seen end on a line would be a point: a twentieth of a degree shows no difference but to the arithmetic.
    double const turned = std::clamp(bearing, 0.05, 89.95) - bearing;
    bearing = (azimuth_deg + turned) * degree;
    sine = std::sin(bearing);
    cosine = std::cos(bearing);
    tilt = std::sin(elevation_deg * degree);
    upright = exaggeration * std::cos(elevation_deg * degree);
}

Model model_of(Raster<float> const& dem, WireframeParams const& params) {
    Model model;
    model.knots = fishnet(dem, params.lines);
    Fishnet const& knots = model.knots;
    bool const empty = knots.low_m > knots.high_m;
    double const low = empty ? 0.0 : knots.low_m;
    double const relief = empty ? 0.0 : knots.high_m - knots.low_m;
    double const side = dem.grid().cell_m * std::max(knots.col_at.back() - knots.col_at.front(),
                                                     knots.row_at.back() - knots.row_at.front());
    model.exaggeration = params.exaggeration > 0.0 ? params.exaggeration : choose_exaggeration(relief, side);
    View const view(params.azimuth_deg, params.elevation_deg, model.exaggeration);
    model.net = net_over(knots, view);
    Net& net = model.net;
    auto const place = [&](std::int64_t col, std::int64_t row) {
        return ground_of(dem.grid(), knots.col_at[col], knots.row_at[row]);
    };
    // Heights from the lowest: with those of a plateau the sheet would be far from the numbers' origin.
    double const base = -std::max(base_of_relief * relief, base_of_side * side / model.exaggeration);
    Feet feet;
    for (std::int64_t row = 0; row < net.rows; ++row) {
        for (std::int64_t col = 0; col < net.columns; ++col) {
            double const z = knots.height_m[row * net.columns + col];
            Vec2 const ground = place(col, row);
            net.at.push_back(view.at(ground, z - low));
            feet.push_back({view.at(ground, base), ground.x * view.sine + ground.y * view.cosine});
        }
    }
    hang_skirt(model, feet);

    std::int64_t const front_col = net.away_col > 0 ? 0 : net.columns - 1;
    std::int64_t const front_row = net.away_row > 0 ? 0 : net.rows - 1;
    std::int64_t const back_col = net.columns - 1 - front_col;
    std::int64_t const back_row = net.rows - 1 - front_row;
    model.base_corner = view.at(place(front_col, front_row), base);
    model.base_col_end = view.at(place(back_col, front_row), base);
    model.base_row_end = view.at(place(front_col, back_row), base);
    std::vector<Vec2> shown{model.base_corner, model.base_col_end, model.base_row_end,
                            view.at(place(back_col, back_row), base)};
    shown.insert(shown.end(), net.at.begin(), net.at.end());
    model.box = box_around(shown);
    return model;
}

} // namespace thalweg::draw
