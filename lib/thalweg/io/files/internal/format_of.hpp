// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <thalweg/core/run/error.hpp>

namespace thalweg::io {

/// The format of a name, or where it is "" of a path's ending, in any case of letters. Private to this module.
/// Takes: the formats there are, each with name and ending ("" for none); who asks, for the message.
/// Throws: BadParameter that lists the names.
template <class Named>
auto format_of(std::vector<Named> const& formats, std::string const& name, std::string const& path,
               std::string const& who) {
    std::string lowered = path;
    std::ranges::transform(lowered, lowered.begin(),
                           [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    std::string known;
    for (Named const& f : formats) {
        if (name.empty() ? *f.ending != '\0' && lowered.ends_with(f.ending) : name == f.name) {
            return f.format;
        }
        known += (known.empty() ? "" : ", ") + std::string(f.name);
    }
    throw BadParameter(name.empty() ? who + ": the name of " + path + " does not tell the format; name one of " + known
                                    : who + ": '" + name + "' is not a format; the formats are " + known);
}

} // namespace thalweg::io
