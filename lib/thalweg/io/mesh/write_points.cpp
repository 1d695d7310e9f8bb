// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <cstddef>
#include <iterator>

#include <fmt/format.h>

#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/core/same_grid.hpp>
#include <thalweg/io/files/internal/files.hpp>
#include <thalweg/io/mesh/internal/las_ply.hpp>
#include <thalweg/io/mesh/points.hpp>

namespace thalweg::io {

namespace {

/// Enumerates points: visit(x, y, z, class), z in the type of its source.
struct ListedPoints {
    std::vector<Vec3> const& points;
    std::string const& crs;
    std::int64_t every;

    static double short_way() { return 1.0; }
    template <class Step, class Visit> void each(Step step, Visit visit) const {
        constexpr std::size_t points_a_step = 4096;
        auto const stride = static_cast<std::size_t>(every);
        std::size_t seen = 0;
        for (std::size_t i = 0; i < points.size(); i += std::min(stride, points.size() - i)) {
            if (seen++ % points_a_step == 0) {
                step(static_cast<double>(i) / static_cast<double>(points.size()));
            }
            Vec3 const p = points[i];
            refuse_if<BadInput>(!is_finite(p), "io.write_points", "point {} is not finite: ({}, {}, {})", i + 1, p.x,
                                p.y, p.z);
            visit(p.x, p.y, p.z, PointClass::key_point);
        }
    }
};

struct Cells {
    Raster<float> const& z;
    Mask const* rivers; ///< of a skeleton
    std::string const& crs;
    std::int64_t every;

    double short_way() const { return z.grid().cell_m; }
    template <class Step, class Visit> void each(Step step, Visit visit) const {
        for (std::int64_t row = 0; row < z.height(); row += std::min(every, z.height() - row)) {
            step(static_cast<double>(row) / static_cast<double>(z.height()));
            for (std::int64_t col = 0; col < z.width(); col += std::min(every, z.width() - col)) {
                Cell const cell{col, row};
                float const height = z[cell];
                if (std::isnan(height)) {
                    continue;
                }
                Vec2 const at = z.grid().centre(cell);
                refuse_if<BadInput>(!std::isfinite(height), "io.write_points",
                                    "the height of the cell at ({}, {}) is {}", at.x, at.y, height);
                visit(at.x, at.y, height, class_of(cell));
            }
        }
    }

private:
    PointClass class_of(Cell cell) const {
        return rivers == nullptr      ? PointClass::ground
               : (*rivers)[cell] != 0 ? PointClass::water
                                      : PointClass::key_point;
    }
};

template <class Source>
std::uint64_t write(Source const& source, std::string const& path, PointFormat format, Run const& run) {
    PointExtent extent;
    std::uint64_t count = 0;
    source.each([&](double) { run.check(); },
                [&](double x, double y, auto z, PointClass) {
                    extent.add({x, y, static_cast<double>(z)});
                    ++count;
                });
    refuse_if<BadInput>(count == 0, "io.write_points", "{}: there is no point to write", path);
    if (format == PointFormat::las && count > std::numeric_limits<std::uint32_t>::max()) {
        throw BadInput("io.write_points",
                       fmt::format("{}: LAS 1.2 holds at most {} points, not {}; take every second, or PLY", path,
                                   std::numeric_limits<std::uint32_t>::max(), count));
    }

    std::string bytes;
    LasFrame frame;
    switch (format) {
    case PointFormat::ply: put_ply_header(bytes, source.crs, count); break;
    case PointFormat::las:
        frame = las_frame(extent, static_cast<std::uint32_t>(count), source.short_way());
        put_las_header(bytes, frame, source.crs);
        break;
    case PointFormat::xyz: break;
    }
    NewFile file(path, {"io.write_points", path});
    source.each(
        [&](double share) {
            run.at(share, "write");
            file.append(bytes);
            bytes.clear();
        },
        [&](double x, double y, auto z, PointClass kind) {
            Vec3 const point{x, y, static_cast<double>(z)};
            switch (format) {
            case PointFormat::ply: put_ply_vertex(bytes, point); break;
            case PointFormat::las: put_las_point(bytes, frame, point, static_cast<std::uint8_t>(kind)); break;
            case PointFormat::xyz: fmt::format_to(std::back_inserter(bytes), "{} {} {}\n", x, y, z); break;
            }
        });
    file.append(bytes);
    file.close();
    run.at(1.0, "write");
    return count;
}

void require(WritePointsParams const& params) {
    require_in("io.write_points", "every", params.every, Range::at_least(1));
}

} // namespace

std::vector<PointFormatName> const& point_formats() {
    static std::vector<PointFormatName> const formats{
        {PointFormat::las, "las", ".las"}, {PointFormat::ply, "ply", ".ply"}, {PointFormat::xyz, "xyz", ".xyz"}};
    return formats;
}

PointFormat point_format(std::string const& name, std::string const& path) {
    return format_of(point_formats(), name, path, "io.write_points");
}

std::uint64_t write_points(FeaturePoints const& points, std::string const& path, WritePointsParams const& params,
                           Run const& run) {
    require(params);
    return write(ListedPoints{points.points, points.crs, params.every}, path, params.format, run);
}

std::uint64_t write_points(Raster<float> const& land, std::string const& path, WritePointsParams const& params,
                           Run const& run) {
    require(params);
    return write(Cells{land, nullptr, land.grid().crs, params.every}, path, params.format, run);
}

std::uint64_t write_points(Skeleton const& skeleton, Mask const& rivers, std::string const& path,
                           WritePointsParams const& params, Run const& run) {
    require(params);
    Grid const& grid = skeleton.z.grid();
    require_same_grid(rivers.grid(), grid, "io.write_points", "the rivers and the skeleton", "make both on one grid");
    return write(Cells{skeleton.z, &rivers, grid.crs, params.every}, path, params.format, run);
}

} // namespace thalweg::io
