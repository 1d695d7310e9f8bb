// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

namespace thalweg::io {

/// A file that is not there yet, written piece by piece. Private to this module.
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
