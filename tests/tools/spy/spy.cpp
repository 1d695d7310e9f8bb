// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Loaded before the C library (LD_PRELOAD). SPY_LOG=FILE: writes a line for each fsync and rename, in order.
// SPY_MEMORY=N: from the N-th allocation after the program handles signals on, every allocation fails. SPY_ONE=N: that
// one alone. SPY_IO=N: the N-th call that opens, reads, writes, renames or flushes a file after then fails (EIO).
// SPY_COUNT=FILE: leaves the numbers of allocations and of these calls there.
#include <atomic>
#include <cerrno>
#include <cstdarg>
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
std::atomic<long> one{-1};
std::atomic<long> calls{0};
std::atomic<long> failing_call{-1};
std::atomic<bool> counts{false};

bool refused() {
    if (!counts.load(std::memory_order_relaxed)) {
        return false;
    }
    long const number = ++allocations;
    if (number != one && (most < 0 || number <= most)) {
        return false;
    }
    errno = ENOMEM;
    return true;
}

/// Whether this call of the system fails.
bool breaks() {
    if (!counts.load(std::memory_order_relaxed)) {
        return false;
    }
    if (++calls != failing_call) {
        return false;
    }
    errno = EIO;
    return true;
}

/// Likewise, and marks the stream, as the C library does.
bool fails(FILE* file) {
    constexpr int error_seen = 0x20; // _IO_ERR_SEEN of glibc
    bool const is_broken = breaks();
    if (is_broken && file != nullptr) {
        file->_flags |= error_seen;
    }
    return is_broken;
}

long number_in(char const* name) {
    char const* const text = std::getenv(name);
    return text == nullptr ? -1 : std::atol(text);
}

template <class Call> Call next(char const* name) {
    return reinterpret_cast<Call>(dlsym(RTLD_NEXT, name));
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
        most = number_in("SPY_MEMORY");
        one = number_in("SPY_ONE");
        failing_call = number_in("SPY_IO");
        counts = true;
    }
    return real(number, action, before);
}

FILE* fopen(char const* path, char const* mode) {
    static auto const real = next<FILE* (*)(char const*, char const*)>("fopen");
    return breaks() ? nullptr : real(path, mode);
}
FILE* fopen64(char const* path, char const* mode) {
    static auto const real = next<FILE* (*)(char const*, char const*)>("fopen64");
    return breaks() ? nullptr : real(path, mode);
}
size_t fread(void* to, size_t size, size_t count, FILE* file) {
    static auto const real = next<size_t (*)(void*, size_t, size_t, FILE*)>("fread");
    return fails(file) ? 0 : real(to, size, count, file);
}
size_t fwrite(void const* from, size_t size, size_t count, FILE* file) {
    static auto const real = next<size_t (*)(void const*, size_t, size_t, FILE*)>("fwrite");
    return fails(file) ? 0 : real(from, size, count, file);
}
int fflush(FILE* file) {
    static auto const real = next<int (*)(FILE*)>("fflush");
    return fails(file) ? EOF : real(file);
}
ssize_t read(int file, void* to, size_t count) {
    static auto const real = next<ssize_t (*)(int, void*, size_t)>("read");
    return breaks() ? -1 : real(file, to, count);
}
ssize_t write(int file, void const* from, size_t count) {
    static auto const real = next<ssize_t (*)(int, void const*, size_t)>("write");
    return breaks() ? -1 : real(file, from, count);
}
int open(char const* path, int flags, ...) {
    va_list rest;
    va_start(rest, flags);
    mode_t const mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(rest, mode_t) : 0;
    va_end(rest);
    return breaks() ? -1 : openat(AT_FDCWD, path, flags, mode);
}
int open64(char const* path, int flags, ...) {
    va_list rest;
    va_start(rest, flags);
    mode_t const mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(rest, mode_t) : 0;
    va_end(rest);
    return breaks() ? -1 : openat(AT_FDCWD, path, flags, mode);
}

int fsync(int file) {
    if (breaks()) {
        return -1;
    }
    char line[8300] = "fsync ";
    char place[64];
    std::snprintf(place, sizeof place, "/proc/self/fd/%d", file);
    ssize_t const length = readlink(place, line + 6, 4096);
    std::strcpy(line + 6 + (length > 0 ? length : 0), "\n");
    note(line);
    return static_cast<int>(syscall(SYS_fsync, file));
}

int rename(char const* from, char const* to) {
    if (breaks()) {
        return -1;
    }
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
        counts = false;
        char text[64];
        int const length = std::snprintf(text, sizeof text, "%ld %ld", allocations.load(), calls.load());
        int const out = open(file, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
        [[maybe_unused]] auto const written = write(out, text, static_cast<size_t>(length));
        close(out);
    }
};
AtEnd const at_end;

} // namespace
