// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// All public headers of the module.
#include <thalweg/core/attributes.hpp>
#include <thalweg/core/by_enum.hpp>
#include <thalweg/core/cells/cells_along.hpp>
#include <thalweg/core/cells/cells_around.hpp>
#include <thalweg/core/cells/d8.hpp>
#include <thalweg/core/cells/framed.hpp>
#include <thalweg/core/cells/nearest_cells.hpp>
#include <thalweg/core/channels.hpp>
#include <thalweg/core/feature_points.hpp>
#include <thalweg/core/finding.hpp>
#include <thalweg/core/grid.hpp>
#include <thalweg/core/height_unit.hpp>
#include <thalweg/core/indexed.hpp>
#include <thalweg/core/length_in_plan.hpp>
#include <thalweg/core/network_file.hpp>
#include <thalweg/core/numbers/compensated_sum.hpp>
#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/numbers/normal.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/numbers/sum_rows.hpp>
#include <thalweg/core/numbers/value_noise.hpp>
#include <thalweg/core/polygons.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/required.hpp>
#include <thalweg/core/ridge_lines.hpp>
#include <thalweg/core/river_lines.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/lanes.hpp>
#include <thalweg/core/run/large_pages.hpp>
#include <thalweg/core/run/memory.hpp>
#include <thalweg/core/run/parallel.hpp>
#include <thalweg/core/run/printable.hpp>
#include <thalweg/core/run/range.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/run/suggest.hpp>
#include <thalweg/core/skeleton.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/core/tin.hpp>
#include <thalweg/core/valley.hpp>
#include <thalweg/core/vec.hpp>
