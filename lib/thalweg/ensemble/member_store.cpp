// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/ensemble/internal/member_store.hpp>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <thalweg/core/append.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/files/tar.hpp>
#include <thalweg/io/raster/heightmap.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/make/river_claims.hpp>
#include <thalweg/recipe/recipe_files.hpp>
#include <thalweg/report/report.hpp>

namespace thalweg::ensemble {

namespace {

namespace fs = std::filesystem;

constexpr std::int64_t largest_input = std::int64_t{1} << 40;

[[noreturn]] void fail_at(std::string const& path, int reason) {
    throw IoError("ensemble.make_members", fmt::format("{}: {}", path, std::generic_category().message(reason)));
}

void require_at(std::string const& path, std::error_code error) {
    if (error) {
        fail_at(path, error.value());
    }
}

/// ensemble.json: what decides the members beside the recipe.
std::string description_of(Ensemble const& ensemble, std::vector<std::string> const& vary, MemberFiles const& files) {
    nlohmann::ordered_json json{{"version", report::version()}, {"seed", ensemble.recipe.seed}, {"vary", vary}};
    json["members_a_shard"] = files.members_a_shard;
    if (files.members_a_shard > 0) {
        json["members"] = ensemble.members;
    }
    json["files"] = files.folders ? "folders" : files.members_a_shard > 0 ? "shards" : "none";
    return json.dump(2) + "\n";
}

/// The lines by which two texts of keys differ: the first of the second.
std::string first_difference(std::string const& there, std::string const& here) {
    std::size_t begin = 0;
    for (std::size_t i = 0; i < std::min(there.size(), here.size()) && there[i] == here[i]; ++i) {
        begin = there[i] == '\n' ? i + 1 : begin;
    }
    std::string line = there.substr(begin, there.find('\n', begin) - begin);
    line.erase(0, line.find_first_not_of(" \t"));
    return line.substr(0, 100);
}

/// A lock of the system that ends with the process. File systems without locks have none.
enum class Locked : std::uint8_t { yes, no, unknown };

/// An open file.
class OpenFile {
public:
    explicit OpenFile(int file) : file_(file) {}
    ~OpenFile() {
        if (file_ >= 0) {
            close(file_);
        }
    }
    OpenFile(OpenFile const&) = delete;
    OpenFile& operator=(OpenFile const&) = delete;

    int get() const { return file_; }
    int release() { return std::exchange(file_, -1); }

private:
    int file_;
};

Locked lock_now(int file) {
    int done = -1;
    do {
        done = flock(file, LOCK_EX | LOCK_NB);
    } while (done != 0 && errno == EINTR);
    return done == 0 ? Locked::yes : errno == EWOULDBLOCK ? Locked::no : Locked::unknown;
}

/// Whether a path still leads to an open file.
bool is_still_at(std::string const& path, int file) {
    struct stat opened {};
    struct stat there {};
    return fstat(file, &opened) == 0 && lstat(path.c_str(), &there) == 0 && opened.st_ino == there.st_ino &&
           opened.st_dev == there.st_dev;
}

std::string host_name() {
    std::array<char, 256> name{};
    gethostname(name.data(), name.size() - 1);
    return name.data();
}

/// Puts the files of a member into its folder, which lacks some of them; others in it stay.
void mend_folder(fs::path const& folder, fs::path const& made, std::vector<std::string> const& files) {
    std::error_code error;
    for (std::string const& name : files) {
        if (fs::is_regular_file(fs::symlink_status(folder / name, error))) {
            continue; // the same bytes
        }
        fs::create_directories((folder / name).parent_path(), error);
        fs::rename(made / name, folder / name, error);
        require_at((folder / name).string(), error);
    }
}

Raster<float> as_shares(Mask const& mask) {
    Raster<float> shares(mask.grid());
    for (std::int64_t i = 0; i < mask.cells(); ++i) {
        shares[i] = mask[i] != 0 ? 1.0F : 0.0F;
    }
    return shares;
}

/// The number of the member whose file in a shard has this name; -1 for none.
std::int64_t number_of_entry(std::string const& name) {
    std::int64_t number = -1;
    auto const [end, fault] = std::from_chars(name.data(), name.data() + name.size(), number);
    return fault == std::errc() && *end == '.' ? number : -1;
}

} // namespace

std::string member_folder(std::int64_t number) {
    return fmt::format("member_{:05}", number);
}

MemberStore::MemberStore(std::string const& folder, Ensemble ensemble, std::vector<std::string> const& vary,
                         MemberFiles const& files, Role role, Share const& share, Run const& run)
    : folder_(folder), inner_((fs::path(folder) / ".ensemble").string()), ensemble_(std::move(ensemble)), files_(files),
      role_(role) {
    refuse_if<BadParameter>(folder.empty(), "ensemble.make_members", "the name of the folder is empty");
    std::error_code error;
    refuse_if<BadInput>(fs::exists(folder, error) && !fs::is_directory(folder, error), "ensemble.make_members",
                        "{} is not a folder", folder);
    refuse_if<BadInput>(fs::is_symlink(fs::symlink_status(inner_, error)), "ensemble.make_members",
                        "{} is a link: put the folder in its place, or name another folder", inner_);
    // In this order: another first run may begin between the two, and its folder is the first thing in there.
    bool const has_content = fs::exists(folder, error) && !fs::is_empty(folder, error);
    bool const is_known = fs::is_directory(inner_, error) || fs::exists(fs::path(folder) / "ensemble.json", error);
    refuse_if<BadInput>(has_content && !is_known, "ensemble.make_members",
                        "{} already exists and holds no ensemble: name another folder", folder);
    if (role == Role::helper) {
        fs::create_directories(inner_, error);
        require_at(inner_, error);
    } else {
        open_folder(vary, share, run);
    }
    ensemble_.recipe = recipe::read_recipe(io::read_text((fs::path(folder_) / "recipe.toml").string(), largest_input),
                                           "recipe.toml of the ensemble");
    ensemble_.recipe.folder = folder_;
    std::vector<std::string> old;
    for (char const* const name : {"table.csv", "timings.csv"}) {
        if (fs::exists(fs::path(folder_) / name, error)) {
            old.emplace_back(name);
        }
    }
    work_ = std::make_unique<io::OutputFolder>(folder_, io::Existing::add, old);
    for (int again = 0; journal_ < 0; ++again) {
        std::string const path = fmt::format("{}/rows-{}-{}-{}.jsonl", inner_, host_name(), getpid(), again);
        journal_ = open(path.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
        if (journal_ < 0 && errno != EEXIST) {
            fail_at(path, errno);
        }
    }
}

MemberStore::~MemberStore() {
    if (journal_ >= 0) {
        close(journal_);
    }
    for (int const file : locks_) {
        close(file);
    }
}

int MemberStore::locked_at(std::string const& path, bool waits, Run const& run) {
    constexpr std::chrono::milliseconds pause{20};
    for (std::error_code error;; run.check()) {
        fs::create_directories(inner_, error); // another process whose first run failed may have removed it
        require_at(inner_, error);
        OpenFile file(open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0644));
        if (file.get() < 0) {
            refuse_if<BadInput>(errno == ELOOP, "ensemble.make_members", "{} is a link: remove it", path);
            if (errno == ENOENT) {
                continue;
            }
            fail_at(path, errno);
        }
        struct stat found {};
        refuse_if<BadInput>(fstat(file.get(), &found) == 0 && !S_ISREG(found.st_mode), "ensemble.make_members",
                            "{} is a pipe or a device: remove it", path);
        Locked const state = lock_now(file.get());
        if (state == Locked::no) {
            if (!waits) {
                return -1;
            }
            std::this_thread::sleep_for(pause);
        } else if (is_still_at(path, file.get())) { // else it was removed before it was locked
            return file.release();
        }
    }
}

void MemberStore::open_folder(std::vector<std::string> const& vary, Share const& share, Run const& run) {
    // Whoever holds this lock is alone between a folder without an ensemble and one with recipe.toml. Before that
    // nobody holds another lock, so that a first run that fails may remove what it made.
    OpenFile const first([&] {
        try {
            return locked_at(inner_ + "/start.lock", true, run);
        } catch (...) {
            std::error_code error; // each only if it is empty
            fs::remove(inner_, error) && fs::remove(folder_, error);
            throw;
        }
    }());
    if (role_ == Role::alone) {
        keep(locked_at(inner_ + "/run.lock", false, run));
        refuse_if<BadInput>(locks_.empty(), "ensemble.make_members",
                            "another thalweg works in {}: wait for it, stop it, or name another folder", folder_);
    }
    try {
        start(vary, run);
    } catch (...) {
        std::error_code error;
        if (!fs::exists(fs::path(folder_) / "recipe.toml", error)) {
            fs::remove_all(inner_, error);
            fs::remove(folder_, error); // only if nothing else has been put there
        }
        throw;
    }
    if (role_ == Role::share) {
        keep(locked_at(fmt::format("{}/share-{}-of-{}.lock", inner_, share.number, share.of), false, run));
        if (locks_.empty()) {
            findings_.push_back({.kind = "share_in_use",
                                 .text = fmt::format("another thalweg works on share {} of {} in {}: members are made "
                                                     "twice where it has not committed them, and kept once",
                                                     share.number, share.of, folder_)});
        }
    }
}

void MemberStore::keep(int lock) {
    if (lock >= 0) {
        locks_.push_back(lock);
    }
}

void MemberStore::start(std::vector<std::string> const& vary, Run const& run) {
    fs::path const folder(folder_);
    io::OutputFolder out(folder_, io::Existing::add);
    recipe::Recipe const kept = recipe::keep_inputs(ensemble_.recipe, out);
    io::write_text(out.path("recipe.toml"), recipe::write_recipe(kept));
    io::write_text(out.path("ensemble.json"), description_of(ensemble_, vary, files_));
    std::error_code error;
    if (!fs::exists(folder / "recipe.toml", error)) {
        out.commit();
    } else {
        for (std::string const& name : out.files()) {
            std::string const there = fs::exists(folder / name, error)
                                          ? io::read_text((folder / name).string(), largest_input)
                                          : std::string();
            std::string const here = io::read_text(out.path(name), largest_input);
            bool const is_text = !name.starts_with("inputs/");
            refuse_if<BadInput>(there != here, "ensemble.make_members",
                                "{} holds another ensemble: {} differs{}. Name another folder", folder_, name,
                                is_text ? fmt::format(" (there: {})", first_difference(there, here)) : "");
        }
        run.tell("ensemble", fmt::format("goes on in {}", folder_));
    }
}

std::string MemberStore::part(std::int64_t number) const {
    return fmt::format("{}/shard-{:06}/{:08}.part", inner_, shard_of(number), number);
}

std::string MemberStore::shard_path(std::int64_t shard) const {
    return fmt::format("{}/shard-{:06}.tar", folder_, shard);
}

std::int64_t MemberStore::shard_of(std::int64_t number) const {
    return files_.members_a_shard > 0 ? number / files_.members_a_shard : 0;
}

std::pair<std::int64_t, std::int64_t> MemberStore::range_of(Share const& share) const {
    // Shares do not cut through shards.
    std::int64_t const unit = std::max<std::int64_t>(files_.members_a_shard, 1);
    std::int64_t const units = (ensemble_.members + unit - 1) / unit;
    auto const bound = [&](std::int64_t number) {
        return std::min(units * number / share.of * unit, ensemble_.members);
    };
    return {bound(share.number - 1), bound(share.number)};
}

std::int64_t MemberStore::members_of(Share const& share) const {
    auto const [begin, end] = range_of(share);
    return end - begin;
}

void MemberNumbers::add(std::int64_t begin, std::int64_t end) {
    if (begin >= end) {
        return;
    }
    if (!ranges_.empty() && ranges_.back().begin + ranges_.back().count == begin) {
        ranges_.back().count += end - begin;
    } else {
        ranges_.push_back({begin, end - begin, size()});
    }
}

std::int64_t MemberNumbers::operator[](std::int64_t i) const {
    auto const after = std::ranges::upper_bound(ranges_, i, {}, &Range::before);
    Range const& range = *std::prev(after);
    return range.begin + (i - range.before);
}

std::set<std::int64_t> MemberStore::numbers_of_folders(Run const& run) const {
    constexpr std::string_view head = "member_";
    std::set<std::int64_t> numbers;
    std::error_code error;
    for (fs::directory_entry const& entry : fs::directory_iterator(folder_, error)) {
        run.check();
        std::string const name = entry.path().filename().string();
        std::int64_t number = 0;
        if (name.starts_with(head)) {
            std::from_chars(name.data() + head.size(), name.data() + name.size(), number);
        }
        if (name == member_folder(number)) {
            numbers.insert(number);
        }
    }
    require_at(folder_, error);
    return numbers;
}

bool MemberStore::is_in_shard(std::int64_t number) {
    std::int64_t const shard = shard_of(number);
    auto const [at, is_new] = in_shards_.try_emplace(shard);
    if (is_new) {
        for (io::TarEntry const& entry : io::tar_entries(shard_path(shard))) {
            at->second.insert(number_of_entry(entry.name));
        }
    }
    return at->second.contains(number);
}

bool MemberStore::is_done(Journals const& journals, RowPlace const& row) {
    std::error_code error;
    if (row.is_failed) {
        return false;
    }
    if (files_.folders) {
        fs::path const folder = fs::path(folder_) / member_folder(row.member);
        return fs::is_directory(fs::symlink_status(folder, error)) &&
               std::ranges::all_of(journals.files_of(row), [&](std::string const& name) {
                   return fs::is_regular_file(fs::symlink_status(folder / name, error));
               });
    }
    if (files_.members_a_shard == 0 || fs::exists(part(row.member), error)) {
        return true;
    }
    // A shard is packed without the members that failed.
    return fs::exists(shard_path(shard_of(row.member)), error) && (!row.had_failed || is_in_shard(row.member));
}

MemberNumbers MemberStore::missing(Share const& share, Run const& run) {
    Journals const journals(inner_, run);
    auto const [begin, end] = range_of(share);
    if (journals.damaged() > 0) {
        findings_.push_back({.kind = "rows_damaged",
                             .amount = static_cast<double>(journals.damaged()),
                             .text = fmt::format("{} rows in {} are damaged: their members are made again",
                                                 journals.damaged(), inner_)});
    }
    if (role_ == Role::share && files_.folders) {
        without_row_ = numbers_of_folders(run);
        for (RowPlace const& row : journals.rows()) {
            without_row_.erase(row.member);
        }
    }
    MemberNumbers numbers;
    std::int64_t next = begin;
    for (RowPlace const& row : journals.rows()) {
        run.check();
        if (row.member >= begin && row.member < end && is_done(journals, row)) {
            numbers.add(next, row.member);
            next = row.member + 1;
        }
    }
    numbers.add(next, end);
    return numbers;
}

bool MemberStore::made_meanwhile(std::int64_t number) const {
    return role_ == Role::share && has_folder(number) && !without_row_.contains(number);
}

bool MemberStore::has_folder(std::int64_t number) const {
    std::error_code error;
    return files_.folders && fs::exists(fs::path(folder_) / member_folder(number), error);
}

bool MemberStore::is_there(std::int64_t number) const {
    std::error_code error;
    if (files_.folders) {
        return has_folder(number);
    }
    return files_.members_a_shard == 0 || fs::exists(part(number), error) ||
           fs::exists(shard_path(shard_of(number)), error);
}

void MemberStore::append(std::string line) {
    line += '\n';
    std::scoped_lock const hold(guard_);
    // A line that was cut off must stay the last one.
    if (is_broken_) {
        throw IoError("ensemble.make_members", fmt::format("a row of the table could not be written in {}", inner_));
    }
    ssize_t const written = write(journal_, line.data(), line.size());
    if (written != static_cast<ssize_t>(line.size())) {
        is_broken_ = true;
        fail_at(inner_, written < 0 ? errno : ENOSPC);
    }
}

std::string MemberStore::staged_part(MadeMember const& made, std::string const& work, Run const& run) {
    std::string const path = work + "/part";
    std::string const key = fmt::format("{:08}", made.row.member.number);
    std::string entries;
    if (made.made) {
        recipe::OutputRecipe const& output = made.made->recipe.output;
        auto const add = [&](char const* ending, std::string const& file) {
            entries += io::tar_entry(fmt::format("{}.{}", key, ending), io::read_text(file, largest_input));
        };
        if (made.made->terrain.has_surface() && output.has(recipe::OutputFiles::dem)) {
            io::write_dem(made.made->terrain.ground.dem, work + "/dem.tif", run);
            add("dem.tif", work + "/dem.tif");
        }
        if (made.made->recipe.network && output.has(recipe::OutputFiles::network)) {
            io::write_grey_png(as_shares(make::river_mask(made.made->terrain.bed.valley)), work + "/rivers.png", 8,
                               run);
            add("rivers.png", work + "/rivers.png");
        }
        entries += io::tar_entry(key + ".json", row_object(made.row));
    }
    io::write_text(path, entries); // empty for a member that failed: its number is missing in the shard
    return path;
}

void MemberStore::add(MadeMember const& made, double seconds, Run const& run) {
    std::int64_t const number = made.row.member.number;
    std::string work;
    {
        std::scoped_lock const hold(guard_);
        work = fmt::format("{}/{}", work_->staging(), next_work_++);
    }
    std::error_code error;
    fs::create_directory(work, error);
    require_at(work, error);
    Stopwatch const stopwatch;
    MemberWork record;
    fs::path from;
    fs::path to;
    if (files_.members_a_shard > 0) {
        from = staged_part(made, work, run);
        to = part(number);
        fs::create_directories(to.parent_path(), error);
        require_at(to.parent_path().string(), error);
    } else if (files_.folders && made.made) {
        from = fs::path(work) / member_folder(number);
        to = fs::path(folder_) / member_folder(number);
        record.files = report::write_terrain(*made.made, from.string(), io::Existing::refuse, run);
    }
    record.writing_s = stopwatch.time_of("write").wall_s;
    record.seconds = seconds + record.writing_s;
    append(row_json(made.row, record));
    if (!from.empty()) {
        fs::rename(from, to, error); // fails where the member's folder is there
        if (error == std::errc::no_such_file_or_directory && files_.members_a_shard > 0) {
            fs::create_directories(to.parent_path(), error); // another process has packed the shard meanwhile
            fs::rename(from, to, error);
        }
        if (error && !is_there(number)) {
            fail_at(to.string(), error.value());
        }
        if (error && files_.folders) {
            mend_folder(to, from, record.files);
        }
    }
    fs::remove_all(work, error);
    added_ += made.made ? 1 : 0;
}

void MemberStore::pack(std::int64_t shard) {
    std::scoped_lock const one_at_a_time(packing_);
    std::int64_t const begin = shard * files_.members_a_shard;
    std::int64_t const end = std::min(begin + files_.members_a_shard, ensemble_.members);
    if (files_.members_a_shard == 0 || begin >= end) {
        return;
    }
    std::error_code error;
    std::string const path = shard_path(shard);
    bool const is_packed = fs::exists(path, error);
    std::vector<std::int64_t> parts;
    for (std::int64_t number = end - 1; number >= begin; --number) {
        if (fs::exists(part(number), error)) {
            parts.push_back(number);
        } else if (!is_packed) {
            return;
        }
    }
    std::ranges::reverse(parts);
    bool const has_new = std::ranges::any_of(parts, [&](std::int64_t n) { return fs::file_size(part(n), error) > 0; });
    try {
        if (!is_packed || has_new) {
            write_shard(path, is_packed ? io::tar_entries(path) : std::vector<io::TarEntry>{}, parts);
        }
    } catch (BadInput const&) { // another process has packed it meanwhile, and removes the parts
        if (!is_packed && fs::exists(path, error)) {
            return;
        }
        throw;
    }
    for (std::int64_t const number : parts) {
        fs::remove(part(number), error);
    }
    fs::remove(fs::path(part(begin)).parent_path(), error); // only if it is empty
}

void MemberStore::write_shard(std::string const& path, std::vector<io::TarEntry> const& before,
                              std::vector<std::int64_t> const& parts) const {
    io::OutputFile out(path, io::Existing::replace);
    std::ofstream entries(out.staging(), std::ios::binary);
    auto const add = [&](std::string const& bytes) {
        if (!entries.write(bytes.data(), static_cast<std::streamsize>(bytes.size()))) {
            fail_at(path, errno);
        }
    };
    std::ifstream old(path, std::ios::binary);
    auto entry = before.begin();
    auto const add_old = [&](std::int64_t until) {
        for (; entry != before.end() && number_of_entry(entry->name) < until; ++entry) {
            std::string bytes(static_cast<std::size_t>(entry->end - entry->begin), '\0');
            old.seekg(entry->begin);
            refuse_if<IoError>(!old.read(bytes.data(), static_cast<std::streamsize>(bytes.size())),
                               "ensemble.make_members", "{} cannot be read", path);
            add(bytes);
        }
    };
    for (std::int64_t const number : parts) {
        add_old(number);
        std::string const bytes = io::read_text(part(number), largest_input);
        if (!bytes.empty()) { // in place of what was there
            while (entry != before.end() && number_of_entry(entry->name) == number) {
                ++entry;
            }
        }
        add(bytes);
    }
    add_old(std::numeric_limits<std::int64_t>::max());
    add(io::tar_end());
    entries.close();
    if (!entries) {
        fail_at(path, errno);
    }
    out.commit();
}

Journals::Account MemberStore::finish(Run const& run) {
    for (std::int64_t shard = 0; files_.members_a_shard > 0 && shard * files_.members_a_shard < ensemble_.members;
         ++shard) {
        run.check();
        pack(shard);
    }
    Journals const journals(inner_, run);
    Journals::Account account =
        journals.write_tables(ensemble_.members, work_->path("table.csv"), work_->path("timings.csv"), run);
    work_->commit();
    return account;
}

} // namespace thalweg::ensemble
