// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/skeleton/internal/ridge_pieces.hpp>

/// Private to this module.
namespace thalweg::skeleton {

/// Joins pieces into the longest lines that keep their labels and meet others only in their ends.
/// Gives: each piece in one line; left < right; sorted by left, right and place; closed lines begin at their vertex
/// farthest west.
RidgeLines chain_ridges(std::vector<RidgePiece> pieces);

} // namespace thalweg::skeleton
