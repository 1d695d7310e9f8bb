// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/vec.hpp>

// Idea: Layers of rock lie in a stack, and one surface tells how the stack is tilted, folded, domed
// and broken: the bed B(x, y). A point's place in the stack is s = z - B(x, y), so that one number
// names its layer. Thickness is across the layers; along the vertical a tilted layer is thicker by 1 /
// cos(dip). Folds are similar (the same shape at every depth) and faults vertical, so that B is the
// same for all layers.
// Source: ours. Strike by the right-hand rule: beds dip to the right of the way along the strike.
// Cost: O(1) a point; equilibrium() asks once a cell of each level.
// Not for: overturned folds, thrusts, layers that thin out: their s is not one number of z.
// Example:
//     Strata const mesa{.layers = {{.thickness_m = 120.0, .strength = 0.3, .cliff = 0.5},
//                                  {.thickness_m = 60.0, .strength = 8.0, .cliff = 5.0},
//                                  {.strength = 0.04, .cliff = 0.15}}};
//     EquilibriumFields fields;
//     fields.strata = mesa;

namespace thalweg::surface {

/// A layer of rock.
struct RockLayer {
    double thickness_m = 100.0; ///< [m] > 0 across the layer
    double strength = 1.0;      ///< [0.001, 1000] steepness of slopes in it, relative to rock without layers
    double cliff = 0.8;         ///< [0.01, 20] tangent of the steepest slopes in it
};

/// Folds with straight hinges: anticlines and synclines in turn.
struct RockFolds {
    double amplitude_m = 0.0;     ///< [m] >= 0 half the height from trough to crest; 0: none
    double wavelength_m = 4000.0; ///< [m] > 0 from crest to crest
    double axis_deg = 0.0;        ///< [degrees] of the hinges, clockwise from north
    double plunge_deg = 0.0;      ///< [-30, 30] by which hinges fall along the axis
};

/// Layers that rise towards a place from all sides.
struct RockDome {
    double east_m = 0.0;      ///< [m] of its middle from the grid's centre
    double north_m = 0.0;     ///< [m]
    double height_m = 0.0;    ///< [m] by which layers rise; below 0: a basin
    double radius_m = 2500.0; ///< [m] > 0 where they have fallen to 0.61 of that
};

/// A vertical fault along a straight line.
struct RockFault {
    double east_m = 0.0;     ///< [m] of a point of it from the grid's centre
    double north_m = 0.0;    ///< [m]
    double strike_deg = 0.0; ///< [degrees] clockwise from north
    double throw_m = 0.0;    ///< [m] by which layers lie lower to the right of the way along the strike
};

/// A stack of layers, and how it lies.
struct Strata {
    std::vector<RockLayer> layers; ///< from the lowest up; empty: rock without layers
    /// the layers lie above and below again and again; false: the lowest and the topmost reach as far as there is land
    bool repeats = false;
    double base_m = 0.0;     ///< [m] bottom of the lowest layer at the grid's centre, before domes, faults and folds,
                             ///< above the lowest end of a river
    double dip_deg = 0.0;    ///< [0, 75]
    double strike_deg = 0.0; ///< [degrees] clockwise from north; layers dip to the right of it
    RockFolds folds;
    std::vector<RockDome> domes;
    std::vector<RockFault> faults;
    double undulation_m = 0.0;         ///< [m] >= 0 amplitude of random bends; 0: none
    double undulation_wave_m = 3000.0; ///< [m] > 0 their wavelength
    std::uint64_t seed = 7;            ///< of the bends

    bool empty() const { return layers.empty(); }
};

/// How high the bed of a stack lies: 0 at the grid's centre where nothing but dip moves it.
class Bed {
public:
    /// \throws BadParameter when a number of the stack is outside its range
    explicit Bed(Strata const& strata);

    /// \param east_m,north_m from the grid's centre
    /// \return [m]
    double height_m(double east_m, double north_m) const;

private:
    /// A direction in plan.
    struct Way {
        double east = 0.0;
        double north = 1.0;
        double along(double x, double y) const { return x * east + y * north; }
        double to_the_right(double x, double y) const { return x * north - y * east; }
    };
    static Way way_of(double deg); ///< clockwise from north
    double folded(double x, double y) const;

    Strata strata_;
    double east_ = 0.0;  ///< rise of the bed per metre to the east
    double north_ = 0.0; ///< to the north
    Way axis_;
    double plunge_ = 0.0;           ///< tangent
    std::vector<Way> fault_strike_; ///< by fault
};

/// A layer in the stack, or one of its repetitions.
struct StackedLayer {
    double top_m = 0.0;    ///< above the bed; infinite: nothing lies on it
    std::size_t layer = 0; ///< in Strata::layers
};

/// The cap rock: the topmost layer that is firmer than the one upon it.
/// \return its number in Strata::layers; none: there is none, or the stack repeats
std::optional<std::size_t> cap_rock(Strata const& strata);

/// The layers that places between two heights above the bed may lie in, from the lowest up; the last one has no end.
/// \param low_m,high_m [m] the place of a point is its height less the bed's
/// \throws BadInput when more than 10 000 repetitions lie between them
std::vector<StackedLayer> stack_of(Strata const& strata, double low_m, double high_m);

/// Where a point in plan lies from a grid's centre, as Bed takes it.
/// \param place [m] in the grid's reference system
Vec2 from_centre(Grid const& grid, Vec2 place);

/// The height of the bed in the cells of a grid.
/// \param shift_m by which layers lie lower than they say: EquilibriumTerrain::strata_shift_m
/// \return [m] by cell: bottom of the lowest layer, or of one repetition of it
/// \throws BadParameter when a number of the stack is outside its range
Raster<float> bed_heights(Grid const& grid, Strata const& strata, double shift_m = 0.0, Run const& run = {});

/// The layer at the surface of terrain.
/// \param dem [m] NaN: no data
/// \param bed [m] as bed_heights(), on the same grid
/// \param strata at least one layer, at most 255
/// \return by cell: number of the layer from 1, the lowest; 0: no data. On the top of a layer that has been laid bare,
/// that layer. The same for any number of threads.
/// \throws BadInput when the grids differ
Raster<std::uint8_t> layers_at(Raster<float> const& dem, Raster<float> const& bed, Strata const& strata,
                               Run const& run = {});

/// \param layers as layers_at()
/// \param count of layers, at most 255
/// \return by layer: its share of the cells with data
std::vector<double> shares_of_layers(Raster<std::uint8_t> const& layers, std::size_t count);

} // namespace thalweg::surface
