// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Loaded before the C library (LD_PRELOAD). SPY_LOG=FILE: writes a line for each fsync and rename, in order.
// SPY_MEMORY=N: from the N-th allocation after the program handles signals on, every allocation fails. SPY_COUNT=FILE:
// leaves the number of allocations there.
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/syscall.h>
#include <unistd.h>

extern "C" {
void* __libc_malloc(size_t bytes);
void* __libc_calloc(size_t count, size_t bytes);
void* __libc_realloc(void* old, size_t bytes);
void* __libc_memalign(size_t alignment, size_t bytes);
}

namespace {

std::atomic<long> allocations{0};
std::atomic<long> most{-1};
std::atomic<bool> counts{false};

bool refused() {
    if (!counts.load(std::memory_order_relaxed)) {
        return false;
    }
    long const number = ++allocations;
    if (most < 0 || number <= most) {
        return false;
    }
    errno = ENOMEM;
    return true;
}

void note(char const* text) {
    char const* const file = std::getenv("SPY_LOG");
    if (file == nullptr) {
        return;
    }
    int const log = open(file, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
    if (log >= 0) {
        [[maybe_unused]] auto const written = write(log, text, std::strlen(text));
        close(log);
    }
}

} // namespace

extern "C" {

void* malloc(size_t bytes) {
    return refused() ? nullptr : __libc_malloc(bytes);
}
void* calloc(size_t count, size_t bytes) {
    return refused() ? nullptr : __libc_calloc(count, bytes);
}
void* realloc(void* old, size_t bytes) {
    return refused() ? nullptr : __libc_realloc(old, bytes);
}
void* memalign(size_t alignment, size_t bytes) {
    return refused() ? nullptr : __libc_memalign(alignment, bytes);
}
void* aligned_alloc(size_t alignment, size_t bytes) {
    return refused() ? nullptr : __libc_memalign(alignment, bytes);
}
int posix_memalign(void** memory, size_t alignment, size_t bytes) {
    void* const taken = refused() ? nullptr : __libc_memalign(alignment, bytes);
    if (taken == nullptr) {
        return ENOMEM;
    }
    *memory = taken;
    return 0;
}

int sigaction(int number, struct sigaction const* action, struct sigaction* before) {
    using Real = int (*)(int, struct sigaction const*, struct sigaction*);
    static Real const real = reinterpret_cast<Real>(dlsym(RTLD_NEXT, "sigaction"));
    if (number == SIGINT && action != nullptr && action->sa_handler != SIG_DFL && action->sa_handler != SIG_IGN) {
        char const* const limit = std::getenv("SPY_MEMORY");
        most = limit == nullptr ? -1 : std::atol(limit);
        counts = true;
    }
    return real(number, action, before);
}

int fsync(int file) {
    char line[8300] = "fsync ";
    char place[64];
    std::snprintf(place, sizeof place, "/proc/self/fd/%d", file);
    ssize_t const length = readlink(place, line + 6, 4096);
    std::strcpy(line + 6 + (length > 0 ? length : 0), "\n");
    note(line);
    return static_cast<int>(syscall(SYS_fsync, file));
}

int rename(char const* from, char const* to) {
    char line[8300];
    std::snprintf(line, sizeof line, "rename %.4000s %.4000s\n", from, to);
    note(line);
    return static_cast<int>(syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0));
}
}

namespace {

struct AtEnd {
    ~AtEnd() {
        char const* const file = std::getenv("SPY_COUNT");
        if (file == nullptr || !counts) {
            return;
        }
        char text[32];
        int const length = std::snprintf(text, sizeof text, "%ld", allocations.load());
        int const out = open(file, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
        [[maybe_unused]] auto const written = write(out, text, static_cast<size_t>(length));
        close(out);
    }
};
AtEnd const at_end;

} // namespace
