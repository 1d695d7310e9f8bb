// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/io/files/internal/about.hpp>
#include <thalweg/io/raster/raster_files.hpp>

class OGRSpatialReference;

namespace thalweg::io {

/// The position of a raster's cells in its CRS: west, width of a cell, skew, north, skew, minus the height of a cell.
using CellFrame = std::array<double, 6>;

/// The unit in which heights are wanted.
enum class HeightsIn : std::uint8_t { metres, stored };

/// A raster file of heights, open: the one way from a file to metres, for every reader. It chooses the band or
/// variable, decodes colours, and applies mask, alpha, no-data, scale, offset, unit and the direction of heights; rows
/// that run from the south and columns that run from the east are read the other way, rows that are columns as these.
/// The vertical CRS only names the unit: nothing shifts heights to another datum.
class OpenedHeights {
public:
    /// \param about whose errors they are
    /// \throws BadInput as read_dem_file, except for what only the values show
    OpenedHeights(Source const& source, ReadDemParams const& params, HeightsIn wanted, About about);
    ~OpenedHeights();
    OpenedHeights(OpenedHeights const&) = delete;
    OpenedHeights& operator=(OpenedHeights const&) = delete;

    int width() const { return width_; }
    int height() const { return height_; }
    /// Whether the file says where it lies.
    bool is_placed() const { return is_placed_; }
    /// Of north-up rows, in the unit of the CRS; cells of 1 from (0, height) where the file has no position.
    CellFrame const& frame() const { return frame_; }
    /// Whether rows and columns run along the axes and cells are squares.
    bool is_grid() const;
    /// The horizontal CRS; null: none, or one of a site.
    OGRSpatialReference const* reference() const { return reference_.get(); }
    /// Its name: "EPSG:n", WKT or "".
    std::string crs() const;

    /// Takes metres for the feet of a projection, in frame and CRS, with a finding.
    void take_metres();

    /// Reads all heights once, from the north.
    /// \param take called with each row's number and heights [m]; NaN: no data
    /// \throws BadInput for heights that no terrain has, undeclared no-data, and where there are no heights at all
    void read(std::function<void(int, std::span<float const>)> const& take, Run const& run);

    /// What was done, complete after read().
    std::vector<Finding> take_findings() { return std::move(findings_); }

private:
    struct Bands;
    struct Counts { ///< of cells
        std::int64_t known = 0;
        std::int64_t above = 0; ///< 0 m
        std::int64_t below = 0;
        std::int64_t named = 0; ///< by --nodata
        std::int64_t nan = 0;
    };

    void take_place();
    /// Makes rows run from the north and columns from the west where both run along the axes.
    void turn();
    void require_latitudes() const;
    /// Takes the unit of length that axes name.
    void take_axes();
    void take_unit();
    /// \return [m] of a stored unit, below 0 where numbers grow downwards
    double signed_unit();
    void find(Finding finding);
    void find_counts(Counts const& counts);
    /// Reads a row of the file, if transposed a column: stored values, and 0 where the file declares no data.
    void read_stored(int file_row, std::span<double> stored, std::span<std::uint8_t> valid);

    ReadDemParams params_;
    HeightsIn wanted_;
    About about_;
    std::string path_;
    std::string name_; ///< the file's, for findings
    std::unique_ptr<Bands> bands_;
    int width_ = 0;
    int height_ = 0;
    bool is_placed_ = false;
    CellFrame frame_{};
    bool is_transposed_ = false; ///< width, height and frame are those of the columns
    bool from_south_ = false;    ///< the file's rows
    bool from_east_ = false;     ///< the file's columns
    std::unique_ptr<OGRSpatialReference> reference_;
    double scale_ = 1.0;         ///< [m] of a stored unit
    double offset_ = 0.0;        ///< [m]
    bool may_be_depths_ = false; ///< the name of its band says so
    std::vector<Finding> findings_;
};

} // namespace thalweg::io
