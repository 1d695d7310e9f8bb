// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <charconv>
#include <cstdint>
#include <string>
#include <system_error>

namespace thalweg::tools {

/// Why a word is not a random seed, which a recipe can hold too; "" where it is one.
inline std::string is_seed(std::string const& word) {
    std::int64_t seed = -1;
    auto const [end, fault] = std::from_chars(word.data(), word.data() + word.size(), seed);
    bool const is_one = fault == std::errc() && end == word.data() + word.size() && seed >= 0;
    return is_one ? "" : "'" + word + "' is not a seed: give a whole number from 0 to 9223372036854775807";
}

} // namespace thalweg::tools
