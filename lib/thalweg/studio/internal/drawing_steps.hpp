// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <thalweg/studio/drawing.hpp>

// The steps of drawing, each in the source of what it draws.
namespace thalweg::studio {

// Each applies a step to the drawing of a result, and sets the name and the messages of the result. They throw as
// drawn() does, and then leave the result half changed.
void apply_step(DrawResult& result, DrawRiver const& step);
void apply_step(DrawResult& result, MoveVertex const& step);
void apply_step(DrawResult& result, InsertVertex const& step);
void apply_step(DrawResult& result, RemoveVertex const& step);
void apply_step(DrawResult& result, CutRiver const& step);
void apply_step(DrawResult& result, JoinRiver const& step);
void apply_step(DrawResult& result, ReverseRiver const& step);
void apply_step(DrawResult& result, Erase const& step);
void apply_step(DrawResult& result, SetType const& step);
void apply_step(DrawResult& result, SetLambda const& step);
void apply_step(DrawResult& result, SetSideStreams const& step);
void apply_step(DrawResult& result, DrawCoast const& step);
void apply_step(DrawResult& result, SwapSides const& step);
void apply_step(DrawResult& result, DrawLake const& step);
void apply_step(DrawResult& result, SetLevel const& step);
void apply_step(DrawResult& result, DrawMask const& step);
void apply_step(DrawResult& result, DrawPin const& step);
void apply_step(DrawResult& result, SetHeight const& step);
void apply_step(DrawResult& result, DrawRidge const& step);
void apply_step(DrawResult& result, SetRidgeHeights const& step);
void apply_step(DrawResult& result, Clear const& step);

/// Moves a vertex of a river. A free end joins what it comes near.
void move_river_vertex(DrawResult& result, MoveVertex const& step);
void move_pin(DrawResult& result, MoveVertex const& step);

/// Removes a river, and those that flow into it unless it goes alone.
void erase_river(DrawResult& result, std::size_t river, bool alone);

/// \throws BadParameter beyond [-12000, 30000] m
void require_height(double height_m, char const* what);

/// \throws NotDrawn for a part that is not in the drawing
void require_part(Drawing const& drawing, Part const& part);

/// The line of a part that has one. \throws NotDrawn where it has no such part or vertex
DrawnLine& line_of_part(Drawing& drawing, Part const& part, std::size_t vertex);

/// "1 river", "2 rivers"
std::string count_of(std::size_t count, char const* one, char const* more);

template <class T> void erase_at(std::vector<T>& from, std::size_t number) {
    from.erase(from.begin() + static_cast<std::ptrdiff_t>(number));
}

} // namespace thalweg::studio
