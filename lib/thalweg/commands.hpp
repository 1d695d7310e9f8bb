// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// Options of a command → what it wrote and found, as the program and the studio run it.
#include <thalweg/commands/blend.hpp>
#include <thalweg/commands/check.hpp>
#include <thalweg/commands/convert.hpp>
#include <thalweg/commands/deform.hpp>
#include <thalweg/commands/draw.hpp>
#include <thalweg/commands/ensemble.hpp>
#include <thalweg/commands/grow.hpp>
#include <thalweg/commands/make.hpp>
#include <thalweg/commands/measure.hpp>
#include <thalweg/commands/points.hpp>
#include <thalweg/commands/replay.hpp>
#include <thalweg/commands/stats.hpp>
#include <thalweg/commands/tin.hpp>
