// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// A Plan → Planform, rivers in plan view → Terrain, with heights and water → Assessment.
#include <thalweg/make/against.hpp>
#include <thalweg/make/assess.hpp>
#include <thalweg/make/blend_into.hpp>
#include <thalweg/make/features.hpp>
#include <thalweg/make/file_values.hpp>
#include <thalweg/make/given.hpp>
#include <thalweg/make/ground.hpp>
#include <thalweg/make/laws.hpp>
#include <thalweg/make/line_sources.hpp>
#include <thalweg/make/make.hpp>
#include <thalweg/make/planform.hpp>
#include <thalweg/make/relief.hpp>
#include <thalweg/make/river_claims.hpp>
#include <thalweg/make/rivers.hpp>
#include <thalweg/make/terrain.hpp>
#include <thalweg/make/valley_cells.hpp>
