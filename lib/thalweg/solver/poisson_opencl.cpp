// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/solver/poisson_opencl.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <thalweg/core/error.hpp>
#include <thalweg/solver/check_problem.hpp>
#include <thalweg/solver/device_queue.hpp>
#include <thalweg/solver/poisson_kernels.hpp>

namespace thalweg::solver {

namespace {

constexpr char const* stage = "solver.solve_poisson";
/// Cells that one work item of a sum takes; with a group's size a constant of the kernels.
constexpr std::int64_t each = 16;
/// Plain aggregation's corrections are too short by about this.
constexpr float over_correction = 1.8F;

std::int64_t even(std::int64_t n) {
    return n + n % 2;
}

/// Where a level's cells stand in its arrays.
struct Layout {
    Layout(std::int64_t level_width, std::int64_t level_height)
        : width(level_width), height(level_height), stride(even(width)), rows(even(height)),
          margin(std::max(stride, each * static_cast<std::int64_t>(DeviceQueue::group))),
          count(stride * rows + 2 * margin) {}
    Layout coarser() const { return {stride / 2, rows / 2}; }
    bool is_one_cell() const { return width == 1 && height == 1; }

    std::int64_t width, height, stride, rows, margin;
    std::int64_t count; ///< of numbers, margins included
};

struct Level {
    Level(Layout const& of, DeviceQueue& queue)
        : at(of), inverse(queue.zeros<float>(at.count)), east(queue.zeros<float>(at.count)),
          south(queue.zeros<float>(at.count)), right(queue.zeros<float>(at.count)), x(queue.zeros<float>(at.count)) {}
    Layout at;
    DeviceArray<float> inverse, east, south, right, x;
};

std::string kernels_with_constants() {
    return fmt::format("#define GROUP {}\n#define EACH {}\n{}", DeviceQueue::group, each, poisson_kernels());
}

/// Bytes of all arrays that live at once, and of the largest.
std::pair<std::int64_t, std::int64_t> memory(Layout const& finest, std::int64_t cells, bool sourced) {
    std::int64_t bytes = cells * (1 + 8 + (sourced ? 8 : 0)) + finest.count * 5 * 8 + finest.count * 4;
    std::int64_t levels = 0;
    for (Layout at = finest;; at = at.coarser()) {
        levels += at.count * 5 * 4;
        if (at.is_one_cell()) {
            break;
        }
    }
    return {bytes + levels, finest.count * 8};
}

/// The equations on the device, and what is done with them.
class Equations {
public:
    Equations(GridProblem const& problem, DeviceQueue& queue)
        : queue_(queue), grid_(problem.kind.grid()), finest_(grid_.width, grid_.height),
          kind_(queue.copy_of(problem.kind.values())), value_(queue.copy_of(problem.value.values())),
          diagonal_(queue.zeros<float>(finest_.count)), right_(queue.zeros<double>(finest_.count)),
          u_(queue.zeros<double>(finest_.count)), r_(queue.zeros<double>(finest_.count)),
          p_(queue.zeros<double>(finest_.count)), q_(queue.zeros<double>(finest_.count)),
          groups_((finest_.stride * finest_.rows + each * group - 1) / (each * group)),
          sums_(queue.zeros<double>(groups_)), host_sums_(static_cast<std::size_t>(groups_)) {
        levels_.emplace_back(finest_, queue);
        Level const& top = levels_.front();
        bool const sourced = problem.source.cells() > 0;
        auto const source = sourced ? queue.copy_of(problem.source.values()) : queue.zeros<double>(1);
        queue.run("assemble", grid_.width, grid_.height, kind_, value_, source, sourced ? 1 : 0, grid_.width,
                  grid_.height, finest_.stride, finest_.margin, diagonal_, top.inverse, top.east, top.south, right_,
                  u_);
        for (DeviceArray<float> diagonal = diagonal_; !levels_.back().at.is_one_cell();) {
            Level const& fine = levels_.back();
            Level coarse(fine.at.coarser(), queue);
            auto coarse_diagonal = queue.zeros<float>(coarse.at.count);
            queue.run("coarsen", coarse.at.width, coarse.at.height, diagonal, fine.east, fine.south, fine.at.stride,
                      fine.at.margin, coarse.at.width, coarse.at.stride, coarse.at.margin, coarse_diagonal,
                      coarse.inverse, coarse.east, coarse.south);
            diagonal = coarse_diagonal;
            levels_.push_back(std::move(coarse));
        }
        norm_ = std::sqrt(sum("square_sum", right_, finest_.margin));
    }

    /// Of the right side: of the residual with 0 in the free cells.
    double norm() const { return norm_; }

    /// The residual's norm against norm(), by u itself.
    double residual() {
        return std::sqrt(sum("find_residual", diagonal_, levels_[0].east, levels_[0].south, u_, right_, 1.0 / norm_,
                             finest_.stride, finest_.margin, r_, levels_[0].right)) /
               norm_;
    }

    /// One step of conjugate gradients. Takes: r' z of the step before, 0 for the first.
    /// Gives: the residual's norm against norm(), as the steps carry it along.
    double step(double& rz) {
        cycle();
        double const before = rz;
        rz = sum("product_sum", r_, levels_[0].x, finest_.margin);
        queue_.run("turn", finest_.stride * finest_.rows, 1, levels_[0].x, before > 0.0 ? rz / before : 0.0,
                   finest_.margin, p_);
        double const pq =
            sum("apply", diagonal_, levels_[0].east, levels_[0].south, p_, finest_.stride, finest_.margin, q_);
        return std::sqrt(sum("advance", p_, q_, rz / pq, 1.0 / norm_, finest_.margin, u_, r_, levels_[0].right)) /
               norm_;
    }

    void read_into(Raster<double>& value) {
        queue_.run("collect", grid_.width, grid_.height, kind_, u_, grid_.width, finest_.stride, finest_.margin,
                   value_);
        queue_.read(value_, value.values());
    }

private:
    static constexpr auto group = static_cast<std::int64_t>(DeviceQueue::group);

    template <class... Arguments> double sum(char const* kernel, Arguments const&... arguments) {
        queue_.run(kernel, groups_ * group, 1, arguments..., sums_);
        queue_.read(sums_, std::span<double>(host_sums_));
        double total = 0.0;
        for (double const part : host_sums_) {
            total += part;
        }
        return total;
    }

    /// x of the finest level from its right side: a V-cycle from x = 0, the same backwards as forwards, so that it is
    /// a symmetric and positive definite matrix times the right side.
    void cycle() {
        for (std::size_t l = 0; l < levels_.size(); ++l) {
            Level const& fine = levels_[l];
            queue_.run("smooth_from_zero", fine.at.width, fine.at.height, fine.inverse, fine.east, fine.south,
                       fine.right, fine.at.width, fine.at.stride, fine.at.margin, fine.x);
            if (l + 1 < levels_.size()) {
                Level const& coarse = levels_[l + 1];
                queue_.run("restrict_residual", coarse.at.width, coarse.at.height, fine.east, fine.south, fine.x,
                           fine.at.stride, fine.at.margin, coarse.at.width, coarse.at.stride, coarse.at.margin,
                           coarse.right);
            }
        }
        for (std::size_t l = levels_.size() - 1; l-- > 0;) {
            Level const& fine = levels_[l];
            Level const& coarse = levels_[l + 1];
            queue_.run("correct_black", fine.at.stride / 2, fine.at.height, fine.inverse, fine.east, fine.south,
                       fine.right, coarse.x, over_correction, fine.at.width, fine.at.stride, fine.at.margin,
                       coarse.at.stride, coarse.at.margin, fine.x);
            queue_.run("smooth_red", fine.at.stride / 2, fine.at.height, fine.inverse, fine.east, fine.south,
                       fine.right, fine.at.width, fine.at.stride, fine.at.margin, fine.x);
        }
    }

    DeviceQueue& queue_;
    Grid const& grid_;
    Layout finest_;
    DeviceArray<std::uint8_t> kind_;
    DeviceArray<double> value_;
    DeviceArray<float> diagonal_;
    DeviceArray<double> right_, u_, r_, p_, q_;
    std::int64_t groups_;
    DeviceArray<double> sums_;
    std::vector<double> host_sums_;
    std::vector<Level> levels_;
    double norm_ = 0.0;
};

bool is(CellKind kind, std::uint8_t cell) {
    return cell == static_cast<std::uint8_t>(kind);
}

/// Rounding and what the tolerance leaves may pass the extremes by a little.
void keep_between_fixed(Raster<std::uint8_t> const& kind, Raster<double>& value) {
    double least = std::numeric_limits<double>::infinity();
    double greatest = -least;
    for (std::int64_t i = 0; i < kind.cells(); ++i) {
        if (is(CellKind::fixed, kind[i])) {
            least = std::min(least, value[i]);
            greatest = std::max(greatest, value[i]);
        }
    }
    for (std::int64_t i = 0; i < kind.cells(); ++i) {
        if (is(CellKind::free, kind[i])) {
            value[i] = std::clamp(value[i], least, greatest);
        }
    }
}

} // namespace

GridSolution solve_poisson_opencl(GridProblem problem, PoissonParams const& params, Run const& run) {
    check_problem(problem, params, stage, run);
    GridSolution solution;
    auto const kinds = std::as_const(problem.kind).values();
    if (std::none_of(kinds.begin(), kinds.end(), [](std::uint8_t k) { return is(CellKind::free, k); })) {
        solution.value = std::move(problem.value);
        return solution;
    }
    DeviceQueue queue(stage, kernels_with_constants());
    Grid const& grid = problem.kind.grid();
    auto const [bytes, largest] = memory(Layout(grid.width, grid.height), grid.cells(), problem.source.cells() > 0);
    check_device_memory(queue.device(), stage, bytes, largest);
    Equations equations(problem, queue);
    if (equations.norm() == 0.0) { // then 0 solves it
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            if (is(CellKind::free, problem.kind[i])) {
                problem.value[i] = 0.0;
            }
        }
        solution.value = std::move(problem.value);
        return solution;
    }
    // What the steps carry along drifts from the residual of u; where that is not small enough they begin anew from u.
    while (!((solution.residual = equations.residual()) <= params.tolerance)) {
        double rz = 0.0;
        for (double carried = 1.0 / params.tolerance; carried > params.tolerance; ++solution.iterations) {
            run.check();
            if (solution.iterations == params.most_iterations) {
                throw NotConverged(fmt::format(
                    "{}: after {} iterations on the OpenCL device {} the residual is {:.1e}, "
                    "not {:.1e}: ask for a larger tolerance or more iterations",
                    stage, solution.iterations, queue.device().name, equations.residual(), params.tolerance));
            }
            carried = equations.step(rz);
        }
    }
    equations.read_into(problem.value);
    if (problem.source.cells() == 0) {
        keep_between_fixed(problem.kind, problem.value);
    }
    solution.value = std::move(problem.value);
    return solution;
}

} // namespace thalweg::solver
