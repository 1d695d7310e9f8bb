// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/planform/internal/carry_ground.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <thalweg/core/cells.hpp>

namespace thalweg::network {

namespace {

constexpr double slack_cells = 1e-9; ///< nearer than that, lines are taken to meet
// A step into a cell d cells from a river costs 1 + repulsion / (d + 1/2)^2: a river that could run anywhere keeps to
// the middle between others.
constexpr double repulsion = 10.0;
constexpr std::uint8_t beside_cells = 2; ///< within which water takes the other river

/// a and b lie on one side of the line through s, farther from it than slack.
bool on_one_side(Segment s, Vec2 a, Vec2 b, double slack) {
    double const least = slack * distance(s.a, s.b);
    double const left = cross(s.a, s.b, a);
    double const right = cross(s.a, s.b, b);
    return (left > least && right > least) || (left < -least && right < -least);
}

bool apart(double a, double b, double c, double d, double slack) {
    return std::max(a, b) + slack < std::min(c, d) || std::max(c, d) + slack < std::min(a, b);
}

/// s and t do not meet; within slack [m] the answer is no.
bool clear(Segment s, Segment t, double slack) {
    return apart(s.a.x, s.b.x, t.a.x, t.b.x, slack) || apart(s.a.y, s.b.y, t.a.y, t.b.y, slack) ||
           on_one_side(s, t.a, t.b, slack) || on_one_side(t, s.a, s.b, slack);
}

/// Two segments from one point meet only there; within slack the answer is no.
bool fan_out(Vec2 from, Vec2 a, Vec2 b, double slack) {
    double const dot = (a.x - from.x) * (b.x - from.x) + (a.y - from.y) * (b.y - from.y);
    return dot < 0.0 || std::fabs(cross(from, a, b)) > slack * std::max(distance(from, a), distance(from, b));
}

bool goes_diagonally(Cell a, Cell b) {
    return a.col != b.col && a.row != b.row;
}

/// The cell whose south-east corner a diagonal step cuts.
Cell corner_cell(Cell a, Cell b) {
    return {std::min(a.col, b.col), std::min(a.row, b.row)};
}

/// Which diagonal a step takes: 1 from north-west to south-east, 2 from north-east to south-west.
std::uint8_t diagonal(Cell a, Cell b) {
    return (a.col < b.col) == (a.row < b.row) ? 1 : 2;
}

} // namespace

CarryGround::CarryGround(Grid const& grid, CarryParams const& params)
    : grid_(grid), params_(params), slack_m_(slack_cells * grid.cell_m), distance_(grid, far), corner_(grid, 0) {}

void CarryGround::add(std::vector<Vec2> const& line, std::int64_t basin, std::string const& what) {
    for (std::size_t i = 1; i + 1 < line.size(); ++i) {
        Cell const cell = cells_along({line[i]}, grid_, what).front();
        confluences_.try_emplace(grid_.index(cell), Confluence{line[i], basin});
    }
    std::vector<Cell> const cells = cells_along(line, grid_, what);
    std::vector<Cell> changed;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        if (distance_[cells[i]] != 0) {
            distance_[cells[i]] = 0;
            changed.push_back(cells[i]);
        }
        if (i > 0 && goes_diagonally(cells[i - 1], cells[i])) {
            corner_[corner_cell(cells[i - 1], cells[i])] |= diagonal(cells[i - 1], cells[i]);
        }
    }
    spread(std::move(changed));
    for (std::size_t i = 1; i < line.size(); ++i) {
        touch({line[i - 1], line[i]});
    }
}

Confluence const* CarryGround::confluence_in(Cell c) const {
    auto const found = confluences_.find(grid_.index(c));
    return found == confluences_.end() ? nullptr : &found->second;
}

double CarryGround::cost(Cell c) const {
    double const d = static_cast<double>(distance_[c]) + 0.5;
    return 1.0 + repulsion / (d * d) + (distance_[c] <= beside_cells ? params_.beside_cells : 0.0);
}

bool CarryGround::cuts_a_corner(Cell from, Cell to) const {
    return goes_diagonally(from, to) && (corner_[corner_cell(from, to)] & ~diagonal(from, to)) != 0;
}

/// Whether something holds for all segments that touch the cells around a step.
template <class Holds> bool CarryGround::all_near(Cell from, Cell to, Holds const& holds) const {
    for (std::int64_t row = std::min(from.row, to.row); row <= std::max(from.row, to.row); ++row) {
        for (std::int64_t col = std::min(from.col, to.col); col <= std::max(from.col, to.col); ++col) {
            auto const near = touching_.find(grid_.index({col, row}));
            if (near != touching_.end() && !std::all_of(near->second.begin(), near->second.end(),
                                                        [&](std::size_t k) { return holds(segments_[k]); })) {
                return false;
            }
        }
    }
    return true;
}

bool CarryGround::open(Vec2 p, Cell from, Cell to) const {
    if (distance_[to] == 0 || cuts_a_corner(from, to)) {
        return false;
    }
    Segment const step{p, grid_.centre(to)};
    return all_near(from, to, [&](Segment s) {
        return s.a == p   ? fan_out(p, step.b, s.b, slack_m_)
               : s.b == p ? fan_out(p, step.b, s.a, slack_m_)
                          : clear(step, s, slack_m_);
    });
}

bool CarryGround::opens_to(Confluence const& confluence, Vec2 p, Cell from, Cell to) const {
    if (cuts_a_corner(from, to)) {
        return false;
    }
    Segment const step{p, confluence.at};
    return all_near(from, to, [&](Segment s) {
        return s.a == step.b   ? fan_out(step.b, p, s.b, slack_m_)
               : s.b == step.b ? fan_out(step.b, p, s.a, slack_m_)
               : s.a == p      ? fan_out(p, step.b, s.b, slack_m_)
               : s.b == p      ? fan_out(p, step.b, s.a, slack_m_)
                               : clear(step, s, slack_m_);
    });
}

void CarryGround::spread(std::vector<Cell> front) {
    for (std::uint8_t d = 1; d < far && !front.empty(); ++d) {
        std::vector<Cell> next;
        for (Cell const c : front) {
            for (Cell const n :
                 {Cell{c.col, c.row - 1}, Cell{c.col - 1, c.row}, Cell{c.col + 1, c.row}, Cell{c.col, c.row + 1}}) {
                if (grid_.contains(n) && distance_[n] > d) {
                    distance_[n] = d;
                    next.push_back(n);
                }
            }
        }
        front = std::move(next);
    }
}

void CarryGround::touch(Segment s) {
    std::size_t const number = segments_.size();
    segments_.push_back(s);
    double const h = grid_.cell_m;
    double const eps = 1e-6 * h;
    auto const row_of = [&](double y) { return static_cast<std::int64_t>(std::floor((grid_.north - y) / h)); };
    auto const col_of = [&](double x) { return static_cast<std::int64_t>(std::floor((x - grid_.west) / h)); };
    for (std::int64_t row = row_of(std::max(s.a.y, s.b.y) + eps); row <= row_of(std::min(s.a.y, s.b.y) - eps); ++row) {
        double begin = 0.0;
        double end = 1.0;
        if (s.a.y != s.b.y) {
            double const top = grid_.north - static_cast<double>(row) * h + eps;
            double const t = (top - s.a.y) / (s.b.y - s.a.y);
            double const u = (top - h - 2.0 * eps - s.a.y) / (s.b.y - s.a.y);
            begin = std::clamp(std::min(t, u), 0.0, 1.0);
            end = std::clamp(std::max(t, u), 0.0, 1.0);
        }
        double const x0 = s.a.x + begin * (s.b.x - s.a.x);
        double const x1 = s.a.x + end * (s.b.x - s.a.x);
        for (std::int64_t col = col_of(std::min(x0, x1) - eps); col <= col_of(std::max(x0, x1) + eps); ++col) {
            if (grid_.contains({col, row})) {
                touching_[grid_.index({col, row})].push_back(number);
            }
        }
    }
}

} // namespace thalweg::network
