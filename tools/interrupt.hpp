// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <stop_token>

namespace thalweg::tools {

/// Turns Ctrl-C (and SIGTERM) into a stop token: call it first, before any thread begins. A second Ctrl-C ends at once.
std::stop_token stop_at_interrupt();

} // namespace thalweg::tools
