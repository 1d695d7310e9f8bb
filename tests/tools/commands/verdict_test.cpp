// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "commands/verdict.hpp"

namespace verdict_test {

using namespace thalweg;
using namespace thalweg::tools;

namespace {

Check const recall{"trace_recall", 0.43, 0.95, false, Bound::at_least};
Check const pits{"depressions", 2.0, 0.0, false};
Check const fine{"crossings", 0.0, 0.0, true};

TEST(Verdict, ALowerBoundIsCalledOne) {
    EXPECT_EQ(in_words(recall), "trace_recall 0.43 (at least 0.95)");
    EXPECT_EQ(in_words(pits), "depressions 2 (at most 0)");
}

TEST(Verdict, CountsFailedChecks) {
    EXPECT_EQ(verdict("a.gpkg", {}), "a.gpkg: ok, 0 checks");
    EXPECT_EQ(verdict("a.gpkg", {fine}), "a.gpkg: ok, 1 check");
    EXPECT_EQ(verdict("a.gpkg", {fine, recall, pits}), "a.gpkg: FAILED, 2 of 3 checks");
    EXPECT_EQ(verdict("a.gpkg", {pits}), "a.gpkg: FAILED, 1 of 1 check");
}

} // namespace

} // namespace verdict_test
