// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <thalweg/pipeline/make/make.hpp>
#include <thalweg/pipeline/report/live_page.hpp>
#include <thalweg/studio/document.hpp>
#include <thalweg/studio/engine.hpp>

// What the studio and its page tell one another (web/README.md).
namespace thalweg::studio {

/// What a page asks for.
struct Request {
    enum class Kind : std::uint8_t { edit, attempt, undo, redo, write, stop };
    std::int64_t id = 0;
    Kind kind = Kind::stop;
    Edit edit = {};        ///< of edit and attempt
    std::string file = {}; ///< of write: one file; "": all
};

/// \throws BadInput for a text that is no request, with what is wrong
Request request_of(std::string_view text);

/// The number of a request that cannot be read otherwise; 0: it has none.
std::int64_t id_of(std::string_view text);

/// \param folder of the document
/// \return what the page is given: version, folder, all keys of recipes
std::string page_parameters(std::string const& folder);

std::string document_message(Document const& document, History const& history, std::string const& command);
std::string busy_message(Job const& job, std::string_view stage, double share);
enum class JobEnd : std::uint8_t { made, stopped };
std::string idle_message(Job const& job, double seconds, JobEnd end = JobEnd::made);
std::string failed_message(Job const& job, std::string_view error);
std::string say_message(std::string_view text);
std::string cluster_message(Job const& job, std::optional<pipeline::ClusterArms> const& arms);
/// \param members as pipeline::live_scene()
std::string scene_message(Job const& job, std::string_view level, std::string const& members);
/// \param job that was begun last
std::string done_message(std::int64_t id, std::int64_t revision, std::int64_t job);
std::string refused_message(std::int64_t id, std::string_view error);

/// What was written on demand.
struct Written {
    std::string folder;
    std::vector<std::string> files;
    std::string url; ///< of the one file asked for, relative to the page; ""
};
std::string written_message(std::int64_t id, std::int64_t revision, Written const& written);

/// Heights that a page shows.
struct Shown {
    Grid grid; ///< of the terrain
    bool is_finished = false;
    pipeline::LiveHeights heights;
    std::optional<pipeline::Sea> sea;
};

/// Heights as a binary message.
/// \param before what the page has of that kind, on the same grid: tiles that are equal are left out; null: nothing
std::string heights_message(Job const& job, Shown const& shown, Shown const* before);

} // namespace thalweg::studio
