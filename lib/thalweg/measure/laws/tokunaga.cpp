// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/laws/tokunaga.hpp>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/measure/laws/line_fit.hpp>

namespace thalweg::measure {

std::optional<TokunagaLaw> tokunaga(std::vector<double> const& side_branches) {
    std::vector<Vec2> points;
    for (std::size_t i = 0; i < side_branches.size(); ++i) {
        if (side_branches[i] > 0.0) {
            points.push_back({static_cast<double>(i), portable::log(side_branches[i])});
        }
    }
    auto const fit = fit_line(points);
    if (!fit) {
        return std::nullopt;
    }
    return TokunagaLaw{portable::exp(fit->intercept), portable::exp(fit->slope), fit->r2, fit->slope_error,
                       fit->points};
}

} // namespace thalweg::measure
