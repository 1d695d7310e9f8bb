// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/export/internal/river_splines.hpp>
#include <thalweg/flow/route.hpp>
#include <thalweg/report/pictures.hpp>

namespace thalweg::exports {

enum class LandMask : std::uint8_t {
    slope,
    flow,
    wetness,
    curvature,
    water,
    river_distance,
    river_width,
    ridge,
    land_cover
};

struct LandMaskName {
    LandMask mask;
    char const* name; ///< "river_distance"
};
/// \return in the order of the enumeration
std::vector<LandMaskName> const& land_masks();

/// A kind of land, as land cover has it.
struct LandKind {
    char const* name;        ///< "forest"
    std::uint32_t colour;    ///< 0xRRGGBB
    char const* where_it_is; ///< the rule, in words
};
/// \return by number: the first is land without data
std::vector<LandKind> const& land_kinds();

/// A mask by cell.
struct LandMaskMade {
    Raster<float> share;      ///< [0, 1] by cell; 0 without data
    double low = 0.0;         ///< the value that 0 stands for
    double high = 1.0;        ///< the value that 1 stands for
    char const* unit = "";    ///< of these
    char const* meaning = ""; ///< in words
};

/// Masks of a terrain, each made when it is asked for.
class LandMasks {
public:
    /// \param scene with a DEM; it outlives the masks
    /// \param rivers of the scene, empty: none; they outlive the masks
    /// \param tree_line_m [m] of land cover: no forest above
    LandMasks(report::Scene const& scene, std::vector<RiverSpline> const& rivers, double tree_line_m)
        : scene_(scene), rivers_(rivers), tree_line_m_(tree_line_m) {}

    /// \return the mask; of land_cover each kind's number over 255
    /// \throws BadInput for river_distance and river_width without rivers
    LandMaskMade made(LandMask mask, Run const& run = {});
    /// \return by cell: number of its land_kinds()
    Raster<std::uint8_t> const& kinds(Run const& run = {});

private:
    LandMaskMade slope(Run const& run) const;
    LandMaskMade contributing(Run const& run);
    LandMaskMade wetness(Run const& run);
    LandMaskMade curvature(Run const& run) const;
    LandMaskMade water(Run const& run);
    LandMaskMade river_distance(Run const& run);
    LandMaskMade river_width(Run const& run);
    LandMaskMade ridge(Run const& run) const;
    flow::FlowField const& field(Run const& run);
    /// The nearest river cell, by cell, and the width of rivers in their cells.
    struct Beside {
        Raster<std::int64_t> nearest;
        Raster<float> width_m;
    };
    Beside const& beside(Run const& run);

    report::Scene const& scene_;
    std::vector<RiverSpline> const& rivers_;
    double tree_line_m_;
    std::optional<flow::FlowField> field_;
    std::optional<Beside> beside_;
    std::optional<Raster<std::uint8_t>> kinds_;
};

} // namespace thalweg::exports
