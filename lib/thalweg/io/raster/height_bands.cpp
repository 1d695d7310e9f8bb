// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/raster/internal/height_bands.hpp>

#include <algorithm>
#include <iterator>
#include <string_view>
#include <utility>
#include <vector>

#include <cpl_string.h>
#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/files/internal/files.hpp>

namespace thalweg::io {

std::string text_of(char const* text) {
    return text == nullptr ? "" : text;
}

namespace {

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

bool names_elevations(std::string const& name) {
    static constexpr std::array<std::string_view, 11> names{
        "elevation", "height", "heights", "z", "dem", "dtm", "altitude", "elev", "topo", "topography", "orography"};
    return std::ranges::find(names, std::string_view(simple_name(name))) != names.end();
}

bool names_depths(std::string const& name) {
    std::string const simple = simple_name(name);
    return simple == "depth" || simple == "depths" || simple == "bathymetry";
}

/// The only name that means heights; of heights and depths that of heights. Nothing: none, or several.
std::optional<std::size_t> name_of_heights(std::vector<std::string> const& names) {
    for (bool (*const means)(std::string const&) : {names_elevations, names_depths}) {
        if (auto const count = std::ranges::count_if(names, means); count > 0) {
            auto const at = std::ranges::find_if(names, means) - names.begin();
            return count == 1 ? std::optional(static_cast<std::size_t>(at)) : std::nullopt;
        }
    }
    return std::nullopt;
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

/// The number that a text is; 0: it is none.
int number_in(std::string const& text) {
    bool const is_number =
        !text.empty() && text.size() < 6 && text.find_first_not_of("0123456789") == std::string::npos;
    return is_number ? std::stoi(text) : 0;
}

/// Chooses the variable where the data set of the file itself is not the one to read.
void choose_variable(HeightBands& bands, std::string const& wanted, About const& about) {
    bool const is_by_name = !wanted.empty() && number_in(wanted) == 0;
    std::vector<Variable> const variables = variables_in(*bands.file);
    auto const named = std::ranges::find_if(variables, [&](Variable const& variable) {
        return is_by_name && (wanted == variable.name || wanted == last_part(variable.name));
    });
    if (named != variables.end()) {
        bands.variable = open_part(bands.file, named->opens);
        refuse_if<BadInput>(bands.variable == nullptr || bands.variable->GetRasterCount() < 1, about.where,
                            "{}: its variable {} cannot be read", about.name, wanted);
        return;
    }
    if (bands.file->GetRasterCount() > 0) {
        return;
    }
    std::vector<std::string> names;
    std::ranges::transform(variables, std::back_inserter(names), &Variable::name);
    refuse_if<BadInput>(is_by_name, about.where, "{} has no variable '{}': it has {}", about.name, wanted,
                        fmt::join(names, ", "));
    bands.variable = variable_of_heights(bands.file, about);
    if (variables.size() > 1) {
        std::string const opened = bands.variable->GetDescription();
        bands.choice = {.kind = "bands",
                        .amount = static_cast<double>(variables.size()),
                        .text = fmt::format("heights are taken from {} of {}", opened.substr(opened.rfind(':') + 1),
                                            fmt::join(names, ", "))};
    }
}

/// The bands of a data set that may hold heights.
struct Candidates {
    std::vector<GDALRasterBand*> plain; ///< neither transparency nor colours
    std::vector<GDALRasterBand*> colours;
    GDALRasterBand* alpha = nullptr;
    std::vector<std::string> names; ///< of plain ones and colours: "2 after"
};

Candidates candidates_in(GDALDataset& data) {
    Candidates found;
    for (int i = 1; i <= data.GetRasterCount(); ++i) {
        GDALRasterBand& band = *data.GetRasterBand(i);
        if (band.GetColorInterpretation() == GCI_AlphaBand && data.GetRasterCount() > 1) {
            found.alpha = &band;
            continue;
        }
        (is_colour(band) ? found.colours : found.plain).push_back(&band);
        std::string const name = band_name(band);
        found.names.push_back(name.empty() ? fmt::format("{}", i) : fmt::format("{} {}", i, name));
    }
    return found;
}

/// The band that a user named, by number or name.
GDALRasterBand* wanted_band(HeightBands const& bands, std::string const& wanted, std::vector<std::string> all,
                            About const& about) {
    GDALDataset& data = bands.data();
    if (int const number = number_in(wanted); number > 0) {
        refuse_if<BadInput>(number > data.GetRasterCount(), about.where, "{} has no band {}: it has {}", about.name,
                            number, data.GetRasterCount());
        return data.GetRasterBand(number);
    }
    for (int i = data.GetRasterCount(); i > 0; --i) {
        if (band_name(*data.GetRasterBand(i)) == wanted) {
            return data.GetRasterBand(i);
        }
    }
    for (Variable const& variable : variables_in(*bands.file)) {
        all.push_back(variable.name);
    }
    throw BadInput(about.where,
                   fmt::format("{} has no band or variable '{}': it has {}", about.name, wanted, fmt::join(all, ", ")));
}

/// The only band, or the only one whose name means heights.
GDALRasterBand* clear_band(Candidates const& found, std::optional<Finding>& choice, About const& about) {
    std::vector<GDALRasterBand*> const& some = found.plain.empty() ? found.colours : found.plain;
    std::vector<std::string> names;
    std::ranges::transform(some, std::back_inserter(names), [](GDALRasterBand* band) { return band_name(*band); });
    auto const at = some.size() == 1 ? std::optional<std::size_t>(0) : name_of_heights(names);
    refuse_if<BadInput>(!at, about.where, "{} has {} bands ({}): a DEM has one; name it with --band N", about.name,
                        some.size(), fmt::join(found.names, ", "));
    if (some.size() > 1) {
        choice = {.kind = "bands",
                  .amount = static_cast<double>(some.size()),
                  .text = fmt::format("heights are taken from band {} of {}", some[*at]->GetBand(),
                                      fmt::join(found.names, ", "))};
    }
    return some[*at];
}

} // namespace

Dataset variable_of_heights(Dataset const& file, About const& about) {
    std::vector<Variable> const variables = variables_in(*file);
    std::vector<std::string> names;
    std::vector<std::string> parts;
    for (Variable const& variable : variables) {
        names.push_back(variable.name);
        parts.push_back(last_part(variable.name));
    }
    refuse_if<BadInput>(variables.empty(), about.where, "{} holds no cells", about.name);
    auto const at = variables.size() == 1 ? std::optional<std::size_t>(0) : name_of_heights(parts);
    refuse_if<BadInput>(!at, about.where,
                        "{} holds {} variables ({}): name the one of heights with --band NAME where the command has "
                        "that option, else as {}",
                        about.name, variables.size(), fmt::join(names, ", "), variables.front().opens);
    Dataset variable = open_part(file, variables[*at].opens);
    refuse_if<BadInput>(variable == nullptr || variable->GetRasterCount() < 1, about.where,
                        "{}: its variable {} cannot be read", about.name, variables[*at].name);
    return variable;
}

HeightBands choose_bands(Dataset file, ReadDemParams const& params, About const& about) {
    HeightBands bands;
    bands.file = std::move(file);
    choose_variable(bands, params.band, about);
    Candidates const found = candidates_in(bands.data());
    bands.alpha = found.alpha;
    bool const is_wanted = number_in(params.band) > 0 || (!params.band.empty() && !bands.variable);
    bool const is_picture = params.values == CellValues::heights && !found.colours.empty();
    if (params.encoding != HeightEncoding::none) {
        refuse_if<BadInput>(found.colours.size() != 3 || found.colours[0]->GetRasterDataType() != GDT_Byte, about.where,
                            "{} has {} bands of colours: --encoding decodes a picture of red, green and blue bytes",
                            about.name, found.colours.size());
        std::ranges::copy(found.colours, bands.colours.begin());
        bands.heights = found.colours.front();
    } else if (is_wanted) {
        bands.heights = wanted_band(bands, params.band, found.names, about);
    } else if (is_picture && found.plain.size() == 1 &&
               GDALDataTypeIsFloating(found.plain.front()->GetRasterDataType()) != 0) {
        bands.heights = found.plain.front(); // heights with a picture of them
    } else if (is_picture) {
        throw BadInput(
            about.where,
            fmt::format("{} is a picture in colours, not a DEM: if the colours encode heights, decode them with "
                        "--encoding terrain-rgb or --encoding terrarium; --band N takes one band as it is",
                        about.name));
    } else {
        bands.heights = clear_band(found, bands.choice, about);
    }
    refuse_if<BadInput>(GDALDataTypeIsComplex(bands.heights->GetRasterDataType()) != 0, about.where,
                        "{} holds complex numbers, not heights", about.name);
    return bands;
}

HeightDirection direction_of(GDALDataset& data, GDALRasterBand& band) {
    using Way = HeightDirection::Way;
    std::string const name = band_name(band);
    std::string const standard = text_of(band.GetMetadataItem("standard_name"));
    std::string const positive = simple_name(text_of(band.GetMetadataItem("positive")));
    bool const says_depth = standard.starts_with("depth") || standard.starts_with("sea_floor_depth");
    bool const says_height = standard.find("altitude") != std::string::npos || standard.starts_with("height");
    // By CF-1.11, 4.3, the attribute must agree with the standard name.
    if ((positive == "down" && says_height) || (positive == "up" && says_depth)) {
        return {Way::up, fmt::format("its standard_name is {}, and positive = {}: its numbers count as heights",
                                     standard.substr(0, 60), positive)};
    }
    if (positive == "down" && names_elevations(name)) {
        return {Way::down, fmt::format("its name is {}, and positive = down: heights are the negatives of its numbers",
                                       name.substr(0, 60))};
    }
    if (positive == "down" || positive == "up") {
        return {positive == "down" ? Way::down : Way::up, ""};
    }
    // BAG files hold elevations, although GDAL 3.6 gives them a vertical axis that points down.
    if (says_depth || says_height || names_elevations(name)) {
        return {says_depth ? Way::down : Way::up, ""};
    }
    OGRSpatialReference const* const reference = data.GetSpatialRef();
    OGRAxisOrientation way = OAO_Other;
    if (reference != nullptr && reference->IsCompound() != 0 && reference->GetAxis("VERT_CS", 0, &way) != nullptr &&
        (way == OAO_Down || way == OAO_Up)) {
        return {way == OAO_Down ? Way::down : Way::up, ""};
    }
    return {names_depths(name) ? Way::depths_or_heights : Way::up, ""};
}

} // namespace thalweg::io
