// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// Values → pictures as PNG, SVG or PDF.
#include <thalweg/draw/comparison.hpp>
#include <thalweg/draw/contact_sheet.hpp>
#include <thalweg/draw/diagrams.hpp>
#include <thalweg/draw/distributions.hpp>
#include <thalweg/draw/map.hpp>
#include <thalweg/draw/picture.hpp>
#include <thalweg/draw/sections.hpp>
#include <thalweg/draw/wireframe.hpp>
