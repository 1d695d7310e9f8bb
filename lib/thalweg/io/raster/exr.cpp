// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <OpenEXR/Iex.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/gdal/internal/dataset.hpp>
#include <thalweg/io/raster/internal/exr.hpp>
#include <thalweg/io/raster/internal/raster_dataset.hpp>
#include <thalweg/io/raster/internal/read_dem.hpp>

namespace thalweg::io {
namespace {

constexpr char const* exr_channel = "Y"; // brightness, which Blender, Godot and Unreal read as grey

/// A file in memory: those on disk are written by write_text, which refuses to replace one.
class ExrBytes : public Imf::OStream {
public:
    ExrBytes() : OStream("OpenEXR") {}
    void write(char const c[], int n) override {
        auto const count = static_cast<std::size_t>(n);
        bytes_.resize(std::max(bytes_.size(), at_ + count));
        std::copy_n(c, count, bytes_.begin() + static_cast<std::ptrdiff_t>(at_));
        at_ += count;
    }
    std::uint64_t tellp() override { return at_; }
    void seekp(std::uint64_t at) override { at_ = at; }
    std::string const& bytes() const { return bytes_; }

private:
    std::string bytes_;
    std::size_t at_ = 0;
};

} // namespace

std::string exr(Raster<float> const& heights, Run const& run) {
    auto const width = static_cast<int>(heights.width());
    auto const height = static_cast<int>(heights.height());
    ExrBytes out;
    Imf::Header header(width, height);
    header.compression() = Imf::ZIP_COMPRESSION;
    header.channels().insert(exr_channel, Imf::Channel(Imf::FLOAT));
    Imf::FrameBuffer samples;
    constexpr std::size_t sample = sizeof(float);
    // OpenEXR takes memory that it only reads by a pointer to memory that it could change.
    auto* const first = const_cast<float*>(heights.values().data());
    samples.insert(exr_channel, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(first), sample,
                                           sample * static_cast<std::size_t>(width)));
    try {
        Imf::OutputFile file(out, header, 0);
        file.setFrameBuffer(samples);
        constexpr int rows = 64;
        for (int row = 0; row < height; row += rows) {
            run.at(static_cast<double>(row) / static_cast<double>(height), "write");
            file.writePixels(std::min(rows, height - row));
        }
    } catch (Iex::BaseExc const& fault) {
        throw IoError("io.write_heightmap", fault.what());
    }
    return out.bytes();
}

Raster<float> heights_of_exr(std::string const& path, About const& about) {
    try {
        Imf::InputFile file(path.c_str(), 0);
        Imf::ChannelList const& channels = file.header().channels();
        std::vector<std::string> names;
        for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
            names.emplace_back(channel.name());
        }
        bool const has_heights = channels.findChannel(exr_channel) != nullptr;
        refuse_if<BadInput>(!has_heights && names.size() != 1, about.where,
                            "{} has channels {}, of which none is called Y: keep the one with the heights (oiiotool "
                            "FILE.exr --ch R -o HEIGHTS.exr)",
                            about.name, fmt::join(names, ", "));
        auto const box = file.header().dataWindow();
        Grid grid;
        grid.width = std::int64_t{box.max.x} - box.min.x + 1;
        grid.height = std::int64_t{box.max.y} - box.min.y + 1;
        require_size(grid, about);
        require_memory(grid, about);
        Raster<float> heights(grid);
        constexpr std::size_t sample = sizeof(float);
        std::size_t const row = sample * static_cast<std::size_t>(grid.width);
        // The slice begins at the place of sample (0, 0), which may lie outside the window.
        char* const origin = reinterpret_cast<char*>(heights.values().data()) -
                             static_cast<std::ptrdiff_t>(sample) * box.min.x -
                             static_cast<std::ptrdiff_t>(row) * box.min.y;
        Imf::FrameBuffer samples;
        samples.insert(has_heights ? exr_channel : names.front(), Imf::Slice(Imf::FLOAT, origin, sample, row));
        file.setFrameBuffer(samples);
        file.readPixels(box.min.y, box.max.y);
        return heights;
    } catch (Iex::BaseExc const& fault) {
        throw BadInput(about.where, about.name + " cannot be read as OpenEXR: " + fault.what());
    }
}

} // namespace thalweg::io
