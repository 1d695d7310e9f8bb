// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/ensemble/internal/ensemble_table.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include <thalweg/core/run/messages.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/files/files.hpp>

namespace thalweg::ensemble {
namespace {

constexpr std::int64_t largest_table = 250'000'000; // [bytes]

/// A field of a CSV text.
struct CsvField {
    std::string text;
    std::size_t end = 0; ///< of the field in the text: a comma, the end of a line or of the text
};

bool ends_field(std::string_view text, std::size_t at) {
    return at >= text.size() || text[at] == ',' || text[at] == '\n' || text.substr(at).starts_with("\r\n");
}

CsvField plain_field(std::string_view text, std::size_t at, std::string const& name, std::size_t line) {
    std::size_t end = at;
    while (!ends_field(text, end)) {
        refuse_if<BadInput>(text[end] == '"' || text[end] == '\r', "ensemble.read_members_table",
                            "{}, line {}: {} inside a field without quotes; it is not a CSV table by RFC 4180", name,
                            line, text[end] == '"' ? "a quote" : "a carriage return");
        ++end;
    }
    return {std::string(text.substr(at, end - at)), end};
}

CsvField quoted_field(std::string_view text, std::size_t at, std::string const& name, std::size_t line) {
    CsvField field;
    for (std::size_t i = at + 1; i < text.size(); ++i) {
        if (text[i] != '"') {
            field.text += text[i];
        } else if (i + 1 < text.size() && text[i + 1] == '"') {
            field.text += '"';
            ++i;
        } else {
            refuse_if<BadInput>(
                !ends_field(text, i + 1), "ensemble.read_members_table",
                "{}, line {}: text follows the closing quote of a field; it is not a CSV table by RFC 4180", name,
                line);
            field.end = i + 1;
            return field;
        }
    }
    refuse_if<BadInput>(true, "ensemble.read_members_table",
                        "{}, line {}: a quoted field has no end; the file is incomplete or not a CSV table", name,
                        line);
    return field;
}

bool is_measure(std::string_view column) {
    constexpr std::array<std::string_view, 5> families = {"rivers.", "dem.", "law.", "dem_law.", "relief."};
    return std::any_of(families.begin(), families.end(), [&](std::string_view f) { return column.starts_with(f); });
}

/// Where the columns of a table are.
struct Columns {
    std::size_t member = 0;
    std::optional<std::size_t> seed;
    std::optional<std::size_t> status;
    std::optional<std::size_t> reason;
    std::vector<std::size_t> keys;
    std::vector<std::size_t> measures;
};

Columns columns_of(std::vector<std::string> const& header, std::string const& name) {
    Columns columns;
    std::optional<std::size_t> member;
    std::set<std::string> seen;
    for (std::size_t i = 0; i < header.size(); ++i) {
        refuse_if<BadInput>(!seen.insert(header[i]).second, "ensemble.read_members_table",
                            "{} has two columns '{}'; rename or remove one", name, header[i]);
        if (header[i] == "member") {
            member = i;
        } else if (header[i] == "seed") {
            columns.seed = i;
        } else if (header[i] == "status") {
            columns.status = i;
        } else if (header[i] == "reason") {
            columns.reason = i;
        } else if (is_measure(header[i])) {
            columns.measures.push_back(i);
        } else if (!header[i].empty() && header[i] != "warnings" && !header[i].starts_with("check.")) {
            columns.keys.push_back(i);
        }
    }
    refuse_if<BadInput>(!member, "ensemble.read_members_table",
                        "{} has no column 'member'; name the table.csv that make --ensemble wrote", name);
    columns.member = *member;
    return columns;
}

DrawnStatus status_of(std::string const& word, std::string const& name, std::int64_t member) {
    refuse_if<BadInput>(word != "ok" && word != "check_failed" && word != "failed", "ensemble.read_members_table",
                        "{}, member {}: unknown status '{}'; it must be ok, check_failed or failed", name, member,
                        word);
    return word == "ok" ? DrawnStatus::ok : word == "failed" ? DrawnStatus::failed : DrawnStatus::check_failed;
}

std::int64_t member_number(std::string const& text, std::string const& name, std::size_t row) {
    std::int64_t number = 0;
    auto const [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    refuse_if<BadInput>(error != std::errc() || end != text.data() + text.size() || number < 0,
                        "ensemble.read_members_table", "{}, row {}: member '{}' is not a whole number from 0", name,
                        row, text);
    return number;
}

} // namespace

std::vector<std::vector<std::string>> csv_records(std::string_view text, std::string const& name) {
    constexpr std::string_view mark = "\xEF\xBB\xBF";
    text.remove_prefix(text.starts_with(mark) ? mark.size() : 0);
    refuse_if<BadInput>(text.find('\0') != std::string_view::npos || !is_utf8(text), "ensemble.read_members_table",
                        "{} is not a text in UTF-8; name the table.csv of an ensemble", name);
    std::vector<std::vector<std::string>> records;
    std::size_t line = 1;
    for (std::size_t at = 0; at < text.size();) {
        std::vector<std::string> record;
        std::size_t const first_line = line;
        bool goes_on = true;
        while (goes_on) {
            bool const quoted = at < text.size() && text[at] == '"';
            CsvField field = quoted ? quoted_field(text, at, name, line) : plain_field(text, at, name, line);
            line += static_cast<std::size_t>(std::count(field.text.begin(), field.text.end(), '\n'));
            at = field.end;
            goes_on = at < text.size() && text[at] == ',';
            at += goes_on ? 1 : 0;
            record.push_back(std::move(field.text));
        }
        at += at < text.size() && text[at] == '\r' ? 1 : 0;
        at += at < text.size() ? 1 : 0; // the line feed
        ++line;
        if (!records.empty()) {
            refuse_if<BadInput>(record.size() != records.front().size(), "ensemble.read_members_table",
                                "{}, line {} has {} fields and the header {}; correct the line", name, first_line,
                                record.size(), records.front().size());
        }
        records.push_back(std::move(record));
    }
    return records;
}

double plain_number(std::string_view text) {
    double value = 0.0;
    auto const [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    bool const is_number = error == std::errc() && end == text.data() + text.size() && std::isfinite(value);
    return is_number ? value : std::numeric_limits<double>::quiet_NaN();
}

MembersTable read_members_table(std::string const& path) {
    auto records = csv_records(io::read_text(path, largest_table), path);
    refuse_if<BadInput>(records.empty(), "ensemble.read_members_table",
                        "{} is empty; name the table.csv of an ensemble", path);
    std::vector<std::string> const header = std::move(records.front());
    Columns const columns = columns_of(header, path);
    refuse_if<BadInput>(records.size() < 2, "ensemble.read_members_table", "{} has a header and no members", path);
    MembersTable table;
    for (std::size_t const i : columns.keys) {
        table.keys.push_back(header[i]);
    }
    for (std::size_t const i : columns.measures) {
        table.measures.push_back({header[i], {}});
        table.measures.back().values.reserve(records.size() - 1);
    }
    std::set<std::int64_t> numbers;
    bool has_number = false;
    for (std::size_t row = 1; row < records.size(); ++row) {
        std::vector<std::string> const& record = records[row];
        DrawnMember member;
        member.number = member_number(record[columns.member], path, row);
        refuse_if<BadInput>(!numbers.insert(member.number).second, "ensemble.read_members_table",
                            "{} has member {} twice; remove one row", path, member.number);
        member.seed = columns.seed ? record[*columns.seed] : "";
        member.status = columns.status ? status_of(record[*columns.status], path, member.number) : DrawnStatus::ok;
        member.reason = columns.reason ? record[*columns.reason] : "";
        for (std::size_t const i : columns.keys) {
            member.values.push_back(record[i]);
        }
        for (std::size_t m = 0; m < columns.measures.size(); ++m) {
            std::string const& text = record[columns.measures[m]];
            double const value = plain_number(text);
            refuse_if<BadInput>(std::isnan(value) && !text.empty(), "ensemble.read_members_table",
                                "{}, member {}, column '{}': '{}' is not a number; leave unknown values empty", path,
                                member.number, header[columns.measures[m]], text);
            table.measures[m].values.push_back(value);
            has_number = has_number || !std::isnan(value);
        }
        table.members.push_back(std::move(member));
    }
    refuse_if<BadInput>(
        !has_number, "ensemble.read_members_table",
        "{} has no numbers in columns rivers.*, dem.*, law.*, dem_law.* or relief.*; there is nothing to draw", path);
    return table;
}

} // namespace thalweg::ensemble
