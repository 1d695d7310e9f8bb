// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>

#include <fcntl.h>
#include <spawn.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <thalweg/studio/studio.hpp>

#include "commands/commands.hpp"
#include "terminal/terminal.hpp"

namespace thalweg::tools {

namespace {

struct StudioOptions {
    std::string input;
    std::string folder;
    studio::StudioParams params;
    bool no_browser = false;
    bool blank = false;
};

/// Opens an address in the user's browser, where there is one.
/// \return whether it was asked to open
bool open_browser(std::string const& address) {
    bool const has_screen = std::getenv("DISPLAY") != nullptr || std::getenv("WAYLAND_DISPLAY") != nullptr;
    if (!has_screen) {
        return false;
    }
    std::string program = "xdg-open";
    std::string word = address;
    char* const words[] = {program.data(), word.data(), nullptr};
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    pid_t child = 0;
    int const error = posix_spawnp(&child, program.c_str(), &actions, nullptr, words, environ);
    posix_spawn_file_actions_destroy(&actions);
    return error == 0;
}

int run_studio(StudioOptions& options, Session const& session) {
    options.params.folder = studio::document_for(options.input, options.folder, options.blank, session.run);
    options.params.threads = session.run.threads;
    studio::Studio studio(options.params);
    session.run.tell("document", options.params.folder);
    std::string const address = studio.address();
    fmt::print("{}\n", address);
    std::fflush(stdout);
    bool const opened = !options.no_browser && open_browser(address);
    session.run.tell("open", fmt::format("{}   (this machine only; Ctrl-C ends it, everything is saved)",
                                         opened ? "the browser shows it" : "open the address in a browser"));
    studio.run(session.run.stop);
    return Exit::done;
}

} // namespace

Command add_studio(CLI::App& app, Session& session) {
    auto const options = std::make_shared<StudioOptions>();
    app.add_option("INPUT", options->input,
                   "The folder of a document; or what a new document begins with: a recipe (TOML), a folder written by "
                   "make, rivers or a DEM, which are copied. Without it, thalweg opens ./studio, or begins it with the "
                   "terrain of make.")
        ->type_name("FILE(toml,gpkg,shp,geojson,json,fgb,kml,gpx,gdb,zip,tif)");
    app.add_option(
           "-o,--output", options->folder,
           "Begin the new document in this folder; without it in ./studio, or ./studio-2 and so on where that is "
           "taken.")
        ->type_name("DIR");
    app.add_flag("--blank", options->blank, "Begin with an empty sheet to draw rivers on.");
    app.add_option("--port", options->params.serve.port, "Serve at this port; 0: any free one.")
        ->type_name("N")
        ->capture_default_str();
    app.add_flag("--no-browser", options->no_browser, "Only print the address.");
    app.add_option("--export", options->params.export_folder,
                   "Export below this folder; without it below the document's.")
        ->type_name("DIR");
    app.footer(
        "Serves a page on this machine alone, at an address that no other user or page can guess, and prints it as "
        "one line. Every change on the page is saved in the document at once and can be undone without end; the "
        "terrain follows, coarse first. The finished terrain has the bytes that make gives from the document's "
        "recipe.toml.\n\n"
        "Examples:\n"
        "  thalweg studio\n"
        "  thalweg studio --blank -o out/sheet\n"
        "  thalweg studio samples/dla.toml -o out/cluster --no-browser\n"
        "  thalweg studio samples/walker_nhdplus.gpkg\n"
        "  thalweg studio samples/jacksboro_utm16.tif\n");
    return [options, &session] { return run_studio(*options, session); };
}

} // namespace thalweg::tools
