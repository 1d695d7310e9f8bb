// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// Nothing, a region or drawn strokes → river networks: clusters by diffusion-limited aggregation, forests, Tokunaga
/// trees.
#include <thalweg/growth/dla/grow_dla.hpp>
#include <thalweg/growth/forest/coast.hpp>
#include <thalweg/growth/forest/grow_forest.hpp>
#include <thalweg/growth/tokunaga/embed_tree.hpp>
#include <thalweg/growth/tokunaga/grow_strokes.hpp>
#include <thalweg/growth/tokunaga/grow_tokunaga.hpp>
#include <thalweg/growth/tokunaga/lsystem.hpp>
