// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// A DEM or a network → measures, checks and findings. Nothing is changed.
#include <thalweg/measure/drainage/certificate.hpp>
#include <thalweg/measure/laws/fits.hpp>
#include <thalweg/measure/laws/network_laws.hpp>
#include <thalweg/measure/likeness/likeness.hpp>
#include <thalweg/measure/peaks/orometry.hpp>
#include <thalweg/measure/relief/geomorphons.hpp>
#include <thalweg/measure/relief/hypsometry.hpp>
#include <thalweg/measure/relief/relief.hpp>
#include <thalweg/measure/relief/slope_area.hpp>
#include <thalweg/measure/relief/slope_aspect.hpp>
#include <thalweg/measure/relief/slopes.hpp>
#include <thalweg/measure/relief/statistics.hpp>
#include <thalweg/measure/relief/swath.hpp>
#include <thalweg/measure/relief/variety.hpp>
#include <thalweg/measure/relief/wetness.hpp>
#include <thalweg/measure/relief/zones.hpp>
#include <thalweg/measure/rivers/profiles.hpp>
#include <thalweg/measure/texture/texture.hpp>
#include <thalweg/measure/topology/topology.hpp>
