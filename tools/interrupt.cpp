// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "interrupt.hpp"

#include "terminal.hpp"

#include <unistd.h>

#include <csignal>
#include <thread>

namespace thalweg::tools {

std::stop_token stop_at_interrupt() {
    static std::stop_source source;
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGINT);
    sigaddset(&signals, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    // A thread that waits, not a handler: requesting a stop takes locks.
    std::thread([signals] {
        int number = 0;
        sigwait(&signals, &number);
        source.request_stop();
        sigwait(&signals, &number);
        wipe_last_line();
        _exit(130);
    }).detach();
    return source.get_token();
}

} // namespace thalweg::tools
