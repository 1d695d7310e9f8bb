// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/ensemble/internal/table.hpp>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <thalweg/core/bounded_json.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/refuse.hpp>

namespace thalweg::ensemble {

namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr std::string_view sum_key = ",\"sum\":\"";

/// Ends a line of JSON with a checksum of what stands before it.
std::string with_sum(std::string line) {
    line.pop_back(); // the brace
    return fmt::format("{}{}{:016x}\"}}", line, sum_key, hash_of(line));
}

bool has_its_sum(std::string_view line) {
    std::size_t const size = sum_key.size() + 18;
    if (line.size() <= size) {
        return false;
    }
    std::string_view const before = line.substr(0, line.size() - size);
    return line.substr(before.size()) == fmt::format("{}{:016x}\"}}", sum_key, hash_of(before));
}

/// Whether a row has what is read of it, each of its kind.
bool is_row(ordered_json const& row) {
    auto const has = [&](char const* name, auto is_right) {
        auto const at = row.find(name);
        return at != row.end() && ((*at).*is_right)();
    };
    auto const all = [&](char const* name, auto is_right) {
        return std::ranges::all_of(row[name], [&](ordered_json const& one) { return (one.*is_right)(); });
    };
    using J = ordered_json;
    constexpr auto text = static_cast<bool (J::*)() const noexcept>(&J::is_string);
    constexpr auto number = static_cast<bool (J::*)() const noexcept>(&J::is_number);
    constexpr auto whole = static_cast<bool (J::*)() const noexcept>(&J::is_number_unsigned);
    constexpr auto object = static_cast<bool (J::*)() const noexcept>(&J::is_object);
    constexpr auto array = static_cast<bool (J::*)() const noexcept>(&J::is_array);
    return row.is_object() && has("member", whole) && has("seed", whole) && has("keys", object) && all("keys", text) &&
           has("status", text) && has("reason", text) && has("warnings", whole) && has("first_warning", text) &&
           has("values", object) && has("seconds", number) && has("cpu_s", number) && has("write_s", number) &&
           has("stages", object) && all("stages", number) && has("files", array) && all("files", text);
}

/// The row of a journal's line; nothing when it is not as row_json() wrote it.
std::optional<ordered_json> row_in(std::string const& line) {
    if (!has_its_sum(line)) {
        return std::nullopt;
    }
    auto row = bounded_json<ordered_json>(line);
    return is_row(row) ? std::optional(std::move(row)) : std::nullopt;
}

ordered_json finite_or_null(double value) {
    return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr);
}

ordered_json keys_object(Member const& member) {
    ordered_json keys = ordered_json::object();
    for (auto const& [key, value] : member.keys) {
        keys[key] = value;
    }
    return keys;
}

ordered_json values_object(MemberRow const& row) {
    ordered_json values = ordered_json::object();
    for (auto const& [column, value] : row.values) {
        values[column] = finite_or_null(value);
    }
    return values;
}

/// A field of a CSV file.
///
/// Source: RFC 4180.
std::string csv_field(std::string const& text) {
    if (text.find_first_of(",\"\n\r") == std::string::npos) {
        return text;
    }
    std::string quoted = "\"";
    for (char const c : text) {
        quoted += c == '"' ? "\"\"" : c == '\n' || c == '\r' ? " " : std::string(1, c);
    }
    return quoted + "\"";
}

std::string csv_number(ordered_json const& value) {
    return value.is_number() ? fmt::format("{:.9g}", value.get<double>()) : "";
}

/// Names of columns, in the order of the first member that has them.
class CsvColumns {
public:
    void add(std::int64_t member, ordered_json const& values) {
        std::int64_t position = 0;
        for (auto const& item : values.items()) {
            auto const place = std::pair(member, position++);
            auto const [at, is_new] = first_.try_emplace(item.key(), place);
            at->second = std::min(at->second, place);
        }
    }
    std::vector<std::string> in_order() const {
        std::vector<std::pair<std::pair<std::int64_t, std::int64_t>, std::string>> places;
        for (auto const& [name, place] : first_) {
            places.emplace_back(place, name);
        }
        std::ranges::sort(places);
        std::vector<std::string> names;
        for (auto& [place, name] : places) {
            names.push_back(std::move(name));
        }
        return names;
    }

private:
    std::map<std::string, std::pair<std::int64_t, std::int64_t>> first_;
};

/// A file that is written line by line.
class CsvFile {
public:
    explicit CsvFile(std::string const& path) : path_(path), file_(std::fopen(path.c_str(), "wbx")) {
        require(file_ != nullptr);
    }
    void add(std::string line) {
        line += '\n';
        require(std::fwrite(line.data(), 1, line.size(), file_.get()) == line.size());
    }
    void close() { require(std::fclose(file_.release()) == 0); }

private:
    void require(bool done) const {
        if (!done) {
            throw IoError("ensemble.make_members",
                          fmt::format("{}: {}", path_, std::generic_category().message(errno)));
        }
    }
    struct Close {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };
    std::string path_;
    std::unique_ptr<std::FILE, Close> file_;
};

/// Reads the lines of journals again.
class JournalReader {
public:
    explicit JournalReader(std::vector<std::string> const& files) {
        for (std::string const& file : files) {
            streams_.emplace_back(file, std::ios::binary);
        }
    }
    ordered_json row(RowPlace const& place) {
        std::ifstream& stream = streams_[place.file];
        stream.clear();
        stream.seekg(place.offset);
        std::string line;
        std::getline(stream, line);
        std::optional<ordered_json> row = row_in(line);
        if (!row) {
            throw IoError(
                "ensemble.make_members",
                fmt::format("the row of member {} was changed while it was read: run the command again", place.member));
        }
        return std::move(*row);
    }

private:
    std::vector<std::ifstream> streams_;
};

/// Gives each list of names a number.
class Lists {
public:
    explicit Lists(std::vector<std::vector<std::string>>& lists) : lists_(lists) { numbers_[{}] = 0; }
    std::uint32_t number_of(ordered_json const& names) {
        auto list = names.get<std::vector<std::string>>();
        auto const [at, is_new] = numbers_.try_emplace(list, static_cast<std::uint32_t>(lists_.size()));
        if (is_new) {
            lists_.push_back(std::move(list));
        }
        return at->second;
    }

private:
    std::vector<std::vector<std::string>>& lists_;
    std::map<std::vector<std::string>, std::uint32_t> numbers_;
};

/// Keeps one row of each member, in their order.
void keep_one_each(std::vector<RowPlace>& rows) {
    std::ranges::stable_sort(rows, {}, &RowPlace::member);
    std::size_t kept = 0;
    for (RowPlace const& row : rows) {
        if (kept == 0 || rows[kept - 1].member != row.member) {
            rows[kept++] = row;
            continue;
        }
        RowPlace& known = rows[kept - 1];
        bool const had_failed = known.had_failed || known.is_failed || row.is_failed;
        known = known.is_failed || !row.is_failed ? row : known;
        known.had_failed = had_failed && !known.is_failed;
    }
    rows.resize(kept);
}

} // namespace

std::uint64_t hash_of(std::string_view text) {
    std::uint64_t hash = 0xcbf29ce484222325;
    for (char const c : text) {
        hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
    }
    return hash;
}

std::string row_json(MemberRow const& row, MemberWork const& work) {
    ordered_json stages = ordered_json::object();
    double cpu_s = 0.0;
    for (StageTime const& time : row.timings_s) {
        stages[time.stage] = time.wall_s;
        cpu_s += time.cpu_s;
    }
    ordered_json const json{{"member", row.member.number},
                            {"seed", row.member.seed},
                            {"keys", keys_object(row.member)},
                            {"status", name_of(row.state)},
                            {"reason", row.reason},
                            {"warnings", row.warnings},
                            {"first_warning", row.first_warning},
                            {"values", values_object(row)},
                            {"seconds", work.seconds},
                            {"cpu_s", cpu_s},
                            {"write_s", work.writing_s},
                            {"stages", stages},
                            {"files", work.files}};
    return with_sum(json.dump(-1, ' ', false, ordered_json::error_handler_t::replace));
}

std::string row_object(MemberRow const& row) {
    ordered_json const json{
        {"member", row.member.number},  {"seed", row.member.seed}, {"keys", keys_object(row.member)},
        {"status", name_of(row.state)}, {"reason", row.reason},    {"warnings", row.warnings},
        {"values", values_object(row)}};
    return json.dump(-1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

Journals::Journals(std::string const& folder, Run const& run) {
    std::error_code error;
    for (fs::directory_entry const& entry : fs::directory_iterator(folder, error)) {
        std::string const name = entry.path().filename().string();
        if (name.starts_with("rows-") && name.ends_with(".jsonl")) {
            refuse_if<BadInput>(!fs::is_regular_file(entry.symlink_status()), "ensemble.make_members",
                                "{} is not a file of thalweg's but a link, a folder, a pipe or a device: remove it",
                                entry.path().string());
            journals_.push_back(entry.path().string());
        }
    }
    if (error) {
        throw IoError("ensemble.make_members", fmt::format("{}: {}", folder, error.message()));
    }
    std::ranges::sort(journals_);
    Lists lists(lists_);
    for (std::size_t i = 0; i < journals_.size(); ++i) {
        std::ifstream stream(journals_[i], std::ios::binary);
        if (!stream) {
            throw IoError("ensemble.make_members",
                          fmt::format("{}: {}", journals_[i], std::generic_category().message(errno)));
        }
        std::int64_t offset = 0;
        for (std::string line; std::getline(stream, line) && !stream.eof(); offset = stream.tellg()) {
            run.check();
            std::optional<ordered_json> const row = row_in(line);
            if (!row) {
                ++damaged_;
                continue;
            }
            rows_.push_back({.member = (*row)["member"].get<std::int64_t>(),
                             .offset = offset,
                             .file = static_cast<std::uint32_t>(i),
                             .files = lists.number_of((*row)["files"]),
                             .is_failed = (*row)["status"] == name_of(MemberState::failed)});
        }
        if (stream.bad()) { // else it would be a journal that ends there
            throw IoError("ensemble.make_members", fmt::format("{} cannot be read to its end", journals_[i]));
        }
    }
    keep_one_each(rows_);
}

Journals::Account Journals::write_tables(std::int64_t members, std::string const& table, std::string const& timings,
                                         Run const& run) const {
    CsvColumns keys;
    CsvColumns measures;
    CsvColumns stages;
    JournalReader reader(journals_);
    auto const each = [&](auto const& visit) {
        for (RowPlace const& place : rows_) {
            run.check();
            if (place.member < members) {
                visit(place.member, reader.row(place));
            }
        }
    };
    each([&](std::int64_t member, ordered_json const& row) {
        keys.add(member, row["keys"]);
        measures.add(member, row["values"]);
        stages.add(member, row["stages"]);
    });
    std::vector<std::string> const of_keys = keys.in_order();
    std::vector<std::string> const of_measures = measures.in_order();
    std::vector<std::string> const of_stages = stages.in_order();
    CsvFile rows(table);
    CsvFile times(timings);
    std::string head = "member,seed";
    for (std::string const& key : of_keys) {
        head += "," + csv_field(key);
    }
    head += ",status,reason,warnings";
    for (std::string const& column : of_measures) {
        head += "," + csv_field(column);
    }
    rows.add(head);
    head = "member,seconds,cpu_s,write_s";
    for (std::string const& stage : of_stages) {
        head += "," + csv_field(stage);
    }
    times.add(head);
    Account account;
    each([&](std::int64_t member, ordered_json const& row) {
        std::string line = fmt::format("{},{}", member, row["seed"].get<std::uint64_t>());
        for (std::string const& key : of_keys) {
            line += "," + csv_field(row["keys"].value(key, ""));
        }
        std::string const status = row["status"];
        std::string const reason = row["reason"];
        line += fmt::format(",{},{},{}", status, csv_field(reason), row["warnings"].get<std::int64_t>());
        for (std::string const& column : of_measures) {
            auto const value = row["values"].find(column);
            line += "," + (value == row["values"].end() ? "" : csv_number(*value));
        }
        rows.add(std::move(line));
        line = fmt::format("{},{:.6f},{:.6f},{:.6f}", member, row["seconds"].get<double>(), row["cpu_s"].get<double>(),
                           row["write_s"].get<double>());
        for (std::string const& stage : of_stages) {
            auto const value = row["stages"].find(stage);
            line += value == row["stages"].end() ? "," : fmt::format(",{:.6f}", value->get<double>());
        }
        times.add(std::move(line));
        auto const first = [&](std::string& words, std::string const& why) {
            words = words.empty() ? fmt::format("member {}: {}", member, why) : words;
        };
        if (status == name_of(MemberState::failed)) {
            ++account.failed;
            first(account.first_failed, reason);
        } else if (status == name_of(MemberState::check_failed)) {
            ++account.checks_failed;
            first(account.first_check, reason);
        } else {
            ++account.ok;
        }
        if (row["warnings"].get<std::int64_t>() > 0) {
            ++account.warned;
            first(account.first_warning, row["first_warning"].get<std::string>());
        }
    });
    rows.close();
    times.close();
    return account;
}

} // namespace thalweg::ensemble
