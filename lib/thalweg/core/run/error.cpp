// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/run/error.hpp>

#include <algorithm>
#include <array>
#include <new>
#include <string_view>

namespace thalweg {

namespace {

constexpr std::string_view separator = ": ";

bool is_module(std::string_view word) {
    constexpr std::array<std::string_view, 21> modules{"core",     "geometry", "solver",  "flow",  "growth",  "network",
                                                       "skeleton", "surface",  "fractal", "blend", "measure", "draw",
                                                       "io",       "serve",    "recipe",  "make",  "report",  "export",
                                                       "ensemble", "commands", "studio"};
    return std::find(modules.begin(), modules.end(), word) != modules.end();
}

bool is_name(std::string_view word) {
    return !word.empty() && std::all_of(word.begin(), word.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    });
}

/// "module.function" at the beginning of a text, or "".
std::string_view function_of(std::string_view text) {
    std::string_view const head = text.substr(0, std::min(text.find(separator), text.size()));
    std::size_t const dot = head.find('.');
    bool const known = head.size() < text.size() && dot != std::string_view::npos && is_module(head.substr(0, dot)) &&
                       is_name(head.substr(dot + 1));
    return known ? head : std::string_view();
}

std::string message_of(std::string_view text) {
    std::string_view const function = function_of(text);
    if (function.empty()) {
        return std::string(text);
    }
    std::string const prefix = std::string(function) + std::string(separator);
    std::string message;
    while (true) {
        if (text.substr(0, prefix.size()) == prefix) {
            text.remove_prefix(prefix.size());
        }
        std::size_t const line = text.find('\n');
        if (line == std::string_view::npos) {
            return message + std::string(text);
        }
        message += text.substr(0, line + 1);
        text.remove_prefix(line + 1);
    }
}

} // namespace

Error::Error(std::string const& text) : std::runtime_error(message_of(text)), where_(std::string(function_of(text))) {}

char const* words_of(std::exception const& error) noexcept {
    return dynamic_cast<std::bad_alloc const*>(&error) != nullptr ? out_of_memory : error.what();
}

} // namespace thalweg
