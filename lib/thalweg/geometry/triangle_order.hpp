// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/tin.hpp>

namespace thalweg::geometry {

/// Puts the triangles of a TIN into a canonical order: each begins with its lowest vertex, and they follow the Morton
/// curve of these vertices, so that neighbours are close in memory and in files. Orientations stay.
/// \param tin finite vertices
void put_in_order(Tin& tin);

} // namespace thalweg::geometry
