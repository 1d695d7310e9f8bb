// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/draw/internal/axes.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace thalweg::draw {

namespace {

/// The largest power of ten that is not above value.
double power_below(double value) {
    double power = 1.0;
    while (power > value) {
        power /= 10.0;
    }
    while (power <= value / 10.0) {
        power *= 10.0;
    }
    return power;
}

} // namespace

double round_down(double value) {
    double const power = power_below(value);
    return value >= 5.0 * power ? 5.0 * power : value >= 2.0 * power ? 2.0 * power : power;
}

int decimals_of(double step) {
    int decimals = 0;
    while (step < 1.0 - 1e-9 && decimals < 9) {
        step *= 10.0;
        ++decimals;
    }
    return decimals;
}

Ticks ticks_between(double low, double high, int most) {
    double const span = high - low;
    // Below this the numbers themselves have no more digits to tell ticks apart.
    double const least = std::max({std::fabs(low) * 1e-12, std::fabs(high) * 1e-12, 1e-9});
    if (!(span > least) || !std::isfinite(span)) {
        return {{low}, 1.0, low == std::floor(low) ? 0 : 2};
    }
    double const count = std::max(1, most);
    double const power = power_below(span / count);
    double step = 10.0 * power;
    for (double const factor : {5.0, 2.0, 1.0}) {
        step = span <= count * factor * power * (1.0 + 1e-9) ? factor * power : step;
    }
    Ticks ticks{{}, step, decimals_of(step)};
    double const first = std::ceil(low / step - 1e-9);
    for (double k = first; k <= high / step + 1e-9; k += 1.0) {
        ticks.values.push_back(k * step);
    }
    return ticks;
}

std::string number(double value, int decimals) {
    if (std::fabs(value) >= 1e9) {
        return fmt::format("{:.4g}", value);
    }
    std::string const digits = fmt::format("{:.{}f}", std::fabs(value), decimals);
    std::size_t const whole = std::min(digits.find('.'), digits.size());
    std::string out;
    for (std::size_t i = 0; i < digits.size(); ++i) {
        if (i > 0 && i < whole && whole > 4 && (whole - i) % 3 == 0) {
            out += "\u2009";
        }
        out += digits[i];
    }
    bool const zero = digits.find_first_not_of("0.") == std::string::npos;
    return value < 0.0 && !zero ? "\u2212" + out : out;
}

void settle_scales(Plot& plot) {
    auto const widen = [](double& low, double& high) {
        double const least = std::max({std::fabs(low) * 1e-6, std::fabs(high) * 1e-6, 1e-9});
        if (high - low < least) {
            double const pad = std::max(least, 0.5);
            low -= pad;
            high += pad;
        }
    };
    widen(plot.x_low, plot.x_high);
    widen(plot.y_low, plot.y_high);
    double const step = ticks_between(plot.y_low, plot.y_high, 6).step;
    plot.y_low = std::floor(plot.y_low / step + 1e-9) * step;
    plot.y_high = std::ceil(plot.y_high / step - 1e-9) * step;
}

void draw_axes(Cairo* sheet, Plot const& plot, std::string const& x_name, std::string const& y_name, double unit) {
    constexpr Colour grid_line{0.88, 0.88, 0.89};
    TextStyle const small{unit, faint_ink};
    TextStyle const name{1.05 * unit, ink};
    Box const& box = plot.box;
    double const hair = 0.07 * unit;
    Ticks const x_ticks =
        ticks_between(plot.x_low, plot.x_high, std::clamp(static_cast<int>(box.width / (6.0 * unit)), 1, 10));
    Ticks const y_ticks =
        ticks_between(plot.y_low, plot.y_high, std::clamp(static_cast<int>(box.height / (2.5 * unit)), 1, 8));
    double widest = 0.0;
    for (double const x : x_ticks.values) {
        double const px = plot.at(x, plot.y_low).x;
        draw_line(sheet, {px, box.y}, {px, box.bottom()}, hair, grid_line);
        draw_line(sheet, {px, box.bottom()}, {px, box.bottom() + 0.4 * unit}, hair, faint_ink);
        draw_text(sheet, {px, box.bottom() + 1.6 * unit}, number(x, x_ticks.decimals), small, Anchor::middle);
    }
    for (double const y : y_ticks.values) {
        double const py = plot.at(plot.x_low, y).y;
        draw_line(sheet, {box.x, py}, {box.right(), py}, hair, grid_line);
        draw_line(sheet, {box.x - 0.4 * unit, py}, {box.x, py}, hair, faint_ink);
        std::string const label = number(y, y_ticks.decimals);
        widest = std::max(widest, text_width(sheet, label, small));
        draw_text(sheet, {box.x - 0.7 * unit, py + 0.36 * unit}, label, small, Anchor::end);
    }
    draw_line(sheet, {box.x, box.bottom()}, {box.right(), box.bottom()}, 1.6 * hair, ink);
    draw_line(sheet, {box.x, box.y}, {box.x, box.bottom()}, 1.6 * hair, ink);
    draw_text(sheet, {box.x + 0.5 * box.width, box.bottom() + 3.4 * unit}, x_name, name, Anchor::middle);
    draw_text(sheet, {box.x - widest - 1.5 * unit, box.y + 0.5 * box.height}, y_name, name, Anchor::middle,
              Vec2{0.0, -1.0});
}

} // namespace thalweg::draw
