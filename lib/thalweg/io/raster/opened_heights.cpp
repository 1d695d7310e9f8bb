// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/raster/internal/opened_heights.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <limits>
#include <string_view>
#include <utility>

#include <cpl_string.h>
#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/crs/internal/crs.hpp>
#include <thalweg/io/crs/internal/units.hpp>
#include <thalweg/io/files/internal/files.hpp>
#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/io/gdal/internal/dataset.hpp>
#include <thalweg/io/raster/internal/read_dem.hpp>
#include <thalweg/io/raster/internal/undeclared_nodata.hpp>

namespace thalweg::io {
namespace {

constexpr double not_there = std::numeric_limits<double>::quiet_NaN();

std::string text_of(char const* text) {
    return text == nullptr ? "" : text;
}

bool is_colour(GDALRasterBand& band) {
    GDALColorInterp const meaning = band.GetColorInterpretation();
    return meaning == GCI_RedBand || meaning == GCI_GreenBand || meaning == GCI_BlueBand ||
           (meaning == GCI_PaletteIndex && band.GetColorTable() != nullptr && band.GetRasterDataType() == GDT_Byte);
}

/// The name that a file gives to a band: of a variable, or a description.
std::string band_name(GDALRasterBand& band) {
    std::string const variable = text_of(band.GetMetadataItem("NETCDF_VARNAME"));
    return variable.empty() ? text_of(band.GetDescription()) : variable;
}

bool names_heights(std::string const& name) {
    static constexpr std::array<std::string_view, 13> names{"elevation", "height",     "heights", "z",    "dem",
                                                            "dtm",       "altitude",   "elev",    "topo", "topography",
                                                            "orography", "bathymetry", "depth"};
    return std::ranges::find(names, std::string_view(simple_name(name))) != names.end();
}

/// A variable of a file that GDAL opens as a data set of its own.
struct Variable {
    std::string opens; ///< GDAL's name
    std::string name;
};

std::vector<Variable> variables_in(GDALDataset& data) {
    std::vector<Variable> found;
    char** const listed = data.GetMetadata("SUBDATASETS");
    for (int i = 1;; ++i) {
        std::string const opens = text_of(CSLFetchNameValue(listed, fmt::format("SUBDATASET_{}_NAME", i).c_str()));
        if (opens.empty()) {
            return found;
        }
        std::string name = opens.substr(opens.rfind(':') + 1);
        std::erase(name, '"');
        name.erase(0, std::min(name.find_first_not_of('/'), name.size()));
        found.push_back({opens, name});
    }
}

std::string last_part(std::string const& name) {
    return name.substr(name.rfind('/') + 1);
}

std::string listed(std::vector<std::string> const& names) {
    std::string words;
    for (std::string const& name : names) {
        words += (words.empty() ? "" : ", ") + name;
    }
    return words;
}

/// The number that a text is; 0: it is none.
int number_in(std::string const& text) {
    bool const is_number =
        !text.empty() && text.size() < 6 && text.find_first_not_of("0123456789") == std::string::npos;
    return is_number ? std::stoi(text) : 0;
}

/// Whether the name of a unit stands for none, as formats write it that must have one.
bool says_nothing(std::string const& unit) {
    static constexpr std::array<std::string_view, 6> words{"", "1", "none", "unknown", "unspecified", "undefined"};
    return std::ranges::find(words, std::string_view(simple_name(unit))) != words.end();
}

/// Whether heights of a band grow downwards: depths.
bool points_down(GDALDataset& data, GDALRasterBand& band) {
    std::string const positive = text_of(band.GetMetadataItem("positive"));
    if (!positive.empty()) {
        return EQUAL(positive.c_str(), "down");
    }
    std::string const standard = text_of(band.GetMetadataItem("standard_name"));
    if (standard == "depth" || standard.starts_with("sea_floor_depth")) {
        return true;
    }
    // BAG files hold elevations, although GDAL 3.6 gives them a vertical axis that points down.
    if (std::string const name = simple_name(band_name(band));
        names_heights(name) && name != "depth" && name != "bathymetry") {
        return false;
    }
    OGRSpatialReference const* const reference = data.GetSpatialRef();
    OGRAxisOrientation way = OAO_Other;
    return reference != nullptr && reference->IsCompound() != 0 && reference->GetAxis("VERT_CS", 0, &way) != nullptr &&
           way == OAO_Down;
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

} // namespace

Dataset variable_of_heights(Dataset const& file, std::string const& what) {
    std::vector<Variable> const variables = variables_in(*file);
    std::vector<std::string> names;
    std::vector<Variable> likely;
    for (Variable const& variable : variables) {
        names.push_back(variable.name);
        if (variables.size() == 1 || names_heights(last_part(variable.name))) {
            likely.push_back(variable);
        }
    }
    refuse_if<BadInput>(variables.empty(), "{} holds no cells", what);
    refuse_if<BadInput>(likely.size() != 1,
                        "{} holds {} variables ({}): name the one of heights with --band NAME where the command has "
                        "that option, else as {}",
                        what, variables.size(), listed(names), variables.front().opens);
    Dataset variable = open_part(file, likely.front().opens);
    refuse_if<BadInput>(variable == nullptr || variable->GetRasterCount() < 1, "{}: its variable {} cannot be read",
                        what, likely.front().name);
    return variable;
}

struct OpenedHeights::Bands {
    Driver driver;
    Dataset file;     ///< as it was named
    Dataset variable; ///< of the file, if one was chosen
    GDALRasterBand* heights = nullptr;
    std::array<GDALRasterBand*, 3> colours{}; ///< that are decoded; null: none
    GDALRasterBand* alpha = nullptr;
    bool is_declared = false; ///< the file says which cells have data
    std::int64_t transparent = 0;

    GDALDataset& data() const { return variable ? *variable : *file; }
};

OpenedHeights::OpenedHeights(Source const& source, ReadDemParams const& params, HeightsIn wanted, std::string what)
    : params_(params), wanted_(params.values == CellValues::numbers ? HeightsIn::stored : wanted),
      what_(std::move(what)), path_(source.path), name_(std::filesystem::path(source.path).filename().string()),
      bands_(std::make_unique<Bands>()) {
    bands_->file = open_file(source, GDAL_OF_RASTER, what_);
    choose_bands();
    width_ = bands_->data().GetRasterXSize();
    height_ = bands_->data().GetRasterYSize();
    take_place();
    take_unit();
}

OpenedHeights::~OpenedHeights() = default;

void OpenedHeights::find(Finding finding) {
    finding.layer = name_;
    finding.text.insert(0, name_ + ": ");
    findings_.push_back(std::move(finding));
}

void OpenedHeights::choose_bands() {
    std::string const& wanted = params_.band;
    bool const is_by_name = !wanted.empty() && number_in(wanted) == 0;
    std::vector<Variable> const variables = variables_in(*bands_->file);
    auto const named = std::ranges::find_if(variables, [&](Variable const& variable) {
        return is_by_name && (wanted == variable.name || wanted == last_part(variable.name));
    });
    std::vector<std::string> names;
    std::ranges::transform(variables, std::back_inserter(names), &Variable::name);
    if (named != variables.end()) {
        bands_->variable = open_part(bands_->file, named->opens);
        refuse_if<BadInput>(bands_->variable == nullptr || bands_->variable->GetRasterCount() < 1,
                            "{}: its variable {} cannot be read", what_, wanted);
    } else if (bands_->file->GetRasterCount() == 0) {
        refuse_if<BadInput>(is_by_name, "{} has no variable '{}': it has {}", what_, wanted, listed(names));
        bands_->variable = variable_of_heights(bands_->file, what_);
        if (variables.size() > 1) {
            std::string const opened = bands_->variable->GetDescription();
            find({.kind = "bands",
                  .amount = static_cast<double>(variables.size()),
                  .text = fmt::format("heights are taken from {} of {}", opened.substr(opened.rfind(':') + 1),
                                      listed(names))});
        }
    }

    GDALDataset& data = bands_->data();
    std::vector<GDALRasterBand*> plain; // neither transparency nor colours
    std::vector<GDALRasterBand*> colours;
    names.clear();
    for (int i = 1; i <= data.GetRasterCount(); ++i) {
        GDALRasterBand& band = *data.GetRasterBand(i);
        if (band.GetColorInterpretation() == GCI_AlphaBand && data.GetRasterCount() > 1) {
            bands_->alpha = &band;
            continue;
        }
        (is_colour(band) ? colours : plain).push_back(&band);
        std::string const name = band_name(band);
        names.push_back(name.empty() ? fmt::format("{}", i) : fmt::format("{} {}", i, name));
    }
    bool const is_picture = params_.values == CellValues::heights && !colours.empty();
    if (params_.encoding != HeightEncoding::none) {
        refuse_if<BadInput>(colours.size() != 3 || colours[0]->GetRasterDataType() != GDT_Byte,
                            "{} has {} bands of colours: --encoding decodes a picture of red, green and blue bytes",
                            what_, colours.size());
        std::ranges::copy(colours, bands_->colours.begin());
        bands_->heights = colours.front();
    } else if (int const number = number_in(wanted); number > 0) {
        refuse_if<BadInput>(number > data.GetRasterCount(), "{} has no band {}: it has {}", what_, number,
                            data.GetRasterCount());
        bands_->heights = data.GetRasterBand(number);
    } else if (is_by_name && !bands_->variable) {
        for (int i = 1; i <= data.GetRasterCount(); ++i) {
            if (band_name(*data.GetRasterBand(i)) == wanted) {
                bands_->heights = data.GetRasterBand(i);
            }
        }
        std::vector<std::string> all = names;
        for (Variable const& variable : variables) {
            all.push_back(variable.name);
        }
        refuse_if<BadInput>(bands_->heights == nullptr, "{} has no band or variable '{}': it has {}", what_, wanted,
                            listed(all));
    } else if (is_picture && plain.size() == 1 && GDALDataTypeIsFloating(plain.front()->GetRasterDataType()) != 0) {
        bands_->heights = plain.front(); // heights with a picture of them
    } else if (is_picture) {
        throw BadInput(fmt::format("{} is a picture in colours, not a DEM: if the colours encode heights, decode them "
                                   "with --encoding terrain-rgb or --encoding terrarium; --band N takes one band as it "
                                   "is",
                                   what_));
    } else {
        std::vector<GDALRasterBand*> const& some = plain.empty() ? colours : plain;
        std::vector<GDALRasterBand*> called;
        std::ranges::copy_if(some, std::back_inserter(called),
                             [](GDALRasterBand* band) { return names_heights(band_name(*band)); });
        bool const is_clear = some.size() == 1 || called.size() == 1;
        refuse_if<BadInput>(!is_clear, "{} has {} bands ({}): a DEM has one; name it with --band N", what_, some.size(),
                            listed(names));
        bands_->heights = some.size() == 1 ? some.front() : called.front();
        if (some.size() > 1) {
            find({.kind = "bands",
                  .amount = static_cast<double>(some.size()),
                  .text =
                      fmt::format("heights are taken from band {} of {}", bands_->heights->GetBand(), listed(names))});
        }
    }
    refuse_if<BadInput>(GDALDataTypeIsComplex(bands_->heights->GetRasterDataType()) != 0,
                        "{} holds complex numbers, not heights", what_);
    bands_->is_declared = (bands_->heights->GetMaskFlags() & GMF_ALL_VALID) == 0 || bands_->alpha != nullptr;
}

void OpenedHeights::take_place() {
    GDALDataset& data = bands_->data();
    if (auto const* const own = data.GetSpatialRef(); own != nullptr && own->IsEmpty() == 0) {
        reference_ = std::make_unique<OGRSpatialReference>(*own);
        reference_->StripVertical();
        reference_->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    }
    is_placed_ = data.GetGeoTransform(frame_.data()) == CE_None;
    if (!is_placed_) {
        frame_ = {0.0, 1.0, 0.0, static_cast<double>(height_), 0.0, -1.0};
        reference_.reset();
        return;
    }
    bool const is_along_axes = frame_[2] == 0.0 && frame_[4] == 0.0;
    if (is_along_axes && frame_[5] > 0.0) {
        from_south_ = true;
        frame_[3] += height_ * frame_[5];
        frame_[5] = -frame_[5];
        find({.kind = "turned_raster",
              .amount = frame_[1],
              .text = "its rows run from south to north, and are read the other way"});
    }
    if (is_along_axes && frame_[1] < 0.0) {
        from_east_ = true;
        frame_[0] += width_ * frame_[1];
        frame_[1] = -frame_[1];
        find({.kind = "turned_raster",
              .amount = frame_[1],
              .text = "its columns run from east to west, and are read the other way"});
    }
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
    if (reference_ || params_.values == CellValues::numbers) {
        return;
    }
    for (CSLConstList line = data.GetMetadata(); line != nullptr && *line != nullptr; ++line) {
        if (std::string_view(*line).ends_with("#units=degrees_east")) { // CF
            reference_ = std::make_unique<OGRSpatialReference>(read_reference("EPSG:4326"));
            find({.kind = "assumed_degrees",
                  .text = "its axes are longitudes and latitudes without a CRS: they count as those of WGS 84"});
            return;
        }
    }
    refuse_if<BadInput>(is_along_axes && are_degrees(frame_, width_, height_),
                        "{} has no CRS, and its position, from ({:.9g}, {:.9g}) with cells of {:.6g}, is one of "
                        "longitudes and latitudes, by its size: name their CRS (gdal_edit.py -a_srs EPSG:4326 {}). If "
                        "they are metres, name a CRS in metres",
                        what_, frame_[0], frame_[3], frame_[1], path_);
}

void OpenedHeights::take_unit() {
    GDALRasterBand& band = *bands_->heights;
    double unit = 1.0;
    if (params_.encoding != HeightEncoding::none) {
        return;
    }
    if (wanted_ == HeightsIn::metres) {
        OGRSpatialReference const* const own = bands_->data().GetSpatialRef();
        std::string word = text_of(band.GetUnitType());
        auto const named = unit_named(word);
        word = says_nothing(word) ? "" : word;
        unit = named ? *named : has_vertical_unit(own) ? own->GetTargetLinearUnits("VERT_CS") : 1.0;
        bool const is_named = named || has_vertical_unit(own);
        if (!word.empty() && !named) {
            find({.kind = "unknown_unit",
                  .amount = unit,
                  .text = fmt::format("its heights are in '{}', which is no unit of length: they count as {}",
                                      word.substr(0, 40), words_for_unit(unit))});
        } else if (std::fabs(unit - 1.0) > 1e-9) {
            find({.kind = "heights_in_metres",
                  .amount = unit,
                  .text = fmt::format("heights in {} are converted into metres", words_for_unit(unit))});
        } else if (!is_named && reference_ && reference_->IsProjected() != 0 &&
                   std::fabs(reference_->GetLinearUnits() - 1.0) > 1e-9) {
            find({.kind = "heights_in_metres",
                  .amount = 1.0,
                  .text = "heights are treated as metres: no vertical CRS or unit says otherwise"});
        }
        if (points_down(bands_->data(), band)) {
            unit = -unit;
            find({.kind = "depths", .text = "its numbers grow downwards: heights are their negatives"});
        }
    }
    scale_ = band.GetScale() * unit;
    offset_ = band.GetOffset() * unit;
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
        if (from.RasterIO(GF_Read, 0, file_row, width_, 1, to, width_, 1, type, 0, 0, nullptr) != CE_None) {
            bands_->driver.check(what_);
            throw IoError(fmt::format("{}: row {} cannot be read", what_, file_row));
        }
    };
    read_row(*bands_->heights, stored.data(), GDT_Float64);
    if (params_.encoding != HeightEncoding::none) {
        std::vector<double> green(stored.size());
        std::vector<double> blue(stored.size());
        read_row(*bands_->colours[1], green.data(), GDT_Float64);
        read_row(*bands_->colours[2], blue.data(), GDT_Float64);
        for (std::size_t col = 0; col < stored.size(); ++col) {
            double const red = stored[col];
            stored[col] = params_.encoding == HeightEncoding::terrain_rgb
                              ? -10000.0 + (red * 65536.0 + green[col] * 256.0 + blue[col]) * 0.1
                              : red * 256.0 + green[col] + blue[col] / 256.0 - 32768.0;
        }
    }
    std::ranges::fill(valid, 1);
    int const mask = bands_->heights->GetMaskFlags();
    if ((mask & (GMF_ALL_VALID | GMF_ALPHA)) == 0) {
        read_row(*bands_->heights->GetMaskBand(), valid.data(), GDT_Byte);
    }
    if (bands_->alpha != nullptr) {
        std::vector<std::uint8_t> opaque(stored.size());
        read_row(*bands_->alpha, opaque.data(), GDT_Byte);
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
    std::int64_t named = 0;
    std::int64_t nan = 0;
    bool empty = true;
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
            named += is_named ? 1 : 0;
            nan += is_nan ? 1 : 0;
            if (known && !(std::fabs(height) <= implausible_height)) {
                throw BadInput(
                    fmt::format("{}: {}", what_, implausible_words(static_cast<std::int64_t>(col), row, raw)));
            }
            raw = known ? raw : not_there;
            heights[from_east_ ? heights.size() - 1 - col : col] =
                known ? static_cast<float>(height) : std::numeric_limits<float>::quiet_NaN();
            empty = empty && !known;
        }
        undeclared.add_row(stored);
        take(row, heights);
    }
    bands_->driver.check(what_);
    refuse_if<BadInput>(empty, "{} holds no heights, only no-data", what_);
    auto const doubt = undeclared.require_none(what_, path_);
    if (params_.nodata && !std::isnan(*params_.nodata)) {
        find({.kind = "named_nodata",
              .amount = static_cast<double>(named),
              .text = fmt::format("{} cells of {:g} are no-data", named, *params_.nodata)});
    }
    if (bands_->transparent > 0) {
        find({.kind = "transparent_cells",
              .amount = static_cast<double>(bands_->transparent),
              .text =
                  fmt::format("{} cells are transparent by the alpha band and count as no-data", bands_->transparent)});
    }
    if (nan > 0) {
        find({.kind = "nan_cells",
              .amount = static_cast<double>(nan),
              .text = fmt::format("{} cells are NaN and count as no-data", nan)});
    }
    if (doubt) {
        find(*doubt);
    }
}

} // namespace thalweg::io
