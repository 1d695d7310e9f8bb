// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include <thalweg/core/run/run.hpp>
#include <thalweg/io/mesh/read_tin.hpp>

namespace thalweg::pipeline {

/// Reads a mesh as io::read_tin does and logs how many faces were cut into triangles.
io::TinFile read_mesh(std::string const& path, Run const& run);

} // namespace thalweg::pipeline
