// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// thalweg_clouds [POINTS]: a compressed point cloud (LAZ) as `thalweg tin` takes it, beside LASzip's own reading of it
// and the TIN of the points that remain. Times [s] of one run; the ratio is what thinning and reading twice cost.
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>

#include <fmt/format.h>
#include <laszip/laszip_api.h>

#include <thalweg/commands/tin.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/io/mesh/points.hpp>

namespace {

using namespace thalweg;

void require(laszip_I32 failed, char const* what) {
    if (failed != 0) {
        throw IoError("thalweg_clouds", std::string("thalweg_clouds: LASzip cannot ") + what);
    }
}

/// Ground as a scanner sees it: points at random places of hills, every eighth of another class.
void write_cloud(std::string const& path, std::uint64_t count) {
    laszip_POINTER writer = nullptr;
    require(laszip_create(&writer), "begin");
    laszip_header* header = nullptr;
    require(laszip_get_header_pointer(writer, &header), "give a header");
    header->version_major = 1;
    header->version_minor = 2;
    header->header_size = 227;
    header->offset_to_point_data = 227;
    header->point_data_format = 0;
    header->point_data_record_length = 20;
    header->number_of_point_records = static_cast<laszip_U32>(count);
    header->x_scale_factor = header->y_scale_factor = header->z_scale_factor = 0.001;
    header->x_offset = 500000.0;
    header->y_offset = 4000000.0;
    require(laszip_open_writer(writer, path.c_str(), 1), "open a file");
    laszip_point* point = nullptr;
    require(laszip_get_point_pointer(writer, &point), "give a point");
    double const side_m = std::sqrt(static_cast<double>(count)) / 2.0; // four points a square metre
    for (std::uint64_t i = 0; i < count; ++i) {
        double const x = side_m * (static_cast<double>(i) + unit(random_word(1, i))) / static_cast<double>(count);
        double const y = side_m * unit(random_word(2, i)); // in swaths from west to east
        double const z = 300.0 + 40.0 * std::sin(x / 90.0) * std::cos(y / 70.0) + 0.1 * unit(random_word(3, i));
        point->X = static_cast<laszip_I32>(1000.0 * x);
        point->Y = static_cast<laszip_I32>(1000.0 * y);
        point->Z = static_cast<laszip_I32>(1000.0 * z);
        point->classification = i % 8 == 0 ? 5 : 2;
        require(laszip_write_point(writer), "write a point");
        require(laszip_update_inventory(writer), "count a point");
    }
    require(laszip_close_writer(writer), "end a file");
    laszip_destroy(writer);
}

std::int64_t read_all(std::string const& path) {
    laszip_POINTER reader = nullptr;
    require(laszip_create(&reader), "begin");
    laszip_BOOL is_compressed = 0;
    require(laszip_open_reader(reader, path.c_str(), &is_compressed), "open the file");
    laszip_header* header = nullptr;
    laszip_point* point = nullptr;
    require(laszip_get_header_pointer(reader, &header), "give a header");
    require(laszip_get_point_pointer(reader, &point), "give a point");
    std::int64_t sum = 0;
    for (laszip_U32 i = 0; i < header->number_of_point_records; ++i) {
        require(laszip_read_point(reader), "read a point");
        sum += point->Z;
    }
    laszip_close_reader(reader);
    laszip_destroy(reader);
    return sum;
}

double seconds_of(auto&& act) {
    auto const begin = std::chrono::steady_clock::now();
    act();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

double tin_of(std::string const& path, std::string const& output, std::int64_t& vertices) {
    return seconds_of([&] {
        commands::TinParams params;
        params.path = path;
        params.output = output;
        params.crs = "EPSG:32631";
        vertices = static_cast<std::int64_t>(commands::run_tin(params).tin.vertices.size());
    });
}

} // namespace

int main(int count, char** words) {
    std::uint64_t const points = count > 1 ? std::strtoull(words[1], nullptr, 10) : 10'000'000;
    std::filesystem::path const folder = std::filesystem::temp_directory_path() / "thalweg-cloud-bench";
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    std::string const cloud = (folder / "cloud.laz").string();
    std::string const kept = (folder / "kept.las").string();
    write_cloud(cloud, points);
    FeaturePoints const thinned = io::read_points({.path = cloud, .crs = "EPSG:32631"});
    io::write_points(thinned, kept, {.format = io::PointFormat::las});
    std::int64_t sum = 0;
    std::int64_t vertices = 0;
    double const reading = seconds_of([&] { sum = read_all(cloud); });
    double const of_kept = tin_of(kept, (folder / "kept.ply").string(), vertices);
    double const of_cloud = tin_of(cloud, (folder / "cloud.ply").string(), vertices);
    fmt::print("points {}  kept {}  LASzip reads {:.2f} s  tin of kept {:.2f} s  tin of cloud {:.2f} s  ratio {:.2f}  "
               "(sum {})\n",
               points, vertices, reading, of_kept, of_cloud, of_cloud / (reading + of_kept), sum);
    std::filesystem::remove_all(folder);
    return 0;
}
