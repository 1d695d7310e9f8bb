// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/blend/internal/distance_within.hpp>

#include <cmath>
#include <limits>
#include <vector>

#include <thalweg/core/run/parallel.hpp>

namespace thalweg::blend {
namespace {

constexpr float far = std::numeric_limits<float>::infinity();

// Along columns: by rows, each from the one before it.
void sweep_columns(Mask const& mask, Raster<float>& distance) {
    auto const step = [&](std::int64_t row, std::int64_t from) {
        for (std::int64_t col = 0; col < mask.width(); ++col) {
            float& d = distance[{col, row}];
            if (mask[{col, row}] == 0) {
                d = 0.0F;
            } else if (from >= 0 && from < mask.height() && distance[{col, from}] + 1.0F < d) {
                d = distance[{col, from}] + 1.0F;
            }
        }
    };
    for (std::int64_t row = 0; row < mask.height(); ++row) {
        step(row, row - 1);
    }
    for (std::int64_t row = mask.height() - 1; row >= 0; --row) {
        step(row, row + 1);
    }
}

/// The lower envelope of the parabolas v(c)^2 + (x - c)^2 of a row.
class Envelope {
public:
    void take(std::span<float> row) {
        centres_.clear();
        begins_.clear();
        heights_.clear();
        for (std::size_t c = 0; c < row.size(); ++c) {
            if (row[c] < far) {
                add(static_cast<double>(c), static_cast<double>(row[c]) * static_cast<double>(row[c]));
            }
        }
        if (centres_.empty()) {
            return;
        }
        std::size_t k = 0;
        for (std::size_t c = 0; c < row.size(); ++c) {
            auto const x = static_cast<double>(c);
            while (k + 1 < centres_.size() && begins_[k + 1] < x) {
                ++k;
            }
            double const dx = x - centres_[k];
            row[c] = static_cast<float>(std::sqrt(dx * dx + heights_[k]));
        }
    }

private:
    void add(double centre, double height) {
        double begin = -std::numeric_limits<double>::infinity();
        while (!centres_.empty()) {
            double const c = centres_.back();
            begin = 0.5 * ((height - heights_.back()) / (centre - c) + (centre + c));
            if (begin > begins_.back()) {
                break;
            }
            centres_.pop_back();
            begins_.pop_back();
            heights_.pop_back();
            begin = -std::numeric_limits<double>::infinity();
        }
        centres_.push_back(centre);
        begins_.push_back(begin);
        heights_.push_back(height);
    }

    std::vector<double> centres_;
    std::vector<double> begins_; // where each becomes the lowest
    std::vector<double> heights_;
};

} // namespace

Raster<float> distance_within(Mask const& mask, Run const& run) {
    Raster<float> distance(mask.grid(), far);
    sweep_columns(mask, distance);
    parallel_ranges(run, mask.height(), 8, [&](std::int64_t begin, std::int64_t end) {
        Envelope envelope;
        for (std::int64_t row = begin; row < end; ++row) {
            envelope.take(distance.row(row));
        }
    });
    return distance;
}

} // namespace thalweg::blend
