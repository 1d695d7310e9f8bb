// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/solver/opencl/internal/device.hpp>
#include <thalweg/solver/opencl/internal/opencl.hpp>

namespace thalweg::solver {
namespace {

constexpr std::string_view source_of_poisson = R"(
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#pragma OPENCL FP_CONTRACT OFF

/* A level stores its numbers as consecutive rows of even length, with margins of zeros before and after. The matrix:
   diagonal, and weights of the edges to a cell's eastern and southern neighbour; 0 if one is not free, so that no test
   for the end of a row is needed. Cells are red and black like a chessboard; the one at 0, 0 is red. Levels are in
   float: they only precondition the iteration, which is in double. */

/* The finest level: edges between free cells weigh 1; fixed neighbours enter the diagonal and the right-hand side. */
kernel void assemble(global const uchar* kind, global const double* value, global const double* source, int sourced,
                     int guessed, double start, double scale, long width, long height, long stride, long margin, global float* diagonal,
                     global float* sink, global float* inverse, global float* east, global float* south, global double* right,
                     global double* u) {
    long const col = get_global_id(0);
    long const row = get_global_id(1);
    long const i = row * width + col;
    if (col >= width || kind[i] != 1) {
        return;
    }
    long const at = margin + row * stride + col;
    bool const inside[4] = {col > 0, col + 1 < width, row > 0, row + 1 < height};
    long const step[4] = {-1, 1, -width, width};
    float degree = 0.0f;
    float to_fixed = 0.0f;
    double sum = sourced ? source[i] : 0.0;
    for (int side = 0; side < 4; ++side) {
        if (inside[side]) {
            uchar const other = kind[i + step[side]];
            degree += other != 0 ? 1.0f : 0.0f;
            to_fixed += other == 2 ? 1.0f : 0.0f;
            sum += other == 2 ? value[i + step[side]] : 0.0;
        }
    }
    diagonal[at] = degree;
    sink[at] = to_fixed;
    inverse[at] = 1.0f / degree;
    east[at] = inside[1] && kind[i + 1] == 1 ? 1.0f : 0.0f;
    south[at] = inside[3] && kind[i + width] == 1 ? 1.0f : 0.0f;
    right[at] = scale * sum;
    u[at] = scale * (guessed ? value[i] : start);
}

/* The matrix of 2 x 2 cells: Galerkin's edges to fixed cells, and a share of those between free cells: a piecewise
   constant correction makes differences look steeper than they are. */
kernel void coarsen(global const float* sink, global const float* east, global const float* south, float share,
                    long stride, long margin, long coarse_width, long coarse_stride, long coarse_margin,
                    global float* coarse_sink, global float* coarse_inverse, global float* coarse_east,
                    global float* coarse_south) {
    long const col = get_global_id(0);
    long const row = get_global_id(1);
    if (col >= coarse_width) {
        return;
    }
    long const a = margin + 2 * row * stride + 2 * col;
    long const b = a + 1;
    long const c = a + stride;
    long const d = c + 1;
    long const at = coarse_margin + row * coarse_stride + col;
    float const to_east = share * (east[b] + east[d]);
    float const to_south = share * (south[c] + south[d]);
    float const to_west = share * (east[a - 1] + east[c - 1]);
    float const to_north = share * (south[a - stride] + south[b - stride]);
    float const to_fixed = sink[a] + sink[b] + sink[c] + sink[d];
    float const diagonal = to_fixed + to_east + to_south + to_west + to_north;
    coarse_sink[at] = to_fixed;
    coarse_inverse[at] = diagonal > 0.0f ? 1.0f / diagonal : 0.0f;
    coarse_east[at] = to_east;
    coarse_south[at] = to_south;
}

/* From x = 0: red cells, then black ones. */
kernel void smooth_from_zero(global const float* restrict inverse, global const float* restrict east,
                             global const float* restrict south, global const float* restrict right, long width,
                             long stride, long margin, global float* restrict x) {
    long const col = get_global_id(0);
    long const row = get_global_id(1);
    if (col >= width) {
        return;
    }
    long const at = margin + row * stride + col;
    float const reds = east[at] * (right[at + 1] * inverse[at + 1]) +
                        east[at - 1] * (right[at - 1] * inverse[at - 1]) +
                        south[at] * (right[at + stride] * inverse[at + stride]) +
                        south[at - stride] * (right[at - stride] * inverse[at - stride]);
    x[at] = (right[at] + (((row + col) & 1) ? reds : 0.0f)) * inverse[at];
}

/* The residual after smooth_from_zero, summed over 2 x 2 cells: 0 in black cells, in red ones the sum of the changes of
   their black neighbours. */
kernel void restrict_residual(global const float* restrict east, global const float* restrict south,
                              global const float* restrict x, long stride, long margin, long coarse_width,
                              long coarse_stride, long coarse_margin, global float* restrict coarse_right) {
    long const col = get_global_id(0);
    long const row = get_global_id(1);
    if (col >= coarse_width) {
        return;
    }
    long const a = margin + 2 * row * stride + 2 * col;
    long const d = a + stride + 1;
    coarse_right[coarse_margin + row * coarse_stride + col] =
        (east[a] * x[a + 1] + east[a - 1] * x[a - 1] + south[a] * x[a + stride] + south[a - stride] * x[a - stride]) +
        (east[d] * x[d + 1] + east[d - 1] * x[d - 1] + south[d] * x[d + stride] + south[d - stride] * x[d - stride]);
}

/* Adds the coarser level's correction and relaxes the black cells. */
kernel void correct_black(global const float* restrict inverse, global const float* restrict east,
                          global const float* restrict south, global const float* restrict right,
                          global const float* restrict coarse_x, long width, long stride, long margin,
                          long coarse_stride, long coarse_margin, global float* x) {
    long const row = get_global_id(1);
    long const col = 2 * (long)get_global_id(0) + (1 - (row & 1));
    if (col >= width) {
        return;
    }
    long const at = margin + row * stride + col;
    global const float* const here = coarse_x + coarse_margin + (row >> 1) * coarse_stride;
    global const float* const above = coarse_x + coarse_margin + ((row - 1) >> 1) * coarse_stride;
    global const float* const below = coarse_x + coarse_margin + ((row + 1) >> 1) * coarse_stride;
    float const reds = east[at] * (x[at + 1] + here[(col + 1) >> 1]) +
                        east[at - 1] * (x[at - 1] + here[(col - 1) >> 1]) +
                        south[at] * (x[at + stride] + below[col >> 1]) +
                        south[at - stride] * (x[at - stride] + above[col >> 1]);
    x[at] = (right[at] + reds) * inverse[at];
}

/* Relaxes the red cells. */
kernel void smooth_red(global const float* restrict inverse, global const float* restrict east,
                       global const float* restrict south, global const float* restrict right, long width,
                       long stride, long margin, global float* x) {
    long const row = get_global_id(1);
    long const col = 2 * (long)get_global_id(0) + (row & 1);
    if (col >= width) {
        return;
    }
    long const at = margin + row * stride + col;
    x[at] = (right[at] + east[at] * x[at + 1] + east[at - 1] * x[at - 1] + south[at] * x[at + stride] +
             south[at - stride] * x[at - stride]) *
            inverse[at];
}

/* Sums a group's numbers in a fixed order. */
void sum_of_group(local double* own, double mine, global double* sums) {
    int const me = get_local_id(0);
    own[me] = mine;
    for (int step = GROUP / 2; step > 0; step /= 2) {
        barrier(CLK_LOCAL_MEM_FENCE);
        if (me < step) {
            own[me] += own[me + step];
        }
    }
    if (me == 0) {
        sums[get_group_id(0)] = own[0];
    }
}

/* A group sums GROUP * EACH consecutive cells; sums has one number per group. */
#define FIRST (margin + (long)get_group_id(0) * GROUP * EACH + get_local_id(0))

kernel void square_sum(global const double* restrict a, long margin, global double* restrict sums) {
    local double own[GROUP];
    double sum = 0.0;
    for (long k = 0, at = FIRST; k < EACH; ++k, at += GROUP) {
        sum += a[at] * a[at];
    }
    sum_of_group(own, sum, sums);
}

/* The largest |u| and |z| of each work item. */
kernel void find_greatest(global const double* restrict u, global const float* restrict z, long margin,
                          global double* restrict most_u, global double* restrict most_z) {
    double a = 0.0;
    double b = 0.0;
    for (long k = 0, at = FIRST; k < EACH; ++k, at += GROUP) {
        a = fmax(a, fabs(u[at]));
        b = fmax(b, fabs((double)z[at]));
    }
    most_u[get_global_id(0)] = a;
    most_z[get_global_id(0)] = b;
}

kernel void product_sum(global const double* restrict r, global const float* restrict z, long margin,
                        global double* restrict sums) {
    local double own[GROUP];
    double sum = 0.0;
    for (long k = 0, at = FIRST; k < EACH; ++k, at += GROUP) {
        sum += r[at] * z[at];
    }
    sum_of_group(own, sum, sums);
}

double product_at(global const float* restrict diagonal, global const float* restrict east,
                  global const float* restrict south, global const double* restrict p, long stride, long at) {
    return diagonal[at] * p[at] - east[at] * p[at + 1] - east[at - 1] * p[at - 1] - south[at] * p[at + stride] -
           south[at - stride] * p[at - stride];
}

/* r = right - A u, and r' r; scaled is scale r. */
kernel void find_residual(global const float* restrict diagonal, global const float* restrict east,
                          global const float* restrict south, global const double* restrict u,
                          global const double* restrict right, double scale, long stride, long margin,
                          global double* restrict r, global float* restrict scaled, global double* restrict sums) {
    local double own[GROUP];
    double sum = 0.0;
    for (long k = 0, at = FIRST; k < EACH; ++k, at += GROUP) {
        double const left = right[at] - product_at(diagonal, east, south, u, stride, at);
        r[at] = left;
        scaled[at] = scale * left;
        sum += left * left;
    }
    sum_of_group(own, sum, sums);
}

/* q = A p, and p' q. */
kernel void apply(global const float* restrict diagonal, global const float* restrict east,
                  global const float* restrict south, global const double* restrict p, long stride, long margin,
                  global double* restrict q, global double* restrict sums) {
    local double own[GROUP];
    double sum = 0.0;
    for (long k = 0, at = FIRST; k < EACH; ++k, at += GROUP) {
        double const product = product_at(diagonal, east, south, p, stride, at);
        q[at] = product;
        sum += p[at] * product;
    }
    sum_of_group(own, sum, sums);
}

/* u += alpha p, r -= alpha q, and r' r; scaled is scale r. */
kernel void advance(global const double* restrict p, global const double* restrict q, double alpha, double scale,
                    long margin, global double* restrict u, global double* restrict r, global float* restrict scaled,
                    global double* restrict sums) {
    local double own[GROUP];
    double sum = 0.0;
    for (long k = 0, at = FIRST; k < EACH; ++k, at += GROUP) {
        u[at] += alpha * p[at];
        double const left = r[at] - alpha * q[at];
        r[at] = left;
        scaled[at] = scale * left;
        sum += left * left;
    }
    sum_of_group(own, sum, sums);
}

/* p = z + beta p. */
kernel void turn(global const float* restrict z, double beta, long margin, global double* restrict p) {
    long const at = margin + get_global_id(0);
    p[at] = z[at] + beta * p[at];
}

/* Copies the values to the free cells of the grid. */
kernel void collect(global const uchar* kind, global const double* u, double times, long width, long stride, long margin,
                    global double* value) {
    long const col = get_global_id(0);
    long const row = get_global_id(1);
    long const i = row * width + col;
    if (col < width && kind[i] == 1) {
        value[i] = times * u[margin + row * stride + col];
    }
}
)";

// Kernels of solve_poisson_opencl, in OpenCL C.
std::string_view poisson_kernels() {
    return source_of_poisson;
}

std::int64_t even(std::int64_t n) {
    return n + n % 2;
}

/// Cells summed by one work item; with the group size a constant of the kernels.
constexpr std::int64_t each = 16;

constexpr auto group = static_cast<std::int64_t>(DeviceQueue::group);

// Layout of a level's cells in its arrays: consecutive rows of even length, an even number of rows, zeros before and
// after that are never written.
struct DeviceLayout {
    // Sums read whole groups, and neighbours of the last cell.
    DeviceLayout(std::int64_t level_width, std::int64_t level_height)
        : width(level_width), height(level_height), stride(even(width)), rows(even(height)),
          margin(stride + each * group), count(stride * rows + 2 * margin) {}

    DeviceLayout coarser() const { return {stride / 2, rows / 2}; }
    bool is_one_cell() const { return width == 1 && height == 1; }

    std::int64_t width, height, stride, rows, margin;
    std::int64_t count; // of numbers, margins included
};

// A grid's equations on the OpenCL device, and the steps of conjugate gradients that solve them. Norms are relative to
// that of the residual with 0 in the free cells.
class DeviceEquations {
public:
    // The initial values.
    struct Start {
        bool guessed = false; // the problem's own values
        double value = 0.0;   // otherwise this value
        double scale = 1.0;   // a power of 2 that multiplies all numbers on the device
    };

    // Throws as DeviceQueue, and IoError when the device has too little memory. problem: every free cell is connected
    // to a fixed one; stage: for messages.
    DeviceEquations(GridProblem const& problem, Start const& start, char const* stage);

    // Norm of the residual with 0 in the free cells, scaled.
    double zero_norm() const { return zero_norm_; }
    // Computes the residual from the values; returns its norm.
    double renew();
    // Computes the correction that a cycle over all levels would add to the values.
    void precondition();
    // Largest absolute correction and value, both scaled.
    struct Greatest {
        double correction = 0.0;
        double value = 0.0;
    };
    Greatest greatest();
    // Restarts conjugate gradients.
    void begin_anew() { rz_ = 0.0; }
    // Takes a step along the direction given by the correction; returns the norm of the residual by recurrence.
    double advance();
    // Copies the values of free cells.
    void read_into(Raster<double>& value);

private:
    struct Level {
        Level(DeviceLayout const& of, DeviceQueue& queue);
        DeviceLayout at;
        DeviceArray<float> inverse; // 1 / diagonal
        DeviceArray<float> east, south;
        DeviceArray<float> right;
        DeviceArray<float> x;
    };

    template <class... Arguments> double sum(char const* kernel, Arguments const&... arguments);

    std::int64_t width_, height_;
    DeviceLayout finest_;
    DeviceQueue queue_;
    std::int64_t groups_; // number of groups in a sum
    DeviceArray<std::uint8_t> kind_;
    DeviceArray<double> value_;
    DeviceArray<float> diagonal_;
    DeviceArray<double> right_, u_, r_, p_, q_;
    DeviceArray<double> sums_, most_u_, most_z_;
    std::vector<double> parts_;
    std::vector<Level> levels_; // the finest first, the last of one cell
    double scale_ = 1.0;
    double zero_norm_ = 0.0;
    double rz_ = 0.0;
};

/// Factor of Galerkin's edges between cells on coarser levels: right for the Laplacian where no cell is fixed. With 1 a
/// cycle's corrections would be half as long as they should be.
constexpr float share_of_ties = 0.5F;

std::int64_t groups_of(DeviceLayout const& finest) {
    return (finest.stride * finest.rows + each * group - 1) / (each * group);
}

/// \throws IoError when the arrays do not fit.
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

/// Groups are summed in a fixed order on the device, their sums in a fixed order here.
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

/// A V-cycle from 0, symmetric forwards and backwards: a symmetric, positive definite matrix times r.
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

constexpr char const* poisson_stage = "solver.solve_poisson";

template <class Change> void change_free(GridProblem& problem, Change change) {
    for (std::int64_t i = 0; i < problem.kind.cells(); ++i) {
        if (problem.kind[i] == free_cell) {
            problem.value[i] = change(problem.value[i]);
        }
    }
}

/// A power of 2 that brings the problem's numbers near 1, so that their squares stay in range.
double scale_of(Contents const& contents) {
    int exponent = 0;
    std::frexp(contents.size, &exponent); // 0 for 0
    return std::ldexp(1.0, -exponent);
}

/// Iterates until the residual, computed from the values, and the correction of a further cycle are small enough.
/// height: largest absolute height of the fixed cells, scaled like the equations.
GridSolution iterate(DeviceEquations& equations, double height, PoissonParams const& params, Run const& run) {
    constexpr double unseen = 2.0; // bound of the error after a cycle, relative to the correction it makes
    GridSolution solution;
    double counted = std::numeric_limits<double>::infinity();
    double norm = equations.renew();
    double share = 0.0;
    for (;; ++solution.iterations) {
        if (norm > 0.0) {
            share = std::clamp(portable::log(norm) / portable::log(params.tolerance), share, 1.0);
        }
        run.at(share, "solve");
        equations.precondition();
        if (norm <= params.tolerance) {
            auto const greatest = equations.greatest();
            if (unseen * greatest.correction <= params.tolerance * std::max(height, greatest.value)) {
                norm = equations.renew();
                if (norm <= params.tolerance) {
                    run.at(1.0, "solve");
                    solution.residual = norm;
                    return solution;
                }
                refuse_if<NotConverged>(norm > 0.5 * counted, poisson_stage,
                                        "the residual stays at {:.3g} of what it was, where double has no more digits; "
                                        "a tolerance of {:.3g} is out of reach",
                                        norm, params.tolerance);
                counted = norm;
                equations.begin_anew();
                equations.precondition();
            }
        }
        refuse_if<NotConverged>(solution.iterations >= params.most_iterations, poisson_stage,
                                "after {} iterations the residual is {:.3g} of what it was instead of {:.3g}; ask for "
                                "less or allow more of them",
                                solution.iterations, norm, params.tolerance);
        norm = equations.advance();
    }
}

} // namespace

GridSolution solve_poisson_opencl(GridProblem problem, Contents const& contents, PoissonParams const& params,
                                  Run const& run) {
    GridSolution solution;
    if (contents.free > 0) {
        bool const guessed = contents.guesses > 0 && contents.unknown == 0;
        double const scale = scale_of(contents);
        DeviceEquations equations(problem, {guessed, contents.sum / static_cast<double>(contents.fixed), scale},
                                  poisson_stage);
        if (equations.zero_norm() > 0.0) {
            double const height = std::max(std::fabs(contents.least), std::fabs(contents.greatest));
            solution = iterate(equations, height * scale, params, run);
            equations.read_into(problem.value);
            if (problem.source.cells() == 0) {
                change_free(problem,
                            [&](double value) { return std::clamp(value, contents.least, contents.greatest); });
            }
        } else {
            change_free(problem, [](double) { return 0.0; });
        }
    }
    solution.value = std::move(problem.value);
    return solution;
}

} // namespace thalweg::solver
