// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// A DEM → flow directions, a conditioned DEM, catchments, streams.
#include <thalweg/flow/catchments.hpp>
#include <thalweg/flow/condition.hpp>
#include <thalweg/flow/direction.hpp>
#include <thalweg/flow/extract_streams.hpp>
#include <thalweg/flow/given_directions.hpp>
#include <thalweg/flow/paths.hpp>
#include <thalweg/flow/route.hpp>
