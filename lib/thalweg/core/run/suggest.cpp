// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/run/suggest.hpp>

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace thalweg {

namespace {

char lower(char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

/// Letters put in, left out, replaced, or swapped with their neighbour.
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    std::vector<std::size_t> above = row;
    std::vector<std::size_t> two_above = row;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        two_above.swap(above);
        above = row;
        row[0] = i;
        for (std::size_t k = 1; k <= b.size(); ++k) {
            char const mine = lower(a[i - 1]);
            char const its = lower(b[k - 1]);
            row[k] = std::min({above[k] + 1, row[k - 1] + 1, above[k - 1] + (mine == its ? 0 : 1)});
            if (i > 1 && k > 1 && mine == lower(b[k - 2]) && its == lower(a[i - 2])) {
                row[k] = std::min(row[k], two_above[k - 2] + 1);
            }
        }
    }
    return row.back();
}

} // namespace

std::string closest(std::string_view word, std::vector<std::string> const& known) {
    word = word.substr(0, 64); // longer words are typing of another kind
    std::string best;
    std::size_t best_distance = std::clamp<std::size_t>(word.size() / 3, 1, 3) + 1;
    for (std::string const& candidate : known) {
        std::size_t const d = edit_distance(word, candidate);
        if (d < best_distance) {
            best_distance = d;
            best = candidate;
        }
    }
    return best;
}

std::string did_you_mean(std::string_view word, std::vector<std::string> const& known) {
    std::string const near = closest(word, known);
    return near.empty() ? "" : " Did you mean '" + near + "'?";
}

} // namespace thalweg
