// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/solver/opencl/internal/device_equations.hpp>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <utility>

#include <fmt/format.h>

#include <thalweg/solver/opencl/internal/poisson_kernels.hpp>

namespace thalweg::solver {

namespace {

constexpr auto group = static_cast<std::int64_t>(DeviceQueue::group);
/// Cells that one work item of a sum takes; with a group's size a constant of the kernels.
constexpr std::int64_t each = 16;
/// How much of Galerkin's ties between cells a coarser level keeps: what is right for the Laplacian where no cell is
/// fixed. With all of them a cycle's corrections are half as long as they should be.
constexpr float share_of_ties = 0.5F;

std::int64_t even(std::int64_t n) {
    return n + n % 2;
}

std::int64_t groups_of(DeviceLayout const& finest) {
    return (finest.stride * finest.rows + each * group - 1) / (each * group);
}

/// Throws: IoError when the arrays do not fit.
DeviceQueue queue_for(GridProblem const& problem, DeviceLayout const& finest, char const* stage) {
    DeviceQueue queue(stage, fmt::format("#define GROUP {}\n#define EACH {}\n{}", group, each, poisson_kernels()));
    std::int64_t bytes = problem.kind.cells() * 9 + problem.source.cells() * 8;
    bytes += finest.count * (5 * 8 + 2 * 4) + groups_of(finest) * (1 + 2 * group) * 8;
    for (DeviceLayout at = finest; !at.is_one_cell(); at = at.coarser()) {
        bytes += at.count * 5 * 4;
    }
    check_device_memory(queue.device(), stage, bytes, finest.count * 8);
    return queue;
}

} // namespace

// Sums take whole groups, and neighbours of the last cell they take.
DeviceLayout::DeviceLayout(std::int64_t level_width, std::int64_t level_height)
    : width(level_width), height(level_height), stride(even(width)), rows(even(height)), margin(stride + each * group),
      count(stride * rows + 2 * margin) {}

DeviceEquations::Level::Level(DeviceLayout const& of, DeviceQueue& queue)
    : at(of), inverse(queue.zeros<float>(at.count)), east(queue.zeros<float>(at.count)),
      south(queue.zeros<float>(at.count)), right(queue.zeros<float>(at.count)), x(queue.zeros<float>(at.count)) {}

DeviceEquations::DeviceEquations(GridProblem const& problem, Start const& start, char const* stage)
    : width_(problem.kind.width()), height_(problem.kind.height()), finest_(width_, height_),
      queue_(queue_for(problem, finest_, stage)), groups_(groups_of(finest_)),
      kind_(queue_.copy_of(problem.kind.values())), value_(queue_.copy_of(problem.value.values())),
      diagonal_(queue_.zeros<float>(finest_.count)), right_(queue_.zeros<double>(finest_.count)),
      u_(queue_.zeros<double>(finest_.count)), r_(queue_.zeros<double>(finest_.count)),
      p_(queue_.zeros<double>(finest_.count)), q_(queue_.zeros<double>(finest_.count)),
      sums_(queue_.zeros<double>(groups_)), most_u_(queue_.zeros<double>(groups_ * group)),
      most_z_(queue_.zeros<double>(groups_ * group)), scale_(start.scale) {
    levels_.emplace_back(finest_, queue_);
    Level const& top = levels_.front();
    bool const sourced = problem.source.cells() > 0;
    auto sink = queue_.zeros<float>(finest_.count);
    queue_.run("assemble", width_, height_, kind_, value_,
               sourced ? queue_.copy_of(problem.source.values()) : queue_.zeros<double>(1), sourced ? 1 : 0,
               start.guessed ? 1 : 0, start.value, start.scale, width_, height_, finest_.stride, finest_.margin,
               diagonal_, sink, top.inverse, top.east, top.south, right_, u_);
    while (!levels_.back().at.is_one_cell()) {
        Level const& fine = levels_.back();
        Level coarse(fine.at.coarser(), queue_);
        auto coarse_sink = queue_.zeros<float>(coarse.at.count);
        queue_.run("coarsen", coarse.at.width, coarse.at.height, sink, fine.east, fine.south, share_of_ties,
                   fine.at.stride, fine.at.margin, coarse.at.width, coarse.at.stride, coarse.at.margin, coarse_sink,
                   coarse.inverse, coarse.east, coarse.south);
        sink = std::move(coarse_sink);
        levels_.push_back(std::move(coarse));
    }
    zero_norm_ = std::sqrt(sum("square_sum", right_, finest_.margin));
}

/// Groups add in one order on the device, their sums in one order here.
template <class... Arguments> double DeviceEquations::sum(char const* kernel, Arguments const&... arguments) {
    queue_.run(kernel, groups_ * group, 1, arguments..., sums_);
    parts_.resize(static_cast<std::size_t>(groups_));
    queue_.read(sums_, std::span<double>(parts_));
    double total = 0.0;
    for (double const part : parts_) {
        total += part;
    }
    return total;
}

double DeviceEquations::renew() {
    Level const& top = levels_.front();
    return std::sqrt(sum("find_residual", diagonal_, top.east, top.south, u_, right_, 1.0 / zero_norm_, finest_.stride,
                         finest_.margin, r_, top.right)) /
           zero_norm_;
}

/// A V-cycle from 0, the same backwards as forwards: so it is a symmetric and positive definite matrix times r.
void DeviceEquations::precondition() {
    for (std::size_t l = 0; l < levels_.size(); ++l) {
        Level const& fine = levels_[l];
        queue_.run("smooth_from_zero", fine.at.width, fine.at.height, fine.inverse, fine.east, fine.south, fine.right,
                   fine.at.width, fine.at.stride, fine.at.margin, fine.x);
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
        queue_.run("correct_black", fine.at.stride / 2, fine.at.height, fine.inverse, fine.east, fine.south, fine.right,
                   coarse.x, fine.at.width, fine.at.stride, fine.at.margin, coarse.at.stride, coarse.at.margin, fine.x);
        queue_.run("smooth_red", fine.at.stride / 2, fine.at.height, fine.inverse, fine.east, fine.south, fine.right,
                   fine.at.width, fine.at.stride, fine.at.margin, fine.x);
    }
}

DeviceEquations::Greatest DeviceEquations::greatest() {
    queue_.run("find_greatest", groups_ * group, 1, u_, levels_.front().x, finest_.margin, most_u_, most_z_);
    parts_.resize(static_cast<std::size_t>(groups_ * group));
    auto const of = [&](DeviceArray<double> const& most) {
        queue_.read(most, std::span<double>(parts_));
        return *std::max_element(parts_.begin(), parts_.end());
    };
    return {.correction = of(most_z_) * zero_norm_, .value = of(most_u_)};
}

double DeviceEquations::advance() {
    Level const& top = levels_.front();
    double const before = rz_;
    rz_ = sum("product_sum", r_, top.x, finest_.margin);
    queue_.run("turn", finest_.stride * finest_.rows, 1, top.x, before > 0.0 ? rz_ / before : 0.0, finest_.margin, p_);
    double const pq = sum("apply", diagonal_, top.east, top.south, p_, finest_.stride, finest_.margin, q_);
    return std::sqrt(
               sum("advance", p_, q_, rz_ / pq, 1.0 / zero_norm_, finest_.margin, u_, r_, levels_.front().right)) /
           zero_norm_;
}

void DeviceEquations::read_into(Raster<double>& value) {
    queue_.run("collect", width_, height_, kind_, u_, 1.0 / scale_, width_, finest_.stride, finest_.margin, value_);
    queue_.read(value_, value.values());
}

} // namespace thalweg::solver
