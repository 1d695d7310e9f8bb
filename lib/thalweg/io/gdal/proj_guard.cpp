// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/gdal/proj_guard.hpp>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <proj.h>

#include <thalweg/io/gdal/internal/gdal_guard.hpp>

namespace thalweg::io {

namespace fs = std::filesystem;

namespace {

std::vector<std::string> folders_of_proj() {
    std::vector<std::string> folders;
    std::string_view rest = proj_info().searchpath;
    while (!rest.empty()) {
        std::size_t const end = std::min(rest.find(':'), rest.size());
        if (end > 0) {
            folders.push_back((fs::absolute(rest.substr(0, end)) / "").lexically_normal().string());
        }
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    return folders;
}

std::vector<std::string> const& proj_folders() {
    static std::vector<std::string> const folders = folders_of_proj();
    return folders;
}

/// PROJ tries a name without a folder in each of its own and at last in the current one; that this fails is usual.
bool is_of_proj(char const* name) noexcept {
    try {
        std::string const path = fs::absolute(name).lexically_normal().string();
        if (std::ranges::any_of(proj_folders(), [&](std::string const& folder) { return path.starts_with(folder); })) {
            return true;
        }
        if (std::string_view(name).find('/') != std::string_view::npos) {
            refuse_grid(name);
        }
    } catch (std::exception const&) { // must not cross frames of C
    }
    return false;
}

std::FILE* file_of(PROJ_FILE_HANDLE* handle) {
    return reinterpret_cast<std::FILE*>(handle);
}

PROJ_FILE_HANDLE* open_file_of_proj(PJ_CONTEXT*, char const* name, PROJ_OPEN_ACCESS access, void*) {
    bool const may = access == PROJ_OPEN_ACCESS_READ_ONLY && is_of_proj(name);
    return may ? reinterpret_cast<PROJ_FILE_HANDLE*>(std::fopen(name, "rbe")) : nullptr;
}
std::size_t read_file_of_proj(PJ_CONTEXT*, PROJ_FILE_HANDLE* handle, void* to, std::size_t bytes, void*) {
    return std::fread(to, 1, bytes, file_of(handle));
}
std::size_t write_no_file(PJ_CONTEXT*, PROJ_FILE_HANDLE*, void const*, std::size_t, void*) {
    return 0;
}
int seek_file_of_proj(PJ_CONTEXT*, PROJ_FILE_HANDLE* handle, long long offset, int whence, void*) {
    return std::fseek(file_of(handle), static_cast<long>(offset), whence) == 0 ? 1 : 0;
}
unsigned long long tell_file_of_proj(PJ_CONTEXT*, PROJ_FILE_HANDLE* handle, void*) {
    return static_cast<unsigned long long>(std::ftell(file_of(handle)));
}
void close_file_of_proj(PJ_CONTEXT*, PROJ_FILE_HANDLE* handle, void*) {
    std::fclose(file_of(handle));
}
int exists_for_proj(PJ_CONTEXT*, char const* name, void*) {
    std::error_code ignored;
    return is_of_proj(name) && fs::exists(name, ignored) ? 1 : 0;
}
int change_no_file(PJ_CONTEXT*, char const*, void*) {
    return 0;
}
int rename_no_file(PJ_CONTEXT*, char const*, char const*, void*) {
    return 0;
}

constexpr PROJ_FILE_API own_files{1,
                                  open_file_of_proj,
                                  read_file_of_proj,
                                  write_no_file,
                                  seek_file_of_proj,
                                  tell_file_of_proj,
                                  close_file_of_proj,
                                  exists_for_proj,
                                  change_no_file,
                                  change_no_file,
                                  rename_no_file};

} // namespace

void confine_proj(pj_ctx* context) {
    proj_context_set_fileapi(context, &own_files, nullptr);
}

} // namespace thalweg::io
