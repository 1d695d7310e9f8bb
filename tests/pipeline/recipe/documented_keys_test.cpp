// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <filesystem>
#include <regex>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/pipeline/recipe/recipe.hpp>

namespace documented_keys_test {

using namespace thalweg;

namespace {

using test::bytes_of;

/// Names in docs that begin as keys do: files, and places in report.json.
std::set<std::string> const other_names = {"network.gpkg", "network.laws", "network.uphill_before_repair",
                                           "statistics.fine_forms_cells", "statistics.residuals"};

std::set<std::string> keys_and_sections() {
    std::set<std::string> names = other_names;
    for (pipeline::KeyHelp const& key : pipeline::recipe_keys()) {
        for (std::size_t dot = key.path.find('.'); dot != std::string::npos; dot = key.path.find('.', dot + 1)) {
            names.insert(key.path.substr(0, dot));
        }
        names.insert(key.path);
    }
    return names;
}

} // namespace

// A key that docs name is one that a recipe may have.
TEST(DocumentedKeys, Exist) {
    std::set<std::string> const known = keys_and_sections();
    std::regex const named(
        "`((?:grid|network|skeleton|surface|statistics|detail|patch|output)(?:\\.(?!hpp)[a-z_]+)+)"); // and no header
    std::filesystem::path const root(THALWEG_SOURCE_DIR);
    int found = 0;
    for (auto const& entry : std::filesystem::recursive_directory_iterator(root / "docs")) {
        std::string const folder = entry.path().parent_path().filename().string();
        if (entry.path().extension() != ".md" || folder == "decisions") { // which speak of their day
            continue;
        }
        std::string const text = bytes_of(entry.path());
        for (std::sregex_iterator at(text.begin(), text.end(), named), end; at != end; ++at, ++found) {
            EXPECT_TRUE(known.contains((*at)[1])) << entry.path() << " names the key " << (*at)[1];
        }
    }
    EXPECT_GT(found, 30);
}

} // namespace documented_keys_test
