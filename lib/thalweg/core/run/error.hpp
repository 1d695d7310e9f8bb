// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \cpponly

#include <exception>
#include <stdexcept>
#include <string>

namespace thalweg {

/// Base class of every exception that thalweg throws.
class Error : public std::runtime_error {
public:
    /// \param where the function that throws: "module.function"
    /// \param what what is wrong, at which place, what to do
    Error(std::string const& where, std::string const& what);

    // what() gives the message, for users of a program.

    /// The function that threw, for users of the library.
    /// \return "module.function"
    char const* where() const noexcept { return where_.what(); }

private:
    std::runtime_error where_; ///< not a string: copying an exception must not throw
};

/// A parameter is outside its range.
class BadParameter : public Error {
public:
    using Error::Error;
};

/// The input cannot be used; the message names the feature and its position.
class BadInput : public Error {
public:
    using Error::Error;
};

/// An iteration stopped before it reached its tolerance.
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

/// Words for who used too much memory; they need none.
inline constexpr char const* out_of_memory = "out of memory: make the grid smaller or the cell larger";

/// What to tell of an exception: its words; out_of_memory for one of the allocator, whose own words say nothing.
/// \param error any
/// \return as long as error lives
char const* words_of(std::exception const& error) noexcept;

} // namespace thalweg
