// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/io/contours.hpp>
#include <thalweg/io/hillshade.hpp>
#include <thalweg/io/read_dem.hpp>
#include <thalweg/io/write_dem.hpp>
