// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "terminal/interrupt.hpp"

#include <cerrno>
#include <csignal>
#include <signal.h>
#include <unistd.h>

#include "terminal/terminal.hpp"

namespace thalweg::tools {

namespace {

std::stop_source* source = nullptr;
volatile std::sig_atomic_t signal_seen = 0;

constexpr int status_of(int number) {
    return 128 + number; // as shells do
}

} // namespace

extern "C" {
// A handler, not a waiting thread: a run must end in order even if no thread can be started. Requesting a stop here is
// one lock-free atomic exchange, because nothing in thalweg registers a stop_callback.
static void stop_in_order(int number) {
    if (signal_seen != 0) {
        wipe_last_line();
        _exit(status_of(number));
    }
    int const before = errno;
    signal_seen = number;
    source->request_stop();
    errno = before;
}
}

std::stop_token stop_at_signals() {
    static std::stop_source only;
    source = &only;
    struct sigaction action {};
    action.sa_handler = stop_in_order;
    action.sa_flags = SA_RESTART; // libraries need not handle it
    sigset_t signals;
    sigemptyset(&signals);
    for (int const number : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction before {};
        sigaction(number, nullptr, &before);
        if (number != SIGHUP || before.sa_handler != SIG_IGN) {
            sigaction(number, &action, nullptr);
        }
        sigaddset(&signals, number);
    }
    sigprocmask(SIG_UNBLOCK, &signals, nullptr);
    return only.get_token();
}

int exit_of_signal() {
    return status_of(signal_seen == 0 ? SIGINT : signal_seen);
}

} // namespace thalweg::tools
