// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include <laszip/laszip_api.h>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/mesh/internal/read_las.hpp>

namespace thalweg::io {
namespace {

class CompressedRecords : public LasRecords {
public:
    explicit CompressedRecords(LasHeader const& header) : header_(header), left_(header.count) {
        refuse_if<IoError>(laszip_create(&reader_) != 0, "io.read_points", "LASzip cannot be used");
        laszip_BOOL is_compressed = 0;
        if (laszip_open_reader(reader_, header.path.c_str(), &is_compressed) != 0 ||
            laszip_get_point_pointer(reader_, &point_) != 0) {
            std::string const words = reason();
            laszip_destroy(reader_); // no destructor runs
            refuse_if<BadInput>(true, "io.read_points", "{} cannot be decompressed: {}", header.name, words);
        }
    }
    ~CompressedRecords() override {
        laszip_close_reader(reader_);
        laszip_destroy(reader_);
    }

    void next(std::vector<LasPoint>& points) override {
        constexpr std::uint64_t points_a_time = 1U << 16U;
        points.resize(static_cast<std::size_t>(std::min(left_, points_a_time)));
        for (LasPoint& p : points) {
            bool const is_read = laszip_read_point(reader_) == 0;
            refuse_if<BadInput>(!is_read, "io.read_points",
                                "{} cannot be decompressed after {} of {} points: {}; it is truncated or damaged: copy "
                                "it again from where it comes",
                                header_.name, header_.count - left_, header_.count, is_read ? "" : reason());
            bool const is_old = header_.format < 6;
            p = {point_->X, point_->Y, point_->Z,
                 static_cast<std::uint8_t>(is_old ? point_->classification : point_->extended_classification),
                 is_old ? point_->withheld_flag != 0 : (point_->extended_classification_flags & 4U) != 0};
            --left_;
        }
    }

private:
    std::string reason() const {
        laszip_CHAR* words = nullptr;
        return laszip_get_error(reader_, &words) == 0 && words != nullptr ? words : "no reason is given";
    }

    LasHeader const& header_;
    std::uint64_t left_;
    laszip_POINTER reader_ = nullptr;
    laszip_point* point_ = nullptr;
};

} // namespace

std::unique_ptr<LasRecords> open_laz(LasHeader const& header) {
    return std::make_unique<CompressedRecords>(header);
}

} // namespace thalweg::io
