// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The program that users call as `thalweg`: it prepares the process and replaces itself with the main program, whose
// libraries take the linker longer to load than a script takes to send a signal. It needs only the C library.
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

/// Blocks signals until the program can end in order.
void hold_signals() {
    sigset_t signals;
    sigemptyset(&signals);
    for (int const number : {SIGINT, SIGTERM, SIGHUP}) {
        sigaddset(&signals, number);
    }
    sigprocmask(SIG_BLOCK, &signals, nullptr);
}

/// A failed write is then an error of the call, not the end of the process.
void ignore_signals_of_writing() {
    std::signal(SIGXFSZ, SIG_IGN);
    std::signal(SIGPIPE, SIG_IGN);
}

/// Otherwise the next opened file would get a closed stream's number. Writing to a closed standard output remains an
/// error; writes to standard error are dropped.
void open_closed_streams() {
    constexpr std::array modes{O_RDONLY, O_RDONLY, O_WRONLY};
    for (int stream = 0; stream < static_cast<int>(modes.size()); ++stream) {
        if (fcntl(stream, F_GETFD) == -1 && errno == EBADF) {
            open("/dev/null", modes[static_cast<std::size_t>(stream)]); // uses the lowest free number
        }
    }
}

using Path = std::array<char, 4096>;

/// The path of this file, without links; "": unknown.
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

/// Replaces this file's path by the main program's, which is relative to this file's folder.
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
