// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/frame/internal/crs_text.hpp>

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

namespace thalweg::io {

std::string in_message(std::string const& crs) {
    constexpr std::size_t most = 60;
    return crs.empty()          ? "no CRS"
           : crs.size() <= most ? crs
                                : fmt::format("{}...", std::string_view(crs).substr(0, most));
}

int epsg_code(std::string const& crs) {
    constexpr std::string_view prefix = "EPSG:";
    if (!crs.starts_with(prefix) || crs.size() > prefix.size() + 6) {
        return 0;
    }
    int code = 0;
    for (char const digit : crs.substr(prefix.size())) {
        if (digit < '0' || digit > '9') {
            return 0;
        }
        code = 10 * code + (digit - '0');
    }
    return code;
}

std::string one_line(std::string text) {
    std::ranges::replace_if(
        text, [](char c) { return c == '\n' || c == '\r'; }, ' ');
    return text;
}

} // namespace thalweg::io
