// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// All public headers of the module.
#include <thalweg/blend/deform.hpp>
#include <thalweg/blend/fuse_tin.hpp>
#include <thalweg/blend/gradients.hpp>
#include <thalweg/blend/mask_polygons.hpp>
#include <thalweg/blend/paste.hpp>
#include <thalweg/blend/paste_tin.hpp>
#include <thalweg/blend/patch.hpp>
#include <thalweg/blend/place_patch.hpp>
