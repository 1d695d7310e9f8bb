// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "help/print_keys.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/messages.hpp>

namespace thalweg::tools {

namespace {

using pipeline::KeyHelp;

std::string section_of(std::string const& path) {
    auto const dot = path.rfind('.');
    return dot == std::string::npos ? "" : path.substr(0, dot);
}

std::string key_name(std::string const& path) {
    return path.substr(path.rfind('.') + 1);
}

std::string without_brackets(std::string const& word) {
    auto const begin = word.find_first_not_of('[');
    auto const end = word.find_last_not_of(']');
    return begin == std::string::npos || end < begin ? word : word.substr(begin, end - begin + 1);
}

template <class Wanted> std::vector<KeyHelp> keys_where(std::vector<KeyHelp> const& keys, Wanted const& wanted) {
    std::vector<KeyHelp> found;
    std::copy_if(keys.begin(), keys.end(), std::back_inserter(found), wanted);
    return found;
}

} // namespace

std::vector<KeyHelp> keys_named(std::string const& word) {
    std::vector<KeyHelp> const all = pipeline::recipe_keys();
    std::string const name = without_brackets(word);
    if (name.empty()) {
        return all;
    }
    std::vector<KeyHelp> found = keys_where(all, [&](KeyHelp const& key) { return key.path == name; });
    if (found.empty()) {
        found =
            keys_where(all, [&](KeyHelp const& key) { return (section_of(key.path) + ".").rfind(name + ".", 0) == 0; });
    }
    if (found.empty()) {
        found = keys_where(all, [&](KeyHelp const& key) { return key_name(key.path) == name; });
    }
    if (found.empty()) {
        std::vector<std::string> known;
        for (KeyHelp const& key : all) {
            known.push_back(key.path);
            known.push_back(section_of(key.path));
        }
        throw BadParameter(
            fmt::format("unknown key '{}'.{} `thalweg recipe` lists every key.", word, did_you_mean(name, known)));
    }
    return found;
}

std::string keys_as_list(std::vector<KeyHelp> const& keys) {
    std::string text;
    std::string section = " ";
    for (KeyHelp const& key : keys) {
        if (section_of(key.path) != section) {
            section = section_of(key.path);
            text += text.empty() ? "" : "\n";
            text += section.empty() ? "" : section == "patch" ? "[[patch]]\n" : "[" + section + "]\n";
        }
        text += fmt::format("{:<18}{}{}\n{:<18}{}; {}{}\n", key_name(key.path), key.meaning,
                            key.unit.empty() ? "" : " [" + key.unit + "]", "", key.type, key.range,
                            key.standard.empty() ? "" : "; default " + key.standard);
    }
    return text;
}

std::string key_as_text(KeyHelp const& key) {
    std::string text = key.path + "\n";
    auto const line = [&](char const* what, std::string const& words) {
        text += words.empty() ? "" : fmt::format("  {:<9} {}\n", what, words);
    };
    line("meaning", key.meaning);
    line("type", key.type);
    line("unit", key.unit);
    line("range", key.range);
    line("default", key.standard);
    line("used by", key.used_by);
    line("file", key.is_file ? "its value is a file name, relative to the recipe's folder" : "");
    return text;
}

std::string keys_as_json(std::vector<KeyHelp> const& keys) {
    nlohmann::ordered_json json{{"keys", nlohmann::ordered_json::array()}};
    for (KeyHelp const& key : keys) {
        json["keys"].push_back({{"key", key.path},
                                {"meaning", key.meaning},
                                {"type", key.type},
                                {"unit", key.unit},
                                {"range", key.range},
                                {"default", key.standard},
                                {"choices", key.choices},
                                {"used_by", key.used_by},
                                {"is_file", key.is_file}});
    }
    return json.dump(2) + "\n";
}

} // namespace thalweg::tools
