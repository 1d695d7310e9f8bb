// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/studio/internal/messages.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <iterator>
#include <map>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <thalweg/core/bounded_json.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/recipe/presets.hpp>
#include <thalweg/recipe/recipe.hpp>
#include <thalweg/report/report.hpp>

namespace thalweg::studio {
namespace {

using nlohmann::ordered_json;

static_assert(std::endian::native == std::endian::little, "heights travel as the processor has them");

constexpr std::int64_t tile = 64; // [values]
constexpr JsonBounds bounds_of_messages{.deepest = 8, .most_keys = 64};

std::string text_of(ordered_json const& message) {
    return message.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

ordered_json or_null(std::optional<double> const& number) {
    return number ? ordered_json(*number) : ordered_json(nullptr);
}

std::string text_at(ordered_json const& of, char const* name) {
    auto const found = of.find(name);
    refuse_if<BadInput>(found == of.end() || !found->is_string(), "studio.Studio", "{} must be a text", name);
    return found->get<std::string>();
}

Step step_of(ordered_json const& of) {
    refuse_if<BadInput>(!of.is_object(), "studio.Studio", "a step is an object: set, unset or recipe");
    if (of.contains("set")) {
        return SetKey{text_at(of, "set"), text_at(of, "value")};
    }
    if (of.contains("unset")) {
        return UnsetKey{text_at(of, "unset")};
    }
    refuse_if<BadInput>(!of.contains("recipe"), "studio.Studio", "a step has set and value, unset, or recipe");
    return ReplaceRecipe{text_at(of, "recipe")};
}

Edit edit_of(ordered_json const& request) {
    constexpr std::size_t most_steps = 1000;
    constexpr std::size_t longest_name = 1000;
    auto const found = request.find("edit");
    refuse_if<BadInput>(found == request.end() || !found->is_object(), "studio.Studio", "there is no edit in it");
    Edit edit;
    edit.name = found->contains("name") ? text_at(*found, "name") : "";
    refuse_if<BadInput>(edit.name.size() > longest_name, "studio.Studio", "the name of an edit has at most {} bytes",
                        longest_name);
    auto const steps = found->find("steps");
    refuse_if<BadInput>(steps == found->end() || !steps->is_array() || steps->empty() || steps->size() > most_steps,
                        "studio.Studio", "an edit has a list of 1 to {} steps", most_steps);
    for (ordered_json const& step : *steps) {
        edit.steps.push_back(step_of(step));
    }
    return edit;
}

ordered_json object_in(std::string_view text) {
    auto request = bounded_json<ordered_json>(text, bounds_of_messages);
    refuse_if<BadInput>(!request.is_object(), "studio.Studio",
                        "a message is one JSON object, nested up to {} deep and with up to {} names in an object",
                        bounds_of_messages.deepest, bounds_of_messages.most_keys);
    return request;
}

std::int64_t id_in(ordered_json const& request) {
    auto const id = request.find("id");
    return id != request.end() && id->is_number_integer() ? id->get<std::int64_t>() : 0;
}

/// A step of drawing as a page says it.
class StepReader {
public:
    StepReader(ordered_json what, Grid const& grid) : what_(std::move(what)), grid_(grid) {}

    DrawStep step() const {
        using R = StepReader;
        static constexpr std::pair<char const*, DrawStep (R::*)() const> verbs[] = {
            {"river", &R::river}, {"move", &R::move},         {"insert", &R::insert},       {"remove", &R::remove},
            {"cut", &R::cut},     {"join", &R::join},         {"reverse", &R::reverse},     {"erase", &R::erase},
            {"type", &R::type},   {"lambda", &R::set_lambda}, {"branching", &R::branching}, {"coast", &R::coast},
            {"swap", &R::swap},   {"lake", &R::lake},         {"level", &R::level},         {"mask", &R::mask},
            {"pin", &R::pin},     {"height", &R::set_height}, {"ridge", &R::ridge},         {"heights", &R::heights},
            {"clear", &R::clear}};
        std::string const verb = text_at(what_, "verb");
        auto const found = std::ranges::find_if(verbs, [&](auto const& one) { return one.first == verb; });
        std::vector<std::string> names;
        std::ranges::transform(verbs, std::back_inserter(names), [](auto const& one) { return one.first; });
        refuse_if<BadInput>(found == std::end(verbs), "studio.Studio", "verb is one of {}", fmt::join(names, ", "));
        return (this->*found->second)();
    }

private:
    DrawStep river() const { return DrawRiver{line(), text("type"), lambda()}; }
    DrawStep move() const { return MoveVertex{part(), index("vertex"), place("to"), reach()}; }
    DrawStep insert() const { return InsertVertex{part(), index("vertex"), place("at")}; }
    DrawStep remove() const { return RemoveVertex{part(), index("vertex")}; }
    DrawStep cut() const { return CutRiver{index("river"), place("at")}; }
    DrawStep join() const { return JoinRiver{index("river"), text("end") == "source", place("at")}; }
    DrawStep reverse() const { return ReverseRiver{index("river")}; }
    DrawStep erase() const { return Erase{part_in(what_), yes("alone")}; }
    DrawStep type() const { return SetType{rivers(), text("type")}; }
    DrawStep set_lambda() const { return SetLambda{rivers(), lambda()}; }
    DrawStep branching() const { return SetSideStreams{yes("on")}; }
    DrawStep coast() const { return DrawCoast{line()}; }
    DrawStep swap() const { return SwapSides{index("coast")}; }
    DrawStep lake() const { return DrawLake{line(), metres_or_none("level")}; }
    DrawStep level() const { return SetLevel{index("lake"), metres_or_none("level")}; }
    DrawStep mask() const { return DrawMask{line()}; }
    DrawStep pin() const { return DrawPin{place("at"), height()}; }
    DrawStep set_height() const { return SetHeight{index("pin"), height()}; }
    DrawStep ridge() const { return DrawRidge{line(), metres_or_none("from"), metres_or_none("to")}; }
    DrawStep heights() const { return SetRidgeHeights{index("ridge"), metres_or_none("from"), metres_or_none("to")}; }
    DrawStep clear() const { return Clear{}; } // NOLINT(readability-convert-member-functions-to-static): in the table

    static std::size_t index(ordered_json const& of, char const* name) {
        auto const found = of.find(name);
        bool const is_one =
            found != of.end() && found->is_number_integer() && (found->is_number_unsigned() || *found >= 0);
        refuse_if<BadInput>(!is_one, "studio.Studio", "{} must be a number from 0", name);
        return found->get<std::size_t>();
    }
    std::size_t index(char const* name) const { return index(what_, name); }

    static double number(ordered_json const& value) {
        refuse_if<BadInput>(!value.is_number(), "studio.Studio", "a place is made of numbers");
        return value.get<double>();
    }

    Vec2 metres(double x, double y) const { return {grid_.west + x * grid_.cell_m, grid_.north - y * grid_.cell_m}; }

    Vec2 place(char const* name) const {
        auto const found = what_.find(name);
        refuse_if<BadInput>(found == what_.end() || !found->is_array() || found->size() != 2, "studio.Studio",
                            "{} must be a place [x, y]", name);
        return metres(number((*found)[0]), number((*found)[1]));
    }

    DrawnLine line() const {
        auto const found = what_.find("points");
        refuse_if<BadInput>(found == what_.end() || !found->is_array() || found->size() % 2 != 0, "studio.Studio",
                            "points must be a list [x, y, x, y, ...]");
        DrawnLine line;
        for (std::size_t i = 0; i + 1 < found->size(); i += 2) {
            line.push_back(metres(number((*found)[i]), number((*found)[i + 1])));
        }
        return line;
    }

    std::string text(char const* name) const { return what_.contains(name) ? text_at(what_, name) : ""; }
    bool yes(char const* name) const { return what_.value(name, ordered_json(false)) == true; }
    int lambda() const {
        constexpr std::size_t most = 1000;
        return what_.contains("lambda") ? static_cast<int>(std::min(index("lambda"), most)) : 0;
    }
    double reach() const {
        return what_.contains("reach") ? std::max(0.0, number(what_["reach"])) * grid_.cell_m : 0.0;
    }
    std::optional<double> metres_or_none(char const* name) const {
        auto const found = what_.find(name);
        bool const is_none = found == what_.end() || found->is_null();
        refuse_if<BadInput>(!is_none && !found->is_number(), "studio.Studio", "{} must be a number [m] or null", name);
        return is_none ? std::nullopt : std::optional(found->get<double>());
    }
    double height() const {
        auto const height_m = metres_or_none("height");
        refuse_if<BadInput>(!height_m, "studio.Studio", "height must be a number [m]");
        return *height_m;
    }
    std::vector<std::size_t> rivers() const {
        auto const found = what_.find("rivers");
        refuse_if<BadInput>(found == what_.end() || !found->is_array(), "studio.Studio", "rivers must be a list");
        std::vector<std::size_t> all;
        for (ordered_json const& one : *found) {
            all.push_back(index({{"river", one}}, "river"));
        }
        return all;
    }
    static Part part_in(ordered_json const& of) {
        static constexpr std::pair<char const*, Part::Kind> kinds[] = {
            {"river", Part::Kind::river}, {"coast", Part::Kind::coast}, {"lake", Part::Kind::lake},
            {"mask", Part::Kind::mask},   {"pin", Part::Kind::pin},     {"ridge", Part::Kind::ridge}};
        auto const kind =
            std::ranges::find_if(kinds, [&](auto const& one) { return of.is_object() && of.contains(one.first); });
        refuse_if<BadInput>(kind == std::end(kinds), "studio.Studio",
                            "a part is a river, coast, lake, mask, pin or ridge");
        return {kind->second, index(of, kind->first)};
    }
    Part part() const { return part_in(what_.value("of", ordered_json::object())); }

    ordered_json what_;
    Grid const& grid_;
};

/// [cells] to a ten thousandth
double short_number(double v) {
    constexpr double parts = 1e4;
    return std::round(v * parts) / parts;
}

ordered_json numbers_of(DrawnLine const& line, Grid const& grid) {
    ordered_json numbers = ordered_json::array();
    for (Vec2 const p : line) {
        Vec2 const at = in_cells(grid, p);
        numbers.push_back(short_number(at.x));
        numbers.push_back(short_number(at.y));
    }
    return numbers;
}

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

Request request_of(std::string_view text) {
    static std::map<std::string, Request::Kind> const kinds{
        {"edit", Request::Kind::edit}, {"try", Request::Kind::attempt},  {"undo", Request::Kind::undo},
        {"redo", Request::Kind::redo}, {"export", Request::Kind::write}, {"stop", Request::Kind::stop},
        {"draw", Request::Kind::draw}};
    ordered_json const request = object_in(text);
    auto const kind = kinds.find(text_at(request, "do"));
    refuse_if<BadInput>(kind == kinds.end(), "studio.Studio", "do is one of edit, try, undo, redo, export, stop, draw");
    Request result{id_in(request), kind->second};
    if (result.kind == Request::Kind::edit || result.kind == Request::Kind::attempt) {
        result.edit = edit_of(request);
    }
    if (result.kind == Request::Kind::write && request.contains("file")) {
        result.file = text_at(request, "file");
    }
    if (result.kind == Request::Kind::draw) {
        auto const what = request.find("what");
        refuse_if<BadInput>(what == request.end() || !what->is_object(), "studio.Studio", "there is no step in it");
        result.step = [what = *what](Grid const& grid) { return StepReader(what, grid).step(); };
        auto const revision = request.find("revision");
        bool const has_one = revision != request.end() && revision->is_number_integer();
        result.revision = has_one ? revision->get<std::int64_t>() : -1;
    }
    return result;
}

DrawStep draw_step(std::string_view what, Grid const& grid) {
    return StepReader(object_in(what), grid).step();
}

std::int64_t id_of(std::string_view text) {
    auto const request = bounded_json<ordered_json>(text, bounds_of_messages);
    return request.is_object() ? id_in(request) : 0;
}

std::string page_parameters(std::string const& folder) {
    ordered_json keys = ordered_json::array();
    for (recipe::KeyHelp const& key : recipe::recipe_keys()) {
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
    ordered_json presets = ordered_json::array();
    for (recipe::Preset const& preset : recipe::presets()) {
        presets.push_back(
            {{"name", preset.name},
             {"meaning", preset.meaning},
             {"not_meant", preset.not_meant},
             {"recipe", recipe::write_recipe(recipe::with_preset(recipe::default_recipe(), preset.name))}});
    }
    return text_of({{"version", report::version()},
                    {"folder", folder},
                    {"keys", std::move(keys)},
                    {"presets", std::move(presets)}});
}

std::string document_message(Document const& document, History const& history, std::string const& command) {
    ordered_json values = ordered_json::object();
    std::vector<std::string> sections;
    for (recipe::KeyValue const& value : recipe::key_values(document.recipe)) {
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

std::string findings_message(Job const& job, std::vector<Finding> const& findings) {
    std::vector<Finding> printed;
    std::ranges::copy_if(findings, std::back_inserter(printed),
                         [](Finding const& finding) { return finding.kind.row().printed == Printed::always; });
    return text_of({{"type", "findings"},
                    {"job", job.number},
                    {"revision", job.revision},
                    {"count", findings.size()},
                    {"list", ordered_json::parse(report::findings_json(printed))}});
}

std::string cluster_message(Job const& job, std::optional<report::ClusterArms> const& arms) {
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

std::string done_message(std::int64_t id, std::int64_t revision, std::int64_t job,
                         std::vector<std::string> const& said) {
    ordered_json message{{"type", "reply"}, {"id", id}, {"ok", true}, {"revision", revision}, {"job", job}};
    if (!said.empty()) {
        message["said"] = said;
    }
    return text_of(message);
}

std::string refused_message(std::int64_t id, std::string_view error, std::optional<Vec2> at) {
    ordered_json message{{"type", "reply"}, {"id", id}, {"ok", false}, {"error", std::string(error)}};
    if (at) {
        message["at"] = {short_number(at->x), short_number(at->y)};
    }
    return text_of(message);
}

Vec2 in_cells(Grid const& grid, Vec2 at) {
    return {(at.x - grid.west) / grid.cell_m, (grid.north - at.y) / grid.cell_m};
}

std::string drawing_message(Drawing const& drawing, std::int64_t revision, bool is_drawn) {
    Grid const& grid = drawing.grid;
    ordered_json rivers = ordered_json::array();
    for (DrawnRiver const& river : drawing.rivers) {
        rivers.push_back({{"line", numbers_of(river.line, grid)}, {"type", river.type}, {"lambda", river.lambda}});
    }
    ordered_json coasts = ordered_json::array();
    for (DrawnLine const& coast : drawing.coasts) {
        coasts.push_back(numbers_of(coast, grid));
    }
    ordered_json lakes = ordered_json::array();
    for (DrawnLake const& lake : drawing.lakes) {
        lakes.push_back({{"ring", numbers_of(lake.rings.front(), grid)}, {"level", or_null(lake.level_m)}});
    }
    ordered_json masks = ordered_json::array();
    for (DrawnLine const& mask : drawing.masks) {
        masks.push_back(numbers_of(mask, grid));
    }
    ordered_json pins = ordered_json::array();
    for (DrawnPin const& pin : drawing.pins) {
        pins.push_back({{"at", numbers_of({pin.at}, grid)}, {"height", pin.height_m}});
    }
    ordered_json ridges = ordered_json::array();
    for (DrawnRidge const& ridge : drawing.ridges) {
        ridges.push_back({{"line", numbers_of(ridge.line, grid)},
                          {"from", or_null(ridge.heights_m.front())},
                          {"to", or_null(ridge.heights_m.back())}});
    }
    return text_of({{"type", "drawing"},
                    {"revision", revision},
                    {"kind", is_drawn ? "drawn" : "shown"},
                    {"branching", drawing.has_side_streams},
                    {"grid", ordered_json::parse(report::grid_json(grid))},
                    {"rivers", std::move(rivers)},
                    {"coasts", std::move(coasts)},
                    {"lakes", std::move(lakes)},
                    {"masks", std::move(masks)},
                    {"pins", std::move(pins)},
                    {"ridges", std::move(ridges)}});
}

std::string written_message(std::int64_t id, std::int64_t revision, WrittenFolder const& written) {
    return text_of({{"type", "reply"},
                    {"id", id},
                    {"ok", true},
                    {"revision", revision},
                    {"folder", written.folder},
                    {"files", written.files},
                    {"url", written.url}});
}

std::string heights_message(Job const& job, ShownHeights const& shown, ShownHeights const* before) {
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
                                {"grid", ordered_json::parse(report::grid_json(shown.grid))},
                                {"width", values.width()},
                                {"height", values.height()},
                                {"cells", shown.heights.cells},
                                {"min", shown.heights.min},
                                {"max", shown.heights.max},
                                {"nodata", shown.heights.nodata},
                                {"sea", ordered_json::parse(report::sea_json(shown.sea))},
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
