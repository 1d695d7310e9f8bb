// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/mesh/internal/read_cloud.hpp>

#include <algorithm>
#include <array>
#include <bitset>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>
#include <string_view>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <ogr_spatialref.h>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/memory.hpp>
#include <thalweg/core/run/messages.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/raster/internal/undeclared_nodata.hpp>

namespace thalweg::io {
namespace {

using Classes = std::bitset<256>;

/// The points of a file, which are needed up to three times. Decoding takes longest, so up to some half a gigabyte of
/// them are kept.
class CloudFile {
public:
    explicit CloudFile(LasHeader const& of) : header(of), keeps_(of.count <= most_kept) {
        kept_.reserve(keeps_ ? static_cast<std::size_t>(of.count) : 0);
    }

    /// Calls visit(LasPoint) for all points that are not withheld.
    /// \param begin,end of the share done
    template <class Visit> void each_point(double begin, double end, Run const& run, Visit visit) {
        if (is_kept_) {
            for (std::size_t i = 0; i < kept_.size(); ++i) {
                if (i % steps_between_checks == 0) {
                    run.at(end, "read");
                }
                visit(kept_[i]);
            }
            return;
        }
        auto const records = open_las(header);
        std::vector<LasPoint> points;
        std::uint64_t seen = 0;
        for (records->next(points); !points.empty(); records->next(points)) {
            run.at(begin + (end - begin) * static_cast<double>(seen) / static_cast<double>(header.count), "read");
            for (LasPoint const& p : points) {
                if (!p.is_withheld) {
                    visit(p);
                    if (keeps_) {
                        kept_.push_back(p);
                    }
                }
            }
            seen += points.size();
        }
        is_kept_ = keeps_;
    }

    LasHeader const& header;

private:
    static constexpr std::uint64_t most_kept = std::uint64_t{1} << 25U;
    static constexpr std::size_t steps_between_checks = std::size_t{1} << 18U;

    bool keeps_;
    bool is_kept_ = false;
    std::vector<LasPoint, LargePages<LasPoint>> kept_;
};

/// The points of one class.
struct OfClass {
    std::uint64_t count = 0;
    std::int32_t west = std::numeric_limits<std::int32_t>::max();
    std::int32_t east = std::numeric_limits<std::int32_t>::min();
    std::int32_t south = std::numeric_limits<std::int32_t>::max();
    std::int32_t north = std::numeric_limits<std::int32_t>::min();

    void add(LasPoint const& p) {
        ++count;
        west = std::min(west, p.x);
        east = std::max(east, p.x);
        south = std::min(south, p.y);
        north = std::max(north, p.y);
    }
    void add(OfClass const& other) {
        count += other.count;
        west = std::min(west, other.west);
        east = std::max(east, other.east);
        south = std::min(south, other.south);
        north = std::max(north, other.north);
    }
};

/// All classes, without points that are withheld.
using Census = std::array<OfClass, 256>;

Census count_classes(CloudFile& file, Run const& run) {
    Census census;
    file.each_point(0.0, 0.4, run, [&](LasPoint const& p) { census[p.kind].add(p); });
    return census;
}

OfClass sum_of(Census const& census, Classes const& classes) {
    OfClass sum;
    for (std::size_t i = 0; i < census.size(); ++i) {
        if (classes[i]) {
            sum.add(census[i]);
        }
    }
    return sum;
}

// Classes of the specification, table 17.
Classes ground_classes() {
    return Classes().set(2).set(static_cast<std::size_t>(PointClass::key_point)); // a thinned ground
}

Classes noise_classes() {
    return Classes().set(7).set(18);
}

/// \throws BadParameter when a word is not a class
Classes classes_named(std::string const& words) {
    std::vector<std::string> const known{"ground", "water", "all"};
    Classes classes;
    std::string_view rest = words;
    for (bool is_more = true; is_more;) {
        auto const end = rest.find(',');
        std::string_view word = rest.substr(0, end);
        word = word.substr(std::min(word.find_first_not_of(' '), word.size()));
        word = word.substr(0, word.find_last_not_of(' ') + 1);
        std::uint8_t number = 0;
        auto const [stop, error] = std::from_chars(word.data(), word.data() + word.size(), number);
        bool const is_number = error == std::errc() && stop == word.data() + word.size();
        refuse_if<BadParameter>(
            !is_number && std::ranges::find(known, word) == known.end(), "io.read_points",
            "'{}' is not a class of points: give ground, water, all or numbers from 0 to 255, separated by commas.{}",
            word, did_you_mean(word, known));
        classes |= word == "ground"  ? ground_classes()
                   : word == "water" ? Classes().set(static_cast<std::size_t>(PointClass::water))
                   : word == "all"   ? ~noise_classes()
                                     : Classes().set(number);
        is_more = end != std::string_view::npos;
        rest = is_more ? rest.substr(end + 1) : "";
    }
    return classes;
}

/// "class 1 (20 points), class 6 (3)"
std::string census_in_words(Census const& census) {
    std::vector<std::string> words;
    for (std::size_t i = 0; i < census.size(); ++i) {
        if (census[i].count > 0) {
            words.push_back(fmt::format("class {} ({}{})", i, census[i].count, words.empty() ? " points" : ""));
        }
    }
    return fmt::format("{}", fmt::join(words, ", "));
}

/// What is taken of a cloud.
struct ChosenPoints {
    Classes classes;
    OfClass points;
    bool is_unclassified = false; ///< nobody has looked for the ground
};

ChosenPoints choose_classes(Census const& census, ReadPointsParams const& params, std::string const& name) {
    std::string const named = params.classes.value_or("");
    ChosenPoints chosen{named.empty() ? ground_classes() : classes_named(named), {}};
    chosen.points = sum_of(census, chosen.classes);
    if (chosen.points.count > 0) {
        return chosen;
    }
    Classes const unclassified = Classes().set(0).set(1);
    if (named.empty() && sum_of(census, ~(unclassified | noise_classes())).count == 0) {
        chosen = {~noise_classes(), sum_of(census, unclassified), true};
    }
    refuse_if<BadInput>(chosen.points.count == 0, "io.read_points", "{} has no points of {}, but of {}{}", name,
                        named.empty() ? "ground (classes 2 and 8)" : "the classes " + named, census_in_words(census),
                        params.classes ? ": name one of them by --classes" : "");
    return chosen;
}

Finding finding_of(ChosenPoints const& chosen, LasHeader const& header) {
    auto const taken = static_cast<double>(chosen.points.count);
    if (chosen.is_unclassified) {
        return {.kind = "cloud_unclassified",
                .amount = taken,
                .text = fmt::format("no point of {} is classified: all {} of its points are taken but noise and "
                                    "withheld ones, with roofs and trees",
                                    header.name, chosen.points.count),
                .layer = header.name};
    }
    std::vector<std::size_t> numbers;
    for (std::size_t i = 0; i < chosen.classes.size(); ++i) {
        if (chosen.classes[i]) {
            numbers.push_back(i);
        }
    }
    bool const is_ground = chosen.classes == ground_classes();
    std::string const which =
        is_ground             ? "of the ground (classes 2 and 8)"
        : numbers.size() > 10 ? "not noise"
                              : fmt::format("of class{} {}", numbers.size() == 1 ? "" : "es", fmt::join(numbers, ", "));
    return {.kind = "cloud_classes",
            .amount = taken,
            .text = fmt::format("{} has {} points; {} of them, {}, are taken", header.name, header.count,
                                chosen.points.count, which),
            .layer = header.name,
            .numbers = {{"points", static_cast<double>(header.count)}}};
}

/// Positions in metres, measured from the origin of the file's CRS.
struct Metres {
    LasHeader const& header;
    double x_m; ///< length of one unit of x
    double y_m;

    Vec2 of(std::int32_t x, std::int32_t y) const { return {header.x.read(x) * x_m, header.y.read(y) * y_m}; }
};

Metres metres_of(LasHeader const& header, OGRSpatialReference const& crs, OfClass const& points) {
    if (crs.IsEmpty() != 0) {
        return {header, 1.0, 1.0};
    }
    if (crs.IsGeographic() == 0) {
        OGRSpatialReference plan(crs);
        plan.StripVertical();
        double const unit = plan.GetLinearUnits();
        return {header, unit > 0.0 ? unit : 1.0, unit > 0.0 ? unit : 1.0};
    }
    // Cells need no more than the size of a degree in the middle of the cloud, on a sphere.
    double const radian = crs.GetAngularUnits(nullptr);
    double const middle = 0.5 * (header.y.read(points.south) + header.y.read(points.north)) * radian;
    double const y_m = crs.GetSemiMajor() * radian;
    return {header, y_m * std::max(portable::cos(std::clamp(middle, -1.5, 1.5)), 0.01), y_m};
}

/// A lattice of square cells.
class CloudCells {
public:
    CloudCells(Metres const& metres, double side_m, OfClass const& points)
        : metres_(metres), side_m_(side_m), low_(cell_of(metres.of(points.west, points.south))),
          high_(cell_of(metres.of(points.east, points.north))) {}

    double cols() const { return high_.x - low_.x + 1.0; }
    double rows() const { return high_.y - low_.y + 1.0; }
    struct Place {
        std::uint64_t cell; ///< numbered by rows from the south-west
        double off_centre;  ///< square of the distance from its centre, in cells
    };
    /// \pre There are less than 2^32 rows and columns, and the point lies in the box
    Place place_of(LasPoint const& p) const {
        Vec2 const at = metres_.of(p.x, p.y);
        Vec2 const cell = cell_of(at);
        double const x = at.x / side_m_ - cell.x - 0.5;
        double const y = at.y / side_m_ - cell.y - 0.5;
        return {(static_cast<std::uint64_t>(cell.y - low_.y) << 32U) | static_cast<std::uint64_t>(cell.x - low_.x),
                x * x + y * y};
    }

private:
    Vec2 cell_of(Vec2 at) const { return {std::floor(at.x / side_m_), std::floor(at.y / side_m_)}; }

    Metres const& metres_;
    double side_m_;
    Vec2 low_;
    Vec2 high_;
};

/// Decides which points are taken.
class TakenPoints {
public:
    TakenPoints(LasHeader const& header, ChosenPoints const& chosen, ReadPointsParams const& params)
        : header_(header), classes_(chosen.classes),
          nodata_(params.heights == PointHeights::wanted ? params.nodata : std::nullopt) {}

    bool has(LasPoint const& p) const { return classes_[p.kind] && !is_nodata(p); }
    bool is_nodata(LasPoint const& p) const { return nodata_ && stands_for(header_.z.read(p.z), *nodata_); }
    bool is_chosen(LasPoint const& p) const { return classes_[p.kind]; }

private:
    LasHeader const& header_;
    Classes const& classes_;
    std::optional<double> nodata_;
};

/// Of each cell the best point so far.
class NearestPoints {
public:
    struct Entry {
        std::uint64_t cell = 0;
        double off_centre = 0.0;
        std::int32_t x = 0;
        std::int32_t y = 0;
        std::int32_t z = 0;
    };

    void offer(std::uint64_t cell, double off_centre, LasPoint const& p) {
        ++offered_;
        std::uint32_t& number = number_of(cell);
        if (number == none) {
            number = static_cast<std::uint32_t>(entries_.size());
            entries_.push_back({cell, off_centre, p.x, p.y, p.z});
            if (entries_.size() * 2 > numbers_.size()) {
                grow();
            }
            return;
        }
        Entry& best = entries_[number];
        if (off_centre > best.off_centre) {
            return;
        }
        Entry const entry{cell, off_centre, p.x, p.y, p.z};
        if (order_of(entry) < order_of(best)) {
            best = entry;
        }
    }

    std::uint64_t offered() const { return offered_; }
    /// \return by number of their cells
    std::vector<Entry> take() {
        std::ranges::sort(entries_, {}, &Entry::cell);
        return std::move(entries_);
    }

private:
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

    // Equally near ones are ordered too, so that the order of points in the file does not matter.
    static std::tuple<double, std::int32_t, std::int32_t, std::int32_t> order_of(Entry const& e) {
        return {e.off_centre, e.x, e.y, e.z};
    }

    /// The number of a cell's entry, in a table with open addressing; none: it has none.
    std::uint32_t& number_of(std::uint64_t cell) {
        std::uint64_t const mask = numbers_.size() - 1;
        std::uint64_t at = (cell ^ (cell >> 29U)) * 0x9e3779b97f4a7c15U; // Fibonacci hashing
        at ^= at >> 32U;
        while (numbers_[at & mask] != none && entries_[numbers_[at & mask]].cell != cell) {
            ++at;
        }
        return numbers_[at & mask];
    }

    void grow() {
        refuse_if<BadInput>(entries_.size() >= none / 2, "io.read_points",
                            "more than {} cells have points; name larger ones (thin)", none / 2);
        numbers_ = std::vector<std::uint32_t>(2 * numbers_.size(), none);
        for (std::size_t i = 0; i < entries_.size(); ++i) {
            number_of(entries_[i].cell) = static_cast<std::uint32_t>(i);
        }
    }

    std::vector<Entry> entries_;
    std::vector<std::uint32_t> numbers_ = std::vector<std::uint32_t>(std::size_t{1} << 12U, none);
    std::uint64_t offered_ = 0;
};

constexpr std::uint64_t many = 1000000; // of which a TIN takes some seconds

/// The smallest of 1, 2 and 5 times a power of ten that is not below a length, from a micrometre on.
double round_side(double least_m) {
    for (int power = -6; power < 15; ++power) {
        double ten = 1.0;
        for (int i = 0; i < std::abs(power); ++i) {
            ten *= 10.0;
        }
        for (double const digit : {1.0, 2.0, 5.0}) {
            double const side_m = power < 0 ? digit / ten : digit * ten; // the double nearest to it
            if (side_m >= least_m) {
                return side_m;
            }
        }
    }
    return least_m;
}

/// Chooses cells that leave at most so many points, by the area that is not empty in a lattice of a million cells.
double fitting_side(CloudFile& file, TakenPoints const& taken, Metres const& metres, OfClass const& points,
                    Run const& run) {
    Vec2 const low = metres.of(points.west, points.south);
    Vec2 const high = metres.of(points.east, points.north);
    double const wide = high.x - low.x;
    double const tall = high.y - low.y;
    constexpr double a_million = 1048576.0;
    double const side_m = std::max({std::sqrt(wide * tall / a_million), std::max(wide, tall) / a_million, 1e-6});
    auto const cols = static_cast<std::size_t>(wide / side_m) + 1;
    auto const rows = static_cast<std::size_t>(tall / side_m) + 1;
    std::vector<std::uint8_t> has_points(cols * rows, 0);
    file.each_point(0.4, 0.7, run, [&](LasPoint const& p) {
        if (taken.is_chosen(p)) {
            Vec2 const at = metres.of(p.x, p.y);
            auto const col = std::min(static_cast<std::size_t>((at.x - low.x) / side_m), cols - 1);
            auto const row = std::min(static_cast<std::size_t>((at.y - low.y) / side_m), rows - 1);
            has_points[row * cols + col] = 1;
        }
    });
    auto const full = static_cast<double>(std::ranges::count(has_points, 1));
    return round_side(std::sqrt(full * side_m * side_m / static_cast<double>(many)));
}

/// Takes the points, one of each cell if there are cells.
Cloud take_points(CloudFile& file, TakenPoints const& taken, std::uint64_t count, Run const& run) {
    LasHeader const& header = file.header;
    Cloud cloud;
    cloud.points.reserve(static_cast<std::size_t>(count));
    file.each_point(0.7, 1.0, run, [&](LasPoint const& p) {
        if (taken.has(p)) {
            cloud.points.push_back(header.place(p));
        }
    });
    cloud.left_out = static_cast<std::int64_t>(count - cloud.points.size());
    return cloud;
}

Cloud take_thinned(CloudFile& file, TakenPoints const& taken, OfClass const& points, Metres const& metres,
                   double side_m, Run const& run) {
    LasHeader const& header = file.header;
    CloudCells const cells(metres, side_m, points);
    constexpr double most = 4294967295.0;
    refuse_if<BadParameter>(!(cells.cols() < most) || !(cells.rows() < most), "io.read_points",
                            "thin is {} m, and {} is more than {:.0f} such cells wide; name a larger one", side_m,
                            header.name, most);
    NearestPoints nearest;
    file.each_point(0.7, 1.0, run, [&](LasPoint const& p) {
        if (taken.has(p)) {
            auto const [cell, off_centre] = cells.place_of(p);
            nearest.offer(cell, off_centre, p);
        }
    });
    Cloud cloud;
    for (NearestPoints::Entry const& e : nearest.take()) {
        cloud.points.push_back(header.place({e.x, e.y, e.z, 0, false}));
    }
    cloud.left_out = static_cast<std::int64_t>(points.count - nearest.offered());
    cloud.findings.push_back({.kind = "cloud_thinned",
                              .amount = side_m,
                              .text = fmt::format("{} points of {} are thinned to {}: one in each cell of {:.6g} m",
                                                  nearest.offered(), header.name, cloud.points.size(), side_m),
                              .layer = header.name,
                              .numbers = {{"points", static_cast<double>(nearest.offered())},
                                          {"kept", static_cast<double>(cloud.points.size())}}});
    return cloud;
}

} // namespace

Cloud read_cloud(LasHeader const& header, ReadPointsParams const& params, OGRSpatialReference const& crs,
                 Run const& run) {
    double const thin_m = params.thin_m.value_or(0.0);
    require_in("io.read_points", "thin", thin_m, Range::at_least(0.0), "m");
    if (header.count == 0) {
        return {};
    }
    CloudFile file(header);
    Census const census = count_classes(file, run);
    refuse_if<BadInput>(sum_of(census, ~Classes()).count == 0, "io.read_points",
                        "all {} points of {} are marked as withheld: not to be used", header.count, header.name);
    ChosenPoints const chosen = choose_classes(census, params, header.name);
    OfClass const& points = chosen.points;
    TakenPoints const taken(header, chosen, params);
    Metres const metres = metres_of(header, crs, points);
    double const side_m = params.thin_m         ? thin_m
                          : points.count > many ? fitting_side(file, taken, metres, points, run)
                                                : 0.0;
    Cloud cloud = side_m > 0.0 ? take_thinned(file, taken, points, metres, side_m, run)
                               : take_points(file, taken, points.count, run);
    cloud.findings.insert(cloud.findings.begin(), finding_of(chosen, header));
    refuse_if<BadInput>(cloud.points.empty(), "io.read_points", "all points of {} have the height {:.9g} of --nodata",
                        header.name, params.nodata.value_or(0.0));
    return cloud;
}

} // namespace thalweg::io
