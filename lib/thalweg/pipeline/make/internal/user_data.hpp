// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include <thalweg/io/network/write_network.hpp>
#include <thalweg/pipeline/make/make.hpp>

/// The user's columns of a terrain's rivers. Private to this module.
namespace thalweg::pipeline {

/// What the file said of the lines that became these arcs; nothing for grown rivers.
std::optional<io::UserData> user_data(Made const& t, StreamNetwork const& plan);

/// The columns that have other names in the shapefiles.
std::vector<io::ShortenedName> shortened_names(Made const& t);

} // namespace thalweg::pipeline
