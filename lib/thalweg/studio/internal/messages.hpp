// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <thalweg/make/make.hpp>
#include <thalweg/report/live_page.hpp>
#include <thalweg/studio/document.hpp>
#include <thalweg/studio/drawing.hpp>
#include <thalweg/studio/engine.hpp>

// What the studio and its page tell one another (web/README.md).
namespace thalweg::studio {

/// What a page asks for.
struct Request {
    enum class Kind : std::uint8_t { edit, attempt, undo, redo, write, stop, draw };
    std::int64_t id = 0;
    Kind kind = Kind::stop;
    Edit edit = {};                                      ///< of edit and attempt
    std::string file = {};                               ///< of write: one file; "": all
    std::function<DrawStep(Grid const& grid)> step = {}; ///< of draw: reads the step, as draw_step()
    std::int64_t revision = -1;                          ///< of draw: of the document that it is for
};

/// \throws BadInput for a text that is no request, with what is wrong
Request request_of(std::string_view text);

/// \param what of a request to draw: one JSON object, with places in cells of the grid
/// \throws BadInput for what is no step, with what is wrong
DrawStep draw_step(std::string_view what, Grid const& grid);

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
/// What is to be read of a job's findings: all but those that list the input's features.
std::string findings_message(Job const& job, std::vector<Finding> const& findings);
std::string cluster_message(Job const& job, std::optional<report::ClusterArms> const& arms);
/// \param members as report::live_scene()
std::string scene_message(Job const& job, std::string_view level, std::string const& members);
/// \param job that was begun last
/// \param said what came of it beside what was asked
std::string done_message(std::int64_t id, std::int64_t revision, std::int64_t job,
                         std::vector<std::string> const& said = {});
/// \param at [cells] where it is wrong
std::string refused_message(std::int64_t id, std::string_view error, std::optional<Vec2> at = std::nullopt);

/// \param is_drawn as is_drawn()
std::string drawing_message(Drawing const& drawing, std::int64_t revision, bool is_drawn);
/// A place of the grid's coordinate system in cells from its north-western corner, y to the south.
Vec2 in_cells(Grid const& grid, Vec2 at);

/// What was written on demand.
struct WrittenFolder {
    std::string folder;
    std::vector<std::string> files;
    std::string url; ///< of the one file asked for, relative to the page; ""
};
std::string written_message(std::int64_t id, std::int64_t revision, WrittenFolder const& written);

/// Heights that a page shows.
struct ShownHeights {
    Grid grid; ///< of the terrain
    bool is_finished = false;
    report::LiveHeights heights;
    std::optional<report::Sea> sea;
};

/// Heights as a binary message.
/// \param before what the page has of that kind, on the same grid: tiles that are equal are left out; null: nothing
std::string heights_message(Job const& job, ShownHeights const& shown, ShownHeights const* before);

} // namespace thalweg::studio
