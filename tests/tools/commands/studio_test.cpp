// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <signal.h> // NOLINT(modernize-deprecated-headers): kill is of POSIX
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "killed_studio.hpp"

namespace studio_command_test {

namespace fs = std::filesystem;

namespace {

std::string const land = "[grid]\nwidth = 64\nheight = 48\n[network]\nsource = \"dla\"\nprune = 4\n"
                         "[network.dla]\nparticles = 400\n[surface]\n";

/// Ends a studio by a signal.
Ended interrupted(StartedStudio& studio) {
    kill(studio.process().pid(), SIGINT);
    return studio.process().wait(30.0);
}

} // namespace

TEST(StudioCommand, PrintsItsAddressAndEndsAtCtrlC) {
    Workplace const place;
    place.write("land.toml", land);
    StartedStudio studio({"land.toml", "-o", "doc"}, place.path());
    EXPECT_TRUE(studio.address().starts_with("http://127.0.0.1:")) << studio.address();
    EXPECT_NE(studio.address().find("/?token="), std::string::npos);
    {
        RawClient window(studio.port());
        ASSERT_TRUE(studio.opens(window));
        auto const document = nlohmann::json::parse(window.read_message().payload);
        EXPECT_EQ(document["type"], "document");
        EXPECT_EQ(document["recipe"], file_bytes(place / "doc/recipe.toml"));
        auto const begin = std::chrono::steady_clock::now();
        Ended const ended = interrupted(studio);
        EXPECT_EQ(ended.code, 0) << ended.err;
        EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10));
        EXPECT_TRUE(test::has(ended.err, "document", "Ctrl-C ends it"));
    }
    EXPECT_EQ(thalweg_run("make doc/recipe.toml -o made -q", place.path()).code, 0) << "a document is a recipe";
}

TEST(StudioCommand, OpensADocumentOnceAtATime) {
    Workplace const place;
    place.write("land.toml", land);
    StartedStudio studio({"land.toml", "-o", "doc", "-q"}, place.path());
    Outcome const second = thalweg_run("studio doc --no-browser", place.path());
    EXPECT_EQ(second.code, 2);
    EXPECT_TRUE(test::has(second.err, "doc", "open")) << second.err;
    EXPECT_EQ(interrupted(studio).code, 0);
    StartedStudio again({"doc", "-q"}, place.path());
    EXPECT_EQ(interrupted(again).code, 0);
}

TEST(StudioCommand, RefusesNonsenseInWords) {
    Workplace const place;
    place.write("land.toml", land);
    place.write("words.txt", "no rivers");
    EXPECT_EQ(thalweg_run("studio nowhere.toml --no-browser", place.path()).code, 2);
    EXPECT_EQ(thalweg_run("studio words.txt --no-browser", place.path()).code, 2);
    EXPECT_EQ(thalweg_run("studio --port 70000 --no-browser", place.path()).code, 2);
    EXPECT_EQ(thalweg_run("studio --port x --no-browser", place.path()).code, 2);
    Outcome const unknown = thalweg_run("studio --preset hils --no-browser", place.path());
    EXPECT_EQ(unknown.code, 2);
    EXPECT_TRUE(test::has(unknown.err, "hills", "dissected-plateau")) << unknown.err;
    StartedStudio studio({"land.toml", "-o", "doc", "-q"}, place.path());
    Outcome const taken =
        thalweg_run("studio land.toml -o other --no-browser --port " + std::to_string(studio.port()), place.path());
    EXPECT_EQ(taken.code, 1);
    EXPECT_TRUE(test::has(taken.err, std::to_string(studio.port()))) << taken.err;
    EXPECT_EQ(interrupted(studio).code, 0);
}

// Every user of the machine may read command lines.
TEST(StudioCommand, ShowsTheBrowserItsTokenInAFileOfItsUserAlone) {
    Workplace const place;
    place.write("land.toml", land);
    fs::create_directory(place / "bin");
    place.write("bin/xdg-open", "#!/bin/sh\necho \"$*\" > words && cp \"$1\" page && stat -c %a \"$1\" > mode.new && "
                                "mv mode.new mode\n");
    place.shell("chmod +x bin/xdg-open");
    StartedStudio studio(
        {"land.toml", "-o", "doc", "-q"}, place.path(),
        [&] {
            setenv("DISPLAY", ":77", 1);
            setenv("PATH", ((place / "bin").string() + ":" + std::getenv("PATH")).c_str(), 1);
        },
        false);
    for (int i = 0; i < 600 && !fs::exists(place / "mode"); ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    std::string const token = studio.address().substr(studio.address().find("token="));
    std::string const words = file_bytes(place / "words");
    EXPECT_EQ(words, (place / "doc/.studio.html").string() + "\n");
    EXPECT_EQ(words.find(token), std::string::npos);
    EXPECT_TRUE(test::has(file_bytes(place / "page"), "url=" + studio.address()));
    EXPECT_EQ(file_bytes(place / "mode"), "600\n");
    std::string const of_process = "/proc/" + std::to_string(studio.process().pid());
    EXPECT_EQ(file_bytes(of_process + "/cmdline").find(token), std::string::npos);
    std::string children = "?";
    for (int i = 0; i < 100 && !children.empty(); ++i) { // the opener leaves no zombie
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        children = file_bytes(of_process + "/task/" + std::to_string(studio.process().pid()) + "/children");
    }
    EXPECT_EQ(children, "");
    EXPECT_EQ(interrupted(studio).code, 0);
    EXPECT_FALSE(fs::exists(place / "doc/.studio.html"));
}

TEST(StudioCommand, LosesNoAnsweredEditWhenItIsKilled) {
    kill_studio_while_editing(3, 5);
}

} // namespace studio_command_test
