// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/tin.hpp>

namespace thalweg::geometry {

/// Numbers the triangles of a TIN without a trace of how they were found: each begins with its lowest vertex, and they
/// follow a Z-shaped curve through the places of these (Morton), so that neighbours lie close in memory and in files.
/// \post the same triangles, each in its direction.
/// \param tin a TIN whose triangles have vertices that are there, finite
void put_in_order(Tin& tin);

} // namespace thalweg::geometry
