// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fstream>
#include <sstream>
#include <string>
#include <sys/types.h>
#include <vector>

/// Grows for many seconds.
inline std::vector<std::string> long_make() {
    return {"make",  "-o",
            "out",   "-q",
            "--set", "network.dla.particles=50000000",
            "--set", "grid.width=4000",
            "--set", "grid.height=4000"};
}

/// What the kernel tells of a process.
inline std::string of_process(pid_t pid, char const* file) {
    std::ifstream in("/proc/" + std::to_string(pid) + "/" + file);
    std::stringstream text;
    text << in.rdbuf();
    return text.str();
}

/// Whether a process has become thalweg and holds or handles a signal, or has ended.
inline bool is_ready_for(pid_t pid, int number) {
    std::string const status = of_process(pid, "status");
    if (status.find("State:\tZ") != std::string::npos) {
        return true;
    }
    if (status.find("Name:\tthalweg\n") == std::string::npos) { // still a copy of the test, whose signals may be held
        return false;
    }
    for (char const* const field : {"SigBlk:\t", "SigCgt:\t"}) {
        std::size_t const at = status.find(field);
        if (at != std::string::npos &&
            (std::stoull(status.substr(at + 8, 16), nullptr, 16) >> (number - 1) & 1U) != 0) {
            return true;
        }
    }
    return false;
}
