// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include <thalweg/core/run/error.hpp>

/// What an act that fails with Failure says; nothing where it does not fail.
template <class Failure = thalweg::Error> std::string message_of(auto&& act) {
    try {
        act();
    } catch (Failure const& error) {
        return error.what();
    }
    return "";
}
