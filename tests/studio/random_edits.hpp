// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <thalweg/core/run/error.hpp>
#include <thalweg/studio/document.hpp>

/// A value that a key may get; nothing: it is left alone here.
inline std::optional<std::string> value_for(thalweg::recipe::KeyHelp const& key, std::optional<std::string> const& now,
                                            std::mt19937_64& random) {
    auto const uniform = [&](double low, double high) {
        return low + (high - low) * static_cast<double>(random() >> 11U) * 0x1p-53;
    };
    static std::set<std::string> const larger{"grid.width",
                                              "grid.height",
                                              "network.dla.particles",
                                              "network.forest.particles",
                                              "network.tokunaga.order",
                                              "network.forest.seeds"};
    if (key.is_file || larger.contains(key.path) || key.path == "grid.cell") {
        return std::nullopt;
    }
    if (!key.choices.empty()) {
        return key.choices[random() % key.choices.size()];
    }
    if (key.type == "yes/no") {
        return random() % 2 == 0 ? "true" : "false";
    }
    if (key.type != "number" && key.type != "integer") {
        return std::nullopt;
    }
    double const present = now ? std::stod(*now) : uniform(0.1, 2.0);
    double value = present == 0.0 ? uniform(0.0, 2.0) : present * uniform(0.6, 1.6);
    value = std::clamp(value, key.least.value_or(value), key.most.value_or(value));
    return key.type == "integer" ? std::to_string(static_cast<std::int64_t>(value)) : std::to_string(value);
}

/// An edit of any key that is not refused, and the document after it.
inline std::pair<thalweg::studio::Edit, thalweg::studio::Document>
random_edit(thalweg::studio::Document const& document, std::mt19937_64& random) {
    using namespace thalweg;
    using namespace thalweg::studio;
    std::vector<recipe::KeyHelp> const keys = recipe::recipe_keys();
    for (;;) {
        auto const values = recipe::key_values(document.recipe);
        recipe::KeyValue const& one = values[random() % values.size()];
        auto const key = std::ranges::find(keys, one.path, &recipe::KeyHelp::path);
        if (key == keys.end()) {
            continue;
        }
        Edit edit;
        if (random() % 8 == 0 && key->path.find('.') != std::string::npos) {
            edit.steps = {UnsetKey{one.path}};
        } else if (auto const value = value_for(*key, one.text, random)) {
            edit.steps = {SetKey{one.path, *value}};
        } else {
            continue;
        }
        try {
            Document after = apply(document, edit).document;
            if (after.toml != document.toml) {
                return {edit, after};
            }
        } catch (BadParameter const&) { // as it may
        }
    }
}
