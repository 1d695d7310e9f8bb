// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <stdexcept>
#include <string>

namespace thalweg {

/// Root of every exception thalweg throws.
class Error : public std::runtime_error {
public:
    /// Takes "module.function: what is wrong, where, what to do" and keeps the two parts apart. Without a module of
    /// thalweg in front (core, geometry, solver, ...) the whole text is the message. A message of several lines may
    /// repeat the prefix at the beginning of each; every repetition is removed.
    /// \param text the text
    explicit Error(std::string const& text);

    // what() gives the message, for users of a program.

    /// \return the function that threw, "module.function", for users of the library; "" when it is not known.
    char const* where() const noexcept { return where_.what(); }

private:
    std::runtime_error where_; ///< not a string: copying an exception must not throw
};

/// A parameter is outside its range.
class BadParameter : public Error {
public:
    using Error::Error;
};

/// The input data cannot be used: the message names the feature and its place.
class BadInput : public Error {
public:
    using Error::Error;
};

/// An iteration stopped before its tolerance.
class NotConverged : public Error {
public:
    using Error::Error;
};

/// A file operation or a memory allocation failed.
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
