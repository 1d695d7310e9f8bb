// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Columns that look like links, nodes or directions of lines.
#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <unordered_map>

#include <fmt/format.h>

#include <thalweg/io/network/internal/read_network.hpp>

namespace thalweg::io {

namespace {

constexpr std::size_t looked_at = 5000; // lines: the first of a file tell
constexpr std::size_t enough = 3;

using Keys = std::vector<std::string>; // by line, "" for none

// The lines that have each id.
using Holders = std::unordered_map<std::string, std::vector<std::size_t>>;

std::string key_of(AttributeTable::Value const& value) {
    if (auto const* const whole = std::get_if<std::int64_t>(&value)) {
        return fmt::format("{}", *whole);
    }
    if (auto const* const real = std::get_if<double>(&value)) {
        auto const whole = whole_in(*real);
        return whole ? fmt::format("{}", *whole) : "";
    }
    auto const* const text = std::get_if<std::string>(&value);
    return text == nullptr ? "" : *text;
}

struct Field {
    std::string name;
    Keys keys;
    Holders holders;
    std::size_t known = 0; // lines with a key
};

class Guess {
public:
    Guess(std::vector<RiverLine> const& lines, AttributeTable const& attributes)
        : lines_(lines), size_(std::min(lines.size(), looked_at)) {
        for (std::size_t c = 0; c < attributes.columns.size(); ++c) {
            Field field;
            field.name = attributes.columns[c].name;
            for (std::size_t l = 0; l < size_; ++l) {
                auto const record = static_cast<std::size_t>(lines[l].feature - 1);
                std::string key = record < attributes.rows.size() ? key_of(attributes.rows[record][c]) : "";
                if (!key.empty()) {
                    field.holders[key].push_back(l);
                    ++field.known;
                }
                field.keys.push_back(std::move(key));
            }
            if (field.known >= enough && 2 * field.known >= size_) {
                fields_.push_back(std::move(field));
            }
        }
    }

    // A field of ids, and one that names the line downstream: of lines that meet, and of several the same.
    std::vector<Finding> links() const {
        return best_pair("links", "arc_id", "ds_arc", [&](Field const& id, Field const& down) {
            return id.holders.size() < id.known || id.known < size_ ? 0 : linked(id, down);
        });
    }

    // Fields of two nodes: lines of which one ends at a node where another begins meet, and more end than begin at one.
    std::vector<Finding> nodes() const {
        return best_pair("nodes", "from_node", "to_node", [&](Field const& from, Field const& to) {
            return to.holders.size() < from.holders.size() ? joined(from, to) : 0;
        });
    }

    // A field all of whose words are of directions, or whose name is.
    std::vector<Finding> directions() const {
        static constexpr std::array names{"flowdir", "flow_dir", "flowtype", "flow_type", "direction",
                                          "dedirec", "sensec",   "fliessr",  "sentido"};
        std::set<std::string> known;
        for (DataSet const& set : all_data_sets()) {
            for (std::string_view const words : {set.with, set.against}) {
                std::ranges::copy(words_of(words), std::inserter(known, known.end()));
            }
        }
        std::vector<Finding> found;
        for (Field const& field : fields_) {
            bool const has_words = std::ranges::any_of(field.holders, [&](auto const& holder) {
                std::string const word = plain_word(holder.first);
                return word.size() > 1 && known.contains(word);
            });
            bool const is_named = std::ranges::any_of(
                names, [&](std::string_view name) { return lower_case(field.name).find(name) != std::string::npos; });
            if (has_words) {
                found.push_back(finding(field.known, fmt::format("field {} looks like the direction of lines: --field "
                                                                 "direction={} takes it",
                                                                 field.name, field.name)));
            } else if (is_named) {
                found.push_back(
                    finding(field.known, fmt::format("field {} is named like the direction of lines, but its values "
                                                     "('{}', ...) are not known ones such as 'in direction' and 'in "
                                                     "opposite direction'",
                                                     field.name, field.holders.begin()->first)));
            }
        }
        return found;
    }

private:
    static Finding finding(std::size_t amount, std::string text) {
        return {.kind = "unused_fields",
                .amount = static_cast<double>(amount),
                .text = std::move(text),
                .key = "network.lines.path"};
    }

    // The two fields for which most lines count, if any does; of equal ones the first.
    template <class Count>
    std::vector<Finding> best_pair(char const* what, char const* first, char const* second, Count const& count) const {
        Field const* best_one = nullptr;
        Field const* best_other = nullptr;
        std::size_t most = 0;
        for (Field const& one : fields_) {
            for (Field const& other : fields_) {
                std::size_t const found = &one == &other ? 0 : count(one, other);
                if (found > most) {
                    most = found;
                    best_one = &one;
                    best_other = &other;
                }
            }
        }
        if (most == 0) {
            return {};
        }
        return {finding(most, fmt::format("fields {} and {} look like {} of lines: --field {}={} --field {}={} takes "
                                          "them",
                                          best_one->name, best_other->name, what, first, best_one->name, second,
                                          best_other->name))};
    }

    bool meet(std::size_t a, std::size_t b) const {
        auto const& one = lines_[a].vertices;
        auto const& other = lines_[b].vertices;
        for (Vec3 const& p : {one.front(), one.back()}) {
            if (in_plan(p) == in_plan(other.front()) || in_plan(p) == in_plan(other.back())) {
                return true;
            }
        }
        return false;
    }

    // How many lines have a link by two fields; 0 where these are no links.
    std::size_t linked(Field const& id, Field const& down) const {
        std::size_t found = 0;
        std::size_t meeting = 0;
        std::set<std::string> named;
        for (std::size_t l = 0; l < size_; ++l) {
            auto const below = id.holders.find(down.keys[l]);
            if (below == id.holders.end() || below->second.front() == l) {
                continue;
            }
            ++found;
            meeting += meet(l, below->second.front()) ? 1 : 0;
            named.insert(down.keys[l]);
        }
        bool const are_links = found >= enough && 2 * found >= size_ && 10 * meeting >= 9 * found;
        return are_links && 10 * named.size() < 9 * found ? found : 0;
    }

    // How many lines end at a node where another begins, by two fields; 0 where these are no nodes, or only repeat the
    // drawn direction.
    std::size_t joined(Field const& from, Field const& to) const {
        std::size_t found = 0;
        std::size_t meeting = 0;
        std::size_t drawn = 0;
        for (std::size_t l = 0; l < size_; ++l) {
            auto const below = from.holders.find(to.keys[l]);
            if (below == from.holders.end() || below->second.front() == l) {
                continue;
            }
            std::size_t const next = below->second.front();
            ++found;
            meeting += meet(l, next) ? 1 : 0;
            drawn += in_plan(lines_[l].vertices.back()) == in_plan(lines_[next].vertices.front()) ? 1 : 0;
        }
        bool const are_nodes = found >= enough && 2 * found >= size_ && 10 * meeting >= 9 * found;
        return are_nodes && drawn < found ? found : 0;
    }

    std::vector<RiverLine> const& lines_;
    std::size_t size_;
    std::vector<Field> fields_;
};

} // namespace

std::vector<Finding> unused_fields(std::vector<RiverLine> const& lines, AttributeTable const& attributes) {
    Guess const guess(lines, attributes);
    std::vector<Finding> found = guess.links();
    if (found.empty()) {
        found = guess.nodes();
    }
    std::vector<Finding> directions = guess.directions();
    std::ranges::move(directions, std::back_inserter(found));
    return found;
}

} // namespace thalweg::io
