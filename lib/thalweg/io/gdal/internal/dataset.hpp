// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <exception>
#include <memory>
#include <string>
#include <string_view>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/io/files/internal/about.hpp>
#include <thalweg/io/gdal/access.hpp>

class GDALDataset;

namespace thalweg::io {

class Driver;

struct CloseDataset {
    std::shared_ptr<void const> keeps = {}; ///< released after the data set is closed
    void operator()(GDALDataset* dataset) const;
};
/// A GDAL data set that closes with its scope; needs a Driver that outlives it.
using Dataset = std::unique_ptr<GDALDataset, CloseDataset>;

/// Value of cells without heights in files.
inline constexpr float nodata_height = -9999.0F;

/// Opens a file or a database, one of the given kinds (GDAL_OF_RASTER, ...), read-only, so that neither a file nor its
/// folder is changed (see UnchangedFile); null when no driver reads it, with the reason in GDAL's errors. What may be
/// opened: see Access.
/// \throws BadInput when it may not be opened; IoError like UnchangedFile
Dataset open_unchanged(Source const& source, unsigned kinds);

/// Opens an existing file likewise, or a part of one: DRIVER:"FILE":NAME.
/// \throws BadInput when there is none or no driver reads it
Dataset open_file(Source const& source, unsigned kinds, About const& about);

/// \throws BadInput when a path that no driver reads is a folder
void refuse_folder(std::string const& path, About const& about);

/// Opens a part of an open file by GDAL's name of it, with the same driver and under the same restrictions; null when
/// it cannot be read.
Dataset open_part(Dataset const& file, std::string const& name);

/// A file that GDAL writes in memory: on a full disk GDAL may report no error (3.10). Needs a Driver that outlives it.
class MemoryFile {
public:
    MemoryFile();
    ~MemoryFile();
    MemoryFile(MemoryFile const&) = delete;
    MemoryFile& operator=(MemoryFile const&) = delete;

    /// The name for GDAL.
    std::string const& path() const { return path_; }
    std::string_view bytes() const;

private:
    std::string path_;
};

/// The name by which GDAL opens the content of a zip archive: the archive itself, or its only folder if its files are
/// there. Other paths are returned unchanged. Needs a Driver that outlives it.
std::string inside_archive(std::string const& path);

/// Drops the errors of opening an archive (.zip) that was opened: of several files in it, drivers say so that read one.
void forget_archive(std::string const& path, Driver const& driver);

/// Passes a Run through GDAL, which does not support exceptions: pass &GdalProgress::step and the object as GDAL's
/// progress function and argument, then call settle() before checking whether GDAL succeeded.
class GdalProgress {
public:
    GdalProgress(Run const& run, char const* what) : run_(run), what_(what) {}

    static int step(double share, char const* /*message*/, void* gdal_progress) {
        auto& self = *static_cast<GdalProgress*>(gdal_progress);
        try {
            self.run_.at(share, self.what_);
            return 1;
        } catch (...) {
            self.stopped_ = std::current_exception();
            return 0;
        }
    }
    /// Rethrows the exception that stopped the work.
    void settle() const {
        if (stopped_) {
            std::rethrow_exception(stopped_);
        }
    }

private:
    Run const& run_;
    char const* what_;
    std::exception_ptr stopped_;
};

} // namespace thalweg::io
