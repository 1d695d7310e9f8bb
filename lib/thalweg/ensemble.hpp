// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// A recipe and what varies → members, their table, and pictures of them.
#include <thalweg/ensemble/draw_ensemble.hpp>
#include <thalweg/ensemble/ensemble.hpp>
#include <thalweg/ensemble/make_members.hpp>
#include <thalweg/ensemble/ranks.hpp>
