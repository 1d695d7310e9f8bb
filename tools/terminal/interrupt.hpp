// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <stop_token>

namespace thalweg::tools {

/// Turns Ctrl-C (SIGINT), SIGTERM and SIGHUP into a stop token, including those held before (see start/start.cpp): call
/// it first. SIGHUP stays ignored if the caller ignores it (nohup). A second signal ends the process immediately.
std::stop_token stop_at_signals();

/// The exit status of a run that such a signal stopped: 130, 143 or 129.
int exit_of_signal();

} // namespace thalweg::tools
