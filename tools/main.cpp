// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "commands.hpp"
#include "complaint.hpp"
#include "describe.hpp"
#include "interrupt.hpp"
#include "terminal.hpp"

#include <thalweg/core/error.hpp>
#include <thalweg/core/memory.hpp>
#include <thalweg/core/printable.hpp>
#include <thalweg/io/driver.hpp>
#include <thalweg/pipeline/report.hpp>
#include <thalweg/solver/devices.hpp>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <chrono>
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
    fmt::print(stderr, "{} {}\n", toned(Tone::bad, "error:", stderr), printable(text));
}

int call(Command const& command, Terminal& terminal) {
    auto const end = [&](std::string const& why, Exit code) {
        terminal.wipe();
        complain(why);
        return code;
    };
    try {
        return command();
    } catch (Cancelled const&) {
        return end("interrupted; nothing was written", Exit::interrupted);
    } catch (BadParameter const& e) {
        return end(e.what(), Exit::wrong);
    } catch (BadInput const& e) {
        return end(e.what(), Exit::wrong);
    } catch (std::bad_alloc const&) {
        return end("out of memory: make the grid smaller or the cell larger", Exit::failed);
    } catch (std::exception const& e) {
        return end(e.what(), Exit::failed);
    }
}

void tell_time(Run const& run, std::string const& stage, double seconds) {
    run.tell(stage, fmt::format("{:<56}{:6.1f} s", "", seconds));
}

/// What ends a command: the time of all, and with -v that of each stage and the memory.
void tell_times(Session const& session, Terminal& terminal, double seconds) {
    if (session.verbose) {
        session.run.say("time by stage");
        for (auto const& [stage, time] : terminal.times()) {
            tell_time(session.run, stage, time);
        }
        session.run.tell("memory", fmt::format("{:<52}{:7.1f} MB", "", static_cast<double>(peak_memory_bytes()) / 1e6));
    }
    tell_time(session.run, "total", seconds);
}

} // namespace

int main(int argc, char** argv) {
    Session session;
    session.run.stop = stop_at_interrupt();

    CLI::App app("thalweg makes terrain from its rivers outward.", "thalweg");
    app.formatter_fn([](CLI::App const* of, std::string const&, CLI::AppFormatMode) { return help_text(*of); });
    app.set_help_flag("-h,--help", "Show this help.");
    app.set_version_flag("--version", fmt::format("thalweg {} ({})", pipeline::version(), io::gdal_version()),
                         "Show the version of thalweg and of GDAL.");
    app.require_subcommand(1);
    app.fallthrough(false);
    std::map<CLI::App*, Command> commands;
    auto const add = [&](char const* name, char const* words, auto const& add_command) {
        CLI::App* const sub = app.add_subcommand(name, words);
        sub->add_option("--threads", session.threads, "Use this many threads; 0 takes every core.")
            ->check(CLI::Range(0, 1024));
        sub->add_option("--device", session.device,
                        "Solve large grid systems on the CPU or on an OpenCL device; heights differ by less than 1e-6 "
                        "m. Other stages always run on the CPU.")
            ->check(CLI::IsMember({"cpu", "opencl"}))
            ->capture_default_str();
        CLI::Option* const quiet = sub->add_flag("-q,--quiet", session.quiet, "Print errors only.");
        sub->add_flag("-v,--verbose", session.verbose, "Print every note and repair, and the time of each stage.")
            ->excludes(quiet);
        commands[sub] = add_command(*sub, session);
    };
    add("make", "Make terrain and a river network from a recipe or a river file.", add_make);
    add("check", "Check the topology of a river network, and its drainage on a DEM.", add_check);
    add("convert", "Convert a river network to another schema or format.", add_convert);
    add("stats", "Print statistics of a DEM.", add_stats);
    add("measure", "Write contributing areas, flow directions and catchments of a DEM.", add_measure);
    add("draw", "Draw pictures of a DEM or of a folder written by make.", add_draw);
    add("tin", "Write a TIN of a DEM, of points or of a network.", add_tin);
    add("points", "Write the cells of a DEM as a point cloud.", add_points);
    add("blend", "Paste a part of one DEM into another without a seam.", add_blend);
    add("deform", "Scale the relief of a region of a DEM, or pull it to heights.", add_deform);
    add("grow", "Grow a network by Tokunaga's law and count its streams.", add_grow);
    add("replay", "Run a folder's recipe again and compare every file.", add_replay);
    add("recipe", "List every key of a recipe.", add_recipe);
    CLI::App* const completion = app.add_subcommand("completion", "Print a completion script for a shell.");
    CLI::App* const man = app.add_subcommand("man", "Write the manual pages.");
    CLI::App* const help = app.add_subcommand("help", "Explain a command.");
    commands[completion] = add_completion(*completion);
    commands[man] = add_man(*man); // these two know every command that is there already
    commands[help] = add_help(*help);
    app.footer("Examples:\n"
               "  thalweg make\n"
               "  thalweg make samples/walker_nhdplus.gpkg -o out/walker\n"
               "  thalweg check out/walker\n"
               "  thalweg help make\n"); // after the commands: they would take it over

    if (argc == 1) {
        fmt::print(stderr, "{}", app.help());
        return Exit::wrong;
    }
    try {
        app.parse(argc, argv);
    } catch (CLI::ParseError const& e) {
        if (e.get_exit_code() == 0) { // --help, --version
            return app.exit(e);
        }
        complain(complaint(app, {argv + 1, argv + argc}, e.what()));
        return Exit::wrong;
    }

    Terminal terminal(session.quiet ? Terminal::Manner::quiet : Terminal::Manner::talk);
    session.run.threads = session.threads;
    session.run.progress = &Terminal::progress;
    session.run.progress_arg = &terminal;
    session.run.log = [&](std::string_view line) { terminal.line(line); };
    CLI::App* const chosen = app.get_subcommands().front();
    return call(
        [&] {
            if (session.verbose) {
                session.run.say(fmt::format("thalweg {} ({})", pipeline::version(), io::gdal_version()));
            }
            if (session.device == "opencl") {
                session.run.device = Device::opencl;
                session.run.tell("device", solver::opencl_device_name());
            }
            auto const begin = std::chrono::steady_clock::now();
            int const code = commands.at(chosen)();
            bool const made = chosen->get_name() == "make" && chosen->count("--dry-run") == 0;
            if (session.verbose || made) {
                tell_times(session, terminal,
                           std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
            }
            return code;
        },
        terminal);
}
