// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/raster/dem_derivatives.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <gdal_alg.h>
#include <gdal_priv.h>
#include <gdal_utils.h>

#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/geometry/crossings.hpp>
#include <thalweg/geometry/polylines.hpp>
#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/io/gdal/internal/dataset.hpp>
#include <thalweg/io/qgis/styles.hpp>
#include <thalweg/io/raster/internal/raster_dataset.hpp>
#include <thalweg/io/tables/table.hpp>

namespace thalweg::io {

Raster<std::uint8_t> hillshade(Raster<float> const& dem, double z_factor, Light light) {
    require_in("io.hillshade", "z_factor", z_factor, Range::above(0.0).or_infinite());
    Driver const driver;
    Dataset const source = dataset_of(dem, {"io.hillshade", ""});
    CPLStringList arguments;
    for (std::string const& argument : {std::string("-of"), std::string("MEM"), std::string("-compute_edges"),
                                        std::string("-z"), fmt::format("{}", z_factor)}) {
        arguments.AddString(argument.c_str());
    }
    if (light == Light::multidirectional) {
        arguments.AddString("-multidirectional");
    }
    std::unique_ptr<GDALDEMProcessingOptions, decltype(&GDALDEMProcessingOptionsFree)> const options(
        GDALDEMProcessingOptionsNew(arguments.List(), nullptr), &GDALDEMProcessingOptionsFree);
    Dataset const shaded(GDALDataset::FromHandle(
        GDALDEMProcessing("", GDALDataset::ToHandle(source.get()), "hillshade", nullptr, options.get(), nullptr)));
    Raster<std::uint8_t> shade(dem.grid());
    int const width = source->GetRasterXSize();
    int const height = source->GetRasterYSize();
    if (shaded == nullptr || shaded->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, width, height, shade.values().data(),
                                                                width, height, GDT_Byte, 0, 0, nullptr) != CE_None) {
        driver.check("io.hillshade");
        throw IoError("io.hillshade", "io.hillshade failed");
    }
    return shade;
}

namespace {

void require_few_levels(Raster<float> const& dem, double interval_m) {
    constexpr double most_levels = 10000.0;
    require_in("io.contours", "interval", interval_m, Range::above(0.0).or_infinite(), "m");
    double low = 0.0;
    double high = 0.0;
    bool first = true;
    for (float const z : dem.values()) {
        if (!std::isnan(z)) {
            low = first ? static_cast<double>(z) : std::min(low, static_cast<double>(z));
            high = first ? static_cast<double>(z) : std::max(high, static_cast<double>(z));
            first = false;
        }
    }
    refuse_if<BadParameter>((high - low) / interval_m > most_levels, "io.contours",
                            "an interval of {} m in a relief of {} m gives more than {} levels: give a larger one",
                            interval_m, high - low, most_levels);
}

/// Whether a ring lies within a square of this size, as around a cell whose height is that of the contour.
bool is_dot(std::vector<Vec2> const& line, double size_m) {
    auto const [west, east] = std::ranges::minmax(line, {}, &Vec2::x);
    auto const [south, north] = std::ranges::minmax(line, {}, &Vec2::y);
    return line.front() == line.back() && east.x - west.x < size_m && north.y - south.y < size_m;
}

/// Traces contours with GDAL, which does not support exceptions.
class Tracer {
public:
    /// Gets one line after the other: its height, and its vertices in the grid's CRS when it asks for them.
    using Vertices = std::function<std::vector<Vec2>()>;
    using Take = std::function<void(double z, Vertices const& vertices)>;

    /// dem, driver: outlive this object
    Tracer(Raster<float> const& dem, double interval_m, Driver const& driver)
        : dem_(dem), interval_m_(interval_m), driver_(driver), source_(dataset_of(dem, {"io.contours", ""})) {
        source_->GetGeoTransform(place_.data());
    }

    void trace(Take const& take, Run const& run) const {
        struct End {
            void operator()(void* tracer) const { GDAL_CG_Destroy(tracer); }
        };
        Task task{*this, take, nullptr};
        std::unique_ptr<void, End> tracer(GDAL_CG_Create(source_->GetRasterXSize(), source_->GetRasterYSize(), FALSE,
                                                         0.0, interval_m_, 0.0, &Tracer::add, &task));
        std::vector<double> heights(static_cast<std::size_t>(dem_.width()));
        bool is_traced = tracer != nullptr;
        for (std::int64_t row = 0; is_traced && row < dem_.height(); ++row) {
            run.at(static_cast<double>(row) / static_cast<double>(dem_.height()), "contours");
            std::ranges::copy(dem_.row(row), heights.begin());
            is_traced = GDAL_CG_FeedLine(tracer.get(), heights.data()) == CE_None;
        }
        tracer.reset(); // ends the lines that are still open
        if (task.failure) {
            std::rethrow_exception(task.failure);
        }
        driver_.check("io.contours");
        refuse_if<IoError>(!is_traced, "io.contours", "io.contours failed");
    }

private:
    struct Task {
        Tracer const& tracer;
        Take const& take;
        std::exception_ptr failure;
    };

    static CPLErr add(double z, int count, double* columns, double* rows, void* task) {
        auto& self = *static_cast<Task*>(task);
        auto const size = static_cast<std::size_t>(count);
        try {
            self.take(z, [&] { return self.tracer.placed({columns, size}, {rows, size}); });
            return CE_None;
        } catch (...) {
            self.failure = std::current_exception();
            return CE_Failure;
        }
    }

    std::vector<Vec2> placed(std::span<double const> columns, std::span<double const> rows) const {
        std::vector<Vec2> line;
        line.reserve(columns.size());
        for (std::size_t i = 0; i < columns.size(); ++i) {
            Vec2 const at{place_[0] + place_[1] * columns[i] + place_[2] * rows[i],
                          place_[3] + place_[4] * columns[i] + place_[5] * rows[i]};
            if (line.empty() || line.back() != at) {
                line.push_back(at);
            }
        }
        return line;
    }

    Raster<float> const& dem_;
    double interval_m_;
    Driver const& driver_;
    Dataset source_;
    std::array<double, 6> place_{}; ///< GDAL's six numbers from columns and rows to the grid's CRS
};

/// Lines simplified as they are traced. All as GDAL traces them would be as large as the DEM.
struct SimplifiedLines {
    std::vector<double> z;
    std::vector<std::vector<Vec2>> lines;
    std::vector<geometry::EndNodes> ends;
    std::vector<bool> is_shorter; ///< than GDAL's

    void add(double height, std::vector<Vec2> traced, double tolerance_m) {
        std::vector<Vec2> few = geometry::simplify(traced, tolerance_m);
        bool const is_closed = traced.front() == traced.back();
        bool const keeps_all = is_closed && few.size() <= 3; // the smallest rings would be points
        is_shorter.push_back(!keeps_all && few.size() != traced.size());
        lines.push_back(keeps_all ? std::move(traced) : std::move(few));
        lines.back().shrink_to_fit();
        z.push_back(height);
        std::size_t const node = 2 * ends.size();
        ends.push_back({node, is_closed ? node : node + 1});
    }

    /// \return which of the shorter lines cross or touch themselves or others; empty: none does
    std::vector<bool> crossing(Run const& run) const {
        std::vector<bool> found(lines.size());
        bool is_any = false;
        for (geometry::Meeting const& meeting : geometry::meetings(lines, ends, run)) {
            bool const closes_ring = meeting.line == meeting.other && meeting.segment == 0 &&
                                     meeting.other_segment + 2 == lines[meeting.line].size() && !meeting.is_stretch() &&
                                     meeting.at == lines[meeting.line].back();
            for (std::size_t const i : {meeting.line, meeting.other}) {
                found[i] = found[i] || (!closes_ring && is_shorter[i]);
                is_any = is_any || found[i];
            }
        }
        return is_any ? found : std::vector<bool>{};
    }
};

/// Simplified contours. Those that would then cross themselves or others are few, and are traced once more.
SimplifiedLines traced(Tracer const& tracer, double tolerance_m, Run const& run) {
    SimplifiedLines made;
    tracer.trace([&](double z, Tracer::Vertices const& vertices) { made.add(z, vertices(), tolerance_m); }, run);
    for (std::vector<bool> again = made.crossing(run); !again.empty(); again = made.crossing(run)) {
        std::size_t line = 0;
        tracer.trace(
            [&](double /*z*/, Tracer::Vertices const& vertices) {
                if (again[line]) {
                    made.lines[line] = vertices();
                    made.is_shorter[line] = false;
                }
                ++line;
            },
            run);
    }
    return made;
}

} // namespace

std::vector<ContourLine> contours(Raster<float> const& dem, double interval_m, Run const& run) {
    constexpr double tolerance_cells = 0.1;
    double const tolerance_m = tolerance_cells * dem.grid().cell_m;
    require_few_levels(dem, interval_m);
    Driver const driver;
    SimplifiedLines made = traced(Tracer(dem, interval_m, driver), tolerance_m, run);
    std::vector<ContourLine> lines;
    for (std::size_t i = 0; i < made.lines.size(); ++i) {
        if (!is_dot(made.lines[i], tolerance_m)) {
            lines.push_back({made.z[i], std::move(made.lines[i])});
        }
    }
    return lines;
}

void write_contours(std::vector<ContourLine> const& lines, double interval_m, std::string const& crs,
                    std::string const& path, Run const& run) {
    write_contours(lines, interval_m, crs, path, HeightUnit::metre, run);
}

void write_contours(std::vector<ContourLine> const& lines, double interval, std::string const& crs,
                    std::string const& path, HeightUnit unit, Run const& run) {
    constexpr double index_every = 5.0;
    auto const line_at = [&lines](std::size_t row) -> ContourLine const& { return lines[row]; };
    Table table{"contours", Table::Shape::line, lines.size(), {}, {}};
    table.columns = {
        {"z", Column::Kind::real, 0, [=](std::size_t row) { return line_at(row).z; }},
        {"is_index", Column::Kind::integer, 0,
         [=](std::size_t row) {
             double const level = std::floor(line_at(row).z / interval + 0.5);
             return static_cast<std::int64_t>(level == index_every * std::floor(level / index_every));
         }},
    };
    table.shape_at = [=](std::size_t row) {
        std::vector<Vec3> line;
        for (Vec2 const p : line_at(row).line) {
            line.push_back({p.x, p.y, line_at(row).z});
        }
        return line;
    };
    if (unit != HeightUnit::metre) {
        table.columns.push_back(
            {"z_unit", Column::Kind::text, 0, [unit](std::size_t) { return std::string(name_of(unit)); }});
    }
    table.style = contour_style();
    write_tables({table}, crs, path, run);
}

} // namespace thalweg::io
