// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include <thalweg/pipeline/make/laws.hpp>

/// Private to this module.
namespace thalweg::pipeline {

/// The laws of rivers as the page has them, JSON: a table of figures, and what its diagrams show (web/README.md).
std::string page_laws(RiverLaws const& laws);

} // namespace thalweg::pipeline
