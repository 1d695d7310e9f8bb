// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/run/messages.hpp>

#include <string>

#include <gtest/gtest.h>
#include <support.hpp>

namespace messages_test {

using namespace thalweg;
using thalweg::closest;

TEST(Printable, PlainTextStaysAsItIs) {
    for (std::string const text : {"", "\n", "a\nb\n", "\t1 m²", "río Ñandú → 長江 🏞"}) {
        EXPECT_EQ(printable(text), text);
    }
}

TEST(Printable, ControlCharactersAndWhatIsNotUtf8AreEscaped) {
    EXPECT_EQ(printable("a\033[31mb"), "a\\x1b[31mb");
    EXPECT_EQ(printable(std::string("a\0b\r\b\177", 6)), "a\\x00b\\x0d\\x08\\x7f");
    EXPECT_EQ(printable("\xc2\x9b"
                        "31m"),
              "\\u{009b}31m");
    EXPECT_EQ(printable("\xe2\x80\xae"
                        "gpj.exe"),
              "\\u{202e}gpj.exe");
    EXPECT_EQ(printable("a\xff\xc0\xaf\xed\xa0\x80\xe2\x82"), "a\\xff\\xc0\\xaf\\xed\\xa0\\x80\\xe2\\x82");
}

TEST(Printable, WhatAFileMayHoldKeepsAllThatIsUtf8) {
    for (std::string const text : {"", "\n\033 a", "río Ñandú → 長江 🏞"}) {
        EXPECT_EQ(as_utf8(text), text);
    }
    EXPECT_EQ(as_utf8("M\xfcller\xff\xe2\x82"), "M\\xfcller\\xff\\xe2\\x82");
    EXPECT_TRUE(is_utf8(as_utf8("\xc0\xaf\xed\xa0\x80\xf5")));
}

TEST(Printable, LongTextIsCutAndSaysHowMuch) {
    std::string const cut = printable("begin " + std::string(10'000'000, 'x') + " end");
    EXPECT_LT(cut.size(), 700U);
    EXPECT_EQ(cut.substr(0, 6), "begin ");
    EXPECT_EQ(cut.substr(cut.size() - 4), " end");
    EXPECT_TRUE(test::has(cut, "[... 9999460 bytes left out ...]"));
    std::string wide;
    for (int i = 0; i < 1000; ++i) {
        wide += "長";
    }
    EXPECT_EQ(printable(wide).find('\\'), std::string::npos) << "cut between characters";
    std::string lines;
    for (int i = 0; i < 1000; ++i) {
        lines += "line\n";
    }
    EXPECT_TRUE(test::has(printable(lines), "[... 951 more lines ...]"));
}

TEST(Printable, PasswordsAreLeftOut) {
    EXPECT_EQ(without_passwords("PG:host=a password=geheim dbname=b"), "PG:host=a password=... dbname=b");
    EXPECT_EQ(without_passwords("'PG:host=a Password = 'ge \\' heim' dbname=b'"),
              "'PG:host=a Password = ... dbname=b'");
    EXPECT_EQ(without_passwords("MYSQL:b,password=geheim,user=u"), "MYSQL:b,password=...,user=u");
    EXPECT_EQ(without_passwords("postgresql://u:ge@heim@h:1/b?password=geheim&x=1"),
              "postgresql://u:...@h:1/b?password=...&x=1");
    EXPECT_EQ(without_passwords("http://h:80/a@b and a password"), "http://h:80/a@b and a password");
    EXPECT_EQ(without_passwords("password="), "password=");
}

TEST(Suggest, NothingNear) {
    EXPECT_EQ(closest("", {}), "");
    EXPECT_EQ(closest("", {"dilate"}), "");
    EXPECT_EQ(closest("zebra", {"dilate", "diffuse"}), "");
    EXPECT_EQ(closest("x", {"uniform"}), "");
}

TEST(Suggest, TypingErrors) {
    std::vector<std::string> const known = {"uniform", "decreasing", "rise_fall"};
    EXPECT_EQ(closest("rise_fal", known), "rise_fall");
    EXPECT_EQ(closest("risefall", known), "rise_fall");
    EXPECT_EQ(closest("unifrom", known), "uniform");
    EXPECT_EQ(closest("decreasing", known), "decreasing");
    EXPECT_EQ(thalweg::did_you_mean("unifom", known), " Did you mean 'uniform'?");
}

TEST(Suggest, SwappedNeighboursAreOneSlip) {
    std::vector<std::string> const known = {"make", "check", "man"};
    EXPECT_EQ(closest("maek", known), "make");
    EXPECT_EQ(closest("mkae", known), "make");
    EXPECT_EQ(closest("chekc", known), "check");
    EXPECT_EQ(closest("ekam", known), "");
}

} // namespace messages_test
