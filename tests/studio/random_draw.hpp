// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>

#include <nlohmann/json.hpp>

#include <thalweg/studio/drawing.hpp>

/// A step that a hand might draw, as the page says it; it may be refused.
inline nlohmann::json random_draw(thalweg::studio::Drawing const& drawing, std::mt19937_64& random) {
    using nlohmann::json;
    auto const uniform = [&](double low, double high) {
        return low + (high - low) * static_cast<double>(random() >> 11U) * 0x1p-53;
    };
    auto const wide = static_cast<double>(drawing.grid.width);
    auto const tall = static_cast<double>(drawing.grid.height);
    auto const place = [&] { return json{uniform(0.0, wide), uniform(0.0, tall)}; };
    auto const cells = [&](thalweg::Vec2 p) {
        return json{(p.x - drawing.grid.west) / drawing.grid.cell_m, (drawing.grid.north - p.y) / drawing.grid.cell_m};
    };
    // A line that turns little by little.
    auto const stroke = [&] {
        json points = json::array();
        double x = uniform(0.0, wide);
        double y = uniform(0.0, tall);
        double heading = uniform(0.0, 6.28);
        auto const steps = 3 + static_cast<int>(random() % 30);
        for (int i = 0; i < steps; ++i) {
            points.push_back(x);
            points.push_back(y);
            heading += uniform(-0.5, 0.5);
            x += 2.5 * std::cos(heading);
            y += 2.5 * std::sin(heading);
        }
        return points;
    };
    auto const ring = [&](double radius) {
        json points = json::array();
        double const x = uniform(0.3 * wide, 0.7 * wide);
        double const y = uniform(0.3 * tall, 0.7 * tall);
        for (double turn = 0.0; turn < 6.28; turn += 0.4) {
            double const r = radius * uniform(0.8, 1.2);
            points.push_back(x + r * std::cos(turn));
            points.push_back(y + r * std::sin(turn));
        }
        return points;
    };
    // Something done to the first of a kind.
    auto const shape = [&](char const* kind, thalweg::studio::DrawnLine const& line) {
        std::size_t const vertex = random() % line.size();
        json const near = cells(line[vertex]);
        json const at{near[0].get<double>() + uniform(-5, 5), near[1].get<double>() + uniform(-5, 5)};
        switch (random() % 6) {
        case 0: return json{{"verb", "erase"}, {kind, 0}};
        case 1: return json{{"verb", "insert"}, {"of", {{kind, 0}}}, {"vertex", vertex}, {"at", at}};
        case 2: return json{{"verb", "remove"}, {"of", {{kind, 0}}}, {"vertex", vertex}};
        case 3:
            if (kind == std::string("coast")) {
                return json{{"verb", "swap"}, {"coast", 0}};
            }
            [[fallthrough]];
        default:
            return json{
                {"verb", "move"}, {"of", {{kind, 0}}}, {"vertex", vertex}, {"to", at}, {"reach", uniform(0, 10)}};
        }
    };
    std::size_t const rivers = drawing.rivers.size();
    auto const river = [&] { return rivers > 0 ? random() % rivers : 0; };
    std::size_t const one = river();
    auto const& line = rivers > 0 ? drawing.rivers[one].line : thalweg::studio::DrawnLine{{0.0, 0.0}};
    std::size_t const vertex = random() % line.size();
    json const of{{"river", one}};
    switch (rivers < 3 ? 0 : random() % 28) {
    default:
        return {{"verb", "river"}, {"points", stroke()}, {"lambda", random() % 3}, {"type", random() % 2 ? "C" : ""}};
    case 8:
    case 9:
    case 10: {
        json at = cells(line[vertex]);
        return {{"verb", "move"},
                {"of", of},
                {"vertex", vertex},
                {"to", {at[0].get<double>() + uniform(-4, 4), at[1].get<double>() + uniform(-4, 4)}},
                {"reach", uniform(0, 8)}};
    }
    case 11: {
        std::size_t const before = 1 + random() % (line.size() - 1);
        json at = cells(0.5 * (line[before - 1] + line[before]));
        return {
            {"verb", "insert"}, {"of", of}, {"vertex", before}, {"at", {at[0].get<double>() + uniform(-2, 2), at[1]}}};
    }
    case 12: return {{"verb", "remove"}, {"of", of}, {"vertex", vertex}};
    case 13: return {{"verb", "cut"}, {"river", one}, {"at", cells(line[vertex])}};
    case 14:
    case 15: {
        auto const& other = drawing.rivers[river()].line;
        return {{"verb", "join"},
                {"river", one},
                {"end", random() % 3 ? "outlet" : "source"},
                {"at", cells(other[random() % other.size()])}};
    }
    case 16: return {{"verb", "reverse"}, {"river", one}};
    case 17: return {{"verb", "erase"}, {"river", one}, {"alone", random() % 2 == 0}};
    case 18: return {{"verb", "type"}, {"rivers", {one}}, {"type", "B"}};
    case 19: return {{"verb", "lambda"}, {"rivers", {one}}, {"lambda", 1 + random() % 4}};
    case 20:
        return drawing.coasts.empty() ? json{{"verb", "coast"}, {"points", ring(0.4 * std::min(wide, tall))}}
                                      : shape("coast", drawing.coasts.front());
    case 21:
        return drawing.lakes.empty() ? json{{"verb", "lake"}, {"points", ring(4.0)}, {"level", nullptr}}
                                     : shape("lake", drawing.lakes.front().rings.front());
    case 22:
        return drawing.masks.empty() ? json{{"verb", "mask"}, {"points", ring(0.6 * std::min(wide, tall))}}
                                     : shape("mask", drawing.masks.front());
    case 23: return {{"verb", "move"}, {"of", of}, {"vertex", line.size() - 1}, {"to", place()}, {"reach", 3}};
    case 24: return {{"verb", "pin"}, {"at", place()}, {"height", std::round(uniform(0.0, 900.0))}};
    case 25: {
        if (drawing.pins.empty()) {
            return {{"verb", "pin"}, {"at", place()}, {"height", 250.5}};
        }
        std::size_t const pin = random() % drawing.pins.size();
        switch (random() % 3) {
        case 0: return {{"verb", "erase"}, {"pin", pin}};
        case 1: return {{"verb", "height"}, {"pin", pin}, {"height", uniform(0.0, 900.0)}};
        default: return {{"verb", "move"}, {"of", {{"pin", pin}}}, {"vertex", 0}, {"to", place()}};
        }
    }
    case 26: {
        json const none = nullptr;
        return {{"verb", "ridge"},
                {"points", stroke()},
                {"from", random() % 2 == 0 ? json(uniform(0.0, 900.0)) : none},
                {"to", random() % 2 == 0 ? json(uniform(0.0, 900.0)) : none}};
    }
    case 27:
        if (drawing.ridges.empty()) {
            return {{"verb", "ridge"}, {"points", stroke()}};
        }
        if (random() % 3 == 0) {
            return {{"verb", "heights"}, {"ridge", 0}, {"from", 400.0}, {"to", nullptr}};
        }
        return shape("ridge", drawing.ridges.front().line);
    }
}
