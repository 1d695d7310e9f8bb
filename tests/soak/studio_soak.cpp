// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <random>

#include <gtest/gtest.h>

#include "killed_studio.hpp"

TEST(KilledStudio, LosesNoEditThatWasAnswered) {
    kill_studio_while_editing(50, std::random_device()());
}
