// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <stop_token>

namespace thalweg::tools {

/// Turns Ctrl-C (SIGINT), SIGTERM and SIGHUP into a stop token, also those that came before and were held (see
/// start/start.cpp): call it first. SIGHUP stays ignored where the caller ignores it (nohup). A second signal ends at
/// once.
std::stop_token stop_at_signals();

/// The exit status of a run that such a signal stopped: 130, 143 or 129.
int exit_of_signal();

} // namespace thalweg::tools
