// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// All public headers of the module.
#include <thalweg/flow/catchments/areas.hpp>
#include <thalweg/flow/catchments/catchments.hpp>
#include <thalweg/flow/catchments/reaches.hpp>
#include <thalweg/flow/conditioning/condition.hpp>
#include <thalweg/flow/conditioning/dem_change.hpp>
#include <thalweg/flow/direction.hpp>
#include <thalweg/flow/flow_field.hpp>
#include <thalweg/flow/routing/flow_lengths.hpp>
#include <thalweg/flow/routing/route.hpp>
#include <thalweg/flow/routing/route_dinf.hpp>
#include <thalweg/flow/steepest_descent.hpp>
#include <thalweg/flow/streams/extract_streams.hpp>
