// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/skeleton/internal/normal_row.hpp>

#include <algorithm>
#include <array>
#include <cstddef>

#include <thalweg/core/numbers/normal.hpp>
#include <thalweg/core/numbers/random.hpp>

namespace thalweg::skeleton {

void normal_row(std::uint64_t seed, std::uint64_t stage, std::uint64_t row, std::span<double> values) {
    for (std::size_t i = 0; i < values.size(); i += 4) {
        auto const words = random_block(seed, stage, row, i / 4);
        auto const [a, b] = normal_pair(words[0], words[1]);
        auto const [c, d] = normal_pair(words[2], words[3]);
        std::array<double, 4> const four = {a, b, c, d};
        std::copy_n(four.begin(), std::min<std::size_t>(4, values.size() - i),
                    values.begin() + static_cast<std::ptrdiff_t>(i));
    }
}

} // namespace thalweg::skeleton
