// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/ensemble/internal/member_store.hpp>

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/files/tar.hpp>
#include <thalweg/io/raster/heightmap.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/pipeline/make/internal/river_claims.hpp>
#include <thalweg/pipeline/plan/internal/plan.hpp>
#include <thalweg/pipeline/recipe/recipe_files.hpp>
#include <thalweg/pipeline/report/report.hpp>

namespace thalweg::pipeline {

namespace {

namespace fs = std::filesystem;

constexpr std::int64_t largest_input = std::int64_t{1} << 40;

[[noreturn]] void fail_at(std::string const& path, int reason) {
    throw IoError(fmt::format("pipeline.member_store: {}: {}", path, std::generic_category().message(reason)));
}

void require_at(std::string const& path, std::error_code error) {
    if (error) {
        fail_at(path, error.value());
    }
}

/// ensemble.json: what decides the members beside the recipe.
std::string description_of(Ensemble const& ensemble, std::vector<std::string> const& vary, MemberFiles const& files) {
    nlohmann::ordered_json json{{"version", version()}, {"seed", ensemble.recipe.seed}, {"vary", vary}};
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

std::pair<int, Locked> locked(std::string const& path, bool waits) {
    int const file = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    if (file < 0) {
        fail_at(path, errno);
    }
    int done = -1;
    do {
        done = flock(file, waits ? LOCK_EX : LOCK_EX | LOCK_NB);
    } while (done != 0 && errno == EINTR);
    return {file, done == 0 ? Locked::yes : errno == EWOULDBLOCK ? Locked::no : Locked::unknown};
}

std::string host_name() {
    std::array<char, 256> name{};
    gethostname(name.data(), name.size() - 1);
    return name.data();
}

Raster<float> as_shares(Mask const& mask) {
    Raster<float> shares(mask.grid());
    for (std::int64_t i = 0; i < mask.cells(); ++i) {
        shares[i] = mask[i] != 0 ? 1.0F : 0.0F;
    }
    return shares;
}

} // namespace

std::string member_folder(std::int64_t number) {
    return fmt::format("member_{:05}", number);
}

MemberStore::MemberStore(std::string const& folder, Ensemble ensemble, std::vector<std::string> const& vary,
                         MemberFiles const& files, Role role, Share const& share, Run const& run)
    : folder_(folder), inner_((fs::path(folder) / ".ensemble").string()), ensemble_(std::move(ensemble)), files_(files),
      role_(role) {
    refuse_if<BadParameter>(folder.empty(), "pipeline.member_store: the name of the folder is empty");
    std::error_code error;
    refuse_if<BadInput>(fs::exists(folder, error) && !fs::is_directory(folder, error),
                        "pipeline.member_store: {} is not a folder", folder);
    bool const is_known = fs::exists(fs::path(folder) / "ensemble.json", error) || fs::is_directory(inner_, error);
    refuse_if<BadInput>(!is_known && fs::exists(folder, error) && !fs::is_empty(folder, error),
                        "pipeline.member_store: {} already exists and holds no ensemble: name another folder", folder);
    fs::create_directories(inner_, error);
    require_at(inner_, error);
    try {
        lock(role, share);
        if (role != Role::helper) {
            start(vary, run);
        }
    } catch (...) {
        if (!fs::exists(fs::path(folder_) / "recipe.toml", error)) {
            fs::remove_all(inner_, error);
            fs::remove(folder_, error); // only if nothing else has been put there
        }
        throw;
    }
    ensemble_.recipe = read_recipe(io::read_text((fs::path(folder_) / "recipe.toml").string(), largest_input),
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

void MemberStore::lock(Role role, Share const& share) {
    if (role == Role::helper) {
        return;
    }
    std::string const name =
        role == Role::alone ? "run.lock" : fmt::format("share-{}-of-{}.lock", share.number, share.of);
    auto const [file, state] = locked(inner_ + "/" + name, false);
    locks_.push_back(file);
    refuse_if<BadInput>(state == Locked::no && role == Role::alone,
                        "pipeline.member_store: another thalweg works in {}: wait for it, stop it, or name another "
                        "folder",
                        folder_);
    if (state == Locked::no) {
        findings_.push_back({.kind = "share_in_use",
                             .text = fmt::format("another thalweg works on share {} of {} in {}: members are made "
                                                 "twice where it has not committed them, and kept once",
                                                 share.number, share.of, folder_)});
    }
}

void MemberStore::start(std::vector<std::string> const& vary, Run const& run) {
    int const only_one = locked(inner_ + "/start.lock", true).first;
    locks_.push_back(only_one);
    fs::path const folder(folder_);
    io::OutputFolder out(folder_, io::Existing::add);
    Recipe const kept = keep_inputs(ensemble_.recipe, out);
    io::write_text(out.path("recipe.toml"), write_recipe(kept));
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
            refuse_if<BadInput>(
                there != here, "pipeline.member_store: {} holds another ensemble: {} differs{}. Name another folder",
                folder_, name, is_text ? fmt::format(" (there: {})", first_difference(there, here)) : "");
        }
        run.tell("ensemble", fmt::format("goes on in {}", folder_));
    }
    flock(only_one, LOCK_UN);
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

std::vector<std::int64_t> MemberStore::missing(Share const& share) {
    Journals const journals(inner_);
    auto const [begin, end] = range_of(share);
    std::vector<std::int64_t> numbers;
    for (std::int64_t number = begin; number < end; ++number) {
        auto const row = journals.rows().find(number);
        std::error_code error;
        bool const is_packed = files_.members_a_shard > 0 && fs::exists(shard_path(shard_of(number)), error);
        bool const is_done =
            row != journals.rows().end() && (is_packed || (!row->second.is_failed && is_there(number)));
        if (!is_done) {
            numbers.push_back(number);
            if (row == journals.rows().end() && has_folder(number)) {
                without_row_.insert(number);
            }
        }
    }
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
        throw IoError(fmt::format("pipeline.member_store: a row of the table could not be written in {}", inner_));
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
        OutputRecipe const& output = made.made->recipe.output;
        auto const add = [&](char const* ending, std::string const& file) {
            entries += io::tar_entry(fmt::format("{}.{}", key, ending), io::read_text(file, largest_input));
        };
        if (made.made->terrain.surface && output.has(OutputFiles::dem)) {
            io::write_dem(made.made->terrain.surface->dem, work + "/dem.tif", run);
            add("dem.tif", work + "/dem.tif");
        }
        if (made.made->recipe.network && output.has(OutputFiles::network)) {
            io::write_grey_png(as_shares(river_mask(made.made->terrain.valley)), work + "/rivers.png", 8, run);
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
        write_terrain(*made.made, from.string(), io::Existing::refuse, run);
    }
    double const writing_s = stopwatch.time_of("write").wall_s;
    append(row_json(made.row, seconds + writing_s, writing_s));
    if (!from.empty()) {
        fs::rename(from, to, error); // fails where another process was faster
        if (error && !is_there(number)) {
            fail_at(to.string(), error.value());
        }
    }
    fs::remove_all(work, error);
}

void MemberStore::pack(std::int64_t shard) {
    std::scoped_lock const one_at_a_time(packing_);
    std::int64_t const begin = shard * files_.members_a_shard;
    std::int64_t const end = std::min(begin + files_.members_a_shard, ensemble_.members);
    std::error_code error;
    auto const is_packed = [&] { return fs::exists(shard_path(shard), error); };
    if (files_.members_a_shard == 0 || begin >= end) {
        return;
    }
    auto const remove_parts = [&] { fs::remove_all(fs::path(part(begin)).parent_path(), error); };
    if (is_packed()) {
        remove_parts();
        return;
    }
    for (std::int64_t number = end - 1; number >= begin; --number) {
        if (!fs::exists(part(number), error)) {
            return;
        }
    }
    io::OutputFile out(shard_path(shard), io::Existing::replace);
    std::ofstream entries(out.staging(), std::ios::binary);
    auto const add = [&](std::string const& bytes) {
        if (!entries.write(bytes.data(), static_cast<std::streamsize>(bytes.size()))) {
            fail_at(shard_path(shard), errno);
        }
    };
    try {
        for (std::int64_t number = begin; number < end; ++number) {
            add(io::read_text(part(number), largest_input));
        }
    } catch (BadInput const&) { // another process has packed it meanwhile, and removes the parts
        if (is_packed()) {
            return;
        }
        throw;
    }
    add(io::tar_end());
    entries.close();
    if (!entries) {
        fail_at(shard_path(shard), errno);
    }
    out.commit();
    remove_parts();
}

Journals::Account MemberStore::finish() {
    for (std::int64_t shard = 0; files_.members_a_shard > 0 && shard * files_.members_a_shard < ensemble_.members;
         ++shard) {
        pack(shard);
    }
    Journals const journals(inner_);
    Journals::Account account =
        journals.write_tables(ensemble_.members, work_->path("table.csv"), work_->path("timings.csv"));
    work_->commit();
    return account;
}

} // namespace thalweg::pipeline
