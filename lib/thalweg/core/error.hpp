// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <stdexcept>
#include <string>

namespace thalweg {

/// Root of every exception thalweg throws. The text reads "room.verb: what, where, what to do".
class Error : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// A parameter is outside its range.
class BadParameter : public Error {
public:
    using Error::Error;
};

/// The data handed in cannot be used: the message names the feature and its place.
class BadInput : public Error {
public:
    using Error::Error;
};

/// An iteration stopped before its tolerance.
class NotConverged : public Error {
public:
    using Error::Error;
};

/// A file or the memory failed.
class IoError : public Error {
public:
    using Error::Error;
};

/// The stop token of a Run was triggered.
class Cancelled : public Error {
public:
    using Error::Error;
};

} // namespace thalweg
