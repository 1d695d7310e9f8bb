// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "commands.hpp"
#include "interrupt.hpp"
#include "terminal.hpp"

#include <thalweg/core/error.hpp>
#include <thalweg/core/suggest.hpp>
#include <thalweg/io/driver.hpp>
#include <thalweg/pipeline/report.hpp>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <map>
#include <new>
#include <string>
#include <vector>

namespace {

using namespace thalweg;
using namespace thalweg::tools;

void complain(std::string const& text) {
    fmt::print(stderr, "{} {}\n", alarmed("error:"), text);
}

/// What CLI11 leaves out: which command or option was meant.
std::string suggestion(CLI::App const& app, int argc, char const* const* argv) {
    CLI::App const* at = &app;
    for (int i = 1; i < argc; ++i) {
        std::string const word = argv[i];
        std::vector<std::string> known;
        if (word.rfind("--", 0) == 0) {
            std::string const name = word.substr(0, word.find('='));
            for (CLI::Option const* option : at->get_options()) {
                for (std::string const& l : option->get_lnames()) {
                    known.push_back("--" + l);
                }
            }
            if (std::find(known.begin(), known.end(), name) == known.end()) {
                return did_you_mean(name, known);
            }
        } else if (at == &app) {
            for (CLI::App const* sub : app.get_subcommands(nullptr)) {
                known.push_back(sub->get_name());
                if (sub->get_name() == word) {
                    at = sub;
                }
            }
            if (at == &app) {
                return did_you_mean(word, known);
            }
        }
    }
    return "";
}

int call(Command const& command) {
    try {
        return command();
    } catch (Cancelled const&) {
        complain("interrupted; nothing was written");
        return Exit::interrupted;
    } catch (BadParameter const& e) {
        complain(e.what());
        return Exit::wrong;
    } catch (BadInput const& e) {
        complain(e.what());
        return Exit::wrong;
    } catch (std::bad_alloc const&) {
        complain("out of memory: make the grid smaller or the cell larger");
        return Exit::failed;
    } catch (std::exception const& e) {
        complain(e.what());
        return Exit::failed;
    }
}

} // namespace

int main(int argc, char** argv) {
    Session session;
    session.run.stop = stop_at_interrupt();

    CLI::App app("thalweg builds terrain from its valleys outward.", "thalweg");
    app.set_version_flag("--version", fmt::format("thalweg {} ({})", pipeline::version(), io::gdal_version()));
    app.require_subcommand(1);
    app.fallthrough(false);
    std::map<CLI::App*, Command> commands;
    auto const add = [&](char const* name, char const* words, auto const& add_command) {
        CLI::App* const sub = app.add_subcommand(name, words);
        sub->add_option("--threads", session.threads, "workers; 0 takes every core")->check(CLI::Range(0, 1024));
        sub->add_flag("-q,--quiet", session.quiet, "say nothing but errors");
        commands[sub] = add_command(*sub, session);
    };
    add("make", "a terrain from a recipe, or the sample valley without one", add_make);
    add("check", "the topology of a network's files", add_check);
    add("stats", "statistics of a DEM", add_stats);
    add("replay", "runs a folder's recipe again and compares the bytes", add_replay);
    add("recipe", "every key of a recipe", add_recipe);
    add("tin", "a TIN from a DEM, points or a network", add_tin);

    try {
        app.parse(argc, argv);
    } catch (CLI::ParseError const& e) {
        if (e.get_exit_code() == 0) { // --help, --version
            return app.exit(e);
        }
        complain(e.what() + std::string(".") + suggestion(app, argc, argv) + " See thalweg --help.");
        return Exit::wrong;
    }

    Terminal terminal(session.quiet ? Terminal::Manner::quiet : Terminal::Manner::talk);
    session.run.threads = session.threads;
    session.run.progress = &Terminal::progress;
    session.run.progress_arg = &terminal;
    session.run.log = [&](std::string_view line) { terminal.line(line); };
    CLI::App* const chosen = app.get_subcommands().front();
    return call(commands.at(chosen));
}
