// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <thalweg/draw/internal/canvas.hpp>

/// Scales, ticks and axes of the pictures. Private to this module.
namespace thalweg::draw {

/// Round numbers (1, 2 or 5 times a power of ten apart) on a stretch of a scale.
struct Ticks {
    std::vector<double> values; ///< ascending
    double step = 1.0;
    int decimals = 0; ///< that tell the values apart
};

/// The largest of 1, 2, 5 times a power of ten that is not above value. value: positive and finite.
double round_down(double value);

/// Ticks inside [low, high]. Gives: at most most + 1 of them; one value when low = high.
Ticks ticks_between(double low, double high, int most);

/// A number with so many decimals, U+2212 for minus, a thin space between thousands from 10 000 on;
/// four digits and an exponent from 1e9 on.
std::string number(double value, int decimals);

/// Decimals [0, 9] that multiples of step need.
int decimals_of(double step);

/// A diagram in its box: x to the right, y up.
struct Plot {
    Box box; ///< [px]
    double x_low = 0.0;
    double x_high = 1.0;
    double y_low = 0.0;
    double y_high = 1.0;

    Vec2 at(double x, double y) const {
        return {box.x + (x - x_low) / (x_high - x_low) * box.width,
                box.bottom() - (y - y_low) / (y_high - y_low) * box.height};
    }
};

/// Widens the scale of y to round numbers, and empty scales to a span.
void settle_scales(Plot& plot);

/// Grid lines, ticks with numbers, names of the axes. unit: [px] size of a small letter, from which all follows.
void draw_axes(Cairo* sheet, Plot const& plot, std::string const& x_name, std::string const& y_name, double unit);

} // namespace thalweg::draw
