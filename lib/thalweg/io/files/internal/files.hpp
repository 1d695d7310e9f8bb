// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <thalweg/core/run/error.hpp>

namespace thalweg::io {

/// The format of a name, or where it is "" of a path's ending, in any case of letters.
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

/// The letters, in lower case, and digits of a name: "US survey foot", "us_survey_foot" and "US-survey-foot" are one.
std::string simple_name(std::string_view name);

/// A file that is not there yet, written piece by piece.
class NewFile {
public:
    /// Takes: the path; who writes ("io.write_text: PATH"), for messages. Throws: IoError with the system's reason,
    /// also when the file exists.
    NewFile(std::string const& path, std::string who);
    /// Throws: IoError.
    void append(std::string_view bytes);
    /// To be called at the end: only then is all known to be written. Throws: IoError.
    void close();

private:
    struct Close {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };
    std::string who_;
    std::unique_ptr<std::FILE, Close> file_;
};

} // namespace thalweg::io
