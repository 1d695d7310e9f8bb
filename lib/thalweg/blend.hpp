// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// A DEM or mesh and a part of another → both without a seam.
#include <thalweg/blend/deform.hpp>
#include <thalweg/blend/mask_polygons.hpp>
#include <thalweg/blend/paste.hpp>
#include <thalweg/blend/tin.hpp>
