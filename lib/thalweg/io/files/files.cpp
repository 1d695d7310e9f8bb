// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/files/files.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h> // NOLINT(modernize-deprecated-headers): kill is of POSIX
#include <unistd.h>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/files/internal/files.hpp>

namespace thalweg::io {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(About const& about, std::error_code reason) {
    throw IoError(about.where, fmt::format("{}: {}", about.name, reason.message()));
}

std::error_code last_error() {
    return {errno, std::generic_category()};
}

// Flushes a file, or a folder's directory entries, to disk: a rename after that never leads to a file truncated by a
// power failure.
void make_durable(fs::path const& place, std::string const& where) {
    int const file = open(place.empty() ? "." : place.c_str(), O_RDONLY | O_CLOEXEC);
    bool const done = file >= 0 && fsync(file) == 0;
    int const reason = errno;
    if (file >= 0) {
        close(file);
    }
    // Some file systems lack fsync, some folders are writable but not readable.
    bool const has_none = reason == EINVAL || reason == ENOTSUP || reason == EROFS;
    std::error_code ignored;
    if (!done && !has_none && !(reason == EACCES && fs::is_directory(place, ignored))) {
        fail({where, place.empty() ? "." : place.string()}, {reason, std::generic_category()});
    }
}

std::vector<fs::path> all_below(fs::path const& folder, std::string const& where) {
    std::vector<fs::path> found;
    std::error_code error;
    fs::recursive_directory_iterator entry(folder, error);
    while (!error && entry != fs::recursive_directory_iterator()) {
        found.push_back(entry->path());
        entry.increment(error);
    }
    if (error) {
        fail({where, folder.string()}, error);
    }
    return found;
}

// The same for every file and folder below a folder, and for the folder. Each waits for the disk, whatever its size,
// and those that wait together are served together.
void make_all_durable(fs::path const& folder, std::string const& where) {
    constexpr std::size_t most_threads = 8; // they only wait
    std::vector<fs::path> const places = all_below(folder, where);
    std::atomic<std::size_t> next = 0;
    std::mutex guard;
    std::exception_ptr failure;
    auto const work = [&] {
        try {
            for (std::size_t i = next++; i < places.size(); i = next++) {
                make_durable(places[i], where);
            }
        } catch (...) {
            std::scoped_lock const lock(guard);
            failure = std::current_exception();
        }
    };
    {
        std::vector<std::jthread> others;
        try {
            while (others.size() + 1 < std::min(places.size(), most_threads)) {
                others.emplace_back(work);
            }
        } catch (std::system_error const&) { // no more threads for this process
        }
        work();
    }
    if (failure) {
        std::rethrow_exception(failure);
    }
    make_durable(folder, where);
}

// A process id is meaningless on another host that sees the same folder.
std::string mark_of_host() {
    std::array<char, 256> name{};
    gethostname(name.data(), name.size() - 1);
    return fmt::format("thalweg-tmp-{}-", name.data());
}

// A process that was killed and whose end its parent has not asked for (in a container, maybe never) still has its id.
bool is_dead(pid_t process) {
    if (kill(process, 0) == -1) {
        return errno == ESRCH;
    }
    std::ifstream stat(fmt::format("/proc/{}/stat", process));
    std::string words;
    std::getline(stat, words);
    std::size_t const state = words.rfind(") "); // the name before it may hold anything
    return state != std::string::npos && words.substr(state + 2, 1) == "Z";
}

bool is_of_dead_process(std::string const& name, std::string const& mark) {
    std::size_t const at = name.find(mark);
    if (at == std::string::npos) {
        return false;
    }
    pid_t process = 0;
    char const* const begin = name.data() + at + mark.size();
    auto const [end, fault] = std::from_chars(begin, name.data() + name.size(), process);
    bool const ends = fault == std::errc() && (end == name.data() + name.size() || *end == '-');
    return ends && process > 0 && is_dead(process);
}

bool holds_old_files(fs::path const& place) {
    std::error_code ignored;
    return place.string().ends_with("-old") || fs::exists(place.string() + "-old", ignored);
}

// The part common to all temporary names of this process: "thalweg-tmp-HOST-PID".
std::string temporary_mark() {
    return fmt::format("{}{}", mark_of_host(), getpid());
}

// Removes temporary files and folders that killed processes of this host left in a folder. If one died while it moved
// old files aside, everything stays: NAME-old beside NAME holds the user's files. Failures are ignored.
void remove_stale_temporaries(fs::path const& folder) noexcept {
    try {
        std::string const mark = mark_of_host();
        std::vector<fs::path> dead;
        for (fs::directory_entry const& entry : fs::directory_iterator(folder.empty() ? fs::path(".") : folder)) {
            if (is_of_dead_process(entry.path().filename().string(), mark) && !holds_old_files(entry.path())) {
                dead.push_back(entry.path());
            }
        }
        for (fs::path const& place : dead) {
            std::error_code ignored;
            fs::remove_all(place, ignored);
        }
    } catch (std::exception const&) { // an unreadable folder, or no memory: the next run tries again
    }
}

void require(std::error_code error, About const& about) {
    if (error) {
        fail(about, error);
    }
}

struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

bool is_plain(fs::path const& name) {
    return !name.empty() && name.is_relative() && std::ranges::find(name, fs::path("..")) == name.end();
}

// Checks that this library may remove a file: its name is below the folder, no link leads to it, and it is not a
// folder.
void require_removable(fs::path const& folder, std::string const& name) {
    if (!is_plain(name)) {
        throw BadInput(
            "io.OutputFolder",
            fmt::format("'{}' in the list of an earlier run is not a valid path within {}", name, folder.string()));
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
            throw BadInput(
                "io.OutputFolder",
                fmt::format("{} is no longer the file that an earlier run wrote: move it away", place.string()));
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
    require(error, {"io.OutputFolder", folder.string()});
    std::ranges::sort(names);
    return names;
}

// Moves that can be undone.
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
        require(error, {"io.OutputFolder", to.string()});
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
        require(error, {"io.OutputFolder", folder.string()});
        made_.push_back(folder);
    }

    std::vector<std::pair<fs::path, fs::path>> done_;
    std::vector<fs::path> made_;
};

} // namespace

std::string lower_extension(std::string const& path) {
    std::string extension = fs::path(path).extension().string();
    std::ranges::transform(extension, extension.begin(),
                           [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    return extension;
}

std::string simple_name(std::string_view name) {
    std::string out;
    for (char const c : name) {
        char const lower = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
        if ((lower >= 'a' && lower <= 'z') || (lower >= '0' && lower <= '9')) {
            out += lower;
        }
    }
    return out;
}

NewFile::NewFile(std::string const& path, About about)
    : about_(std::move(about)), file_(std::fopen(path.c_str(), "wbx")) {
    if (file_ == nullptr) {
        fail(about_, last_error());
    }
}

void NewFile::append(std::string_view bytes) {
    if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size()) {
        fail(about_, last_error());
    }
}

void NewFile::close() {
    if (std::fclose(file_.release()) != 0) {
        fail(about_, last_error());
    }
}

OutputFolder::OutputFolder(std::string const& folder, Existing existing, std::vector<std::string> old_files)
    : old_files_(std::move(old_files)), adds_(existing == Existing::add) {
    refuse_if<BadParameter>(folder.empty(), "io.OutputFolder", "the name of the folder is empty");
    fs::path place = fs::path(folder).lexically_normal();
    if (!place.has_filename()) {
        place = place.parent_path(); // "out/"
    }
    folder_ = place.string();
    std::error_code error;
    existed_ = fs::exists(place, error);
    if (existed_) {
        refuse_if<BadInput>(!fs::is_directory(place, error), "io.OutputFolder", "{} is not a folder", folder_);
        bool const empty = fs::is_empty(place, error);
        require(error, {"io.OutputFolder", folder_});
        refuse_if<BadInput>(!empty && existing == Existing::refuse, "io.OutputFolder",
                            "{} already exists: name another or use --overwrite", folder_);
        refuse_if<BadInput>(!empty && existing == Existing::replace && old_files_.empty(), "io.OutputFolder",
                            "{} holds files but no report.json or export.json that lists them: nothing in it may be "
                            "replaced, name another folder",
                            folder_);
        for (std::string const& name : old_files_) {
            require_removable(place, name);
        }
    }
    remove_stale_temporaries(place.parent_path());
    if (existed_) {
        remove_stale_temporaries(place);
    }
    // Inside an existing folder, which may be a mount point whose parent is another file system or not writable.
    std::string const stem = (existed_ ? (place / ".").string() : folder_ + ".") + temporary_mark();
    fs::path missing = existed_ ? fs::path() : fs::absolute(place).parent_path();
    for (; !missing.empty() && !fs::exists(missing, error); missing = missing.parent_path()) {
        made_.insert(made_.begin(), missing.string());
    }
    for (std::string const& made : made_) {
        fs::create_directory(made, error);
        require(error, {"io.OutputFolder", made});
    }
    staging_ = stem;
    for (int again = 2; !fs::create_directory(staging_, error); ++again) {
        require(error, {"io.OutputFolder", staging_});
        staging_ = fmt::format("{}-{}", stem, again);
    }
}

OutputFolder::~OutputFolder() {
    std::error_code ignored;
    fs::remove_all(staging_, ignored);
    if (!committed_) {
        for (auto made = made_.rbegin(); made != made_.rend(); ++made) {
            fs::remove(*made, ignored); // only if nothing else has been put there
        }
    }
}

std::string OutputFolder::path(std::string const& name) const {
    refuse_if<BadParameter>(!is_plain(name), "io.OutputFolder", "'{}' is not a valid path within {}", name, folder_);
    fs::path const place = fs::path(staging_) / name;
    std::error_code error;
    fs::create_directories(place.parent_path(), error);
    require(error, {"io.OutputFolder", place.parent_path().string()});
    return place.string();
}

std::vector<std::string> OutputFolder::files() const {
    return files_below(staging_);
}

void OutputFolder::commit() {
    fs::path const folder(folder_);
    std::string const where = "io.OutputFolder";
    std::error_code error;
    make_all_durable(staging_, where);
    if (!existed_) {
        // rename() would silently replace an empty folder created in the meantime; one with content stops it.
        fs::rename(staging_, folder, error);
        require(error, {"io.OutputFolder", folder_});
        committed_ = true;
        make_durable(folder.parent_path(), where);
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
                throw BadInput("io.OutputFolder", fmt::format("{} already exists: name another or use --overwrite",
                                                              (folder / name).string()));
            }
            throw BadInput("io.OutputFolder",
                           fmt::format("{} was not written by thalweg and will not be replaced: move it away",
                                       (folder / name).string()));
        }
    }
    // The old files are moved aside first, so that every move has a free target and can be undone.
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
    make_durable(folder, where);
    moves.keep();
    committed_ = true;
    fs::remove_all(aside, error);
    for (std::string const& name : old_files_) { // folders that became empty, such as inputs/; those with content stay
        for (fs::path above = (folder / name).parent_path(); above != folder && fs::remove(above, error);) {
            above = above.parent_path();
        }
    }
}

std::vector<std::string> files_there(std::string const& folder, std::vector<std::string> const& names,
                                     Existing existing) {
    std::vector<std::string> there;
    for (std::string const& name : names) {
        if (fs::exists(fs::symlink_status(fs::path(folder) / name))) {
            there.push_back(name);
        }
    }
    if (!there.empty() && existing == Existing::refuse) {
        throw BadInput("io.files_there", fmt::format("{} already exists: name another or use --overwrite",
                                                     (fs::path(folder) / there.front()).string()));
    }
    return there;
}

bool is_pipe_or_device(std::string const& path) {
    std::error_code ignored;
    fs::file_status const status = fs::status(path, ignored);
    return fs::is_fifo(status) || fs::is_socket(status) || fs::is_character_file(status);
}

void refuse_pipe(std::string const& path, About const& about) {
    refuse_if<BadInput>(is_pipe_or_device(path), about.where,
                        "{} is a pipe or a device, and inputs are read more than once: write it to a file first",
                        about.name);
}

std::string read_text(std::string const& path, std::int64_t max_bytes) {
    About const about{"io.read_text", path};
    refuse_pipe(path, about);
    std::error_code error;
    refuse_if<BadInput>(!fs::exists(path, error), about.where, "{} does not exist", about.name);
    refuse_if<BadInput>(fs::is_directory(path, error), about.where, "{} is a folder", about.name);
    File const file(std::fopen(path.c_str(), "rb"));
    if (file == nullptr) {
        fail(about, last_error());
    }
    std::string text;
    std::vector<char> block(std::size_t{1} << 16U);
    while (std::size_t const count = std::fread(block.data(), 1, block.size(), file.get())) {
        text.append(block.data(), count);
        refuse_if<BadInput>(static_cast<std::int64_t>(text.size()) > max_bytes, about.where,
                            "{} is larger than {} bytes", about.name, max_bytes);
    }
    if (std::ferror(file.get()) != 0) {
        fail(about, last_error());
    }
    return text;
}

void write_text(std::string const& path, std::string_view text) {
    NewFile file(path, {"io.write_text", path});
    file.append(text);
    file.close();
}

void copy_file(std::string const& from, std::string const& to) {
    std::error_code error;
    refuse_if<BadInput>(!fs::is_regular_file(from, error), "io.copy_file", "{} is not a file", from);
    fs::copy_file(from, to, fs::copy_options::none, error);
    require(error, {"io.copy_file", fmt::format("{} to {}", from, to)});
}

OutputFile::OutputFile(std::string const& path, Existing existing) : path_(path), existing_(existing) {
    refuse_if<BadParameter>(!fs::path(path).has_filename(), "io.OutputFile", "'{}' is not a valid file name", path);
    fs::path const folder = fs::path(path).parent_path();
    std::error_code ignored;
    if (!folder.empty() && !fs::is_directory(folder, ignored)) {
        throw BadInput("io.OutputFile", fmt::format("there is no folder {} for {}", folder.string(), path));
    }
    require_place();
    remove_stale_temporaries(folder);
    staging_ = (folder / fmt::format(".{}-{}", temporary_mark(), fs::path(path).filename().string())).string();
    fs::remove(staging_, ignored); // of an earlier process with the same id
}

OutputFile::~OutputFile() {
    std::error_code ignored;
    fs::remove(staging_, ignored);
}

void OutputFile::require_place() const {
    std::error_code ignored;
    auto const status = fs::symlink_status(path_, ignored);
    if (!fs::exists(status)) {
        return;
    }
    refuse_if<BadInput>(!fs::is_regular_file(status), "io.OutputFile",
                        "{} exists and is not a regular file: name another", path_);
    refuse_if<BadInput>(existing_ == Existing::refuse, "io.OutputFile",
                        "{} already exists: name another or use --overwrite", path_);
}

void OutputFile::commit() {
    require_place(); // something may have been created in the meantime
    make_durable(staging_, "io.OutputFile");
    std::error_code error;
    fs::rename(staging_, path_, error);
    if (error) {
        throw IoError("io.OutputFile", fmt::format("{}: {}", path_, error.message()));
    }
    make_durable(fs::path(path_).parent_path(), "io.OutputFile");
}

TemporaryFolder::TemporaryFolder(std::string const& name) {
    char const* const wanted = std::getenv("TMPDIR");
    std::string const set = wanted == nullptr ? "" : wanted;
    std::error_code failed;
    fs::path const above = fs::temp_directory_path(failed);
    if (failed) {
        throw IoError(
            "io.TemporaryFolder",
            fmt::format(
                "the folder for temporary files{} does not exist or is not a folder: set TMPDIR to one that does",
                set.empty() ? "" : fmt::format(", TMPDIR={},", set)));
    }
    remove_stale_temporaries(above);
    std::string folder = (above / fmt::format("{}-{}-XXXXXX", name, temporary_mark())).string();
    if (mkdtemp(folder.data()) == nullptr) {
        throw IoError("io.TemporaryFolder",
                      fmt::format("no folder for temporary files can be made in {}: {}; set TMPDIR to another folder",
                                  above.string(), std::generic_category().message(errno)));
    }
    path_ = folder;
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
}

} // namespace thalweg::io
