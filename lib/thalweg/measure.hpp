// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// All public headers of the module.
#include <thalweg/measure/drainage/certificate.hpp>
#include <thalweg/measure/drainage/extract_ridges.hpp>
#include <thalweg/measure/laws/horton.hpp>
#include <thalweg/measure/laws/junction_angles.hpp>
#include <thalweg/measure/laws/line_fit.hpp>
#include <thalweg/measure/laws/link_lengths.hpp>
#include <thalweg/measure/laws/network_laws.hpp>
#include <thalweg/measure/laws/power_law.hpp>
#include <thalweg/measure/laws/tokunaga.hpp>
#include <thalweg/measure/peaks/isolation.hpp>
#include <thalweg/measure/peaks/orometry.hpp>
#include <thalweg/measure/peaks/prominence.hpp>
#include <thalweg/measure/relief/chi.hpp>
#include <thalweg/measure/relief/geomorphons.hpp>
#include <thalweg/measure/relief/hypsometry.hpp>
#include <thalweg/measure/relief/level_patch.hpp>
#include <thalweg/measure/relief/local_extremes.hpp>
#include <thalweg/measure/relief/natural_ranges.hpp>
#include <thalweg/measure/relief/perched.hpp>
#include <thalweg/measure/relief/reference_dems.hpp>
#include <thalweg/measure/relief/relief.hpp>
#include <thalweg/measure/relief/relief_metrics.hpp>
#include <thalweg/measure/relief/slope_area.hpp>
#include <thalweg/measure/relief/slope_area_ratio.hpp>
#include <thalweg/measure/relief/slopes.hpp>
#include <thalweg/measure/relief/statistics.hpp>
#include <thalweg/measure/texture/gradient_texture.hpp>
#include <thalweg/measure/texture/straight_channels.hpp>
#include <thalweg/measure/topology/topology.hpp>
