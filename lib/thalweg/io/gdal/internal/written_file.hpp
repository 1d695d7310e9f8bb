// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>

#include <thalweg/io/files/internal/about.hpp>

namespace thalweg::io {

/// A new file that GDAL writes piece by piece. On a full disk GDAL may report no error (3.10): this notes it. Without
/// close() the file is removed. Needs a Driver that outlives it.
class WrittenFile {
public:
    /// Creates the file.
    /// \param path of the file
    /// \param about the call that writes it, for messages
    /// \throws IoError with the system's reason, also when the file exists
    WrittenFile(std::string const& path, About about);
    ~WrittenFile();
    WrittenFile(WrittenFile const&) = delete;
    WrittenFile& operator=(WrittenFile const&) = delete;

    /// The name for GDAL.
    std::string const& name() const { return name_; }
    /// \throws IoError with the system's reason when a piece could not be written
    void check() const;
    /// Must be called at the end, after GDAL has closed the file: only then is everything known to be written.
    /// \throws IoError as check()
    void close();

    struct State; ///< what GDAL's calls work on

private:
    About about_;
    std::string path_;
    std::string name_;
    std::shared_ptr<State> state_;
    bool closed_ = false;
};

} // namespace thalweg::io
