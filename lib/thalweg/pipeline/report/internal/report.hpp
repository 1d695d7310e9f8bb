// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/measure/drainage/certificate.hpp>

namespace thalweg::pipeline {

// Parts of report.json common to other reports.

/// Findings as a JSON array.
std::string findings_json(std::vector<Finding> const& findings);

/// A certificate as a JSON object.
std::string certificate_json(measure::Certificate const& certificate);

} // namespace thalweg::pipeline
