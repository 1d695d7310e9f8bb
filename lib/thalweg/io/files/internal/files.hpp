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
#include <thalweg/io/files/internal/about.hpp>

namespace thalweg::io {

/// Rejects pipes and devices.
/// \throws BadInput when is_pipe_or_device
void refuse_pipe(std::string const& path, About const& about);

/// Finds a format by its name, or, if that is "", by a path's extension, ignoring case. all: the formats with name and
/// extension ("": none); where: the caller. Throws BadParameter that lists the names.
template <class Named>
auto format_of(std::vector<Named> const& formats, std::string const& name, std::string const& path,
               std::string const& where) {
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
    throw BadParameter(where, name.empty() ? "the name of " + path + " does not tell the format; name one of " + known
                                           : "'" + name + "' is not a format; the formats are " + known);
}

/// The extension of a path in lower case: ".las"; "": none.
std::string lower_extension(std::string const& path);

/// The letters, in lower case, and digits of a name: "US survey foot", "us_survey_foot" and "US-survey-foot" are equal.
std::string simple_name(std::string_view name);

/// A new file, written piece by piece.
class NewFile {
public:
    /// Creates the file.
    /// \param path of the file
    /// \param about whose errors they are
    /// \throws IoError with the system's reason, also when the file exists
    NewFile(std::string const& path, About about);
    /// Appends bytes.
    /// \throws IoError when writing fails
    void append(std::string_view bytes);
    /// Must be called at the end: only then is everything known to be written.
    /// \throws IoError when writing fails
    void close();

private:
    struct Close {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };
    About about_;
    std::unique_ptr<std::FILE, Close> file_;
};

} // namespace thalweg::io
