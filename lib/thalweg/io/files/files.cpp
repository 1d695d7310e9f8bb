// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/files/files.hpp>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/files/internal/durable.hpp>
#include <thalweg/io/files/internal/leftovers.hpp>
#include <thalweg/io/files/internal/new_file.hpp>

namespace thalweg::io {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(std::string const& what, std::error_code reason) {
    throw IoError(fmt::format("{}: {}", what, reason.message()));
}

std::error_code last_error() {
    return {errno, std::generic_category()};
}

void require(std::error_code error, std::string const& what) {
    if (error) {
        fail(what, error);
    }
}

struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

bool is_plain(fs::path const& name) {
    return !name.empty() && name.is_relative() && std::ranges::find(name, fs::path("..")) == name.end();
}

// A file this library may remove: below the folder by its name, reached without a link, and no folder itself.
void require_removable(fs::path const& folder, std::string const& name) {
    if (!is_plain(name)) {
        throw BadInput(
            fmt::format("io.output_folder: '{}' in report.json is not a valid path within {}", name, folder.string()));
    }
    fs::path place = folder;
    fs::path const relative(name);
    std::error_code ignored;
    for (auto part = relative.begin(); part != relative.end(); ++part) {
        place /= *part;
        bool const last = std::next(part) == relative.end();
        fs::file_status const status = fs::symlink_status(place, ignored);
        if (!fs::exists(status)) {
            return;
        }
        if (last ? !fs::is_regular_file(status) : !fs::is_directory(status)) {
            throw BadInput(fmt::format(
                "io.output_folder: {} is no longer the file that an earlier run wrote: move it away", place.string()));
        }
    }
}

std::vector<std::string> files_below(fs::path const& folder) {
    std::vector<std::string> names;
    std::error_code error;
    fs::recursive_directory_iterator entry(folder, error);
    while (!error && entry != fs::recursive_directory_iterator()) {
        if (!entry->is_directory(error)) {
            names.push_back(entry->path().lexically_relative(folder).generic_string());
        }
        entry.increment(error);
    }
    require(error, "io.output_folder: " + folder.string());
    std::ranges::sort(names);
    return names;
}

// Moves that can be taken back.
class Moves {
public:
    Moves() = default;
    Moves(Moves const&) = delete;
    Moves& operator=(Moves const&) = delete;
    ~Moves() {
        std::error_code ignored;
        for (auto move = done_.rbegin(); move != done_.rend(); ++move) {
            fs::rename(move->second, move->first, ignored);
        }
        for (auto folder = made_.rbegin(); folder != made_.rend(); ++folder) {
            fs::remove(*folder, ignored);
        }
    }
    void move(fs::path const& from, fs::path const& to) {
        make(to.parent_path());
        std::error_code error;
        fs::rename(from, to, error);
        require(error, "io.output_folder: " + to.string());
        done_.emplace_back(from, to);
    }
    void keep() {
        done_.clear();
        made_.clear();
    }

private:
    void make(fs::path const& folder) {
        std::error_code error;
        if (fs::is_directory(folder, error)) {
            return;
        }
        make(folder.parent_path());
        fs::create_directory(folder, error);
        require(error, "io.output_folder: " + folder.string());
        made_.push_back(folder);
    }

    std::vector<std::pair<fs::path, fs::path>> done_;
    std::vector<fs::path> made_;
};

} // namespace

OutputFolder::OutputFolder(std::string const& folder, Existing existing, std::vector<std::string> old_files)
    : old_files_(std::move(old_files)), adds_(existing == Existing::add) {
    if (folder.empty()) {
        throw BadParameter("io.output_folder: the name of the folder is empty");
    }
    fs::path place = fs::path(folder).lexically_normal();
    if (!place.has_filename()) {
        place = place.parent_path(); // "out/"
    }
    folder_ = place.string();
    std::error_code error;
    existed_ = fs::exists(place, error);
    if (existed_) {
        if (!fs::is_directory(place, error)) {
            throw BadInput(fmt::format("io.output_folder: {} is not a folder", folder_));
        }
        bool const empty = fs::is_empty(place, error);
        require(error, "io.output_folder: " + folder_);
        if (!empty && existing == Existing::refuse) {
            throw BadInput(
                fmt::format("io.output_folder: {} already exists: name another or use --overwrite", folder_));
        }
        if (!empty && existing == Existing::replace && old_files_.empty()) {
            throw BadInput(
                fmt::format("io.output_folder: {} holds files but no report.json that lists them: nothing in "
                            "it may be replaced, name another folder",
                            folder_));
        }
        for (std::string const& name : old_files_) {
            require_removable(place, name);
        }
    }
    sweep_leftovers(place.parent_path());
    if (existed_) {
        sweep_leftovers(place);
    }
    // In an existing folder, for it may be a mount point whose parent is another file system or not ours to write to.
    std::string const stem = (existed_ ? (place / ".").string() : folder_ + ".") + temporary_mark();
    fs::path missing = existed_ ? fs::path() : fs::absolute(place).parent_path();
    for (; !missing.empty() && !fs::exists(missing, error); missing = missing.parent_path()) {
        made_.insert(made_.begin(), missing.string());
    }
    for (std::string const& made : made_) {
        fs::create_directory(made, error);
        require(error, "io.output_folder: " + made);
    }
    staging_ = stem;
    for (int again = 2; !fs::create_directory(staging_, error); ++again) {
        require(error, "io.output_folder: " + staging_);
        staging_ = fmt::format("{}-{}", stem, again);
    }
}

OutputFolder::~OutputFolder() {
    std::error_code ignored;
    fs::remove_all(staging_, ignored);
    if (!committed_) {
        for (auto made = made_.rbegin(); made != made_.rend(); ++made) {
            fs::remove(*made, ignored); // only when nothing else has come into it
        }
    }
}

std::string OutputFolder::path(std::string const& name) const {
    if (!is_plain(name)) {
        throw BadParameter(fmt::format("io.output_folder: '{}' is not a valid path within {}", name, folder_));
    }
    fs::path const place = fs::path(staging_) / name;
    std::error_code error;
    fs::create_directories(place.parent_path(), error);
    require(error, "io.output_folder: " + place.parent_path().string());
    return place.string();
}

std::vector<std::string> OutputFolder::files() const {
    return files_below(staging_);
}

void OutputFolder::commit() {
    fs::path const folder(folder_);
    std::string const who = "io.output_folder";
    std::error_code error;
    make_all_durable(staging_, who);
    if (!existed_) {
        // rename() would silently replace an empty folder that has come since; one that holds something stops it.
        fs::rename(staging_, folder, error);
        require(error, "io.output_folder: " + folder_);
        committed_ = true;
        make_durable(folder.parent_path(), who);
        return;
    }
    std::vector<std::string> const names = files();
    if (adds_) {
        std::erase_if(old_files_, [&](std::string const& old) { return std::ranges::find(names, old) == names.end(); });
    }
    for (std::string const& name : names) {
        bool const ours = std::ranges::find(old_files_, name) != old_files_.end();
        if (!ours && fs::exists(fs::symlink_status(folder / name, error))) {
            if (adds_) {
                throw BadInput(fmt::format("io.output_folder: {} already exists: name another or use --overwrite",
                                           (folder / name).string()));
            }
            throw BadInput(
                fmt::format("io.output_folder: {} was not written by thalweg and will not be replaced: move it "
                            "away",
                            (folder / name).string()));
        }
    }
    // The old files go aside first, so that every move has an empty place to go to and can be taken back.
    fs::path const aside = fs::path(staging_ + "-old");
    Moves moves;
    for (std::string const& name : old_files_) {
        if (fs::exists(fs::symlink_status(folder / name, error))) {
            moves.move(folder / name, aside / name);
        }
    }
    for (std::string const& name : names) {
        moves.move(fs::path(staging_) / name, folder / name);
    }
    make_durable(folder, who);
    moves.keep();
    committed_ = true;
    fs::remove_all(aside, error);
    for (std::string const& name : old_files_) {
        fs::path const above = (folder / name).parent_path();
        if (above != folder) {
            fs::remove(above, error); // an emptied inputs/; one that holds something stays
        }
    }
}

bool is_pipe_or_device(std::string const& path) {
    std::error_code ignored;
    fs::file_status const status = fs::status(path, ignored);
    return fs::is_fifo(status) || fs::is_socket(status) || fs::is_character_file(status);
}

void refuse_pipe(std::string const& path, std::string const& what) {
    if (is_pipe_or_device(path)) {
        throw BadInput(what + " is a pipe or a device, and inputs are read more than once: write it to a file first");
    }
}

std::string read_text(std::string const& path, std::int64_t max_bytes) {
    std::string const what = "io.read_text: " + path;
    refuse_pipe(path, what);
    std::error_code error;
    if (!fs::exists(path, error)) {
        throw BadInput(what + " does not exist");
    }
    if (fs::is_directory(path, error)) {
        throw BadInput(what + " is a folder");
    }
    File const file(std::fopen(path.c_str(), "rb"));
    if (file == nullptr) {
        fail(what, last_error());
    }
    std::string text;
    std::vector<char> block(std::size_t{1} << 16U);
    while (std::size_t const count = std::fread(block.data(), 1, block.size(), file.get())) {
        text.append(block.data(), count);
        if (static_cast<std::int64_t>(text.size()) > max_bytes) {
            throw BadInput(fmt::format("{} is larger than {} bytes", what, max_bytes));
        }
    }
    if (std::ferror(file.get()) != 0) {
        fail(what, last_error());
    }
    return text;
}

void write_text(std::string const& path, std::string_view text) {
    NewFile file(path, "io.write_text: " + path);
    file.append(text);
    file.close();
}

void copy_file(std::string const& from, std::string const& to) {
    std::error_code error;
    if (!fs::is_regular_file(from, error)) {
        throw BadInput(fmt::format("io.copy_file: {} is not a file", from));
    }
    fs::copy_file(from, to, fs::copy_options::none, error);
    require(error, fmt::format("io.copy_file: {} to {}", from, to));
}

} // namespace thalweg::io
