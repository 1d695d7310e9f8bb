// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/bounded_json.hpp>

#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace bounded_json_test {

using namespace thalweg;
using nlohmann::json;
using nlohmann::ordered_json;

namespace {

std::string nested(int deep) {
    return std::string(static_cast<std::size_t>(deep), '[') + std::string(static_cast<std::size_t>(deep), ']');
}

std::string with_keys(int count, std::string const& value = "0") {
    std::string text = "{";
    for (int i = 0; i < count; ++i) {
        text += (i > 0 ? ",\"k" : "\"k") + std::to_string(i) + "\":" + value;
    }
    return text + "}";
}

template <class Json> bool is_taken(std::string const& text, JsonBounds const& bounds) {
    return !bounded_json<Json>(text, bounds).is_discarded();
}

} // namespace

TEST(BoundedJson, TakesWhatLiesWithin) {
    std::string const text = R"({"b":[1,-2.5,"x",null,true],"a":{"c":{}},"b":3})";
    EXPECT_EQ(bounded_json<ordered_json>(text), ordered_json::parse(text));
    EXPECT_EQ(bounded_json<json>(text), json::parse(text));
    EXPECT_EQ(bounded_json<json>("7"), json(7));
    for (char const* const wrong : {"", "{", "[1,]", "nul", "{\"a\":1}x"}) {
        EXPECT_TRUE(bounded_json<json>(wrong).is_discarded()) << wrong;
    }
}

TEST(BoundedJson, RefusesWhatIsTooDeep) {
    for (int deepest = 1; deepest < 6; ++deepest) {
        JsonBounds const bounds{.deepest = deepest};
        EXPECT_TRUE(is_taken<json>(nested(deepest), bounds)) << deepest;
        EXPECT_FALSE(is_taken<json>(nested(deepest + 1), bounds)) << deepest;
        EXPECT_FALSE(is_taken<json>("{\"a\":" + nested(deepest) + "}", bounds)) << deepest;
    }
    EXPECT_FALSE(is_taken<ordered_json>(nested(2000000), {}));
    EXPECT_FALSE(is_taken<ordered_json>(std::string(2000000, '['), {}));
}

TEST(BoundedJson, RefusesObjectsWithTooManyKeys) {
    JsonBounds const bounds{.most_keys = 10};
    EXPECT_TRUE(is_taken<json>(with_keys(10), bounds));
    EXPECT_FALSE(is_taken<json>(with_keys(11), bounds));
    EXPECT_TRUE(is_taken<json>("[" + with_keys(10) + "," + with_keys(10) + "]", bounds)) << "each has its own";
    EXPECT_TRUE(is_taken<json>(with_keys(10, with_keys(10)), bounds));
    EXPECT_FALSE(is_taken<json>(with_keys(10, with_keys(11)), bounds));
    EXPECT_FALSE(is_taken<ordered_json>(with_keys(300000), {})) << "in a moment, not in minutes";
}

} // namespace bounded_json_test
