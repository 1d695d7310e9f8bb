// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "terminal/progress.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace thalweg::tools {

namespace {

/// Three digits and a letter: "12.3 M".
std::string short_number(double value) {
    constexpr std::array<char const*, 4> letters{"", " k", " M", " G"};
    std::size_t step = 0;
    while (value >= 999.5 && step + 1 < letters.size()) {
        value /= 1000.0;
        ++step;
    }
    int const places = value >= 99.95 || step == 0 ? 0 : value >= 9.995 ? 1 : 2;
    return fmt::format("{:.{}f}{}", value, places, letters.at(step));
}

std::string rate_text(BarState const& state) {
    if (state.per_second <= 0.0) {
        return "";
    }
    if (state.amount > 0.0) {
        return fmt::format("{} {}/s", short_number(state.per_second * state.amount), state.unit);
    }
    double const percent = state.per_second * 100.0;
    return fmt::format("{:.{}f} %/s", percent, percent < 9.95 ? 1 : 0);
}

/// Rounds like an estimate: seconds, from ten minutes whole minutes.
std::string left_text(double seconds) {
    if (seconds < 0.0) {
        return "";
    }
    auto const whole = static_cast<long long>(std::ceil(std::min(seconds, 1e9)));
    if (whole < 60) {
        return fmt::format("{} s left", whole);
    }
    if (whole < 600) {
        return fmt::format("{} min {:02} s left", whole / 60, whole % 60);
    }
    return whole < 3600 ? fmt::format("{} min left", (whole + 59) / 60)
                        : fmt::format("{} h {:02} min left", whole / 3600, whole % 3600 / 60);
}

} // namespace

void Pace::at(double share, double elapsed_s) {
    double const step = elapsed_s - elapsed_;
    if (step <= 0.0 || share < share_) {
        return;
    }
    constexpr double memory_s = 3.0;
    constexpr double known_from_s = 0.5; // earlier values are mostly noise
    double const weight = step / (memory_s + step);
    if (elapsed_s < 2.0 * memory_s) {
        rate_ = share / elapsed_s;
    } else {
        rate_ += weight * ((share - share_) / step - rate_);
    }
    share_ = share;
    elapsed_ = elapsed_s;
    if (rate_ <= 0.0 || elapsed_s < known_from_s) {
        return;
    }
    double const guess = (1.0 - share) / rate_;
    left_ = left_ < 0.0 ? guess : std::max(0.0, left_ - step) * (1.0 - weight) + guess * weight;
}

std::string bar_text(BarState const& state, int columns, Colour colour) {
    std::size_t const room = static_cast<std::size_t>(std::max(columns, 2)) - 1;
    double const share = std::clamp(state.share, 0.0, 1.0);
    std::string const head = fmt::format("{:<10} ", state.what);
    // Rounded down: 100 % means done.
    std::string const percent = fmt::format("{:>3} %", static_cast<int>(share * 100.0));
    std::string const left = left_text(state.left_s);
    std::string rate = rate_text(state);

    constexpr std::size_t widest_bar = 30;
    constexpr std::size_t narrowest_bar = 8;
    auto const with_gap = [](std::string const& part) { return part.empty() ? 0 : part.size() + 2; };
    std::size_t const plain = head.size() + percent.size();
    std::size_t rest = plain + 3 + with_gap(left) + with_gap(rate); // two brackets and a space
    if (rest + narrowest_bar > room) {
        rest -= with_gap(rate);
        rate.clear();
    }
    std::string text = head;
    if (rest + narrowest_bar <= room) {
        std::size_t const width = std::min(widest_bar, room - rest);
        auto const full = static_cast<std::size_t>(share * static_cast<double>(width));
        bool const coloured = colour == Colour::ansi;
        text += fmt::format("[{}{}{}{}] ", coloured ? "\033[34m" : "", std::string(full, '#'),
                            coloured ? "\033[0m" : "", std::string(width - full, '.'));
        text += percent;
        text += rate.empty() ? "" : "  " + rate;
        return text + (left.empty() ? "" : "  " + left);
    }
    text += percent;
    if (plain + with_gap(left) <= room) {
        return text + (left.empty() ? "" : "  " + left);
    }
    return text.substr(0, room);
}

void StageTimes::count(double now_s) {
    if (!running_.empty()) {
        seconds_[running_.back()].second += now_s - since_s_;
    }
    since_s_ = now_s;
}

void StageTimes::at(std::string_view stage, bool done, double now_s) {
    count(now_s);
    auto known = std::ranges::find(seconds_, stage, [](auto const& one) { return std::string_view(one.first); });
    auto const place = static_cast<std::size_t>(known - seconds_.begin());
    auto const runs = std::ranges::find(running_, place);
    if (runs != running_.end()) { // stages started within it have ended without a report
        running_.erase(done ? runs : runs + 1, running_.end());
        return;
    }
    if (known == seconds_.end()) {
        seconds_.emplace_back(stage, 0.0);
    }
    if (!done) {
        running_.push_back(place);
    }
}

std::vector<std::pair<std::string, double>> StageTimes::until(double now_s) {
    count(now_s);
    return seconds_;
}

} // namespace thalweg::tools
