// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/studio/document.hpp>

#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/studio/internal/journal.hpp>

namespace document_test {

using namespace thalweg;
using namespace thalweg::studio;

namespace {

using test::has;
using test::message_of;

Edit set(std::string const& key, std::string const& value) {
    return {"", {SetKey{key, value}}};
}

Document forest() {
    return document_of(recipe::write_recipe(recipe::default_recipe_on(64, 64)));
}

std::string after(Edit const& edit) {
    return apply(forest(), edit).document.toml;
}

std::string refusal(Edit const& edit) {
    return message_of<Error>([&] { apply(forest(), edit); });
}

/// An edit that may be refused.
rc::Gen<Step> some_step() {
    using rc::gen::element;
    static std::string const cluster = "[grid]\nwidth = 50\nheight = 60\n[network]\n[surface]\nmethod = \"dilate\"\n";
    return rc::gen::weightedOneOf<Step>(
        {{6, element<Step>(SetKey{"seed", "8"}, SetKey{"grid.width", "80"}, SetKey{"surface.method", "dilate"},
                           SetKey{"surface.method", "tin"}, SetKey{"surface.method", "equilibrium"},
                           SetKey{"surface.base", "paper"}, SetKey{"surface.increment", "3-0.01*x"},
                           SetKey{"network.source", "dla"}, SetKey{"network.source", "forest"},
                           SetKey{"network.dla.particles", "3000"}, SetKey{"network.heights", "graded"},
                           SetKey{"network.concavity", "0.5"}, SetKey{"detail.levels", "3"},
                           SetKey{"output.title", "Tarn \"1\"\t\xC3\xA9"}, SetKey{"output.units", "foot"},
                           SetKey{"skeleton.ridges", "voronoi"}, SetKey{"grid.origin", "[10, 20]"})},
         {2, rc::gen::map(rc::gen::inRange(0, 100000),
                          [](int seed) {
                              return Step(SetKey{"seed", std::to_string(seed)});
                          })},
         {2, element<Step>(UnsetKey{"seed"}, UnsetKey{"detail"}, UnsetKey{"skeleton"}, UnsetKey{"grid.width"},
                           UnsetKey{"surface.method"}, UnsetKey{"network.prune"}, UnsetKey{"patch.1"})},
         {1, element<Step>(ReplaceRecipe{cluster}, ReplaceRecipe{"seed = 1"},
                           TakeInput{"surface.mask", "inputs/1/m.tif"}, TakeInput{"patch.1.source", "inputs/2/p.tif"},
                           SetKey{"patch.1.rotate", "30"}, SetKey{"surface.mask", "../m.tif"})}});
}

rc::Gen<Edit> some_edit() {
    return rc::gen::map(rc::gen::resize(3, rc::gen::container<std::vector<Step>>(some_step())),
                        [](std::vector<Step> steps) {
                            return Edit{"a drag", std::move(steps)};
                        });
}

} // namespace

TEST(Document, ItsTextIsThatOfItsRecipe) {
    Document const document = forest();
    EXPECT_EQ(document.toml, recipe::write_recipe(document.recipe));
    EXPECT_EQ(document_of(document.toml).toml, document.toml);
    EXPECT_EQ(document_of("# by hand\n" + document.toml).toml, document.toml);
}

TEST(Document, AnEditSetsAKeyAsOnTheCommandLine) {
    EXPECT_TRUE(has(after(set("seed", "12")), "seed = 12\n"));
    EXPECT_TRUE(has(after(set("network.heights", "graded")), "heights = 'graded'\n"));
    EXPECT_TRUE(has(after(set("output.title", "a = \"b\"")), "title = 'a = \"b\"'\n"));
    EXPECT_EQ(apply(apply(forest(), set("seed", "12")).document, {"", {UnsetKey{"seed"}}}).document.toml,
              forest().toml);
}

TEST(Document, AMethodTakesItsKeysWithItAndTheInverseBringsThemBack) {
    Document const first = apply(forest(), set("surface.hillslope", "22")).document;
    AppliedEdit const other = apply(first, set("surface.method", "dilate"));
    EXPECT_TRUE(has(first.toml, "hillslope = 22.0"));
    EXPECT_FALSE(has(other.document.toml, "hillslope"));
    EXPECT_EQ(apply(other.document, {"", {other.inverse}}).document.toml, first.toml);
}

TEST(Document, SectionsAndPatchesAreTakenOut) {
    Edit const patch{"paste",
                     {TakeInput{"patch.1.source", "inputs/1/a.tif"}, TakeInput{"patch.2.source", "inputs/2/b.tif"}}};
    Document const patched = apply(forest(), patch).document;
    EXPECT_TRUE(has(patched.toml, "a.tif", "b.tif"));
    Document const one = apply(patched, {"", {UnsetKey{"patch.1"}}}).document;
    EXPECT_FALSE(has(one.toml, "a.tif"));
    EXPECT_TRUE(has(one.toml, "b.tif"));
    EXPECT_EQ(apply(one, {"", {UnsetKey{"patch.1"}}}).document.toml, forest().toml);
}

TEST(Document, RefusesInTheWordsOfTheRecipe) {
    EXPECT_TRUE(has(refusal(set("network.prunes", "3")), "unknown key 'network.prunes'", "network.prune"));
    EXPECT_TRUE(has(refusal(set("grid.cell", "-3")), "grid.cell: -3 is outside its range"));
    EXPECT_TRUE(has(refusal(set("surface.method", "dilat")), "Did you mean 'dilate'?"));
    EXPECT_TRUE(has(refusal(set("surface.base", "paper")), "surface.base has no effect in this recipe: it needs"));
    EXPECT_TRUE(has(refusal({"", {UnsetKey{"grid.width"}}}), "go together"));
    EXPECT_TRUE(has(refusal({"", {UnsetKey{"grid"}}}), "part of every recipe"));
    EXPECT_TRUE(has(refusal({"", {UnsetKey{"detail"}}}), "no such [detail]"));
    EXPECT_TRUE(has(refusal({"", {UnsetKey{""}}}), "unknown key"));
    EXPECT_TRUE(has(refusal({"", {ReplaceRecipe{"seed = "}}}), "line 1"));
    EXPECT_TRUE(has(refusal({"\xFF", {}}), "not UTF-8"));
    for (std::string const name :
         {"/etc/passwd", "../m.tif", "inputs/../../m.tif", "inputs/", "m.tif", "PG:dbname=x"}) {
        EXPECT_TRUE(has(refusal({"", {TakeInput{"surface.mask", name}}}), "below inputs/")) << name;
        EXPECT_TRUE(has(refusal(set("surface.mask", name)), "below inputs/")) << name;
    }
    for (ReplaceLines const& lines : {ReplaceLines{-1, "", "x\n"}, ReplaceLines{9999, "", "x\n"},
                                      ReplaceLines{0, "nowhere\n", ""}, ReplaceLines{0, "", "x"}}) {
        EXPECT_TRUE(has(refusal({"", {lines}}), "lines")) << lines.first;
    }
}

TEST(Document, EveryKeyIsSetOrRefusedAndTakenBack) {
    Document const first = forest();
    int accepted = 0;
    for (recipe::KeyHelp const& key : recipe::recipe_keys()) {
        std::vector<std::string> values = key.choices;
        values.push_back(key.is_file ? "inputs/1/x" : "1");
        for (std::string const& value : values) {
            try {
                AppliedEdit const there = apply(first, set(key.path, value));
                EXPECT_EQ(apply(there.document, {"", {there.inverse}}).document.toml, first.toml) << key.path;
                EXPECT_EQ(document_of(there.document.toml).toml, there.document.toml) << key.path;
                ++accepted;
            } catch (BadParameter const&) {
            }
        }
    }
    EXPECT_GT(accepted, 60);
}

TEST(Document, AnInverseTakesAnEditBackByteForByte) {
    ASSERT_TRUE(rc::check("apply and its inverse", [] {
        Document document = forest();
        for (Edit const& edit : *rc::gen::resize(8, rc::gen::container<std::vector<Edit>>(some_edit()))) {
            try {
                AppliedEdit const there = apply(document, edit);
                AppliedEdit const back = apply(there.document, {"", {there.inverse}});
                RC_ASSERT(back.document.toml == document.toml);
                RC_ASSERT(apply(back.document, {"", {back.inverse}}).document.toml == there.document.toml);
                RC_ASSERT(recipe::write_recipe(there.document.recipe) == there.document.toml);
                document = there.document;
            } catch (BadParameter const&) {
            }
        }
    }));
}

TEST(Document, UndoneAndRedoneWithoutEnd) {
    ASSERT_TRUE(rc::check("undo all, redo all, and so says the journal", [] {
        Session session{forest(), {}};
        std::string const first = session.document.toml;
        std::string journal = line_of_beginning(first);
        for (Edit const& edit : *rc::gen::resize(12, rc::gen::container<std::vector<Edit>>(some_edit()))) {
            std::size_t const before = session.history.done.size();
            try {
                session = edited(session, edit);
            } catch (BadParameter const&) {
            }
            journal += session.history.done.size() > before ? line_of(session.history.done.back()) : "";
        }
        std::string const last = session.document.toml;
        std::size_t const count = session.history.done.size();
        RC_ASSERT(read_journal(journal, "").toml == last);
        for (std::size_t i = 0; i < count; ++i) {
            session = undone(session);
            journal += line_of_undo();
        }
        RC_ASSERT(session.document.toml == first);
        RC_ASSERT(undone(session).document.toml == first);
        Journal const read = read_journal(journal, "");
        RC_ASSERT(read.toml == first);
        RC_ASSERT(read.history.undone.size() == count);
        RC_ASSERT(journal_of(first, read.history) == journal);
        for (std::size_t i = 0; i < count; ++i) {
            session = redone(session);
        }
        RC_ASSERT(session.document.toml == last);
        RC_ASSERT(redone(session).document.toml == last);
    }));
}

TEST(Document, AnEditAfterUndoDropsWhatWasUndone) {
    Session session = edited(edited({forest(), {}}, set("seed", "1")), set("seed", "2"));
    session = undone(session);
    EXPECT_EQ(edited(session, set("seed", "1")).history.undone.size(), 1U); // it changes nothing
    session = edited(session, set("seed", "3"));
    EXPECT_TRUE(session.history.undone.empty());
    EXPECT_TRUE(has(undone(session).document.toml, "seed = 1\n"));
}

TEST(Document, EditsHaveNames) {
    EXPECT_EQ(name_of(set("seed", "1")), "seed = 1");
    EXPECT_EQ(name_of({"a drag", {SetKey{"seed", "1"}, SetKey{"seed", "2"}}}), "a drag");
    EXPECT_EQ(name_of({"", {UnsetKey{"detail"}}}), "without detail");
    EXPECT_EQ(name_of({"", {}}), "");
}

} // namespace document_test
