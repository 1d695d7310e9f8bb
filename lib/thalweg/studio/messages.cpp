// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/studio/internal/messages.hpp>

#include <algorithm>
#include <bit>
#include <cstring>
#include <map>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/pipeline/recipe/recipe.hpp>
#include <thalweg/pipeline/report/report.hpp>

namespace thalweg::studio {
namespace {

using nlohmann::ordered_json;

static_assert(std::endian::native == std::endian::little, "heights travel as the processor has them");

constexpr std::int64_t tile = 64; // [values]

std::string text_of(ordered_json const& message) {
    return message.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

ordered_json or_null(std::optional<double> const& number) {
    return number ? ordered_json(*number) : ordered_json(nullptr);
}

std::string text_at(ordered_json const& of, char const* name) {
    auto const found = of.find(name);
    refuse_if<BadInput>(found == of.end() || !found->is_string(), "studio.request: {} must be a text", name);
    return found->get<std::string>();
}

Step step_of(ordered_json const& of) {
    refuse_if<BadInput>(!of.is_object(), "studio.request: a step is an object: set, unset or recipe");
    if (of.contains("set")) {
        return SetKey{text_at(of, "set"), text_at(of, "value")};
    }
    if (of.contains("unset")) {
        return UnsetKey{text_at(of, "unset")};
    }
    refuse_if<BadInput>(!of.contains("recipe"), "studio.request: a step has set and value, unset, or recipe");
    return ReplaceRecipe{text_at(of, "recipe")};
}

Edit edit_of(ordered_json const& request) {
    constexpr std::size_t most_steps = 1000;
    auto const found = request.find("edit");
    refuse_if<BadInput>(found == request.end() || !found->is_object(), "studio.request: there is no edit in it");
    Edit edit;
    edit.name = found->contains("name") ? text_at(*found, "name") : "";
    auto const steps = found->find("steps");
    refuse_if<BadInput>(steps == found->end() || !steps->is_array() || steps->empty() || steps->size() > most_steps,
                        "studio.request: an edit has a list of 1 to {} steps", most_steps);
    for (ordered_json const& step : *steps) {
        edit.steps.push_back(step_of(step));
    }
    return edit;
}

ordered_json object_in(std::string_view text) {
    ordered_json request = ordered_json::parse(text, nullptr, false);
    refuse_if<BadInput>(!request.is_object(), "studio.request: a message is one JSON object");
    return request;
}

std::int64_t id_in(ordered_json const& request) {
    auto const id = request.find("id");
    return id != request.end() && id->is_number_integer() ? id->get<std::int64_t>() : 0;
}

} // namespace

Request request_of(std::string_view text) {
    static std::map<std::string, Request::Kind> const kinds{
        {"edit", Request::Kind::edit}, {"try", Request::Kind::attempt},  {"undo", Request::Kind::undo},
        {"redo", Request::Kind::redo}, {"export", Request::Kind::write}, {"stop", Request::Kind::stop}};
    ordered_json const request = object_in(text);
    auto const kind = kinds.find(text_at(request, "do"));
    refuse_if<BadInput>(kind == kinds.end(), "studio.request: do is one of edit, try, undo, redo, export, stop");
    Request result{id_in(request), kind->second};
    if (result.kind == Request::Kind::edit || result.kind == Request::Kind::attempt) {
        result.edit = edit_of(request);
    }
    if (result.kind == Request::Kind::write && request.contains("file")) {
        result.file = text_at(request, "file");
    }
    return result;
}

std::int64_t id_of(std::string_view text) {
    ordered_json const request = ordered_json::parse(text, nullptr, false);
    return request.is_object() ? id_in(request) : 0;
}

std::string page_parameters(std::string const& folder) {
    ordered_json keys = ordered_json::array();
    for (pipeline::KeyHelp const& key : pipeline::recipe_keys()) {
        keys.push_back({{"path", key.path},
                        {"type", key.type},
                        {"range", key.range},
                        {"low", or_null(key.least)},
                        {"high", or_null(key.most)},
                        {"unit", key.unit},
                        {"standard", key.standard},
                        {"meaning", key.meaning},
                        {"choices", key.choices},
                        {"used_by", key.used_by},
                        {"is_file", key.is_file}});
    }
    return text_of({{"version", pipeline::version()}, {"folder", folder}, {"keys", std::move(keys)}});
}

std::string document_message(Document const& document, History const& history, std::string const& command) {
    ordered_json values = ordered_json::object();
    std::vector<std::string> sections;
    for (pipeline::KeyValue const& value : pipeline::key_values(document.recipe)) {
        values[value.path] = value.text ? ordered_json(*value.text) : ordered_json(nullptr);
        std::string const section = value.path.substr(0, value.path.rfind('.'));
        if (section != value.path && (sections.empty() || sections.back() != section)) {
            sections.push_back(section);
        }
    }
    auto const last = [](std::vector<Change> const& changes) {
        return changes.empty() ? std::string() : name_of(changes.back().edit);
    };
    return text_of({{"type", "document"},
                    {"revision", document.revision},
                    {"recipe", document.toml},
                    {"values", std::move(values)},
                    {"sections", sections},
                    {"undo", last(history.done)},
                    {"redo", last(history.undone)},
                    {"command", command}});
}

std::string busy_message(Job const& job, std::string_view stage, double share) {
    return text_of({{"type", "busy"},
                    {"job", job.number},
                    {"revision", job.revision},
                    {"stage", std::string(stage)},
                    {"share", share}});
}

std::string idle_message(Job const& job, double seconds, JobEnd end) {
    return text_of({{"type", "idle"},
                    {"job", job.number},
                    {"revision", job.revision},
                    {"seconds", seconds},
                    {"stopped", end == JobEnd::stopped}});
}

std::string failed_message(Job const& job, std::string_view error) {
    return text_of(
        {{"type", "failed"}, {"job", job.number}, {"revision", job.revision}, {"error", std::string(error)}});
}

std::string say_message(std::string_view text) {
    return text_of({{"type", "say"}, {"text", std::string(text)}});
}

std::string cluster_message(Job const& job, std::optional<pipeline::ClusterArms> const& arms) {
    if (!arms) {
        return text_of({{"type", "cluster"}, {"job", job.number}, {"width", 0}, {"height", 0}, {"arms", ""}});
    }
    return text_of({{"type", "cluster"},
                    {"job", job.number},
                    {"width", arms->width},
                    {"height", arms->height},
                    {"arms", arms->arms},
                    {"chosen", arms->chosen}});
}

std::string scene_message(Job const& job, std::string_view level, std::string const& members) {
    return fmt::format(R"({{"type":"scene","job":{},"revision":{},"level":"{}",{}}})", job.number, job.revision, level,
                       members);
}

std::string done_message(std::int64_t id, std::int64_t revision, std::int64_t job) {
    return text_of({{"type", "reply"}, {"id", id}, {"ok", true}, {"revision", revision}, {"job", job}});
}

std::string refused_message(std::int64_t id, std::string_view error) {
    return text_of({{"type", "reply"}, {"id", id}, {"ok", false}, {"error", std::string(error)}});
}

std::string written_message(std::int64_t id, std::int64_t revision, Written const& written) {
    return text_of({{"type", "reply"},
                    {"id", id},
                    {"ok", true},
                    {"revision", revision},
                    {"folder", written.folder},
                    {"files", written.files},
                    {"url", written.url}});
}

namespace {

/// The values of a tile, cut at the raster's edge, row by row.
std::vector<float> values_of_tile(Raster<float> const& raster, std::int64_t number) {
    std::int64_t const across = (raster.width() + tile - 1) / tile;
    std::int64_t const col = number % across * tile;
    std::int64_t const row = number / across * tile;
    std::int64_t const wide = std::min(tile, raster.width() - col);
    std::vector<float> values;
    values.reserve(static_cast<std::size_t>(tile * tile));
    for (std::int64_t r = row; r < std::min(row + tile, raster.height()); ++r) {
        auto const line = raster.row(r).subspan(static_cast<std::size_t>(col), static_cast<std::size_t>(wide));
        values.insert(values.end(), line.begin(), line.end());
    }
    return values;
}

bool have_same_bytes(std::vector<float> const& a, std::vector<float> const& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

} // namespace

std::string heights_message(Job const& job, Shown const& shown, Shown const* before) {
    Raster<float> const& values = shown.heights.values;
    bool const differs =
        before == nullptr || before->grid != shown.grid || before->heights.values.grid() != values.grid();
    std::int64_t const across = (values.width() + tile - 1) / tile;
    std::int64_t const count = across * ((values.height() + tile - 1) / tile);
    std::vector<std::int64_t> tiles;
    std::vector<float> payload;
    for (std::int64_t number = 0; number < count; ++number) {
        std::vector<float> const now = values_of_tile(values, number);
        if (differs || !have_same_bytes(now, values_of_tile(before->heights.values, number))) {
            tiles.push_back(number);
            payload.insert(payload.end(), now.begin(), now.end());
        }
    }
    std::string head = text_of({{"kind", "heights"},
                                {"job", job.number},
                                {"revision", job.revision},
                                {"level", shown.is_finished ? "full" : "coarse"},
                                {"grid", ordered_json::parse(pipeline::grid_json(shown.grid))},
                                {"width", values.width()},
                                {"height", values.height()},
                                {"cells", shown.heights.cells},
                                {"min", shown.heights.min},
                                {"max", shown.heights.max},
                                {"nodata", shown.heights.nodata},
                                {"sea", ordered_json::parse(pipeline::sea_json(shown.sea))},
                                {"tile", tile},
                                {"tiles", tiles}});
    head.append((4 - head.size() % 4) % 4, ' ');
    auto const length = static_cast<std::uint32_t>(head.size());
    std::string message(sizeof length + head.size() + payload.size() * sizeof(float), '\0');
    std::memcpy(message.data(), &length, sizeof length);
    std::memcpy(message.data() + sizeof length, head.data(), head.size());
    std::memcpy(message.data() + sizeof length + head.size(), payload.data(), payload.size() * sizeof(float));
    return message;
}

} // namespace thalweg::studio
