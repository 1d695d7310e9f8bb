// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/studio/studio.hpp>

#include "commands/commands.hpp"
#include "commands/options.hpp"
#include "terminal/terminal.hpp"

namespace thalweg::tools {

namespace {

struct StudioOptions {
    std::string input;
    std::string folder;
    studio::StudioParams params;
    bool no_browser = false;
    bool blank = false;
    std::string preset;
};

/// A page that leads to an address, readable by this user alone. Command lines are readable by every user of the
/// machine, so the address, which holds the token, must not stand in one. It lies in the document, where a confined
/// browser may read it, as it may not in the system's temporary folder.
class WayIn {
public:
    WayIn(std::string const& folder, std::string const& address)
        : path_((std::filesystem::absolute(folder) / ".studio.html").lexically_normal().string()) {
        unlink(path_.c_str()); // of a process that was killed
        int const file = open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600);
        if (file < 0) {
            return;
        }
        std::string const page = fmt::format(
            "<!doctype html><meta charset=\"utf-8\"><meta name=\"referrer\" content=\"no-referrer\">"
            "<meta http-equiv=\"refresh\" content=\"0; url={0}\"><title>thalweg</title><a href=\"{0}\">thalweg</a>\n",
            address);
        is_there_ = write(file, page.data(), page.size()) == static_cast<ssize_t>(page.size());
        close(file);
    }
    ~WayIn() { unlink(path_.c_str()); }
    WayIn(WayIn const&) = delete;
    WayIn& operator=(WayIn const&) = delete;

    bool is_there() const { return is_there_; }
    std::string const& path() const { return path_; }

private:
    std::string path_;
    bool is_there_ = false;
};

bool has_screen() {
    return std::getenv("DISPLAY") != nullptr || std::getenv("WAYLAND_DISPLAY") != nullptr;
}

/// Opens a page in the user's browser.
/// \return whether it was asked to open
bool open_browser(WayIn const& page) {
    std::string program = "xdg-open";
    std::string word = page.path();
    char* const words[] = {program.data(), word.data(), nullptr};
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    pid_t child = 0;
    int const error = posix_spawnp(&child, program.c_str(), &actions, nullptr, words, environ);
    posix_spawn_file_actions_destroy(&actions);
    if (error == 0) { // it may end at once, or with the browser
        std::thread([child] { waitpid(child, nullptr, 0); }).detach();
    }
    return error == 0;
}

int run_studio(StudioOptions& options, Session const& session) {
    options.params.folder =
        studio::document_for(options.input, options.folder, options.blank, options.preset, session.run);
    options.params.threads = session.run.threads;
    studio::Studio studio(options.params);
    session.run.tell("document", options.params.folder);
    std::string const address = studio.address();
    fmt::print("{}\n", address);
    if (std::fflush(stdout) != 0) { // nobody would find it
        throw IoError(
            "commands.studio",
            "the address cannot be written to standard output: send it to a file or a terminal that takes it");
    }
    std::optional<WayIn> way_in;
    bool opened = false;
    if (!options.no_browser && has_screen()) {
        way_in.emplace(options.params.folder, address);
        opened = way_in->is_there() && open_browser(*way_in);
    }
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
    app.add_option("--preset", options->preset,
                   "Begin with land of this kind: a preset, as for make. The page offers them too.")
        ->check(CLI::IsMember(preset_names()));
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
        "  thalweg studio --preset hills -o out/hilly\n"
        "  thalweg studio samples/dla.toml -o out/cluster --no-browser\n"
        "  thalweg studio samples/walker_nhdplus.gpkg\n"
        "  thalweg studio samples/jacksboro_utm16.tif\n");
    return [options, &session] { return run_studio(*options, session); };
}

} // namespace thalweg::tools
