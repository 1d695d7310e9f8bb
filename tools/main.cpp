// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <map>
#include <new>
#include <optional>
#include <signal.h>
#include <sstream>
#include <string>
#include <system_error>
#include <thread>
#include <unistd.h>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/memory.hpp>
#include <thalweg/core/run/messages.hpp>
#include <thalweg/core/run/peak_memory.hpp>
#include <thalweg/core/run/stage_log.hpp>
#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/report/report.hpp>
#include <thalweg/solver/opencl/devices.hpp>

#include "commands/commands.hpp"
#include "help/help.hpp"
#include "ranks/ranks.hpp"
#include "terminal/interrupt.hpp"
#include "terminal/terminal.hpp"

namespace {

using namespace thalweg;
using namespace thalweg::tools;

// Allocated before memory is exhausted.
constexpr std::string_view memory_line = "error: out of memory: make the grid smaller or the cell larger\n";

void complain(std::string const& text) {
    write_to_stderr(fmt::format("{} {}\n", toned(Tone::bad, "error:", stderr), printable(text)));
}

/// Ends the process with a message where no handler can catch an exception: in a library's thread, or while another
/// exception is handled.
[[noreturn]] void end_without_handler() {
    try {
        if (std::exception_ptr const fault = std::current_exception()) {
            std::rethrow_exception(fault);
        }
        write_to_stderr("error: the program ends, as a thread could not go on; its output is not complete. This is a "
                        "fault of thalweg: please report it\n");
    } catch (std::bad_alloc const&) {
        write_to_stderr(memory_line);
    } catch (std::exception const& e) {
        write_to_stderr("error: ");
        write_to_stderr(e.what());
        write_to_stderr("\n");
    } catch (...) {
        write_to_stderr("error: a fault of an unknown kind\n");
    }
    _exit(Exit::failed);
}

/// Libraries report lack of memory only in text; the input is then not at fault.
int exit_code_for(std::string const& words) {
    for (char const* const of_memory : {"ut of memory", "annot allocate", "bad_alloc"}) {
        if (words.find(of_memory) != std::string::npos) {
            return Exit::failed;
        }
    }
    return Exit::wrong;
}

int call(Command const& command, Terminal& terminal) {
    auto const end = [&](std::string const& why, int code) {
        terminal.wipe();
        complain(why);
        return code;
    };
    try {
        return command();
    } catch (Cancelled const& e) {
        std::string const words = e.what(); // of an ensemble they say what was written
        return end(words == "interrupted" ? "interrupted; nothing was written" : words, exit_of_signal());
    } catch (BadParameter const& e) {
        return end(e.what(), exit_code_for(e.what()));
    } catch (BadInput const& e) {
        return end(e.what(), exit_code_for(e.what()));
    } catch (std::bad_alloc const&) {
        terminal.wipe();
        write_to_stderr(memory_line);
        return Exit::failed;
    } catch (std::exception const& e) {
        return end(e.what(), Exit::failed);
    }
}

void tell_time(Run const& run, std::string const& stage, double seconds) {
    run.tell(stage, fmt::format("{:<56}{:6.1f} s", "", seconds));
}

/// Logs the total time, and with -v the time of each stage and the memory.
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

/// A run whose output could not be written has failed.
int exit_code_after_output(int code) {
    std::string const fault = fault_of_stdout();
    if (fault.empty() || (code != Exit::done && code != Exit::check_failed)) {
        return code;
    }
    complain(fmt::format("cannot write to standard output: {}", fault));
    return Exit::failed;
}

using Commands = std::map<CLI::App*, Command>;

/// The options of every command that does work.
void add_options_of_all(CLI::App& sub, Session& session) {
    sub.add_option("--threads", session.threads, "Use this many threads; 0 takes every core.")
        ->check(CLI::Range(0, 1024));
    sub.add_option("--device", session.device,
                   "Solve large grid systems on the CPU or on an OpenCL device; heights differ by less than 1e-6 "
                   "m. Other stages always run on the CPU.")
        ->check(CLI::IsMember({"cpu", "opencl"}))
        ->capture_default_str();
    CLI::Option* const quiet = sub.add_flag("-q,--quiet", session.quiet, "Print errors only.");
    sub.add_flag("-v,--verbose", session.verbose, "Print every note and repair, and the time of each stage.")
        ->excludes(quiet);
    sub.add_flag("--progress", session.progress,
                 "Report progress and findings on stderr as lines of JSON, for programs that run thalweg: {\"stage\": "
                 "\"surface\", \"share\": 0.3125} and {\"finding\": {...}}.");
}

Commands add_commands(CLI::App& app, Session& session) {
    Commands commands;
    auto const add = [&](char const* name, char const* words, auto const& add_command) {
        CLI::App* const sub = app.add_subcommand(name, words);
        add_options_of_all(*sub, session);
        commands[sub] = add_command(*sub, session);
    };
    add("make", "Make terrain and a river network from a recipe or a river file.", add_make);
    add("rebuild", "Make the terrain between rivers with heights, and compare it with a DEM.", add_rebuild);
    add("studio", "Edit a recipe in the browser while its terrain follows.", add_studio);
    add("check", "Check the topology of a river network, and its drainage on a DEM.", add_check);
    add("convert", "Convert a river network to another schema or format.", add_convert);
    add("stats", "Print statistics of a DEM.", add_stats);
    add("measure", "Write contributing areas, flow directions and catchments of a DEM.", add_measure);
    add("draw", "Draw pictures of a DEM, of a folder written by make, or of an ensemble.", add_draw);
    add("export", "Write heights or a mesh for game engines, 3D programs and printers.", add_export);
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
    commands[man] = add_man(*man); // these two list all commands added before them
    commands[help] = add_help(*help);
    return commands;
}

void describe_program(CLI::App& app) {
    app.formatter_fn([](CLI::App const* of, std::string const&, CLI::AppFormatMode) { return help_text(*of); });
    app.set_help_flag("-h,--help", "Show this help.");
    app.set_version_flag("--version",
                         fmt::format("thalweg {} ({}, {})", report::version(), io::gdal_version(), mpi_version()),
                         "Show the versions of thalweg, of GDAL and of MPI.");
    app.require_subcommand(1);
    app.fallthrough(false);
}

/// Parses the command line.
/// \return an exit code if nothing remains to be done: help, a version, an error
std::optional<int> parse(CLI::App& app, int argc, char** argv) {
    if (argc == 1) {
        write_to_stderr(app.help());
        return Exit::wrong;
    }
    try {
        app.parse(argc, argv);
    } catch (CLI::ParseError const& e) {
        if (e.get_exit_code() == 0) { // --help, --version
            std::ostringstream text;
            app.exit(e, text, text);
            fmt::print("{}", text.str());
            return Exit::done;
        }
        complain(complaint(app, {argv + 1, argv + argc}, e.what()));
        return Exit::wrong;
    }
    return std::nullopt;
}

/// Whether the system allows the threads of a run (0: one per core): those of oneTBB, and as many of GDAL. GDAL waits
/// forever for a thread that could not be started.
bool can_start_threads(int wanted) {
    if (wanted == 1) {
        return true;
    }
    long const count = wanted > 0 ? wanted : std::max<long>(sysconf(_SC_NPROCESSORS_ONLN), 1);
    std::atomic<bool> done = false;
    std::vector<std::thread> threads;
    bool all = true;
    try {
        threads.reserve(2 * static_cast<std::size_t>(count));
        while (threads.size() < threads.capacity()) {
            threads.emplace_back([&done] { done.wait(false); });
        }
    } catch (std::system_error const&) { // limit on processes
        all = false;
    } catch (std::bad_alloc const&) { // limit on memory
        all = false;
    }
    done = true;
    done.notify_all();
    for (std::thread& thread : threads) {
        thread.join();
    }
    return all;
}

/// A finding's line, its severity in colour.
std::string in_tone(Finding const& finding) {
    std::string const line = line_of(finding);
    if (finding.severity() == Severity::note) {
        return line;
    }
    std::string_view const severity = name_of(finding.severity());
    return toned(finding.severity() == Severity::warning ? Tone::careful : Tone::bad, severity, stderr) +
           line.substr(severity.size());
}

/// Prepares the environment of a run.
void prepare(Session& session, Terminal& terminal) {
    session.run.threads = can_start_threads(session.threads) ? session.threads : 1;
    session.run.progress = &Terminal::progress;
    session.run.progress_arg = &terminal;
    session.run.log = [&terminal](std::string_view line) { terminal.line(line); };
    if (session.progress) {
        session.run.planned = [&terminal](std::vector<StageTime> const& stages) {
            auto json = nlohmann::ordered_json::array();
            for (StageTime const& one : stages) {
                json.push_back({{"stage", one.stage}, {"seconds", one.wall_s}});
            }
            terminal.data(nlohmann::ordered_json{{"stages", json}}.dump());
        };
    }
    session.run.found = [&session, &terminal](Finding const& finding) {
        session.findings.push_back(finding);
        bool const is_printed = session.verbose || finding.kind.row().printed == Printed::always;
        if (is_printed && session.progress) {
            terminal.data(fmt::format("{{\"finding\": {}}}", report::finding_json(finding)));
        } else if (is_printed) {
            terminal.line(in_tone(finding));
        }
    };
}

int work(CLI::App const& chosen, Command const& command, Session& session, Terminal& terminal) {
    if (session.verbose) {
        session.run.say(fmt::format("thalweg {} ({})", report::version(), io::gdal_version()));
    }
    if (session.run.threads != session.threads) {
        session.run.tell("threads", "one: the system lets no more start");
    }
    if (session.device == "opencl") {
        session.run.device = Device::opencl;
        session.run.tell("device", solver::opencl_device_name());
    }
    auto const begin = std::chrono::steady_clock::now();
    int const code = command();
    bool const made = (chosen.get_name() == "make" || chosen.get_name() == "rebuild") && chosen.count("--dry-run") == 0;
    if (session.verbose || made) {
        tell_times(session, terminal, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    }
    return code;
}

int run(int argc, char** argv) {
    Session session;
    session.run.stop = stop_at_signals();
    CLI::App app("thalweg makes terrain from its rivers outward.", "thalweg");
    describe_program(app);
    Commands const commands = add_commands(app, session);
    app.footer("Examples:\n"
               "  thalweg make\n"
               "  thalweg make samples/walker_nhdplus.gpkg -o out/walker\n"
               "  thalweg check out/walker\n"
               "  thalweg help make\n"); // added after the commands, which would inherit it
    if (std::optional<int> const code = parse(app, argc, argv)) {
        return *code;
    }
    Terminal terminal(session.quiet ? Terminal::Manner::quiet : Terminal::Manner::talk,
                      session.progress ? Terminal::Progress::json : Terminal::Progress::bar);
    prepare(session, terminal);
    CLI::App* const chosen = app.get_subcommands().front();
    return call([&] { return work(*chosen, commands.at(chosen), session, terminal); }, terminal);
}

} // namespace

/// GDAL aborts if there is no memory for an error message. It has already reported that on standard error.
extern "C" {
static void handle_abort(int /*number*/) {
    constexpr char text[] = "error: a library could not go on, which happens when memory is short\n";
    [[maybe_unused]] auto const written = write(STDERR_FILENO, text, sizeof text - 1);
    _exit(thalweg::tools::Exit::failed);
}

/// Handles a library that writes to memory it was refused; any other fault keeps its signal.
[[maybe_unused]] static void handle_fault(int number) {
    alarm(2);                                   // the fault may be inside malloc
    constexpr std::size_t most_asked = 1 << 20; // faults immediately, e.g. libgeotiff, which does not check the result
    if (std::malloc(most_asked) == nullptr) {
        [[maybe_unused]] auto const written = write(STDERR_FILENO, memory_line.data(), memory_line.size());
        _exit(thalweg::tools::Exit::failed);
    }
    std::signal(number, SIG_DFL); // the instruction runs again
}
}

namespace {

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) // sanitizers report faults themselves
/// Handles faults on a separate stack: if memory is refused, Cairo jumps through an uninitialised buffer and leaves no
/// stack.
void handle_faults() {
    static char stack[1 << 16];
    stack_t own{};
    own.ss_sp = stack;
    own.ss_size = sizeof stack;
    sigaltstack(&own, nullptr);
    struct sigaction action {};
    action.sa_handler = handle_fault;
    action.sa_flags = SA_ONSTACK;
    sigaction(SIGSEGV, &action, nullptr);
}
#else
void handle_faults() {}
#endif

} // namespace

int main(int argc, char** argv) {
    std::set_terminate(end_without_handler);
    std::signal(SIGABRT, handle_abort);
    handle_faults();
    return_large_blocks();
    try {
        return exit_code_after_output(run(argc, argv));
    } catch (...) {
        end_without_handler();
    }
}
