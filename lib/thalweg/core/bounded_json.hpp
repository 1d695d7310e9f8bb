// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

namespace thalweg {

/// Bounds of JSON that somebody else may have written. A library's parser has none of its own: values nested a million
/// deep overflow the stack of who copies or writes them, and objects that keep their keys in order are slow to fill.
struct JsonBounds {
    int deepest = 16;             ///< >= 1, objects and arrays in one another
    std::size_t most_keys = 4096; ///< of one object
};

/// Parses JSON within bounds, in a time and a depth that they keep small.
/// \tparam Json nlohmann::json or nlohmann::ordered_json
/// \param text may come from outside
/// \return the value; discarded (is_discarded()) when the text is no JSON or goes beyond the bounds
template <class Json> Json bounded_json(std::string_view text, JsonBounds const& bounds = {}) {
    using Event = typename Json::parse_event_t;
    bool is_beyond = false;
    std::vector<std::size_t> keys(static_cast<std::size_t>(bounds.deepest) + 1, 0); // of the open object, by depth
    Json value = Json::parse(
        text.begin(), text.end(),
        [&](int depth, Event event, Json&) {
            bool const opens = event == Event::object_start || event == Event::array_start;
            is_beyond = is_beyond || depth > bounds.deepest || (opens && depth >= bounds.deepest);
            if (is_beyond) {
                return false; // what follows is read and dropped
            }
            auto const at = static_cast<std::size_t>(depth);
            if (event == Event::object_start) {
                keys[at + 1] = 0;
            } else if (event == Event::key) {
                is_beyond = ++keys[at] > bounds.most_keys;
            }
            return !is_beyond;
        },
        false);
    return is_beyond ? Json(Json::value_t::discarded) : value;
}

} // namespace thalweg
