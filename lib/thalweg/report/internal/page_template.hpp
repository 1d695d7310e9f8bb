// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

namespace thalweg::report {

/// The report page built into the library, with unfilled markers: the bytes of web/dist/report.html.
std::string_view page_template();

} // namespace thalweg::report
