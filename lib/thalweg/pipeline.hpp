// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// All public headers of the module.
#include <thalweg/pipeline/commands/blend.hpp>
#include <thalweg/pipeline/commands/check.hpp>
#include <thalweg/pipeline/commands/convert.hpp>
#include <thalweg/pipeline/commands/deform.hpp>
#include <thalweg/pipeline/commands/draw.hpp>
#include <thalweg/pipeline/commands/ensemble.hpp>
#include <thalweg/pipeline/commands/grow.hpp>
#include <thalweg/pipeline/commands/make.hpp>
#include <thalweg/pipeline/commands/measure.hpp>
#include <thalweg/pipeline/commands/points.hpp>
#include <thalweg/pipeline/commands/replay.hpp>
#include <thalweg/pipeline/commands/stats.hpp>
#include <thalweg/pipeline/commands/tin.hpp>
