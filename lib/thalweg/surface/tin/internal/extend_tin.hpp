// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/tin.hpp>

namespace thalweg::surface {

/// Gives every NaN cell the height at the nearest point of the TIN's edge: of the sides that one triangle has alone.
/// Takes: a TIN, and a raster it was drawn on. Of points equally near that of the lowest triangle counts.
/// Gives: no NaN is left, unless the TIN has no triangle. Throws: Cancelled.
void extend_tin(Tin const& tin, Raster<float>& dem, Run const& run = {});

} // namespace thalweg::surface
