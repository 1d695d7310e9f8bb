// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/river_files.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/vec.hpp>

// Rivers, coasts, lakes, masks, pins and ridges as a user draws them.
namespace thalweg::studio {

using DrawnLine = std::vector<Vec2>; ///< [m] no two vertices in a row at one place, rounded to 1e-6 m

/// A river as it is drawn. Law: where it flows into another, its last vertex is one of the other's, bit for bit.
struct DrawnRiver {
    DrawnLine line;          ///< from source to outlet, at least two vertices
    std::string type = {};   ///< Rosgen type, or ""
    int lambda = 0;          ///< [1, 50] generator of side streams; 0: the recipe's
    std::int64_t record = 0; ///< of its attributes, from 1; 0: none
    friend bool operator==(DrawnRiver const&, DrawnRiver const&) = default;
};

/// A lake as it is drawn.
struct DrawnLake {
    std::vector<DrawnLine> rings;  ///< the first is its shore, others are islands; implicitly closed
    std::optional<double> level_m; ///< nothing: the terrain's
    friend bool operator==(DrawnLake const&, DrawnLake const&) = default;
};

/// A place whose height is known.
struct DrawnPin {
    Vec2 at; ///< [m] rounded to 1e-6 m
    double height_m = 0.0;
    friend bool operator==(DrawnPin const&, DrawnPin const&) = default;
};

/// A ridge as it is drawn: no water crosses it.
struct DrawnRidge {
    DrawnLine line; ///< at least two vertices
    /// By vertex; nothing: linear between those that have one, beyond the last one level; at none: the terrain's.
    std::vector<std::optional<double>> heights_m;
    friend bool operator==(DrawnRidge const&, DrawnRidge const&) = default;
};

/// What is drawn on a grid. Law: rivers meet only where one flows into another, and none in a circle.
struct Drawing {
    Grid grid;
    std::vector<DrawnRiver> rivers;
    AttributeTable attributes;     ///< of rivers that come from a user's file
    std::vector<DrawnLine> coasts; ///< land at their left; closed ones end where they begin
    std::vector<DrawnLake> lakes;
    std::vector<DrawnLine> masks; ///< implicitly closed; only what lies in one gets heights; none: all
    std::vector<std::vector<DrawnLine>> mask_islands; ///< of the first masks, by mask: holes in it, implicitly closed
    std::vector<DrawnPin> pins;
    std::vector<DrawnRidge> ridges;
    bool has_side_streams = false; ///< each river grows a network of its own
};

/// A part of a drawing.
struct Part {
    enum class Kind : std::uint8_t { river, coast, lake, mask, pin, ridge };
    Kind kind = Kind::river;
    std::size_t number = 0;
};

// Steps of drawing. Rivers, coasts, ... are named by their numbers before the step.

/// Draws a river, in either direction. Its ends snap to rivers, coasts and the border.
struct DrawRiver {
    DrawnLine points; ///< [m] freehand or from corner to corner
    std::string type = {};
    int lambda = 0;
};
/// Moves a vertex; vertices of other rivers at the same place go with it. A free end joins a river that it comes near.
struct MoveVertex {
    Part of;
    std::size_t vertex = 0;
    Vec2 to;
    double reach_m = 0.0; ///< vertices within that, along the line, follow the less the farther they are
};
struct InsertVertex {
    Part of;
    std::size_t vertex = 0; ///< before which
    Vec2 at;
};
struct RemoveVertex {
    Part of;
    std::size_t vertex = 0;
};
/// Cuts a river in two; the upper one ends a few cells above.
struct CutRiver {
    std::size_t river = 0;
    Vec2 at;
};
/// Carries an end of a river straight to a place, and joins what is there.
struct JoinRiver {
    std::size_t river = 0;
    bool at_source = false;
    Vec2 at;
};
/// Lets a river and all below it run the other way.
struct ReverseRiver {
    std::size_t river = 0;
};
struct Erase {
    Part of;
    bool alone = false; ///< of a river: without those that flow into it
};
struct SetType {
    std::vector<std::size_t> rivers;
    std::string type;
};
struct SetLambda {
    std::vector<std::size_t> rivers;
    int lambda = 0;
};
struct SetSideStreams {
    bool on = false;
};
/// Draws a coast, closed where its ends come near one another, else carried to the border. The land is where most of
/// the rivers are, else at its left, within a closed one.
struct DrawCoast {
    DrawnLine points;
};
/// Land and sea change sides.
struct SwapSides {
    std::size_t coast = 0;
};
struct DrawLake {
    DrawnLine points;
    std::optional<double> level_m;
};
struct SetLevel {
    std::size_t lake = 0;
    std::optional<double> level_m;
};
struct DrawMask {
    DrawnLine points;
};
/// Sets a pin: the terrain has its height there.
struct DrawPin {
    Vec2 at;
    double height_m = 0.0;
};
struct SetHeight {
    std::size_t pin = 0;
    double height_m = 0.0;
};
/// Draws a ridge, which ends short of rivers and at coasts.
struct DrawRidge {
    DrawnLine points;
    std::optional<double> from_m = {}; ///< height of its first vertex
    std::optional<double> to_m = {};   ///< height of its last vertex
};
/// Sets the heights of a ridge's ends. One of them: it is level. None: the heights between them go too.
struct SetRidgeHeights {
    std::size_t ridge = 0;
    std::optional<double> from_m;
    std::optional<double> to_m;
};
struct Clear {};

using DrawStep = std::variant<DrawRiver, MoveVertex, InsertVertex, RemoveVertex, CutRiver, JoinRiver, ReverseRiver,
                              Erase, SetType, SetLambda, SetSideStreams, DrawCoast, SwapSides, DrawLake, SetLevel,
                              DrawMask, DrawPin, SetHeight, DrawRidge, SetRidgeHeights, Clear>;

/// What cannot be drawn, and why.
class NotDrawn : public BadInput {
public:
    NotDrawn(std::string const& where, std::string const& what, std::optional<Vec2> place = std::nullopt)
        : BadInput(where, what), at(place) {}

    std::optional<Vec2> at; ///< [m] where it is wrong
};

/// A drawing after a step.
struct DrawResult {
    Drawing drawing;
    std::string name;              ///< of the step, for people
    std::vector<std::string> said; ///< what became of it beside what was asked
};

/// Draws a step. Freehand lines are smoothed over 2.5 cells and simplified by a quarter of a cell. Ends within 3 cells
/// of a river, a coast or the border snap to it. A new river keeps 1.5 cells from others, except towards where they
/// meet. A new ridge keeps 1.5 cells from rivers: its ends are cut off there.
/// \return the drawing after it; what the step does not touch stays bit for bit
/// \throws NotDrawn where rivers would cross, come too near, flow in a circle or out of another one, where a ridge
/// would cross a river, for pins in rivers, in the sea and in one cell, and for numbers of what is not there
/// \throws BadParameter for a type or lambda that is none, and heights beyond [-12000, 30000] m
DrawResult drawn(Drawing drawing, DrawStep const& step);

/// \return the rivers that flow into one, directly or through others; ascending, without itself
std::vector<std::size_t> rivers_into(Drawing const& drawing, std::size_t river);

/// Whether a place is land by the coasts drawn: at the left of the nearest.
bool is_land(Drawing const& drawing, Vec2 at);

/// The coasts of a mask.
/// \param land 0: sea; without cells: no sea
/// \return lines between land and sea, land at their left, simplified by three quarters of a cell; the grid's border is
/// none
std::vector<DrawnLine> coasts_of(Mask const& land);

} // namespace thalweg::studio
