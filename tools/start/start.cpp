// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What users call as `thalweg`: it prepares the process and becomes the program, whose libraries take the linker longer
// to load than a script takes to send a signal. It needs the C library alone.
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <signal.h>
#include <sys/auxv.h>
#include <unistd.h>

namespace {

/// They wait until the program can end in order.
void hold_signals() {
    sigset_t signals;
    sigemptyset(&signals);
    for (int const number : {SIGINT, SIGTERM, SIGHUP}) {
        sigaddset(&signals, number);
    }
    sigprocmask(SIG_BLOCK, &signals, nullptr);
}

/// What cannot be written is then an error of the call that writes, not the end of the process.
void ignore_signals_of_writing() {
    std::signal(SIGXFSZ, SIG_IGN);
    std::signal(SIGPIPE, SIG_IGN);
}

/// A closed stream's number would go to the next file that is opened. Writing to a standard output that was closed
/// stays an error; what goes to standard error is dropped.
void open_closed_streams() {
    constexpr std::array modes{O_RDONLY, O_RDONLY, O_WRONLY};
    for (int stream = 0; stream < static_cast<int>(modes.size()); ++stream) {
        if (fcntl(stream, F_GETFD) == -1 && errno == EBADF) {
            open("/dev/null", modes[static_cast<std::size_t>(stream)]); // takes the lowest number that is free
        }
    }
}

using Path = std::array<char, 4096>;

/// The path of this file, without links; "" where the system does not tell.
void find_this_file(Path& path) {
    ssize_t const length = readlink("/proc/self/exe", path.data(), path.size() - 1);
    path[length > 0 ? static_cast<std::size_t>(length) : 0] = '\0';
    // NOLINTNEXTLINE(performance-no-int-to-ptr): the C library gives the address as a number
    auto const* const called = reinterpret_cast<char const*>(getauxval(AT_EXECFN));
    if (length > 0 || called == nullptr) {
        return;
    }
    if (char* const real = realpath(called, nullptr); real != nullptr && std::strlen(real) < path.size()) {
        std::strcpy(path.data(), real);
    }
}

/// Puts the program's path, which is relative to this file's folder, in place of this file's.
bool turn_to_program(Path& path) {
    char* const slash = std::strrchr(path.data(), '/');
    if (slash == nullptr) {
        return false;
    }
    auto const folder = static_cast<std::size_t>(slash + 1 - path.data());
    if (folder + sizeof THALWEG_PROGRAM > path.size()) {
        return false;
    }
    std::memcpy(path.data() + folder, THALWEG_PROGRAM, sizeof THALWEG_PROGRAM);
    return true;
}

} // namespace

int main(int, char** words) {
    hold_signals();
    ignore_signals_of_writing();
    open_closed_streams();
    Path path{};
    find_this_file(path);
    if (turn_to_program(path)) {
        execv(path.data(), words);
    }
    constexpr char text[] =
        "error: the program " THALWEG_PROGRAM " is missing beside this one: install thalweg again\n";
    [[maybe_unused]] auto const written = write(STDERR_FILENO, text, sizeof text - 1);
    return 1;
}
