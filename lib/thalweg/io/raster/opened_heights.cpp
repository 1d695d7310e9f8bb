// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/raster/internal/opened_heights.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string_view>
#include <utility>

#include <cpl_string.h>
#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/crs/internal/crs.hpp>
#include <thalweg/io/crs/internal/units.hpp>
#include <thalweg/io/files/internal/files.hpp>
#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/io/gdal/internal/dataset.hpp>
#include <thalweg/io/raster/internal/height_bands.hpp>
#include <thalweg/io/raster/internal/heightmap_files.hpp>
#include <thalweg/io/raster/internal/netcdf_axes.hpp>
#include <thalweg/io/raster/internal/read_dem.hpp>
#include <thalweg/io/raster/internal/undeclared_nodata.hpp>

namespace thalweg::io {
namespace {

constexpr double not_there = std::numeric_limits<double>::quiet_NaN();

/// Whether the name of a unit stands for none, as formats write it that must have one.
bool says_nothing(std::string const& unit) {
    static constexpr std::array<std::string_view, 8> words{"",        "1",           "-",         " ",
                                                           "unknown", "unspecified", "undefined", "none"};
    std::string const simple = simple_name(unit);
    return std::ranges::find(words, std::string_view(simple.empty() ? unit : simple)) != words.end();
}

/// Whether coordinates can only be longitudes and latitudes. A position of exactly (0, 0) is one of a model.
bool are_degrees(CellFrame const& frame, int width, int height) {
    double const east = frame[0] + width * frame[1];
    double const south = frame[3] + height * frame[5];
    double const least_cell = 0.2; // [degrees], 12 minutes
    bool const at_origin = frame[0] == 0.0 && (frame[3] == 0.0 || south == 0.0);
    return !at_origin && frame[1] < least_cell && -frame[5] < least_cell && frame[0] >= -180.0 && east <= 360.0 &&
           frame[3] <= 90.0 && south >= -90.0;
}

/// Whether the axes of a NetCDF file are longitudes, by CF.
bool has_degrees_east(GDALDataset& data) {
    for (CSLConstList line = data.GetMetadata(); line != nullptr && *line != nullptr; ++line) {
        if (std::string_view(*line).ends_with("#units=degrees_east")) {
            return true;
        }
    }
    return false;
}

} // namespace

struct OpenedHeights::Bands {
    Driver driver; ///< outlives the files
    HeightBands of;
    bool is_declared = false; ///< the file says which cells have data
    std::int64_t transparent = 0;
};

OpenedHeights::OpenedHeights(Source const& source, ReadDemParams const& params, HeightsIn wanted, About about)
    : params_(params), wanted_(params.values == CellValues::heights ? wanted : HeightsIn::stored),
      about_(std::move(about)), path_(source.path), name_(std::filesystem::path(source.path).filename().string()),
      bands_(std::make_unique<Bands>()) {
    if (is_heightmap(source)) {
        Dataset const picture = is_picture_of_heights(source) ? open_file(source, GDAL_OF_RASTER, about_) : Dataset();
        OpenedHeightmap opened = open_heightmap(source, params_, picture, about_);
        find(std::move(opened.finding));
        bands_->of = choose_bands(std::move(opened.data), params_, about_);
        params_.nodata = params_.nodata.value_or(not_there); // 65535 is a height
    } else {
        bands_->of = choose_bands(open_file(source, GDAL_OF_RASTER, about_), params_, about_);
    }
    if (bands_->of.choice) {
        find(*bands_->of.choice);
    }
    bands_->is_declared = (bands_->of.heights->GetMaskFlags() & GMF_ALL_VALID) == 0 || bands_->of.alpha != nullptr;
    width_ = bands_->of.data().GetRasterXSize();
    height_ = bands_->of.data().GetRasterYSize();
    take_place();
    take_unit();
}

OpenedHeights::~OpenedHeights() = default;

void OpenedHeights::find(Finding finding) {
    finding.layer = name_;
    finding.text.insert(0, name_ + ": ");
    findings_.push_back(std::move(finding));
}

void OpenedHeights::take_place() {
    GDALDataset& data = bands_->of.data();
    if (auto const* const own = data.GetSpatialRef(); own != nullptr && own->IsEmpty() == 0) {
        refuse_if<BadInput>(own->IsGeocentric() != 0, about_.where,
                            "{} has a geocentric CRS, {}: positions from the centre of the Earth are not those of a "
                            "map. Assign the CRS of its cells (gdal_edit.py -a_srs EPSG:n {})",
                            about_.name, text_of(own->GetName()), path_);
        reference_ = std::make_unique<OGRSpatialReference>(*own);
        reference_->StripVertical();
        reference_->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    }
    is_placed_ = data.GetGeoTransform(frame_.data()) == CE_None;
    if (!is_placed_) {
        auto const frame = frame_of_variables(bands_->of.variable ? bands_->of.variable : bands_->of.file);
        is_placed_ = frame.has_value();
        frame_ = frame.value_or(CellFrame{0.0, 1.0, 0.0, static_cast<double>(height_), 0.0, -1.0});
    }
    if (!is_placed_) {
        reference_.reset();
        return;
    }
    turn();
    if (reference_ && reference_->IsLocal() != 0) {
        double const unit = reference_->GetLinearUnits();
        for (double& number : frame_) {
            number *= unit;
        }
        find({.kind = "site_grid",
              .amount = unit,
              .text = fmt::format("its CRS, {}, is one of a site: the position is in metres, without a place on the "
                                  "Earth",
                                  text_of(reference_->GetName()))});
        reference_.reset();
        return;
    }
    if (!reference_ && has_degrees_east(data)) {
        reference_ = std::make_unique<OGRSpatialReference>(read_reference("EPSG:4326"));
        find({.kind = "assumed_degrees",
              .text = "its axes are longitudes and latitudes without a CRS: they count as those of WGS 84"});
    }
    reference_ && reference_->IsGeographic() != 0 ? require_latitudes() : take_axes();
}

void OpenedHeights::turn() {
    auto const say = [&](char const* words) { find({.kind = "turned_raster", .amount = frame_[1], .text = words}); };
    if (frame_[1] == 0.0 && frame_[5] == 0.0 && frame_[2] != 0.0 && frame_[4] != 0.0) {
        is_transposed_ = true;
        std::swap(frame_[1], frame_[2]);
        std::swap(frame_[4], frame_[5]);
        std::swap(width_, height_);
        say("its rows are the columns of the map, and are read as these");
    }
    if (frame_[2] != 0.0 || frame_[4] != 0.0) {
        return;
    }
    if (frame_[5] > 0.0) {
        from_south_ = true;
        frame_[3] += height_ * frame_[5];
        frame_[5] = -frame_[5];
        say("its rows run from south to north, and are read the other way");
    }
    if (frame_[1] < 0.0) {
        from_east_ = true;
        frame_[0] += width_ * frame_[1];
        frame_[1] = -frame_[1];
        say("its columns run from east to west, and are read the other way");
    }
}

void OpenedHeights::require_latitudes() const {
    if (frame_[2] != 0.0 || frame_[4] != 0.0) {
        return;
    }
    double const degree = portable::pi / 180.0 / reference_->GetAngularUnits(nullptr);
    double const pole = 90.0 * degree - frame_[5]; // cells may be centred on it
    double const south = frame_[3] + height_ * frame_[5];
    refuse_if<BadInput>(frame_[3] > pole || south < -pole, about_.where,
                        "{} reaches from latitude {:.6g} to {:.6g} degrees, beyond a pole: correct its position "
                        "(gdal_edit.py -a_ullr) or its CRS (gdal_edit.py -a_srs)",
                        about_.name, south / degree, frame_[3] / degree);
}

void OpenedHeights::take_axes() {
    double const of_crs = reference_ ? reference_->GetLinearUnits() : 1.0;
    for (std::size_t const axis : {0U, 1U}) {
        std::string const word = unit_of_axis(bands_->of.data(), axis == 0 ? "x" : "y");
        double const unit = unit_named(word).value_or(of_crs);
        constexpr double least = 1e-3; // feet of one kind count as those of another
        bool const is_other = std::fabs(unit / of_crs - 1.0) > least;
        for (std::size_t i = 3 * axis; is_other && i < 3 * axis + 3; ++i) {
            frame_[i] *= unit / of_crs;
        }
        if (!unit_named(word) && !says_nothing(word)) {
            find({.kind = "unknown_unit",
                  .amount = of_crs,
                  .text = fmt::format("its coordinates {} are in '{}', which is no unit of length: they count as {}",
                                      axis == 0 ? "x" : "y", word.substr(0, 40), words_for_unit(of_crs))});
        } else if (axis == 0 && is_other && reference_) {
            find({.kind = "dem_reprojected",
                  .amount = frame_[1],
                  .text = fmt::format("its axes are in {}, its CRS in {}: cells of {:.6g}", words_for_unit(unit),
                                      words_for_unit(of_crs), frame_[1])});
        } else if (axis == 0 && is_other) {
            find({.kind = "site_grid",
                  .amount = unit,
                  .text = fmt::format("its axes are in {} without a CRS: the position is in metres, without a place on "
                                      "the Earth",
                                      words_for_unit(unit))});
        }
    }
    refuse_if<BadInput>(!reference_ && params_.values == CellValues::heights && frame_[2] == 0.0 && frame_[4] == 0.0 &&
                            are_degrees(frame_, width_, height_),
                        about_.where,
                        "{} has no CRS, and its position, from ({:.9g}, {:.9g}) with cells of {:.6g}, is one of "
                        "longitudes and latitudes, by its size: name their CRS (gdal_edit.py -a_srs EPSG:4326 {}). If "
                        "they are metres, name a CRS in metres",
                        about_.name, frame_[0], frame_[3], frame_[1], path_);
}

void OpenedHeights::take_unit() {
    GDALRasterBand& band = *bands_->of.heights;
    if (params_.encoding != HeightEncoding::none || params_.values == CellValues::codes) {
        return;
    }
    double unit = params_.values == CellValues::heights ? signed_unit() : 1.0;
    unit = wanted_ == HeightsIn::metres ? unit : std::copysign(1.0, unit);
    scale_ = band.GetScale() * unit;
    offset_ = band.GetOffset() * unit;
}

double OpenedHeights::signed_unit() {
    GDALRasterBand& band = *bands_->of.heights;
    OGRSpatialReference const* const own = bands_->of.data().GetSpatialRef();
    std::string const word = text_of(band.GetUnitType());
    auto const named = unit_named(word);
    double const of_crs = has_vertical_unit(own) ? own->GetTargetLinearUnits("VERT_CS") : 1.0;
    bool const is_unknown = !named && !says_nothing(word);
    double unit = named ? *named : is_unknown ? 1.0 : of_crs;
    bool const is_named = named || has_vertical_unit(own);
    bool const in_feet = own != nullptr && (own->IsProjected() != 0 || own->IsLocal() != 0) &&
                         std::fabs(own->GetLinearUnits() - 1.0) > 1e-9;
    if (is_unknown) {
        bool const is_other = std::fabs(of_crs - 1.0) > 1e-9;
        find({.kind = "unknown_unit",
              .amount = unit,
              .text = fmt::format(
                  "its heights are in '{}', which is no unit of length: they count as metres{}", word.substr(0, 40),
                  is_other ? fmt::format(", although its vertical CRS is in {}", words_for_unit(of_crs)) : "")});
    } else if (std::fabs(unit - 1.0) > 1e-9) {
        find({.kind = "heights_in_metres",
              .amount = unit,
              .text = fmt::format("heights in {} are converted into metres", words_for_unit(unit))});
    } else if (!is_named && in_feet) {
        find({.kind = "heights_in_metres",
              .amount = 1.0,
              .text = "heights are treated as metres: no vertical CRS or unit says otherwise"});
    }
    HeightDirection const direction = direction_of(bands_->of.data(), band);
    may_be_depths_ = direction.way == HeightDirection::Way::depths_or_heights;
    bool const is_down = direction.way == HeightDirection::Way::down;
    if (!direction.contradiction.empty()) {
        find({.kind = "doubtful_direction", .text = direction.contradiction});
    } else if (is_down) {
        find({.kind = "depths", .text = "its numbers grow downwards: heights are their negatives"});
    }
    return is_down ? -unit : unit;
}

void OpenedHeights::take_metres() {
    double const unit = reference_ && reference_->IsProjected() != 0 ? reference_->GetLinearUnits() : 1.0;
    if (std::fabs(unit - 1.0) < 1e-12) {
        return;
    }
    for (double& number : frame_) {
        number *= unit;
    }
    reference_->SetLinearUnitsAndUpdateParameters(SRS_UL_METER, 1.0);
    find({.kind = "dem_reprojected",
          .amount = frame_[1],
          .text = fmt::format("coordinates in {} become metres of the same projection, cells of {:.6g} m",
                              words_for_unit(unit), frame_[1])});
}

bool OpenedHeights::is_grid() const {
    return frame_[2] == 0.0 && frame_[4] == 0.0 && frame_[1] > 0.0 && frame_[5] < 0.0 &&
           are_squares(frame_[1], -frame_[5], width_, height_);
}

std::string OpenedHeights::crs() const {
    return reference_ ? io::name_of(*reference_) : "";
}

void OpenedHeights::read_stored(int file_row, std::span<double> stored, std::span<std::uint8_t> valid) {
    auto const read_row = [&](GDALRasterBand& from, void* to, GDALDataType type) {
        bool const done =
            is_transposed_
                ? from.RasterIO(GF_Read, file_row, 0, 1, width_, to, 1, width_, type, 0, 0, nullptr) == CE_None
                : from.RasterIO(GF_Read, 0, file_row, width_, 1, to, width_, 1, type, 0, 0, nullptr) == CE_None;
        if (!done) {
            bands_->driver.check(about_.where, about_.name);
            throw IoError(about_.where, fmt::format("{}: row {} cannot be read", about_.name, file_row));
        }
    };
    read_row(*bands_->of.heights, stored.data(), GDT_Float64);
    if (params_.encoding != HeightEncoding::none) {
        std::vector<double> green(stored.size());
        std::vector<double> blue(stored.size());
        read_row(*bands_->of.colours[1], green.data(), GDT_Float64);
        read_row(*bands_->of.colours[2], blue.data(), GDT_Float64);
        for (std::size_t col = 0; col < stored.size(); ++col) {
            double const red = stored[col];
            stored[col] = params_.encoding == HeightEncoding::terrain_rgb
                              ? -10000.0 + (red * 65536.0 + green[col] * 256.0 + blue[col]) * 0.1
                              : red * 256.0 + green[col] + blue[col] / 256.0 - 32768.0;
        }
    }
    std::ranges::fill(valid, 1);
    int const mask = bands_->of.heights->GetMaskFlags();
    if ((mask & (GMF_ALL_VALID | GMF_ALPHA)) == 0) {
        read_row(*bands_->of.heights->GetMaskBand(), valid.data(), GDT_Byte);
    }
    if (bands_->of.alpha != nullptr) {
        std::vector<std::uint8_t> opaque(stored.size());
        read_row(*bands_->of.alpha, opaque.data(), GDT_Byte);
        for (std::size_t col = 0; col < opaque.size(); ++col) {
            bands_->transparent += valid[col] != 0 && opaque[col] == 0 ? 1 : 0;
            valid[col] = opaque[col] == 0 ? 0 : valid[col];
        }
    }
}

void OpenedHeights::read(std::function<void(int, std::span<float const>)> const& take, Run const& run) {
    std::vector<double> stored(static_cast<std::size_t>(width_));
    std::vector<std::uint8_t> valid(stored.size());
    std::vector<float> heights(stored.size());
    bool const scaled = scale_ != 1.0 || offset_ != 0.0;
    UndeclaredNodata undeclared(width_, params_, bands_->is_declared, scale_);
    Counts counts;
    for (int row = 0; row < height_; ++row) {
        run.at(static_cast<double>(row) / height_, "read");
        int const file_row = from_south_ ? height_ - 1 - row : row;
        read_stored(file_row, stored, valid);
        for (std::size_t col = 0; col < stored.size(); ++col) {
            double& raw = stored[col];
            double const height = scaled ? raw * scale_ + offset_ : raw; // -0 stays -0
            bool const is_named = valid[col] != 0 && params_.nodata && stands_for(raw, *params_.nodata);
            bool const is_nan = valid[col] != 0 && std::isnan(height);
            bool const known = valid[col] != 0 && !is_nan && !is_named;
            counts.named += is_named ? 1 : 0;
            counts.nan += is_nan ? 1 : 0;
            counts.above += known && height > 0.0 ? 1 : 0;
            counts.below += known && height < 0.0 ? 1 : 0;
            if (known && !(std::fabs(height) <= implausible_height)) {
                throw BadInput(about_.where, fmt::format("{}: {}", about_.name,
                                                         implausible_words(static_cast<std::int64_t>(col), row, raw)));
            }
            raw = known ? raw : not_there;
            heights[from_east_ ? heights.size() - 1 - col : col] =
                known ? static_cast<float>(height) : std::numeric_limits<float>::quiet_NaN();
            counts.known += known ? 1 : 0;
        }
        undeclared.add_row(stored);
        take(row, heights);
    }
    bands_->driver.check(about_.where, about_.name);
    refuse_if<BadInput>(counts.known == 0, about_.where, "{} holds no heights, only no-data", about_.name);
    auto const doubt = undeclared.require_none(about_, path_);
    find_counts(counts);
    if (doubt) {
        find(*doubt);
    }
}

void OpenedHeights::find_counts(Counts const& counts) {
    if (params_.nodata && !std::isnan(*params_.nodata)) {
        find({.kind = "named_nodata",
              .amount = static_cast<double>(counts.named),
              .text = fmt::format("{} cells of {:g} are no-data", counts.named, *params_.nodata)});
    }
    if (bands_->transparent > 0) {
        find({.kind = "transparent_cells",
              .amount = static_cast<double>(bands_->transparent),
              .text =
                  fmt::format("{} cells are transparent by the alpha band and count as no-data", bands_->transparent)});
    }
    if (counts.nan > 0) {
        find({.kind = "nan_cells",
              .amount = static_cast<double>(counts.nan),
              .text = fmt::format("{} cells are NaN and count as no-data", counts.nan)});
    }
    if (may_be_depths_ && counts.above > counts.below) {
        find(
            {.kind = "doubtful_direction",
             .text = "its name means depths, and nothing says that its numbers grow downwards: they count as heights"});
    }
}

} // namespace thalweg::io
