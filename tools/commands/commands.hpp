// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/run/run.hpp>

namespace CLI {
class App;
}

namespace thalweg::tools {

/// Exit codes (contract).
enum Exit : int { done = 0, failed = 1, wrong = 2, check_failed = 3 }; // exit codes of signals: interrupt.hpp

/// How a command runs: options every command has.
struct Session {
    int threads = 0;
    std::string device = "cpu";
    bool quiet = false;
    bool verbose = false;
    bool json = false;
    bool progress = false;              ///< as lines of JSON
    Run run;                            ///< ready when the command is called
    std::vector<Finding> findings = {}; ///< that the command's run reported
};

/// A command adds its options to the app and returns its action. help.hpp describes how help, manual and completion
/// read the options.
using Command = std::function<int()>;
Command add_make(CLI::App& app, Session& session);
Command add_rebuild(CLI::App& app, Session& session);
Command add_check(CLI::App& app, Session& session);
Command add_convert(CLI::App& app, Session& session);
Command add_stats(CLI::App& app, Session& session);
Command add_draw(CLI::App& app, Session& session);
Command add_export(CLI::App& app, Session& session);
Command add_replay(CLI::App& app, Session& session);
Command add_recipe(CLI::App& app, Session& session);
Command add_tin(CLI::App& app, Session& session);
Command add_points(CLI::App& app, Session& session);
Command add_blend(CLI::App& app, Session& session);
Command add_deform(CLI::App& app, Session& session);
Command add_measure(CLI::App& app, Session& session);
Command add_grow(CLI::App& app, Session& session);
Command add_studio(CLI::App& app, Session& session);
// Commands about the command line itself: they read the other commands.
Command add_completion(CLI::App& app);
Command add_man(CLI::App& app);
Command add_help(CLI::App& app);

} // namespace thalweg::tools
