// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the columns of a river file say of where water goes.
#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <ogrsf_frmts.h>

#include <thalweg/io/network/internal/read_network.hpp>

namespace thalweg::io {

namespace {

// An id that some programs write as a real number.
std::string without_zero(std::string id) {
    if (id.ends_with(".0")) {
        id.resize(id.size() - 2);
    }
    return id;
}

// The ids of a text that holds several: "[12, 13]".
std::vector<std::string> ids_in(std::string text) {
    std::ranges::replace_if(
        text, [](char c) { return std::string_view(",;[](){}'\"\t").find(c) != std::string_view::npos; }, ' ');
    std::vector<std::string> ids = words_of(text);
    std::erase(ids, "");
    std::ranges::transform(ids, ids.begin(), without_zero);
    return ids;
}

bool is_code(std::string const& word) {
    return !word.empty() && word.find_first_not_of("-0123456789.") == std::string::npos;
}

FileColumn first_of(OGRLayer& layer, std::string_view names) {
    return {layer, words_of(names), false};
}

// Both columns where both are there.
void take_pair(OGRLayer& layer, std::string_view one, std::string_view other, FileColumn& first, FileColumn& second) {
    FileColumn a = first_of(layer, one);
    FileColumn b = first_of(layer, other);
    if (!first.is_there() && a.is_there() && b.is_there()) {
        first = std::move(a);
        second = std::move(b);
    }
}

} // namespace

std::string plain_word(std::string word) {
    word = lower_case(std::move(word));
    std::erase_if(word, [](char c) { return c == ' ' || c == '_'; });
    return word.erase(0, word.find_last_of("/#:") + 1);
}

FlowFields::FlowFields(OGRLayer& layer, FlowColumns named)
    : from_node_(named.from_node), to_node_(named.to_node), rank_(named.rank) {
    std::vector<DataSet const*> const sets = data_sets_of(layer);
    if (named.id.is_there() && named.down.is_there()) {
        links_.push_back({named.id, named.down});
    }
    if (named.direction.is_there()) {
        Direction& direction = directions_.emplace_back(Direction{named.direction, {}, {}});
        for (DataSet const& set : all_data_sets()) {
            std::ranges::copy(words_of(set.with), std::back_inserter(direction.with));
            std::ranges::copy(words_of(set.against), std::back_inserter(direction.against));
        }
    }
    bool const is_named = !links_.empty() || !directions_.empty() || to_node_.is_there();
    for (DataSet const* const set : sets) {
        if (!is_named) {
            find(layer, *set);
        }
        if (FileColumn rank = first_of(layer, set->rank); !rank_.is_there() && rank.is_number()) {
            rank_ = std::move(rank);
        }
        take_pair(layer, set->z_first, set->z_last, z_first_, z_last_);
    }
}

void FlowFields::find(OGRLayer& layer, DataSet const& set) {
    FileColumn id = first_of(layer, set.id);
    FileColumn down = first_of(layer, set.down);
    if (id.is_there() && down.is_there()) {
        links_.push_back({std::move(id), std::move(down), set.nexus, set.of_nexus});
    }
    take_pair(layer, set.from_node, set.to_node, from_node_, to_node_);
    if (FileColumn column = first_of(layer, set.direction); column.is_there()) {
        directions_.push_back({std::move(column), words_of(set.with), words_of(set.against)});
    }
}

void FlowFields::read_direction(OGRFeature const& feature, Said& said) {
    for (Direction const& direction : directions_) {
        std::string const word = without_zero(plain_word(direction.column.text(feature)));
        int const runs = std::ranges::count(direction.with, word) > 0      ? 1
                         : std::ranges::count(direction.against, word) > 0 ? -1
                                                                           : 0;
        if (!is_code(word)) {
            said.by_word = said.by_word == 0 ? runs : said.by_word;
        } else if (std::ranges::any_of(direction.with, is_code)) { // else a discharge, say
            constexpr std::string_view codes = " -1 0 1 2 3 4 9 "; // Esri: 4 flows both ways
            are_codes_ = are_codes_ && codes.find(fmt::format(" {} ", word)) != std::string_view::npos;
            said.by_code = said.by_code == 0 ? runs : said.by_code;
        }
    }
}

void FlowFields::read(OGRFeature const& feature, std::int64_t number) {
    for (Links& links : links_) {
        std::string const own = without_zero(links.id.text(feature));
        if (own.empty()) {
            continue;
        }
        links.feature_of.try_emplace(own, number);
        if (std::string const down = links.down.text(feature); !down.empty() && down != own) {
            links.down_id.emplace(number, down);
        }
    }
    Said said;
    read_direction(feature, said);
    constexpr double none = -9998.0;
    double const rank = rank_.real(feature);
    said.rank = rank > none && std::isfinite(rank) ? rank : nan;
    auto const number_of = [&](FileColumn const& column) {
        std::string const name = without_zero(column.text(feature));
        auto const next = static_cast<std::int64_t>(node_numbers_.size()) + 1;
        return name.empty() ? 0 : node_numbers_.try_emplace(name, next).first->second;
    };
    said.from_node = number_of(from_node_);
    said.to_node = number_of(to_node_);
    said_.emplace(number, said);
}

std::int64_t FlowFields::Links::below(std::int64_t number) const {
    auto const linked = down_id.find(number);
    if (linked == down_id.end()) {
        return 0;
    }
    std::vector<std::string> ids = ids_in(linked->second);
    ids.insert(ids.begin(), without_zero(linked->second));
    for (std::string const& named : ids) {
        auto found = feature_of.find(named);
        if (found == feature_of.end() && !nexus.empty() && named.starts_with(nexus)) {
            found = feature_of.find(std::string(of_nexus) + named.substr(nexus.size()));
        }
        if (found != feature_of.end() && found->second != number) {
            return found->second;
        }
    }
    return 0;
}

double FlowFields::Links::share_found() const {
    auto const found = std::ranges::count_if(down_id, [&](auto const& linked) { return below(linked.first) != 0; });
    return down_id.empty() ? 0.0 : static_cast<double>(found) / static_cast<double>(down_id.size());
}

// Of several pairs of columns the first that links at least half of the lines that name one, else the first of those
// that link most.
FlowFields::Links const& FlowFields::links() const {
    if (links_.size() == 1) {
        return links_.front();
    }
    std::vector<double> shares;
    for (Links const& links : links_) {
        shares.push_back(links.share_found());
        if (shares.back() >= 0.5) {
            return links;
        }
    }
    return links_[static_cast<std::size_t>(std::ranges::max_element(shares) - shares.begin())];
}

std::map<std::int64_t, std::int64_t> FlowFields::downs() const {
    std::map<std::int64_t, std::int64_t> downs;
    if (!links_.empty()) {
        Links const& chosen = links();
        for (auto const& [number, ids] : chosen.down_id) {
            if (std::int64_t const below = chosen.below(number); below != 0) {
                downs.emplace(number, below);
            }
        }
    }
    return downs;
}

FlowFields::Said FlowFields::said_of(std::int64_t number) const {
    auto const said = said_.find(number);
    return said == said_.end() ? Said() : said->second;
}

int FlowFields::runs_of(std::int64_t number) const {
    Said const said = said_of(number);
    return said.by_word != 0 || !are_codes_ ? said.by_word : said.by_code;
}

void FlowFields::tell(std::vector<RiverLine>& lines) const {
    std::set<double> ranks;
    for (auto const& [number, said] : said_) {
        if (!std::isnan(said.rank)) {
            ranks.insert(said.rank);
        }
    }
    // Ranks that are not whole numbers are counted from the least; only their order matters.
    bool const are_whole = std::ranges::all_of(ranks, [](double rank) { return whole_in(rank).has_value(); });
    std::map<double, std::int64_t> numbers;
    for (double const rank : ranks) {
        auto const next = static_cast<std::int64_t>(numbers.size()) + 1;
        numbers.emplace(rank, are_whole ? static_cast<std::int64_t>(rank) : next);
    }
    auto const down_of = downs();
    for (RiverLine& line : lines) {
        Said const said = said_of(line.feature);
        auto const down = down_of.find(line.feature);
        line.down = down == down_of.end() ? 0 : down->second;
        line.runs = runs_of(line.feature);
        line.rank = std::isnan(said.rank) ? 0 : numbers.at(said.rank);
        line.from_node = said.from_node;
        line.to_node = said.to_node;
    }
}

bool FlowFields::raise(OGRFeature const& feature, std::vector<Vec3>& line) const {
    constexpr double lowest_m = -990.0; // files fill heights that they do not know with -999, -1000 or less
    double const first = z_first_.real(feature);
    double const last = z_last_.real(feature);
    bool const has_heights = std::ranges::any_of(line, [](Vec3 const& v) { return !std::isnan(v.z); });
    if (has_heights || !(first > lowest_m) || !(last > lowest_m) || !std::isfinite(first) || !std::isfinite(last)) {
        return false;
    }
    std::vector<double> along{0.0};
    for (std::size_t i = 1; i < line.size(); ++i) {
        along.push_back(along.back() + distance(in_plan(line[i - 1]), in_plan(line[i])));
    }
    for (std::size_t i = 0; i < line.size(); ++i) {
        line[i].z = first + (last - first) * (along.back() > 0.0 ? along[i] / along.back() : 0.0);
    }
    return true;
}

} // namespace thalweg::io
