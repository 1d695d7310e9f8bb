// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/commands/draw_files.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/messages.hpp>
#include <thalweg/pipeline/commands/internal/read_scene.hpp>
#include <thalweg/pipeline/report/internal/page.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <utility>

namespace thalweg::pipeline {

namespace {

namespace fs = std::filesystem;

struct NamedFormat {
    char const* name;
    draw::Format format;
};
constexpr NamedFormat formats[] = {{"png", draw::Format::png}, {"svg", draw::Format::svg}, {"pdf", draw::Format::pdf}};

constexpr char const* page_word = "page";
constexpr char const* page_ending = ".html";

[[noreturn]] void unknown(char const* what, std::string const& word, std::vector<std::string> const& known) {
    throw BadParameter(fmt::format("pipeline.draw_files: unknown {1} '{0}'; there are {2}.{3}", word, what,
                                   fmt::join(known, ", "), did_you_mean(word, known)));
}

PictureKind kind_of(std::string const& word) {
    std::vector<std::string> known;
    for (PictureKind const kind : picture_kinds()) {
        if (word == name_of(kind)) {
            return kind;
        }
        known.emplace_back(name_of(kind));
    }
    known.emplace_back(page_word);
    unknown("picture", word, known);
}

NamedFormat format_of(std::string const& word) {
    std::vector<std::string> known;
    for (NamedFormat const& format : formats) {
        if (word == format.name) {
            return format;
        }
        known.emplace_back(format.name);
    }
    unknown("format", word, known);
}

/// One file to be written: a picture, or without a kind the report page.
struct Task {
    std::optional<PictureKind> kind;
    draw::Format format = draw::Format::png;
    std::string name;
};

/// What is asked for, before anything is read.
struct Order {
    std::string folder;
    std::string single; ///< the name of the one picture; "" for a folder of them
    std::vector<PictureKind> kinds;
    std::vector<NamedFormat> formats;
    bool page = false;
    bool everything() const { return kinds.empty() && !page; }
};

template <class T, class Same> void add_once(std::vector<T>& list, T const& item, Same const& same) {
    if (std::none_of(list.begin(), list.end(), [&](T const& other) { return same(other, item); })) {
        list.push_back(item);
    }
}

Order order_of(std::string const& output, DrawParams const& params) {
    Order order;
    for (std::string const& word : params.what) {
        if (word == page_word) {
            order.page = true;
            continue;
        }
        add_once(order.kinds, kind_of(word), [](PictureKind a, PictureKind b) { return a == b; });
    }
    for (std::string const& word : params.formats) {
        add_once(order.formats, format_of(word),
                 [](NamedFormat const& a, NamedFormat const& b) { return a.format == b.format; });
    }
    if (output.empty()) {
        throw BadParameter("pipeline.draw_files: the name of the output is empty");
    }
    fs::path const path(output);
    std::string const ending = path.extension().string();
    if (!fs::is_directory(path) && ending == page_ending) {
        if (!order.kinds.empty() || !order.formats.empty()) {
            throw BadParameter(
                fmt::format("pipeline.draw_files: {} is the name of a page: name a folder for pictures", output));
        }
        order.page = true;
        order.single = path.filename().string();
        order.folder = path.has_parent_path() ? path.parent_path().string() : ".";
        return order;
    }
    bool const is_picture =
        !fs::is_directory(path) && std::any_of(std::begin(formats), std::end(formats),
                                               [&](auto const& f) { return ending == std::string(".") + f.name; });
    if (!is_picture) {
        order.folder = output;
        if (order.formats.empty()) {
            order.formats = {formats[0]};
        }
        return order;
    }
    NamedFormat const own = format_of(ending.substr(1));
    bool const other = std::any_of(order.formats.begin(), order.formats.end(),
                                   [&](NamedFormat const& f) { return f.format != own.format; });
    if (order.kinds.size() > 1 || other || order.page) {
        throw BadParameter(fmt::format("pipeline.draw_files: {} is the name of one picture in one format: name a "
                                       "folder for several",
                                       output));
    }
    if (order.kinds.empty()) {
        order.kinds = {PictureKind::map};
    }
    order.formats = {own};
    order.single = path.filename().string();
    order.folder = path.has_parent_path() ? path.parent_path().string() : ".";
    return order;
}

std::vector<Task> tasks_of(Order const& order, Scene const& scene) {
    std::vector<Task> tasks;
    if (order.page) {
        tasks.push_back({{}, {}, order.single.empty() ? std::string(page_word) + page_ending : order.single});
    }
    for (PictureKind const kind : order.everything() ? picture_kinds() : order.kinds) {
        std::string const missing = missing_for(kind, scene);
        if (!missing.empty() && order.everything()) {
            continue;
        }
        if (!missing.empty()) {
            throw BadInput(fmt::format("pipeline.draw_files: no {} can be drawn: {}", name_of(kind), missing));
        }
        for (NamedFormat const& format : order.formats) {
            tasks.push_back({kind, format.format,
                             order.single.empty() ? fmt::format("{}.{}", name_of(kind), format.name) : order.single});
        }
    }
    return tasks;
}

/// A word as a shell takes it.
std::string for_shell(std::string const& word) {
    bool const plain = !word.empty() && word.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                                               "0123456789_./+:=@%-") == std::string::npos;
    if (plain) {
        return word;
    }
    std::string out = "'";
    for (char const c : word) {
        out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    }
    return out + "'";
}

std::string command_of(std::string const& source, std::string const& output, DrawParams const& params) {
    std::string command = fmt::format("thalweg draw {} -o {} --what page", for_shell(source), for_shell(output));
    if (!params.network.empty()) {
        command += " --network " + for_shell(params.network);
    }
    if (!params.title.empty()) {
        command += " --title " + for_shell(params.title);
    }
    return command;
}

} // namespace

Drawn draw_files(std::string const& source, std::string const& output, DrawParams const& params, io::Existing existing,
                 Run const& run) {
    Order const order = order_of(output, params);
    SceneRead read = read_scene({source, params.nodata}, params.network, run);
    if (!params.title.empty()) {
        read.scene.title = params.title;
    }
    std::vector<Task> const tasks = tasks_of(order, read.scene);
    std::vector<std::string> there;
    for (Task const& task : tasks) {
        if (fs::exists(fs::symlink_status(fs::path(order.folder) / task.name))) {
            there.push_back(task.name);
        }
    }
    if (!there.empty() && existing == io::Existing::refuse) {
        throw BadInput(fmt::format("pipeline.draw_files: {} already exists: name another or use --overwrite",
                                   (fs::path(order.folder) / there.front()).string()));
    }
    io::OutputFolder out(order.folder, io::Existing::add, there);
    Drawn drawn{{}, std::move(read.notes)};
    for (std::size_t i = 0; i < tasks.size(); ++i) {
        run.at(static_cast<double>(i) / static_cast<double>(tasks.size()),
               tasks[i].kind ? name_of(*tasks[i].kind) : page_word);
        Look look = params.look;
        look.format = tasks[i].format;
        io::write_text(out.path(tasks[i].name),
                       tasks[i].kind ? draw_picture(*tasks[i].kind, read.scene, look, run).bytes
                                     : scene_page(read.scene, drawn.notes, command_of(source, output, params), run));
        drawn.files.push_back(order.folder == "." && !order.single.empty()
                                  ? tasks[i].name
                                  : (fs::path(order.folder) / tasks[i].name).string());
    }
    run.at(1.0, "draw");
    out.commit();
    return drawn;
}

} // namespace thalweg::pipeline
