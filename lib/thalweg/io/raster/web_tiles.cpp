// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/raster/web_tiles.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include <cpl_vsi.h>
#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/crs/internal/crs.hpp>
#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/io/gdal/internal/dataset.hpp>
#include <thalweg/io/raster/internal/png.hpp>

namespace thalweg::io {
namespace {

constexpr char const* web_mercator = "EPSG:3857";
constexpr double half_world_m = 20037508.342789244; // pi x 6378137
constexpr std::int64_t height_side = 256;
constexpr std::int64_t colour_side = 512;
constexpr std::int64_t web_deepest = 30;
constexpr std::int64_t knots = 32; // intervals a tile's side; between them projections are linear to 1e-4 of a sample

constexpr double rgb_lowest_m = -10000.0; // of Terrain-RGB
constexpr double rgb_steps_a_metre = 10.0;
constexpr double rgb_most = 16777215.0;

constexpr std::int64_t levels_above = 2; // 3D maps take heights for a whole view from there

double tile_m(std::int64_t zoom) {
    return 2.0 * half_world_m / static_cast<double>(std::int64_t{1} << zoom);
}

/// Reprojects positions; needs a Driver that outlives it.
class WebTurn {
public:
    WebTurn(std::string const& from, std::string const& to)
        : from_(read_reference(from)), to_(read_reference(to)), turn_(OGRCreateCoordinateTransformation(&from_, &to_)) {
        refuse_if<BadInput>(turn_ == nullptr, "io.web_pyramid", "{} leads to no longitude and latitude",
                            in_message(from));
    }
    /// digits: 1e6 rounds to 1e-6, so that the last bits of libm do not count.
    std::vector<Vec2> apply(std::span<Vec2 const> points, double digits) const {
        std::vector<Vec2> out = apply_anywhere(points, digits);
        for (std::size_t i = 0; i < out.size(); ++i) {
            refuse_if<BadInput>(!std::isfinite(out[i].x) || !std::isfinite(out[i].y), "io.web_pyramid",
                                "the position {}, {} cannot be projected for the web", points[i].x, points[i].y);
        }
        return out;
    }
    /// The same, not finite where a position cannot be projected.
    std::vector<Vec2> apply_anywhere(std::span<Vec2 const> points, double digits) const {
        std::vector<double> x;
        std::vector<double> y;
        for (Vec2 const p : points) {
            x.push_back(p.x);
            y.push_back(p.y);
        }
        if (!points.empty()) {
            turn_->Transform(static_cast<int>(x.size()), x.data(), y.data());
        }
        std::vector<Vec2> out;
        for (std::size_t i = 0; i < x.size(); ++i) {
            out.push_back({std::floor(x[i] * digits + 0.5) / digits, std::floor(y[i] * digits + 0.5) / digits});
        }
        return out;
    }

private:
    OGRSpatialReference from_;
    OGRSpatialReference to_;
    std::unique_ptr<OGRCoordinateTransformation> turn_;
};

constexpr double to_micrometres = 1e6;
constexpr double to_centimetres_in_degrees = 1e7;

std::vector<Vec2> rim_of(Grid const& grid) {
    constexpr int pieces = 64;
    double const wide = grid.east() - grid.west;
    double const high = grid.north - grid.south();
    std::vector<Vec2> rim;
    for (int k = 0; k <= pieces; ++k) {
        double const share = static_cast<double>(k) / pieces;
        for (double const other : {0.0, 1.0}) {
            rim.push_back({grid.west + share * wide, grid.north - other * high});
            rim.push_back({grid.west + other * wide, grid.north - share * high});
        }
    }
    return rim;
}

double side_of_cell(Grid const& grid, WebTurn const& turn) {
    Vec2 const middle{0.5 * (grid.west + grid.east()), 0.5 * (grid.south() + grid.north)};
    std::array<Vec2, 3> const corner{middle, {middle.x + grid.cell_m, middle.y}, {middle.x, middle.y + grid.cell_m}};
    std::vector<Vec2> const at = turn.apply(corner, to_micrometres);
    return std::min(distance(at[0], at[1]), distance(at[0], at[2]));
}

std::int64_t tiles_of_levels(WebPyramid const& pyramid, std::int64_t max_zoom) {
    std::int64_t count = 0;
    for (std::int64_t zoom = pyramid.min_zoom; zoom <= max_zoom; ++zoom) {
        WebTileRange const at = web_tiles_at(pyramid, zoom);
        count += 2 * (at.east - at.west + 1) * (at.south - at.north + 1);
    }
    return count;
}

/// A picture in memory, 4 bytes a pixel.
struct WebPicture {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> rgba;
};

WebPicture decoded(std::string const& png) {
    About const about{"io.write_web_tiles", "the picture"};
    Driver const driver;
    MemoryFile const file;
    VSILFILE* const to = VSIFOpenL(file.path().c_str(), "wb");
    bool const is_there = to != nullptr && VSIFWriteL(png.data(), 1, png.size(), to) == png.size();
    refuse_if<IoError>((to != nullptr && VSIFCloseL(to) != 0) || !is_there, about.where, "{} does not fit in memory",
                       about.name);
    char const* const png_alone[] = {"PNG", nullptr};
    Dataset source(GDALDataset::Open(file.path().c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, png_alone));
    refuse_if<BadInput>(source == nullptr || source->GetRasterCount() < 3, about.where, "{} is not a PNG in colours",
                        about.name);
    WebPicture out{source->GetRasterXSize(), source->GetRasterYSize(), {}};
    out.rgba.assign(std::size_t{4} * static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height), 255);
    CPLErr const error = source->RasterIO(GF_Read, 0, 0, out.width, out.height, out.rgba.data(), out.width, out.height,
                                          GDT_Byte, 3, nullptr, 4, GSpacing{4} * out.width, 1, nullptr);
    source.reset();
    driver.check(about.where, about.name);
    refuse_if<IoError>(error != CE_None, about.where, "{} cannot be read", about.name);
    return out;
}

/// Heights and colours of a tile.
struct WebTile {
    std::vector<float> z;
    std::vector<std::uint8_t> rgba;
};

WebTile blank_tile() {
    return {std::vector<float>(height_side * height_side), std::vector<std::uint8_t>(4 * colour_side * colour_side)};
}

/// A place between two samples: the first, and the share of the second.
struct Between {
    std::int64_t at = 0;
    double share = 0.0;
};

Between between(double place, std::int64_t count) {
    double const kept = std::clamp(place, 0.0, static_cast<double>(count - 1));
    std::int64_t const at =
        std::clamp<std::int64_t>(static_cast<std::int64_t>(kept), 0, std::max<std::int64_t>(count - 2, 0));
    return {at, kept - static_cast<double>(at)};
}

double mixed(double a, double b, double share) {
    return a + (b - a) * share;
}

constexpr double far_off = 1e9; // [cells]

class WebSampler {
public:
    WebSampler(WebGround const& ground, WebPicture const& picture, Grid const& grid)
        : ground_(ground), picture_(picture), grid_(grid), turn_(web_mercator, grid.crs) {}

    /// Samples a tile where it is asked for, whatever lies between the samples.
    WebTile sample(std::int64_t zoom, std::int64_t column, std::int64_t row) const {
        std::vector<Vec2> const net = cells_at_knots(zoom, column, row);
        WebTile tile = blank_tile();
        for_samples(net, height_side, [&](std::size_t i, Vec2 cell) { tile.z[i] = height_at(cell); });
        for_samples(net, colour_side, [&](std::size_t i, Vec2 cell) { put_colour(cell, &tile.rgba[4 * i]); });
        return tile;
    }

private:
    /// Places of a tile's knots in the grid, in cells from its north-west corner.
    std::vector<Vec2> cells_at_knots(std::int64_t zoom, std::int64_t column, std::int64_t row) const {
        double const step = tile_m(zoom) / static_cast<double>(knots);
        std::vector<Vec2> net;
        for (std::int64_t j = 0; j <= knots; ++j) {
            for (std::int64_t i = 0; i <= knots; ++i) {
                net.push_back({static_cast<double>(column * knots + i) * step - half_world_m,
                               half_world_m - static_cast<double>(row * knots + j) * step});
            }
        }
        net = turn_.apply_anywhere(net, to_micrometres);
        for (Vec2& p : net) {
            if (!std::isfinite(p.x) || !std::isfinite(p.y)) { // far off the DEM
                p = {-far_off, -far_off};
                continue;
            }
            p = {(p.x - grid_.west) / grid_.cell_m, (grid_.north - p.y) / grid_.cell_m};
        }
        return net;
    }
    template <class Take> static void for_samples(std::vector<Vec2> const& net, std::int64_t side, Take take) {
        double const scale = static_cast<double>(knots) / static_cast<double>(side);
        for (std::int64_t j = 0; j < side; ++j) {
            Between const v = between((static_cast<double>(j) + 0.5) * scale, knots + 1);
            for (std::int64_t i = 0; i < side; ++i) {
                Between const u = between((static_cast<double>(i) + 0.5) * scale, knots + 1);
                auto const upper = static_cast<std::size_t>(v.at * (knots + 1) + u.at);
                std::size_t const lower = upper + knots + 1;
                Vec2 const north = net[upper] + u.share * (net[upper + 1] - net[upper]);
                Vec2 const south = net[lower] + u.share * (net[lower + 1] - net[lower]);
                take(static_cast<std::size_t>(j * side + i), north + v.share * (south - north));
            }
        }
    }
    float height_at(Vec2 cell) const {
        Between const x = between(cell.x - 0.5, grid_.width);
        Between const y = between(cell.y - 0.5, grid_.height);
        std::int64_t const east = std::min(x.at + 1, grid_.width - 1);
        std::int64_t const south = std::min(y.at + 1, grid_.height - 1);
        auto const z = [&](std::int64_t col, std::int64_t row) {
            return static_cast<double>(ground_.heights[Cell{col, row}]);
        };
        return static_cast<float>(mixed(mixed(z(x.at, y.at), z(east, y.at), x.share),
                                        mixed(z(x.at, south), z(east, south), x.share), y.share));
    }
    void put_colour(Vec2 cell, std::uint8_t* rgba) const {
        Cell const in{static_cast<std::int64_t>(std::floor(cell.x)), static_cast<std::int64_t>(std::floor(cell.y))};
        if (!grid_.contains(in) || ground_.shown[in] == 0) {
            return;
        }
        auto const along = [](double place, std::int64_t cells, int pixels) {
            double const share = cells > 1 ? (place - 0.5) / static_cast<double>(cells - 1) : 0.5;
            return between(share * pixels - 0.5, pixels);
        };
        Between const x = along(cell.x, grid_.width, picture_.width);
        Between const y = along(cell.y, grid_.height, picture_.height);
        std::int64_t const east = std::min<std::int64_t>(x.at + 1, picture_.width - 1);
        std::int64_t const south = std::min<std::int64_t>(y.at + 1, picture_.height - 1);
        auto const colour = [&](std::int64_t col, std::int64_t row, std::size_t band) {
            return static_cast<double>(picture_.rgba[4 * static_cast<std::size_t>(row * picture_.width + col) + band]);
        };
        for (std::size_t band = 0; band < 3; ++band) {
            double const value = mixed(mixed(colour(x.at, y.at, band), colour(east, y.at, band), x.share),
                                       mixed(colour(x.at, south, band), colour(east, south, band), x.share), y.share);
            rgba[band] = static_cast<std::uint8_t>(std::floor(value + 0.5));
        }
        rgba[3] = 255;
    }

    WebGround const& ground_;
    WebPicture const& picture_;
    Grid const& grid_;
    WebTurn turn_;
};

/// Puts the means of a child's samples, four by four, into its quarter of the parent.
void put_quarter(WebTile const& child, WebTile& parent, std::int64_t east, std::int64_t south) {
    constexpr std::int64_t half_z = height_side / 2;
    for (std::int64_t j = 0; j < half_z; ++j) {
        for (std::int64_t i = 0; i < half_z; ++i) {
            auto const at = static_cast<std::size_t>(2 * j * height_side + 2 * i);
            auto const z = [&](std::size_t k) { return static_cast<double>(child.z[at + k]); };
            auto const to = static_cast<std::size_t>((j + south * half_z) * height_side + i + east * half_z);
            parent.z[to] = static_cast<float>(0.25 * ((z(0) + z(1)) + (z(height_side) + z(height_side + 1))));
        }
    }
    constexpr std::int64_t half_c = colour_side / 2;
    for (std::int64_t j = 0; j < half_c; ++j) {
        for (std::int64_t i = 0; i < half_c; ++i) {
            auto const at = static_cast<std::size_t>(2 * j * colour_side + 2 * i);
            std::array<std::uint8_t const*, 4> four{};
            for (std::size_t k = 0; std::size_t const step : {std::size_t{0}, std::size_t{1}, std::size_t{colour_side},
                                                              std::size_t{colour_side + 1}}) {
                four[k++] = &child.rgba[4 * (at + step)];
            }
            unsigned const alpha = 0U + four[0][3] + four[1][3] + four[2][3] + four[3][3];
            if (alpha == 0) {
                continue;
            }
            auto const to = static_cast<std::size_t>((j + south * half_c) * colour_side + i + east * half_c);
            for (std::size_t band = 0; band < 3; ++band) {
                unsigned sum = 0;
                for (std::uint8_t const* const pixel : four) {
                    sum += unsigned{pixel[band]} * pixel[3];
                }
                parent.rgba[4 * to + band] = static_cast<std::uint8_t>((2 * sum + alpha) / (2 * alpha));
            }
            parent.rgba[4 * to + 3] = static_cast<std::uint8_t>((alpha + 2) / 4);
        }
    }
}

std::string name_of_tile(char const* kind, std::int64_t zoom, std::int64_t column, std::int64_t row) {
    return fmt::format("{}/{}/{}/{}.png", kind, zoom, column, row);
}

void write_tile(WebTile& tile, std::int64_t zoom, std::int64_t column, std::int64_t row, OutputFolder const& out) {
    std::vector<std::uint8_t> rgb;
    rgb.reserve(3 * tile.z.size());
    for (float const z : tile.z) {
        double const steps = std::floor((static_cast<double>(z) - rgb_lowest_m) * rgb_steps_a_metre + 0.5);
        auto const number = static_cast<std::uint32_t>(std::clamp(steps, 0.0, rgb_most));
        for (unsigned const shift : {16U, 8U, 0U}) {
            rgb.push_back(static_cast<std::uint8_t>((number >> shift) & 0xFFU));
        }
    }
    auto const square = [](std::int64_t side) { return Grid{.width = side, .height = side, .crs = {}}; };
    write_png(rgb, 3, square(height_side), png_small, out.path(name_of_tile("heights", zoom, column, row)), {});
    write_png(tile.rgba, 4, square(colour_side), png_small, out.path(name_of_tile("colour", zoom, column, row)), {});
}

bool meets(WebPyramid const& pyramid, std::int64_t zoom, std::int64_t column, std::int64_t row) {
    WebTileRange const at = web_tiles_at(pyramid, zoom);
    return column >= at.west && column <= at.east && row >= at.north && row <= at.south;
}

/// Makes a tile from those below it and writes it; known(zoom, column, row) gives those that are made already, or null.
template <class Known>
WebTile made_tile(WebSampler const& sampler, WebPyramid const& pyramid, std::int64_t zoom, std::int64_t column,
                  std::int64_t row, OutputFolder const& out, Run const& run, Known known) {
    if (zoom == pyramid.full_zoom || !meets(pyramid, zoom, column, row)) {
        run.check();
        WebTile tile = sampler.sample(zoom, column, row);
        if (zoom <= pyramid.max_zoom && meets(pyramid, zoom, column, row)) {
            write_tile(tile, zoom, column, row, out);
        }
        return tile;
    }
    WebTile tile = blank_tile();
    for (std::int64_t south = 0; south < 2; ++south) {
        for (std::int64_t east = 0; east < 2; ++east) {
            std::int64_t const c = 2 * column + east;
            std::int64_t const r = 2 * row + south;
            WebTile const* const there = known(zoom + 1, c, r);
            put_quarter(there != nullptr ? *there : made_tile(sampler, pyramid, zoom + 1, c, r, out, run, known), tile,
                        east, south);
        }
    }
    if (zoom <= pyramid.max_zoom) {
        write_tile(tile, zoom, column, row, out);
    }
    return tile;
}

void require_ground(WebGround const& ground, WebPyramid const& pyramid) {
    Grid const& grid = pyramid.grid;
    for (Grid const* const other : {&ground.heights.grid(), &ground.shown.grid()}) {
        refuse_if<BadInput>(other->width != grid.width || other->height != grid.height, "io.write_web_tiles",
                            "{} x {} cells for a pyramid of {} x {}", other->width, other->height, grid.width,
                            grid.height);
    }
    constexpr double highest_m = rgb_lowest_m + rgb_most / rgb_steps_a_metre;
    for (std::int64_t i = 0; i < ground.heights.cells(); ++i) {
        Cell const c = grid.at(i);
        refuse_if<BadInput>(ground.heights[i] < rgb_lowest_m || ground.heights[i] > highest_m, "io.write_web_tiles",
                            "the cell at column {}, row {} is {:.6g} m high: Terrain-RGB has heights from {} to {} m",
                            c.col, c.row, ground.heights[i], rgb_lowest_m, highest_m);
        refuse_if<BadInput>(!std::isfinite(ground.heights[i]), "io.write_web_tiles",
                            "the cell at column {}, row {} has no height", c.col, c.row);
    }
}

} // namespace

WebTileRange web_tiles_at(WebPyramid const& pyramid, std::int64_t zoom) {
    double const side = tile_m(zoom);
    // A web map rounds the box once more: what it may ask for is there.
    constexpr double beyond = 0.1;
    std::int64_t const last = (std::int64_t{1} << zoom) - 1;
    auto const number = [&](double from_edge) {
        return std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor(from_edge / side)), 0, last);
    };
    return {number(pyramid.low.x + half_world_m - beyond), number(pyramid.high.x + half_world_m + beyond),
            number(half_world_m - pyramid.high.y - beyond), number(half_world_m - pyramid.low.y + beyond)};
}

WebPyramid web_pyramid(Grid const& grid, WebPyramidParams const& params) {
    require_in("io.web_pyramid", "most_zoom", params.most_zoom, Range::between(0, 22));
    require_in("io.web_pyramid", "most_tiles", params.most_tiles, Range::at_least(1));
    refuse_if<BadInput>(grid.width < 1 || grid.height < 1, "io.web_pyramid", "a grid of {} x {} cells", grid.width,
                        grid.height);
    Driver const driver;
    WebPyramid out;
    out.grid = grid;
    if (grid.crs.empty()) {
        out.shift = {-0.5 * (grid.west + grid.east()), -0.5 * (grid.south() + grid.north)};
        out.grid.crs = web_mercator;
        out.grid.west += out.shift.x;
        out.grid.north += out.shift.y;
    }
    WebTurn const turn(out.grid.crs, web_mercator);
    std::vector<Vec2> const rim = turn.apply(rim_of(out.grid), to_micrometres);
    out.low = out.high = rim.front();
    for (Vec2 const p : rim) {
        out.low = {std::min(out.low.x, p.x), std::min(out.low.y, p.y)};
        out.high = {std::max(out.high.x, p.x), std::max(out.high.y, p.y)};
    }
    refuse_if<BadInput>(std::max(-out.low.y, out.high.y) > half_world_m, "io.web_pyramid",
                        "the DEM reaches beyond 85 degrees of latitude, where web maps end");
    refuse_if<BadInput>(out.high.x - out.low.x > half_world_m || out.low.x < -half_world_m - 1.0 ||
                            out.high.x > half_world_m + 1.0,
                        "io.web_pyramid", "the DEM crosses the meridian of 180 degrees, where web maps end");
    std::array<Vec2, 2> const ends{out.low, out.high};
    std::vector<Vec2> const corners = WebTurn(web_mercator, "EPSG:4326").apply(ends, to_centimetres_in_degrees);
    driver.check("io.web_pyramid");
    out.box = {corners[0].x, corners[0].y, corners[1].x, corners[1].y};
    double const cell = side_of_cell(out.grid, turn);
    double const extent = std::max(out.high.x - out.low.x, out.high.y - out.low.y);
    while (out.full_zoom < web_deepest && tile_m(out.full_zoom) / height_side > cell * (1.0 + 1e-9)) {
        ++out.full_zoom;
    }
    std::int64_t const most = std::min(out.full_zoom, params.most_zoom);
    while (out.min_zoom < most && tile_m(out.min_zoom + 1) >= extent) {
        ++out.min_zoom;
    }
    out.min_zoom = std::max<std::int64_t>(0, out.min_zoom - levels_above);
    out.max_zoom = out.min_zoom;
    while (out.max_zoom < most && tiles_of_levels(out, out.max_zoom + 1) <= params.most_tiles) {
        ++out.max_zoom;
    }
    out.tiles = tiles_of_levels(out, out.max_zoom);
    return out;
}

std::vector<std::string> write_web_tiles(WebGround const& ground, WebPyramid const& pyramid, OutputFolder const& out,
                                         Run const& run) {
    require_ground(ground, pyramid);
    run.at(0.0, "tiles");
    WebPicture const picture = decoded(ground.picture);
    // Levels enough for many threads, few enough to keep their tiles.
    std::int64_t const split = std::min(pyramid.min_zoom + 4, pyramid.max_zoom);
    WebTileRange const parts = web_tiles_at(pyramid, split);
    std::int64_t const columns = parts.east - parts.west + 1;
    std::int64_t const count = columns * (parts.south - parts.north + 1);
    std::vector<WebTile> made(static_cast<std::size_t>(count));
    auto const none = [](std::int64_t, std::int64_t, std::int64_t) -> WebTile const* { return nullptr; };
    parallel_ranges(run, count, 1, [&](std::int64_t begin, std::int64_t end) {
        Driver const driver;
        WebSampler const sampler(ground, picture, pyramid.grid);
        for (std::int64_t i = begin; i < end; ++i) {
            made[static_cast<std::size_t>(i)] =
                made_tile(sampler, pyramid, split, parts.west + i % columns, parts.north + i / columns, out, run, none);
        }
        driver.check("io.write_web_tiles");
    });
    run.at(0.9, "tiles");
    Driver const driver;
    WebSampler const sampler(ground, picture, pyramid.grid);
    auto const known = [&](std::int64_t zoom, std::int64_t column, std::int64_t row) -> WebTile const* {
        bool const is_part = zoom == split && meets(pyramid, zoom, column, row);
        return is_part ? &made[static_cast<std::size_t>((row - parts.north) * columns + column - parts.west)] : nullptr;
    };
    std::vector<std::string> names;
    for (std::int64_t zoom = pyramid.min_zoom; zoom <= pyramid.max_zoom; ++zoom) {
        WebTileRange const at = web_tiles_at(pyramid, zoom);
        for (std::int64_t column = at.west; column <= at.east; ++column) {
            for (std::int64_t row = at.north; row <= at.south; ++row) {
                if (zoom == pyramid.min_zoom && zoom < split) {
                    made_tile(sampler, pyramid, zoom, column, row, out, run, known);
                }
                names.push_back(name_of_tile("heights", zoom, column, row));
                names.push_back(name_of_tile("colour", zoom, column, row));
            }
        }
    }
    driver.check("io.write_web_tiles");
    std::ranges::sort(names);
    return names;
}

std::vector<std::vector<Vec2>> lines_in_degrees(std::vector<std::vector<Vec2>> lines, WebPyramid const& pyramid) {
    Driver const driver;
    WebTurn const turn(pyramid.grid.crs, "EPSG:4326");
    for (std::vector<Vec2>& line : lines) {
        for (Vec2& p : line) {
            p = p + pyramid.shift;
        }
        line = turn.apply(line, to_centimetres_in_degrees);
    }
    driver.check("io.lines_in_degrees");
    return lines;
}

} // namespace thalweg::io
