// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

namespace thalweg::report {

/// The bytes of tests/data/awkward.bin, embedded as the report page is.
std::string_view awkward_bytes();

} // namespace thalweg::report
