// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/ensemble/ensemble.hpp>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include <thalweg/core/run/error.hpp>

namespace ensemble_test {

using namespace thalweg;
using namespace thalweg::recipe;
using namespace thalweg::make;
using namespace thalweg::ensemble;

namespace {

Ensemble of(std::vector<std::string> const& vary, std::int64_t members = 1000) {
    Ensemble ensemble{.recipe = default_recipe_on(64, 48), .members = members};
    for (std::string const& text : vary) {
        ensemble.vary.push_back(read_varied_key(text));
    }
    return ensemble;
}

std::string value(Ensemble const& ensemble, std::int64_t number) {
    return member_of(ensemble, number).keys.at(0).second;
}

} // namespace

TEST(Ensemble, AMemberHasItsSeed) {
    Ensemble ensemble = of({});
    ensemble.recipe.seed = 40;
    EXPECT_EQ(member_of(ensemble, 2).seed, 42U);
    EXPECT_EQ(recipe_of(ensemble, member_of(ensemble, 2)).seed, 42U);
}

TEST(Ensemble, AKeyBetweenTwoNumbersIsUniform) {
    Ensemble const ensemble = of({"surface.mean_slope=10..30"});
    double sum = 0.0;
    double squares = 0.0;
    for (std::int64_t i = 0; i < ensemble.members; ++i) {
        double const z = std::stod(value(ensemble, i));
        EXPECT_GE(z, 10.0);
        EXPECT_LT(z, 30.0);
        sum += z;
        squares += z * z;
    }
    double const mean = sum / 1000.0;
    EXPECT_NEAR(mean, 20.0, 0.75); // four standard errors
    EXPECT_NEAR(std::sqrt(squares / 1000.0 - mean * mean), 20.0 / std::sqrt(12.0), 0.4);
}

TEST(Ensemble, AValueIsThatOfSeedAndKey) {
    Ensemble later = of({"surface.mean_slope=10..30"});
    later.recipe.seed += 5;
    EXPECT_EQ(value(of({"surface.mean_slope=10..30"}), 5), value(later, 0));
    Ensemble const two = of({"surface.mean_slope=0..1", "surface.debris_area=0..1"});
    Member const member = member_of(two, 0);
    EXPECT_NE(member.keys.at(0).second, member.keys.at(1).second);
}

TEST(Ensemble, WholeNumbersAreRounded) {
    Ensemble const ensemble = of({"network.forest.spacing=8..10"});
    std::set<std::string> values;
    for (std::int64_t i = 0; i < 100; ++i) {
        values.insert(value(ensemble, i));
    }
    EXPECT_EQ(values, (std::set<std::string>{"8", "9", "10"}));
}

TEST(Ensemble, AListGivesItsValuesInTurn) {
    Ensemble const ensemble = of({"network.source=forest, dla"});
    EXPECT_EQ(value(ensemble, 0), "forest");
    EXPECT_EQ(value(ensemble, 1), "dla");
    EXPECT_EQ(value(ensemble, 2), "forest");
    EXPECT_EQ(recipe_of(ensemble, member_of(ensemble, 1)).network->source, Source::dla);
    EXPECT_EQ(read_varied_key("grid.origin=[0, 0], [10, 20]").values, (std::vector<std::string>{"[0, 0]", "[10, 20]"}));
    EXPECT_EQ(read_varied_key(R"(output.title="a, b",c)").values, (std::vector<std::string>{R"("a, b")", "c"}));
    EXPECT_EQ(read_varied_key("surface.mean_slope=10").values, std::vector<std::string>{"10"});
}

TEST(Ensemble, ImpossibleKeysAreRefused) {
    for (char const* const text :
         {"", "surface.mean_slope", "=1..2", "surface.mean_slop=1..2", "seed=1..2", "seed=1,2", "network.source=1..2",
          "surface.mean_slope=2..1", "surface.mean_slope=a..b", "surface.mean_slope=..", "surface.mean_slope=1..inf",
          "surface.mean_slope=", "surface.mean_slope=1,,2", "patch.x=1..2"}) {
        EXPECT_THROW(read_varied_key(text), BadParameter) << text;
    }
}

TEST(Ensemble, AnImpossibleMemberIsARow) {
    MadeMember const made = make_member(of({"surface.mean_slope=25,95"}, 2), 1);
    EXPECT_FALSE(made.made);
    EXPECT_EQ(made.row.state, MemberState::failed);
    EXPECT_NE(made.row.reason.find("surface.mean_slope = 95"), std::string::npos) << made.row.reason;
}

TEST(Ensemble, AMemberIsWhatItsRecipeMakes) {
    Ensemble const ensemble = of({"surface.mean_slope=10..30"}, 4);
    MadeMember const member = make_member(ensemble, 3);
    ASSERT_TRUE(member.made);
    MakeResult const alone = make::make(recipe_of(ensemble, member_of(ensemble, 3)));
    EXPECT_TRUE(std::ranges::equal(member.made->terrain.ground.dem.values(), alone.terrain.ground.dem.values()));
    EXPECT_EQ(member.row.state, MemberState::ok) << member.row.reason;
    auto const found = [&](std::string const& column) {
        auto const at = std::ranges::find(member.row.values, column, [](auto const& v) { return v.first; });
        return at == member.row.values.end() ? -1.0 : at->second;
    };
    EXPECT_EQ(found("dem.mean"), alone.assessment.statistics->mean);
    EXPECT_EQ(found("rivers.arcs"), static_cast<double>(alone.terrain.rivers.network.planform.arc_count()));
    EXPECT_EQ(found("check.depressions"), 0.0);
    EXPECT_NE(found("law.drainage_density"), -1.0);
    EXPECT_NE(found("dem_law.drainage_density"), -1.0);
    EXPECT_NE(found("relief.slope_mean"), -1.0);
}

} // namespace ensemble_test
