// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

namespace thalweg::exports {

/// The map page built into the library, with unfilled markers: the bytes of web/dist/terrain.html.
std::string_view web_template();

} // namespace thalweg::exports
