// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/skeleton/regress.hpp>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/solver/linear/linear.hpp>

namespace thalweg::skeleton {

namespace {

constexpr std::size_t term_count = 12;
using Terms = std::array<double, term_count>;

double at_least_half(double half) {
    return half > 0.0 ? half : 0.5; // a single row or column
}

/// The terms of the regression and their coordinates on a grid.
class Basis {
public:
    Basis(Grid const& grid, RegressParams const& params)
        : grid_(grid), params_(params), half_x_(at_least_half(0.5 * static_cast<double>(grid.width - 1))),
          half_y_(at_least_half(0.5 * static_cast<double>(grid.height - 1))) {}

    /// Values of the terms at (x, y) [cells] from the centre, y northwards.
    Terms at(double x, double y) const {
        double const u = x / half_x_;
        double const v = y / half_y_;
        double const hill = portable::exp(-std::fabs(x) / params_.length_x - std::fabs(y) / params_.length_y);
        double const eighth = params_.eighth == EighthTerm::x2y2 ? u * u * v * v : u * u * u * v;
        return {1.0,
                u,
                v,
                u * u,
                u * v,
                v * v,
                u * u * v,
                eighth,
                u * v * v,
                hill,
                hill * wave_x(x, portable::cos),
                hill * wave_y(y, portable::sin)};
    }

    /// Derivatives of the terms by x and y [1/cell]; those of |x| and |y| are 0 at 0.
    std::pair<Terms, Terms> slopes(double x, double y) const {
        double const u = x / half_x_;
        double const v = y / half_y_;
        double const a = 1.0 / half_x_;
        double const b = 1.0 / half_y_;
        bool const whole = params_.eighth == EighthTerm::x2y2;
        double const hill = portable::exp(-std::fabs(x) / params_.length_x - std::fabs(y) / params_.length_y);
        double const sign_x = x > 0.0 ? 1.0 : x < 0.0 ? -1.0 : 0.0;
        double const sign_y = y > 0.0 ? 1.0 : y < 0.0 ? -1.0 : 0.0;
        double const fall_x = -sign_x / params_.length_x;
        double const fall_y = -sign_y / params_.length_y;
        double const cosine = wave_x(x, portable::cos);
        double const sine = wave_y(y, portable::sin);
        double const turn_x = -sign_x * wave_x(x, portable::sin) * 2.0 * portable::pi * params_.frequency_x / width();
        double const turn_y = sign_y * wave_y(y, portable::cos) * 2.0 * portable::pi * params_.frequency_y / height();
        Terms const to_x{0.0,
                         a,
                         0.0,
                         2.0 * u * a,
                         v * a,
                         0.0,
                         2.0 * u * v * a,
                         whole ? 2.0 * u * v * v * a : 3.0 * u * u * v * a,
                         v * v * a,
                         hill * fall_x,
                         hill * (fall_x * cosine + turn_x),
                         hill * fall_x * sine};
        Terms const to_y{0.0,
                         0.0,
                         b,
                         0.0,
                         u * b,
                         2.0 * v * b,
                         u * u * b,
                         whole ? 2.0 * u * u * v * b : u * u * u * b,
                         2.0 * u * v * b,
                         hill * fall_y,
                         hill * fall_y * cosine,
                         hill * (fall_y * sine + turn_y)};
        return {to_x, to_y};
    }

    /// Position relative to the grid's centre [cells].
    Vec2 from_middle(Vec2 ground) const {
        return {(ground.x - 0.5 * (grid_.west + grid_.east())) / grid_.cell_m,
                (ground.y - 0.5 * (grid_.north + grid_.south())) / grid_.cell_m};
    }

    Vec2 middle_to(Cell c) const {
        return {static_cast<double>(c.col) - 0.5 * static_cast<double>(grid_.width - 1),
                0.5 * static_cast<double>(grid_.height - 1) - static_cast<double>(c.row)};
    }

    bool has(std::size_t term) const {
        return (term != 10 || params_.frequency_x > 0.0) && (term != 11 || params_.frequency_y > 0.0);
    }

private:
    double width() const { return static_cast<double>(grid_.width); }
    double height() const { return static_cast<double>(grid_.height); }
    double wave_x(double x, double (*wave)(double)) const {
        return wave(2.0 * portable::pi * params_.frequency_x * std::fabs(x) / width());
    }
    double wave_y(double y, double (*wave)(double)) const {
        return wave(2.0 * portable::pi * params_.frequency_y * std::fabs(y) / height());
    }

    Grid const& grid_;
    RegressParams const& params_;
    double half_x_;
    double half_y_;
};

void require(FeaturePoints const& points, Grid const& grid, RegressParams const& p, std::size_t terms) {
    auto const refuse = [](std::string const& what) { throw BadParameter("skeleton.regress", what); };
    if (grid.cells() <= 0 || !(grid.cell_m > 0.0)) {
        refuse("the grid has no cells");
    }
    require_in("skeleton.regress", "correlation length lx", p.length_x, Range::above(0.0), "cells");
    require_in("skeleton.regress", "correlation length ly", p.length_y, Range::above(0.0), "cells");
    if (!(p.frequency_x >= 0.0) || !(p.frequency_y >= 0.0) || !(p.frequency_x + p.frequency_y < 1e4)) {
        refuse(fmt::format("frequencies {} and {}: give 0 to 10 000 cycles", p.frequency_x, p.frequency_y));
    }
    if (p.slope != SlopeMode::none && !(p.slope_rad > 0.0 && p.slope_rad < 0.5 * portable::pi)) {
        refuse(fmt::format("slope {} rad: give more than 0 and less than pi/2 = 1.5708", p.slope_rad));
    }
    refuse_if<BadInput>(points.points.size() < terms, "skeleton.regress",
                        "{} points for {} terms: give {} or more, better twice as many", points.points.size(), terms,
                        terms);
    for (std::size_t i = 0; i < points.points.size(); ++i) {
        Vec3 const& q = points.points[i];
        refuse_if<BadInput>(!is_finite(q), "skeleton.regress", "point {} is ({}, {}, {}), no numbers", i + 1, q.x, q.y,
                            q.z);
    }
}

/// The constraint of equation 13 on the columns in use.
solver::Sphere sphere_of(Basis const& basis, Grid const& grid, RegressParams const& params,
                         std::vector<std::size_t> const& columns) {
    solver::Sphere sphere;
    sphere.tau = portable::sin(params.slope_rad) / portable::cos(params.slope_rad);
    if (params.slope == SlopeMode::centre) {
        sphere.unknowns = {1, 2}; // x and y: all other terms are level at the centre
        sphere.form = solver::Matrix(2, 2);
        auto const [to_x, to_y] = basis.slopes(0.0, 0.0);
        sphere.form.at(0, 0) = to_x[1] * to_x[1];
        sphere.form.at(1, 1) = to_y[2] * to_y[2];
        return sphere;
    }
    for (std::size_t c = 1; c < columns.size(); ++c) {
        sphere.unknowns.push_back(c);
    }
    std::size_t const n = sphere.unknowns.size();
    sphere.form = solver::Matrix(n, n);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        Vec2 const at = basis.middle_to(grid.at(i));
        auto const [to_x, to_y] = basis.slopes(at.x, at.y);
        for (std::size_t r = 0; r < n; ++r) {
            for (std::size_t c = 0; c <= r; ++c) {
                std::size_t const p = columns[sphere.unknowns[r]];
                std::size_t const q = columns[sphere.unknowns[c]];
                sphere.form.at(r, c) += to_x[p] * to_x[q] + to_y[p] * to_y[q];
            }
        }
    }
    for (std::size_t r = 0; r < n; ++r) {
        for (std::size_t c = 0; c <= r; ++c) {
            sphere.form.at(r, c) /= static_cast<double>(grid.cells());
            sphere.form.at(c, r) = sphere.form.at(r, c);
        }
    }
    return sphere;
}

double square(solver::Sphere const& sphere, std::vector<double> const& x) {
    double sum = 0.0;
    for (std::size_t r = 0; r < sphere.unknowns.size(); ++r) {
        for (std::size_t c = 0; c < sphere.unknowns.size(); ++c) {
            sum += x[sphere.unknowns[r]] * sphere.form.at(r, c) * x[sphere.unknowns[c]];
        }
    }
    return sum;
}

} // namespace

Regression regress(FeaturePoints const& points, Grid const& grid, RegressParams const& params, Run const& run) {
    Basis const basis(grid, params);
    std::vector<std::size_t> columns;
    for (std::size_t term = 0; term < term_count; ++term) {
        if (basis.has(term)) {
            columns.push_back(term);
        }
    }
    require(points, grid, params, columns.size());

    solver::Matrix a(points.points.size(), columns.size());
    std::vector<double> b(points.points.size());
    for (std::size_t i = 0; i < b.size(); ++i) {
        Vec3 const& p = points.points[i];
        Vec2 const at = basis.from_middle({p.x, p.y});
        Terms const terms = basis.at(at.x, at.y);
        for (std::size_t c = 0; c < columns.size(); ++c) {
            a.at(i, c) = terms[columns[c]];
        }
        b[i] = p.z;
    }
    Regression result;
    result.terms = columns.size();
    solver::Solution solution;
    if (params.slope == SlopeMode::none) {
        solution = solver::least_squares(a, b);
    } else {
        solver::Sphere const sphere = sphere_of(basis, grid, params, columns);
        solution = solver::least_squares_on_sphere(a, b, sphere);
        result.slope_error = std::fabs(square(sphere, solution.x) / (sphere.tau * sphere.tau) - 1.0);
    }
    result.rank = solution.rank;
    result.rms_m = solution.rms;
    for (std::size_t c = 0; c < columns.size(); ++c) {
        result.coefficients[columns[c]] = solution.x[c];
    }
    result.surface = Raster<float>(grid);
    parallel_ranges(run, grid.height, 16, [&](std::int64_t begin, std::int64_t end) {
        run.check();
        for (std::int64_t r = begin; r < end; ++r) {
            for (std::int64_t c = 0; c < grid.width; ++c) {
                Vec2 const at = basis.middle_to({c, r});
                Terms const terms = basis.at(at.x, at.y);
                double z = 0.0;
                for (std::size_t term = 0; term < term_count; ++term) {
                    z += result.coefficients[term] * terms[term];
                }
                result.surface[Cell{c, r}] = static_cast<float>(z);
            }
        }
    });
    return result;
}

} // namespace thalweg::skeleton
