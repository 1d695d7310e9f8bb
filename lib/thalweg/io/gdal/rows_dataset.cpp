// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/gdal/internal/rows_dataset.hpp>

#include <algorithm>
#include <array>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <gdal_priv.h>

namespace thalweg::io {
namespace {

template <class T> constexpr GDALDataType gdal_type = std::is_same_v<T, float> ? GDT_Float32 : GDT_Int32;

template <class T> class RowsBand final : public GDALRasterBand {
public:
    RowsBand(GDALDataset& dataset, T no_data, RowPart<T> part) : no_data_(no_data), part_(std::move(part)) {
        poDS = &dataset;
        nBand = 1;
        eDataType = gdal_type<T>;
        nBlockXSize = dataset.GetRasterXSize();
        nBlockYSize = 1;
    }

    double GetNoDataValue(int* success) override {
        if (success != nullptr) {
            *success = TRUE;
        }
        return static_cast<double>(no_data_);
    }
    char const* GetUnitType() override { return unit_.c_str(); }
    CPLErr SetUnitType(char const* unit) override {
        unit_ = unit;
        return CE_None;
    }

protected:
    CPLErr IReadBlock(int /*x*/, int row, void* block) override {
        part_(row, 0, {static_cast<T*>(block), static_cast<std::size_t>(nBlockXSize)});
        return CE_None;
    }
    /// Passes GDAL's cache of blocks, which would keep a copy of the raster.
    CPLErr IRasterIO(GDALRWFlag flag, int x, int y, int width, int height, void* to, int to_width, int to_height,
                     GDALDataType type, GSpacing pixel, GSpacing line, GDALRasterIOExtraArg* extra) override {
        if (flag != GF_Read || to_width != width || to_height != height) {
            return GDALRasterBand::IRasterIO(flag, x, y, width, height, to, to_width, to_height, type, pixel, line,
                                             extra);
        }
        std::vector<T> row(static_cast<std::size_t>(width));
        for (int r = 0; r < height; ++r) {
            part_(y + r, x, row);
            GDALCopyWords64(row.data(), eDataType, sizeof(T), static_cast<char*>(to) + r * line, type,
                            static_cast<int>(pixel), width);
        }
        return CE_None;
    }

private:
    T no_data_;
    RowPart<T> part_;
    std::string unit_;
};

class RowsDataset final : public GDALDataset {
public:
    template <class T> RowsDataset(std::int64_t width, std::int64_t height, T no_data, RowPart<T> part) {
        nRasterXSize = static_cast<int>(width);
        nRasterYSize = static_cast<int>(height);
        SetBand(1, new RowsBand<T>(*this, no_data, std::move(part))); // the data set owns it
    }

    CPLErr GetGeoTransform(double* frame) override {
        std::copy(frame_.begin(), frame_.end(), frame);
        return CE_None;
    }
    CPLErr SetGeoTransform(double* frame) override {
        std::copy_n(frame, frame_.size(), frame_.begin());
        return CE_None;
    }
    OGRSpatialReference const* GetSpatialRef() const override { return crs_.IsEmpty() ? nullptr : &crs_; }
    CPLErr SetSpatialRef(OGRSpatialReference const* crs) override {
        crs_ = crs == nullptr ? OGRSpatialReference() : *crs;
        return CE_None;
    }

private:
    std::array<double, 6> frame_{0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
    OGRSpatialReference crs_;
};

} // namespace

Dataset rows_dataset(std::int64_t width, std::int64_t height, float no_data, RowPart<float> part) {
    return Dataset(new RowsDataset(width, height, no_data, std::move(part)));
}

Dataset rows_dataset(std::int64_t width, std::int64_t height, std::int32_t no_data, RowPart<std::int32_t> part) {
    return Dataset(new RowsDataset(width, height, no_data, std::move(part)));
}

} // namespace thalweg::io
