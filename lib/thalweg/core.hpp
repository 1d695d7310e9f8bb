// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// The values that all modules share (grids, rasters, river networks, TINs, findings), and what runs them: errors,
/// threads, progress, random numbers.
#include <thalweg/core/append.hpp>
#include <thalweg/core/bounded_json.hpp>
#include <thalweg/core/box_means.hpp>
#include <thalweg/core/by_enum.hpp>
#include <thalweg/core/cells.hpp>
#include <thalweg/core/channels.hpp>
#include <thalweg/core/features.hpp>
#include <thalweg/core/finding.hpp>
#include <thalweg/core/finding_kinds.hpp>
#include <thalweg/core/height_unit.hpp>
#include <thalweg/core/lattice.hpp>
#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/numbers/elementary_rows.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/numbers/ranks.hpp>
#include <thalweg/core/numbers/sums.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/river_files.hpp>
#include <thalweg/core/rosgen.hpp>
#include <thalweg/core/run/beside.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/lanes.hpp>
#include <thalweg/core/run/memory.hpp>
#include <thalweg/core/run/messages.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/peak_memory.hpp>
#include <thalweg/core/run/result_cache.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/run/small_blocks.hpp>
#include <thalweg/core/run/stage_log.hpp>
#include <thalweg/core/same_grid.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/core/tin.hpp>
#include <thalweg/core/vec.hpp>
