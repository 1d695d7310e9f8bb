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
    return 128 + number; // as shells count
}

} // namespace

extern "C" {
// A handler and not a thread that waits: where no thread can be started a run must end in order, too. Requesting a stop
// from here is one exchange of an atomic without a lock, because nothing in thalweg registers a stop_callback.
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
    action.sa_flags = SA_RESTART; // libraries need not know of it
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
