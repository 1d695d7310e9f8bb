// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/solver/grid/poisson.hpp>
#include <thalweg/solver/opencl/internal/device_queue.hpp>

namespace thalweg::solver {

/// Where a level's cells stand in its arrays: row behind row of an even length, an even number of rows, zeros before
/// and after that are never written.
struct DeviceLayout {
    DeviceLayout(std::int64_t level_width, std::int64_t level_height);
    DeviceLayout coarser() const { return {stride / 2, rows / 2}; }
    bool is_one_cell() const { return width == 1 && height == 1; }

    std::int64_t width, height, stride, rows, margin;
    std::int64_t count; ///< of numbers, margins included
};

/// A grid's equations on the OpenCL device, and the steps of conjugate gradients that solve them. Norms are against
/// that of the residual with 0 in the free cells.
class DeviceEquations {
public:
    /// Where the search begins.
    struct Start {
        bool guessed = false; ///< at the problem's own values
        double value = 0.0;   ///< else at this
        double scale = 1.0;   ///< a power of 2, by which all numbers on the device are multiplied
    };

    /// Takes: a problem with a fixed cell for every free one; the stage that asks, for messages.
    /// Throws: as DeviceQueue; IoError when the device's memory is too small.
    DeviceEquations(GridProblem const& problem, Start const& start, char const* stage);

    /// Of the residual with 0 in the free cells, scaled.
    double zero_norm() const { return zero_norm_; }
    /// Counts the residual from the values. Gives: its norm.
    double renew();
    /// Makes the correction that a cycle over all levels would add to the values.
    void precondition();
    /// Greatest |number| of a correction and of the values, both scaled.
    struct Greatest {
        double correction = 0.0;
        double value = 0.0;
    };
    Greatest greatest();
    /// Forgets the direction of the steps before.
    void begin_anew() { rz_ = 0.0; }
    /// Steps on along the direction that the correction gives. Gives: the residual's norm as it follows from the one
    /// before.
    double advance();
    /// Free cells take their values.
    void read_into(Raster<double>& value);

private:
    struct Level {
        Level(DeviceLayout const& of, DeviceQueue& queue);
        DeviceLayout at;
        DeviceArray<float> inverse; ///< 1 / diagonal
        DeviceArray<float> east, south;
        DeviceArray<float> right;
        DeviceArray<float> x;
    };

    template <class... Arguments> double sum(char const* kernel, Arguments const&... arguments);

    std::int64_t width_, height_;
    DeviceLayout finest_;
    DeviceQueue queue_;
    std::int64_t groups_; ///< that a sum is cut into
    DeviceArray<std::uint8_t> kind_;
    DeviceArray<double> value_;
    DeviceArray<float> diagonal_;
    DeviceArray<double> right_, u_, r_, p_, q_;
    DeviceArray<double> sums_, most_u_, most_z_;
    std::vector<double> parts_;
    std::vector<Level> levels_; ///< the finest first, the last of one cell
    double scale_ = 1.0;
    double zero_norm_ = 0.0;
    double rz_ = 0.0;
};

} // namespace thalweg::solver
