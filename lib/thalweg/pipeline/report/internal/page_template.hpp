// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

namespace thalweg::pipeline {

/// The report page as built into the library, its markers not yet filled in: the bytes of web/dist/report.html.
std::string_view page_template();

} // namespace thalweg::pipeline
