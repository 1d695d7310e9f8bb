// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/gdal/internal/written_file.hpp>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <map>
#include <mutex>
#include <system_error>
#include <utility>

#include <cpl_vsi.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <thalweg/core/run/error.hpp>

namespace thalweg::io {

struct WrittenFile::State {
    int file = -1; ///< descriptor
    int error = 0; ///< the first errno; 0: none
};

namespace {

using Written = WrittenFile::State;

constexpr char const* written_prefix = "/vsithalweg/";

std::mutex written_guard;

/// The files that GDAL may open, by their names behind the prefix.
std::map<std::string, std::shared_ptr<Written>>& written_files() {
    static std::map<std::string, std::shared_ptr<Written>> open;
    return open;
}

std::shared_ptr<Written> written_named(char const* name) {
    std::scoped_lock const lock(written_guard);
    auto const found = written_files().find(name);
    return found == written_files().end() ? nullptr : found->second;
}

void note_error(Written& state) {
    if (state.error == 0) {
        state.error = errno;
    }
}

/// A file as GDAL has opened it, perhaps more than once.
struct WrittenHandle {
    std::shared_ptr<Written> state;
    off_t at = 0;
    bool at_end = false;
};

std::int64_t size_of_written(Written const& state) {
    struct stat now {};
    return fstat(state.file, &now) == 0 ? now.st_size : 0;
}

/// What GDAL calls.
struct WrittenCalls {
    static int stat_named(void* /*data*/, char const* name, VSIStatBufL* status, int /*flags*/) {
        auto const state = written_named(name);
        if (state == nullptr) {
            return -1;
        }
        std::memset(status, 0, sizeof(*status));
        status->st_mode = S_IFREG;
        status->st_size = size_of_written(*state);
        return 0;
    }

    static void* open_named(void* /*data*/, char const* name, char const* access) {
        auto state = written_named(name);
        if (state == nullptr) {
            errno = ENOENT;
            return nullptr;
        }
        if (access[0] == 'w' && ftruncate(state->file, 0) != 0) {
            note_error(*state);
            return nullptr;
        }
        return new WrittenHandle{std::move(state)};
    }

    static vsi_l_offset tell(void* file) { return static_cast<vsi_l_offset>(static_cast<WrittenHandle*>(file)->at); }

    static int seek(void* file, vsi_l_offset offset, int whence) {
        auto& handle = *static_cast<WrittenHandle*>(file);
        std::int64_t const from = whence == SEEK_CUR   ? handle.at
                                  : whence == SEEK_END ? size_of_written(*handle.state)
                                                       : 0;
        handle.at = from + static_cast<off_t>(offset);
        handle.at_end = false;
        return 0;
    }

    static std::size_t read(void* file, void* to, std::size_t size, std::size_t count) {
        auto& handle = *static_cast<WrittenHandle*>(file);
        std::size_t const all = size * count;
        std::size_t done = 0;
        while (done < all) {
            ssize_t const n = pread(handle.state->file, static_cast<char*>(to) + done, all - done, handle.at);
            if (n <= 0 && !(n < 0 && errno == EINTR)) {
                handle.at_end = n == 0;
                break;
            }
            done += static_cast<std::size_t>(std::max<ssize_t>(n, 0));
            handle.at += std::max<ssize_t>(n, 0);
        }
        return size == 0 ? 0 : done / size;
    }

    static std::size_t write(void* file, void const* from, std::size_t size, std::size_t count) {
        auto& handle = *static_cast<WrittenHandle*>(file);
        std::size_t const all = size * count;
        std::size_t done = 0;
        while (done < all) {
            ssize_t const n = pwrite(handle.state->file, static_cast<char const*>(from) + done, all - done, handle.at);
            if (n < 0 && errno != EINTR) {
                note_error(*handle.state);
                break;
            }
            done += static_cast<std::size_t>(std::max<ssize_t>(n, 0));
            handle.at += std::max<ssize_t>(n, 0);
        }
        return size == 0 ? 0 : done / size;
    }

    static int is_at_end(void* file) { return static_cast<WrittenHandle*>(file)->at_end ? 1 : 0; }

    static int truncate_to(void* file, vsi_l_offset size) {
        auto& handle = *static_cast<WrittenHandle*>(file);
        if (ftruncate(handle.state->file, static_cast<off_t>(size)) != 0) {
            note_error(*handle.state);
            return -1;
        }
        return 0;
    }

    static int close_handle(void* file) {
        delete static_cast<WrittenHandle*>(file);
        return 0;
    }

    static int keep(void* /*data*/, char const* /*name*/) {
        return 0; // the object removes its file
    }
};

void install_written() {
    [[maybe_unused]] static bool const is_installed = [] {
        VSIFilesystemPluginCallbacksStruct* const calls = VSIAllocFilesystemPluginCallbacksStruct();
        calls->stat = WrittenCalls::stat_named;
        calls->unlink = WrittenCalls::keep;
        calls->open = WrittenCalls::open_named;
        calls->tell = WrittenCalls::tell;
        calls->seek = WrittenCalls::seek;
        calls->read = WrittenCalls::read;
        calls->eof = WrittenCalls::is_at_end;
        calls->write = WrittenCalls::write;
        calls->truncate = WrittenCalls::truncate_to;
        calls->close = WrittenCalls::close_handle;
        VSIInstallPluginHandler(written_prefix, calls);
        VSIFreeFilesystemPluginCallbacksStruct(calls);
        return true;
    }();
}

} // namespace

WrittenFile::WrittenFile(std::string const& path, About about)
    : about_(std::move(about)), path_(path), state_(std::make_shared<State>()) {
    static std::atomic<int> made{0};
    install_written();
    constexpr mode_t everybody = 0666; // less the user's mask
    state_->file = open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, everybody);
    if (state_->file < 0) {
        throw IoError(about_.where, about_.beginning() + std::generic_category().message(errno));
    }
    std::string const name = fmt::format("{}/{}", ++made, std::filesystem::path(path).filename().string());
    name_ = written_prefix + name;
    std::scoped_lock const lock(written_guard);
    written_files()[name] = state_;
}

WrittenFile::~WrittenFile() {
    {
        std::scoped_lock const lock(written_guard);
        written_files().erase(name_.substr(std::strlen(written_prefix)));
    }
    if (!closed_) {
        ::close(state_->file);
        std::error_code ignored;
        std::filesystem::remove(path_, ignored);
    }
}

void WrittenFile::check() const {
    if (state_->error != 0) {
        throw IoError(about_.where, about_.beginning() + std::generic_category().message(state_->error));
    }
}

void WrittenFile::close() {
    check();
    closed_ = true;
    if (::close(state_->file) != 0) {
        int const error = errno;
        std::error_code ignored;
        std::filesystem::remove(path_, ignored);
        throw IoError(about_.where, about_.beginning() + std::generic_category().message(error));
    }
}

} // namespace thalweg::io
