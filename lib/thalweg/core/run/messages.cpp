// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/run/messages.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <tuple>
#include <utility>

#include <fmt/format.h>

namespace thalweg {
namespace {

constexpr std::size_t longest_line = 600;
constexpr std::size_t kept_first = 400;
constexpr std::size_t kept_last = 150;
constexpr std::size_t most_lines = 60;
constexpr std::size_t kept_lines = 50;

bool continues(char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;
}

/// The first character of a text and its length in bytes; length 0: not UTF-8.
std::pair<std::uint32_t, std::size_t> first_character(std::string_view text) {
    auto const head = static_cast<unsigned char>(text.front());
    if (head < 0x80U) {
        return {head, 1};
    }
    std::size_t const length = head >= 0xF0U ? 4 : head >= 0xE0U ? 3 : 2;
    if (head < 0xC2U || head > 0xF4U || text.size() < length) {
        return {0, 0};
    }
    std::uint32_t code = head & (0x7FU >> length);
    for (std::size_t i = 1; i < length; ++i) {
        if (!continues(text[i])) {
            return {0, 0};
        }
        code = (code << 6U) | (static_cast<unsigned char>(text[i]) & 0x3FU);
    }
    constexpr std::array<std::uint32_t, 5> least{0, 0, 0x80, 0x800, 0x10000};
    bool const is_known = code >= least[length] && code <= 0x10FFFF && !(code >= 0xD800 && code <= 0xDFFF);
    return is_known ? std::pair{code, length} : std::pair<std::uint32_t, std::size_t>{0, 0};
}

/// Whether a character controls a terminal or the order of the text it shows.
bool is_control(std::uint32_t code) {
    return (code < 0x20 && code != '\t') || (code >= 0x7F && code <= 0x9F) || code == 0x61C ||
           (code >= 0x200B && code <= 0x200F) || (code >= 0x2028 && code <= 0x202E) ||
           (code >= 0x2060 && code <= 0x206F) || code == 0xFEFF;
}

std::string escaped_byte(char byte) {
    return fmt::format("\\x{:02x}", static_cast<unsigned char>(byte));
}

std::string escaped(std::string_view text) {
    std::string out;
    out.reserve(text.size());
    while (!text.empty()) {
        auto const [code, length] = first_character(text);
        if (length == 0) {
            out += escaped_byte(text.front());
        } else if (is_control(code)) {
            out += code < 0x80 ? fmt::format("\\x{:02x}", code) : fmt::format("\\u{{{:04x}}}", code);
        } else {
            out += text.substr(0, length);
        }
        text.remove_prefix(std::max<std::size_t>(length, 1));
    }
    return out;
}

std::string cut_line(std::string_view line) {
    if (line.size() <= longest_line) {
        return std::string(line);
    }
    std::size_t first = kept_first;
    std::size_t last = line.size() - kept_last;
    while (first > 0 && continues(line[first])) {
        --first;
    }
    while (last < line.size() && continues(line[last])) {
        ++last;
    }
    return fmt::format("{} [... {} bytes left out ...] {}", line.substr(0, first), last - first, line.substr(last));
}

bool is_same_letter(char a, char b) {
    return std::tolower(static_cast<unsigned char>(a)) == b;
}

/// Finds where the value of a "password = value" at this position begins and ends; empty: there is none.
std::pair<std::size_t, std::size_t> password_at(std::string_view text, std::size_t at) {
    constexpr std::string_view word = "password";
    if (text.size() - at < word.size() ||
        !std::equal(word.begin(), word.end(), text.begin() + static_cast<std::ptrdiff_t>(at),
                    [](char w, char t) { return is_same_letter(t, w); })) {
        return {0, 0};
    }
    std::size_t begin = std::min(text.find_first_not_of(' ', at + word.size()), text.size());
    if (begin == text.size() || text[begin] != '=') {
        return {0, 0};
    }
    begin = std::min(text.find_first_not_of(' ', begin + 1), text.size());
    if (begin < text.size() && (text[begin] == '\'' || text[begin] == '"')) {
        std::size_t end = begin + 1;
        while (end < text.size() && text[end] != text[begin]) {
            end += text[end] == '\\' ? 2 : 1;
        }
        return {begin, std::min(end + 1, text.size())};
    }
    return {begin, std::min(text.find_first_of(" ,&;'\"\n)", begin), text.size())};
}

/// Finds where the password of a "://user:password@" whose "://" is at this position begins and ends; empty: there is
/// none.
std::pair<std::size_t, std::size_t> address_password_at(std::string_view text, std::size_t at) {
    constexpr std::string_view mark = "://";
    if (text.substr(at, mark.size()) != mark) {
        return {0, 0};
    }
    std::size_t const from = at + mark.size();
    std::size_t const end = std::min(text.find_first_of("/ \n?", from), text.size());
    std::size_t const host = text.substr(from, end - from).rfind('@');
    std::size_t const colon = text.find(':', from);
    return host == std::string_view::npos || colon == std::string_view::npos || colon > from + host
               ? std::pair<std::size_t, std::size_t>{0, 0}
               : std::pair{colon + 1, from + host};
}

char lower(char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

/// Counts inserted, deleted and replaced letters; swapping two neighbours counts as one edit.
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

std::string without_passwords(std::string_view text) {
    std::string out;
    std::size_t copied = 0;
    for (std::size_t at = 0; at < text.size(); ++at) {
        auto [begin, end] = password_at(text, at);
        if (end == 0) {
            std::tie(begin, end) = address_password_at(text, at);
        }
        if (end > begin) {
            out += text.substr(copied, begin - copied);
            out += "...";
            copied = end;
            at = end - 1;
        }
    }
    return out + std::string(text.substr(copied));
}

bool is_utf8(std::string_view text) {
    while (!text.empty()) {
        std::size_t const length = first_character(text).second;
        if (length == 0) {
            return false;
        }
        text.remove_prefix(length);
    }
    return true;
}

std::string as_utf8(std::string_view text) {
    std::string out;
    out.reserve(text.size());
    while (!text.empty()) {
        std::size_t const length = first_character(text).second;
        out += length == 0 ? escaped_byte(text.front()) : std::string(text.substr(0, length));
        text.remove_prefix(std::max<std::size_t>(length, 1));
    }
    return out;
}

std::string in_single_quotes(std::string_view text) {
    std::string out = "'";
    for (char const c : text) {
        out += c == '\'' ? "'\\''" : std::string(1, c);
    }
    return out + "'";
}

std::string for_shell(std::string const& word) {
    bool const plain = !word.empty() && word.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                                               "0123456789_./+:=@%-") == std::string::npos;
    return plain ? word : in_single_quotes(word);
}

std::string printable(std::string_view text) {
    auto const lines = static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')) + 1;
    std::size_t const shown = lines <= most_lines ? lines : kept_lines;
    std::string out;
    for (std::size_t i = 0; i < shown; ++i) {
        std::size_t const end = std::min(text.find('\n'), text.size());
        if (i > 0) {
            out += '\n';
        }
        out += escaped(cut_line(without_passwords(text.substr(0, end))));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return shown == lines ? out : fmt::format("{}\n[... {} more lines ...]", out, lines - shown);
}

std::string closest(std::string_view word, std::vector<std::string> const& known) {
    word = word.substr(0, 64); // limits the time; longer words are not typing errors
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
