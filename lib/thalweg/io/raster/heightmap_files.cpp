// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/raster/internal/heightmap_files.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <system_error>
#include <utility>

#include <cpl_error.h>
#include <cpl_json.h>
#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/crs/internal/crs.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/io/files/internal/files.hpp>
#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/io/raster/heightmap.hpp>
#include <thalweg/io/raster/internal/exr.hpp>
#include <thalweg/io/raster/internal/raster_dataset.hpp>

namespace thalweg::io {
namespace {

namespace fs = std::filesystem;

enum class SampleType : std::uint8_t { numbers, metres };

/// What is known of a heightmap besides its samples.
struct MapDescription {
    std::string by = {}; ///< the file that says it; "": options, or nothing
    std::int64_t width = 0;
    std::int64_t height = 0;
    std::optional<std::pair<double, double>> heights_m = {}; ///< of the numbers 0 and 65535
    std::optional<std::array<double, 6>> frame = {};         ///< as GDAL has it
    std::string crs = {};
    bool from_south = false;
};

bool is_raw_name(std::string const& path) {
    std::string const ending = lower_extension(path);
    return ending == ".r16" || ending == ".r32" || ending == ".raw";
}

bool is_exr_file(std::string const& path) {
    constexpr std::array<char, 4> magic{0x76, 0x2f, 0x31, 0x01};
    std::array<char, 4> first{};
    std::error_code ignored;
    if (!fs::is_regular_file(path, ignored)) {
        return false;
    }
    std::ifstream file(path, std::ios::binary);
    return file.read(first.data(), first.size()).good() && first == magic;
}

/// The description of a file by thalweg's export; invalid: there is none.
CPLJSONObject json_beside(std::string const& path) {
    constexpr std::int64_t largest = 64 << 20;
    std::error_code ignored;
    CPLJSONObject none;
    none.Deinit();
    if (!fs::is_regular_file(path, ignored) || fs::file_size(path, ignored) > largest) {
        return none;
    }
    CPLErrorStateBackuper const kept;
    CPLErrorHandlerPusher const quiet(CPLQuietErrorHandler);
    CPLJSONDocument document;
    if (!document.LoadMemory(read_text(path, largest))) {
        return none;
    }
    CPLJSONObject const json = document.GetRoot();
    return json.GetType() == CPLJSONObject::Type::Object && json.GetObj("thalweg").IsValid() ? json : none;
}

std::optional<double> number_of(CPLJSONObject const& json) {
    bool const is_number = json.IsValid() && (json.GetType() == CPLJSONObject::Type::Double ||
                                              json.GetType() == CPLJSONObject::Type::Integer ||
                                              json.GetType() == CPLJSONObject::Type::Long);
    double const number = is_number ? json.ToDouble() : HUGE_VAL;
    return std::isfinite(number) ? std::optional(number) : std::nullopt;
}

std::optional<std::pair<double, double>> pair_of(CPLJSONObject const& json) {
    CPLJSONArray const both = json.IsValid() ? json.ToArray() : CPLJSONArray();
    if (!both.IsValid() || both.Size() != 2) {
        return std::nullopt;
    }
    auto const first = number_of(both[0]);
    auto const second = number_of(both[1]);
    return first && second ? std::optional(std::pair{*first, *second}) : std::nullopt;
}

std::int64_t count_of(CPLJSONObject const& json) {
    constexpr double most = 1 << 20;
    return static_cast<std::int64_t>(std::clamp(number_of(json).value_or(0.0), 0.0, most));
}

/// Takes heights, place and CRS, which files and folders describe alike.
void take_common(CPLJSONObject const& json, MapDescription& map) {
    auto const min_m = number_of(json.GetObj("min_m"));
    auto const step = number_of(json.GetObj("metres_per_step"));
    if (min_m && step) {
        map.heights_m = std::pair{*min_m, *min_m + 65535.0 * *step};
    }
    auto const first = pair_of(json.GetObj("north_west"));
    auto const apart = pair_of(json.GetObj("step_m"));
    if (first && apart && apart->first > 0.0 && apart->second > 0.0) {
        map.frame = {first->first - 0.5 * apart->first,   apart->first, 0.0,
                     first->second + 0.5 * apart->second, 0.0,          -apart->second};
    }
    map.crs = json.GetString("crs");
}

/// Takes the description of one file.
std::optional<MapDescription> described_alone(std::string const& path) {
    CPLJSONObject const json = json_beside(path + ".json");
    static constexpr std::array<std::string_view, 4> formats{"png16", "r16", "r32", "exr"};
    if (!json.IsValid() || std::ranges::find(formats, std::string_view(json.GetString("format"))) == formats.end()) {
        return std::nullopt;
    }
    MapDescription map;
    map.by = path + ".json";
    map.width = count_of(json.GetObj("width"));
    map.height = count_of(json.GetObj("height"));
    take_common(json, map);
    return map;
}

/// The column and row of a tile by its name: height_x1_y0.r16.
std::pair<std::int64_t, std::int64_t> tile_of(std::string const& name) {
    auto const number_after = [&](std::string_view mark) {
        std::size_t const at = name.rfind(mark);
        std::int64_t number = 0;
        if (at != std::string::npos) {
            std::from_chars(name.data() + at + mark.size(), name.data() + name.size(), number);
        }
        constexpr std::int64_t most = 63;
        return std::clamp<std::int64_t>(number, 0, most);
    };
    return {number_after("_x"), number_after("_y")};
}

/// Takes the description of the folder of a file.
std::optional<MapDescription> described_in_folder(std::string const& path) {
    fs::path const by = fs::path(path).parent_path() / "export.json";
    std::string const name = fs::path(path).filename().string();
    CPLJSONObject const json = json_beside(by.string());
    CPLJSONArray const files = json.IsValid() ? json.GetArray("heights/files") : CPLJSONArray();
    bool is_there = false;
    for (int i = 0; files.IsValid() && i < files.Size(); ++i) {
        is_there = is_there || files[i].ToString() == name;
    }
    if (!is_there) {
        return std::nullopt;
    }
    MapDescription map;
    map.by = by.string();
    map.width = count_of(json.GetObj("tiles/width"));
    map.height = count_of(json.GetObj("tiles/height"));
    take_common(json, map);
    if (map.frame && files.Size() > 1) {
        auto const [col, row] = tile_of(name);
        (*map.frame)[0] += static_cast<double>(col * (map.width - 1)) * (*map.frame)[1];
        (*map.frame)[3] += static_cast<double>(row * (map.height - 1)) * (*map.frame)[5];
    }
    map.from_south = json.GetString("heights/axes").starts_with("rows from south");
    return map;
}

std::optional<MapDescription> described(std::string const& path) {
    std::optional<MapDescription> map = described_alone(path);
    return map ? map : described_in_folder(path);
}

bool has_gdal_driver(std::string const& path) {
    CPLErrorStateBackuper const kept;
    CPLErrorHandlerPusher const quiet(CPLQuietErrorHandler);
    return GDALIdentifyDriver(path.c_str(), nullptr) != nullptr;
}

/// Numbers of a file without a header, little-endian.
template <class T> std::vector<float> raw_samples(std::string const& bytes, auto const& height_of) {
    std::vector<float> out(bytes.size() / sizeof(T));
    for (std::size_t i = 0; i < out.size(); ++i) {
        std::array<char, sizeof(T)> raw{};
        std::memcpy(raw.data(), bytes.data() + i * sizeof(T), sizeof(T));
        if constexpr (std::endian::native == std::endian::big) {
            std::ranges::reverse(raw);
        }
        out[i] = height_of(std::bit_cast<T>(raw));
    }
    return out;
}

/// Heights of numbers of 16 bits.
auto heights_of_numbers(MapDescription const& map) {
    double const low = map.heights_m ? map.heights_m->first : 0.0;
    double const step = map.heights_m ? (map.heights_m->second - low) / 65535.0 : 1.0;
    return [low, step](double number) { return static_cast<float>(low + number * step); };
}

/// Finds the size of a file without a header.
void take_size(MapDescription& map, std::uint64_t bytes, std::uint64_t sample, ReadDemParams const& params,
               About const& about) {
    if (params.raw_width > 0) {
        map.width = params.raw_width;
        map.height = params.raw_height;
    }
    std::uint64_t const samples = bytes / sample;
    if (map.width == 0) {
        auto const side = static_cast<std::uint64_t>(std::llround(std::sqrt(static_cast<double>(samples))));
        refuse_if<BadInput>(bytes % sample != 0 || side * side != samples || samples == 0, about.where,
                            "{} has no header, and its {} bytes are no square of {}-bit samples: name their number "
                            "(--raw-size WIDTHxHEIGHT)",
                            about.name, bytes, 8 * sample);
        map.width = map.height = static_cast<std::int64_t>(side);
    }
    auto const wanted = static_cast<std::uint64_t>(map.width) * static_cast<std::uint64_t>(map.height);
    refuse_if<BadInput>(
        wanted * sample != bytes, about.where,
        "{} holds {} bytes, but {} x {} samples of {} bits take {}: name their number (--raw-size WIDTHxHEIGHT){}",
        about.name, bytes, map.width, map.height, 8 * sample, wanted * sample,
        map.by.empty() || params.raw_width > 0 ? "" : ", or mend " + map.by);
}

std::vector<float> read_raw(std::string const& path, MapDescription& map, ReadDemParams const& params,
                            About const& about) {
    constexpr std::int64_t largest = std::int64_t{1} << 31;
    std::string const bytes = read_text(path, largest);
    bool const is_r32 = lower_extension(path) == ".r32" ||
                        (!map.by.empty() && !map.heights_m); // a description without steps is one of metres
    take_size(map, bytes.size(), is_r32 ? sizeof(float) : sizeof(std::uint16_t), params, about);
    return is_r32 ? raw_samples<float>(bytes, [](float z) { return z; })
                  : raw_samples<std::uint16_t>(bytes, heights_of_numbers(map));
}

std::vector<float> read_png16(Dataset const& data, MapDescription& map, About const& about) {
    refuse_if<BadInput>(data->GetRasterXSize() != map.width || data->GetRasterYSize() != map.height ||
                            data->GetRasterCount() != 1,
                        about.where, "{} has {} x {} samples, and {} x {} by {}: mend or remove that file", about.name,
                        data->GetRasterXSize(), data->GetRasterYSize(), map.width, map.height, map.by);
    std::vector<float> out(static_cast<std::size_t>(map.width * map.height));
    auto const wide = static_cast<int>(map.width);
    auto const high = static_cast<int>(map.height);
    refuse_if<IoError>(data->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, wide, high, out.data(), wide, high, GDT_Float32,
                                                        0, 0, nullptr) != CE_None,
                       about.where, "{}: its samples cannot be read", about.name);
    auto const height_of = heights_of_numbers(map);
    std::ranges::transform(out, out.begin(), height_of);
    return out;
}

std::vector<float> read_samples(Source const& source, MapDescription& map, ReadDemParams const& params,
                                Dataset const& picture, About const& about) {
    if (is_exr_file(source.path)) {
        Raster<float> const heights = heights_of_exr(source.path, about);
        map.width = heights.width();
        map.height = heights.height();
        return {heights.values().begin(), heights.values().end()};
    }
    return picture ? read_png16(picture, map, about) : read_raw(source.path, map, params, about);
}

Dataset shown(std::vector<float>& samples, MapDescription const& map, About const& about) {
    require_size({map.width, map.height, 1.0, 0.0, 0.0, ""}, about);
    auto const wide = static_cast<int>(map.width);
    auto const high = static_cast<int>(map.height);
    if (map.from_south) {
        for (int row = 0; row < high / 2; ++row) {
            std::swap_ranges(samples.begin() + static_cast<std::ptrdiff_t>(row) * wide,
                             samples.begin() + static_cast<std::ptrdiff_t>(row + 1) * wide,
                             samples.begin() + static_cast<std::ptrdiff_t>(high - 1 - row) * wide);
        }
    }
    Dataset data(GetGDALDriverManager()->GetDriverByName("MEM")->Create("", wide, high, 1, GDT_Float32, nullptr));
    refuse_if<IoError>(!data || data->GetRasterBand(1)->RasterIO(GF_Write, 0, 0, wide, high, samples.data(), wide, high,
                                                                 GDT_Float32, 0, 0, nullptr) != CE_None,
                       about.where, "{}: there is no memory for its samples", about.name);
    data->GetRasterBand(1)->SetUnitType("m");
    if (map.frame) {
        std::array<double, 6> frame = *map.frame;
        data->SetGeoTransform(frame.data());
    }
    if (!map.crs.empty()) {
        OGRSpatialReference const crs = read_reference(map.crs);
        data->SetSpatialRef(&crs);
    }
    return data;
}

Finding finding_of(MapDescription const& map, bool has_numbers, ReadDemParams const& params) {
    double const step = map.heights_m ? (map.heights_m->second - map.heights_m->first) / 65535.0 : 1.0;
    std::string const size = fmt::format("a heightmap of {} x {} samples", map.width, map.height);
    std::string const place = map.frame ? "" : ", 1 m apart (--raw-cell sets another distance)";
    std::string const by = map.by.empty() ? "" : fmt::format(", by {}", fs::path(map.by).filename().string());
    if (!has_numbers) {
        return {.kind = "heightmap", .text = fmt::format("{} in metres{}{}", size, by, place)};
    }
    if (map.heights_m) {
        return {.kind = "heightmap",
                .amount = step,
                .text = fmt::format("{}: 0 is {:.6g} m, 65535 is {:.6g} m{}{}", size, map.heights_m->first,
                                    map.heights_m->second, params.raw_heights ? "" : by, place)};
    }
    return {.kind = "heightmap",
            .amount = step,
            .text = fmt::format("{}: nothing says which heights its numbers stand for, so they count as metres "
                                "(--raw-heights LOW,HIGH names those of 0 and 65535){}",
                                size, place)};
}

} // namespace

bool is_heightmap(Source const& source) {
    std::string const& path = source.path;
    std::error_code ignored;
    if (!fs::is_regular_file(path, ignored)) {
        return false;
    }
    if (is_exr_file(path)) {
        return true;
    }
    if (is_picture_of_heights(source)) {
        return described(path).has_value();
    }
    return is_raw_name(path) && (described(path) || !has_gdal_driver(path));
}

bool is_heightmap_file(std::string const& path) {
    Driver const driver;
    return is_heightmap(path);
}

std::vector<std::string> heightmap_files(Source const& source) {
    std::vector<std::string> files{source.path};
    if (auto const map = described(source.path)) {
        files.push_back(map->by);
    }
    std::ranges::sort(files);
    return files;
}

bool is_picture_of_heights(Source const& source) {
    return lower_extension(source.path) == ".png";
}

OpenedHeightmap open_heightmap(Source const& source, ReadDemParams const& params, Dataset const& picture,
                               About const& about) {
    require_allowed(source);
    MapDescription map = described(source.path).value_or(MapDescription{});
    if (params.raw_heights) {
        map.heights_m = params.raw_heights;
    }
    std::vector<float> samples = read_samples(source, map, params, picture, about);
    if (params.raw_cell_m) {
        double const cell_m = *params.raw_cell_m;
        map.frame = {0.0, cell_m, 0.0, static_cast<double>(map.height) * cell_m, 0.0, -cell_m};
        map.crs.clear();
    }
    bool const has_numbers =
        !is_exr_file(source.path) && lower_extension(source.path) != ".r32" && (map.by.empty() || map.heights_m);
    Dataset data = shown(samples, map, about);
    return {std::move(data), finding_of(map, has_numbers, params)};
}

} // namespace thalweg::io
