// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/flow/flow_field.hpp>

namespace thalweg::flow {

/// By cell: the longest way that water runs down to it by D8, from a divide [m]; 0 where none arrives or without data.
/// Throws: Cancelled. Source: the length of Hack 1957 on a grid.
Raster<float> flow_lengths(FlowField const& drainage, Run const& run = {});

} // namespace thalweg::flow
