// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/solver/spectral/fft.hpp>

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include <unsupported/Eigen/FFT>

#include <thalweg/core/numbers/elementary.hpp>

namespace thalweg::solver {

namespace {

// Columns gathered at a time: the part read of a row fills cache lines.
constexpr std::int64_t columns_a_bundle = 8;

} // namespace

struct LineTransform::Plan {
    Eigen::internal::kiss_cpx_fft<double> kiss;
};

std::int64_t good_size(std::int64_t n) {
    for (std::int64_t size = std::max<std::int64_t>(n + n % 2, 2);; size += 2) {
        std::int64_t rest = size;
        for (std::int64_t const factor : {2, 3, 5}) {
            while (rest % factor == 0) {
                rest /= factor;
            }
        }
        if (rest == 1) {
            return size;
        }
    }
}

LineTransform::LineTransform(std::int64_t length, Direction direction) : plan_(std::make_unique<Plan>()) {
    auto& kiss = plan_->kiss;
    kiss.m_inverse = direction == Direction::inverse;
    kiss.m_twiddles.resize(static_cast<std::size_t>(length));
    // Not kissfft's own twiddles: they come from libm's sin and cos, whose bits depend on the processor.
    double const step = (kiss.m_inverse ? 2.0 : -2.0) * portable::pi;
    for (std::size_t i = 0; i < kiss.m_twiddles.size(); ++i) {
        double const angle = step * (static_cast<double>(i) / static_cast<double>(length));
        kiss.m_twiddles[i] = {portable::cos(angle), portable::sin(angle)};
    }
    if (length > 1) { // kissfft does not support length 1
        kiss.factorize(static_cast<int>(length));
    }
}

LineTransform::LineTransform(LineTransform const& other) : plan_(std::make_unique<Plan>(*other.plan_)) {}
LineTransform::LineTransform(LineTransform&& other) noexcept = default;
LineTransform::~LineTransform() = default;

void LineTransform::operator()(Complex const* in, Complex* out) {
    auto& kiss = plan_->kiss;
    if (kiss.m_twiddles.size() == 1) {
        *out = *in;
        return;
    }
    kiss.work(0, out, in, 1, 1);
}

Raster<Complex> fft(Raster<Complex> values, Direction direction, Run const& run) {
    if (values.cells() == 0) {
        return values;
    }
    std::int64_t const width = values.width();
    std::int64_t const height = values.height();
    LineTransform const along_row(width, direction);
    parallel_ranges(run, height, 8, [&](std::int64_t begin, std::int64_t end) {
        LineTransform transform = along_row;
        std::vector<Complex> line(static_cast<std::size_t>(width));
        for (std::int64_t r = begin; r < end; ++r) {
            run.check();
            auto const row = values.row(r);
            transform(row.data(), line.data());
            std::copy(line.begin(), line.end(), row.begin());
        }
    });
    LineTransform const along_column(height, direction);
    std::int64_t const bundles = (width + columns_a_bundle - 1) / columns_a_bundle;
    parallel_ranges(run, bundles, 1, [&](std::int64_t begin, std::int64_t end) {
        LineTransform transform = along_column;
        auto const length = static_cast<std::size_t>(height);
        std::vector<Complex> columns(length * columns_a_bundle);
        std::vector<Complex> line(length);
        for (std::int64_t b = begin; b < end; ++b) {
            run.check();
            std::int64_t const first = b * columns_a_bundle;
            auto const count = static_cast<std::size_t>(std::min(columns_a_bundle, width - first));
            for (std::size_t r = 0; r < length; ++r) {
                for (std::size_t c = 0; c < count; ++c) {
                    columns[c * length + r] =
                        values[first + static_cast<std::int64_t>(c) + static_cast<std::int64_t>(r) * width];
                }
            }
            for (std::size_t c = 0; c < count; ++c) {
                transform(&columns[c * length], line.data());
                std::copy(line.begin(), line.end(), &columns[c * length]);
            }
            for (std::size_t r = 0; r < length; ++r) {
                for (std::size_t c = 0; c < count; ++c) {
                    values[first + static_cast<std::int64_t>(c) + static_cast<std::int64_t>(r) * width] =
                        columns[c * length + r];
                }
            }
        }
    });
    return values;
}

} // namespace thalweg::solver
