// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <exception>
#include <memory>
#include <string>
#include <string_view>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/io/gdal/access.hpp>

class GDALDataset;

namespace thalweg::io {

struct CloseDataset {
    std::shared_ptr<void const> keeps = {}; ///< goes after the data set is closed
    void operator()(GDALDataset* dataset) const;
};
/// A GDAL data set that closes with its scope; needs a Driver that outlives it.
using Dataset = std::unique_ptr<GDALDataset, CloseDataset>;

/// What stands for a cell without height in files.
inline constexpr float nodata_height = -9999.0F;

/// Opens a file or a database, one of the given kinds (GDAL_OF_RASTER, ...), read-only, so that neither a file nor its
/// folder is changed (see Undisturbed); null when no driver reads it, with the reason in GDAL's errors. What may be
/// opened: see Access. Throws: BadInput when it may not be opened; IoError like Undisturbed.
Dataset open_undisturbed(Source const& source, unsigned kinds);

/// Opens an existing file likewise. Throws: BadInput when there is none or no driver reads it.
Dataset open_file(Source const& source, unsigned kinds, std::string const& what);

/// A file that GDAL writes in memory: on a full disk it may say nothing (3.10). Needs a Driver that outlives it.
class MemoryFile {
public:
    MemoryFile();
    ~MemoryFile();
    MemoryFile(MemoryFile const&) = delete;
    MemoryFile& operator=(MemoryFile const&) = delete;

    /// The name that GDAL knows.
    std::string const& path() const { return path_; }
    std::string_view bytes() const;

private:
    std::string path_;
};

/// Sets position and CRS of a data set. Throws: BadInput when the CRS is none.
void set_frame(GDALDataset& dataset, Grid const& grid);

/// Throws: BadInput when a raster is empty or GDAL cannot count its cells.
void require_size(Grid const& grid, std::string const& what);

/// A copy of heights for GDAL to work on, nodata_height for NaN.
/// Throws: BadInput at an infinite height or one that equals nodata_height, or like require_size.
Dataset in_memory(Raster<float> const& dem, std::string const& what);

/// The name by which GDAL opens what a zip archive holds: the archive itself, or the only folder in it where its files
/// lie there. Any other path is given back. Needs a Driver that outlives it.
std::string inside_archive(std::string const& path);

/// Carries a Run through GDAL, which knows no exceptions: pass &Watch::step and the watch as GDAL's progress function
/// and argument, then call settle() before asking GDAL whether it worked.
class Watch {
public:
    Watch(Run const& run, char const* what) : run_(run), what_(what) {}

    static int step(double share, char const* /*message*/, void* watch) {
        auto& self = *static_cast<Watch*>(watch);
        try {
            self.run_.at(share, self.what_);
            return 1;
        } catch (...) {
            self.stopped_ = std::current_exception();
            return 0;
        }
    }
    /// Throws what stopped the work.
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
