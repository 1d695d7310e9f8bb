// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/files/internal/simple_name.hpp>

namespace thalweg::io {

std::string simple_name(std::string_view name) {
    std::string out;
    for (char const c : name) {
        char const lower = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
        if ((lower >= 'a' && lower <= 'z') || (lower >= '0' && lower <= '9')) {
            out += lower;
        }
    }
    return out;
}

} // namespace thalweg::io
