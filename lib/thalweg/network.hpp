// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// Lines or a mask → river networks: imported, traced, pruned, bent, ordered, with heights and cells.
#include <thalweg/network/channels/channels.hpp>
#include <thalweg/network/channels/lakes.hpp>
#include <thalweg/network/channels/side_valleys.hpp>
#include <thalweg/network/elevation/known_heights.hpp>
#include <thalweg/network/elevation/river_types.hpp>
#include <thalweg/network/elevation/set_heights.hpp>
#include <thalweg/network/import/choose_cell.hpp>
#include <thalweg/network/import/from_file.hpp>
#include <thalweg/network/import/import_lines.hpp>
#include <thalweg/network/import/land_and_sea.hpp>
#include <thalweg/network/import/open_ends.hpp>
#include <thalweg/network/import/prepare_lines.hpp>
#include <thalweg/network/import/river_heights.hpp>
#include <thalweg/network/order/main_stems.hpp>
#include <thalweg/network/order/order.hpp>
#include <thalweg/network/order/pfafstetter.hpp>
#include <thalweg/network/order/select.hpp>
#include <thalweg/network/planform/carry_outlets.hpp>
#include <thalweg/network/planform/meander.hpp>
#include <thalweg/network/planform/rotate.hpp>
#include <thalweg/network/planform/split_confluences.hpp>
#include <thalweg/network/vectorise/prune.hpp>
#include <thalweg/network/vectorise/rasterise.hpp>
#include <thalweg/network/vectorise/vectorise.hpp>
