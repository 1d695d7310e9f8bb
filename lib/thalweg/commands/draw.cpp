// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/commands/draw.hpp>

#include <algorithm>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/run/messages.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/ensemble/draw_ensemble.hpp>
#include <thalweg/report/page.hpp>
#include <thalweg/report/read_scene.hpp>

namespace thalweg::commands {
namespace {

namespace fs = std::filesystem;

constexpr ensemble::NamedFormat formats[] = {
    {"png", draw::Format::png}, {"svg", draw::Format::svg}, {"pdf", draw::Format::pdf}};

constexpr char const* page_word = "page";
constexpr char const* page_ending = ".html";
constexpr char const* ensemble_word = "ensemble";

[[noreturn]] void unknown(char const* what, std::string const& word, std::vector<std::string> const& known) {
    throw BadParameter("commands.run_draw", fmt::format("unknown {1} '{0}'; there are {2}.{3}", word, what,
                                                        fmt::join(known, ", "), did_you_mean(word, known)));
}

report::PictureKind kind_of(std::string const& word) {
    std::vector<std::string> known;
    for (report::PictureKind const kind : report::picture_kinds()) {
        if (word == name_of(kind)) {
            return kind;
        }
        known.emplace_back(name_of(kind));
    }
    known.emplace_back(page_word);
    known.emplace_back(ensemble_word);
    unknown("picture", word, known);
}

ensemble::NamedFormat format_of(std::string const& word) {
    std::vector<std::string> known;
    for (ensemble::NamedFormat const& format : formats) {
        if (word == format.name) {
            return format;
        }
        known.emplace_back(format.name);
    }
    unknown("format", word, known);
}

/// An output file: a picture, or without a kind the report page.
struct Task {
    std::optional<report::PictureKind> kind;
    draw::Format format = draw::Format::png;
    std::string name;
};

/// The requested output, determined before anything is read.
struct Order {
    std::string folder;
    std::string single; ///< name of the single picture; "": a folder
    std::vector<report::PictureKind> kinds;
    std::vector<ensemble::NamedFormat> formats;
    bool page = false;
    bool ensemble = false; ///< of a table, and nothing else
    bool everything() const { return kinds.empty() && !page; }
};

template <class T, class Same> void add_once(std::vector<T>& list, T const& item, Same const& same) {
    if (std::none_of(list.begin(), list.end(), [&](T const& other) { return same(other, item); })) {
        list.push_back(item);
    }
}

Order order_of(DrawParams const& params) {
    std::string const& output = params.output;
    Order order;
    for (std::string const& word : params.what) {
        if (word == page_word) {
            order.page = true;
            continue;
        }
        if (word == ensemble_word) {
            order.ensemble = true;
            continue;
        }
        add_once(order.kinds, kind_of(word), [](report::PictureKind a, report::PictureKind b) { return a == b; });
    }
    for (std::string const& word : params.formats) {
        add_once(order.formats, format_of(word),
                 [](ensemble::NamedFormat const& a, ensemble::NamedFormat const& b) { return a.format == b.format; });
    }
    refuse_if<BadParameter>(order.ensemble && (order.page || !order.kinds.empty()), "commands.run_draw",
                            "an ensemble is drawn by itself: leave out the other kinds");
    refuse_if<BadParameter>(output.empty(), "commands.run_draw", "the name of the output is empty");
    fs::path const path(output);
    std::string const ending = path.extension().string();
    bool const is_folder = fs::is_directory(path);
    bool const is_page = !is_folder && ending == page_ending;
    bool const is_picture = !is_folder && std::any_of(std::begin(formats), std::end(formats), [&](auto const& f) {
        return ending == std::string(".") + f.name;
    });
    order.folder = output;
    if (is_page || is_picture) {
        order.single = path.filename().string();
        order.folder = path.has_parent_path() ? path.parent_path().string() : ".";
    }
    if (is_page) {
        refuse_if<BadParameter>(!order.kinds.empty() || !order.formats.empty(), "commands.run_draw",
                                "{} is the name of a page: name a folder for pictures", output);
        order.page = true;
    } else if (is_picture) {
        ensemble::NamedFormat const own = format_of(ending.substr(1));
        bool const other = std::any_of(order.formats.begin(), order.formats.end(),
                                       [&](ensemble::NamedFormat const& f) { return f.format != own.format; });
        refuse_if<BadParameter>(order.kinds.size() > 1 || other || order.page, "commands.run_draw",
                                "{} is the name of one picture in one format: name a folder for several", output);
        if (order.kinds.empty() && !order.ensemble) {
            order.kinds = {report::PictureKind::map};
        }
        order.formats = {own};
    } else if (order.formats.empty()) {
        order.formats = {formats[order.ensemble ? 1 : 0]};
    }
    return order;
}

std::vector<Task> tasks_of(Order const& order, report::Scene const& scene) {
    std::vector<Task> tasks;
    if (order.page) {
        tasks.push_back({{}, {}, order.single.empty() ? std::string(page_word) + page_ending : order.single});
    }
    for (report::PictureKind const kind : order.everything() ? report::picture_kinds() : order.kinds) {
        std::string const missing = report::missing_for(kind, scene);
        if (!missing.empty() && order.everything()) {
            continue;
        }
        if (!missing.empty()) {
            throw BadInput("commands.run_draw", fmt::format("no {} can be drawn: {}", name_of(kind), missing));
        }
        for (ensemble::NamedFormat const& format : order.formats) {
            tasks.push_back({kind, format.format,
                             order.single.empty() ? fmt::format("{}.{}", name_of(kind), format.name) : order.single});
        }
    }
    return tasks;
}

std::string command_of(DrawParams const& params) {
    std::string command =
        fmt::format("thalweg draw {} -o {} --what page", for_shell(params.source), for_shell(params.output));
    if (!params.network.empty()) {
        command += " --network " + for_shell(params.network);
    }
    if (!params.title.empty()) {
        command += " --title " + for_shell(params.title);
    }
    return command;
}

std::string command_for_ensemble(DrawParams const& params) {
    std::string command =
        fmt::format("thalweg draw {} --what ensemble -o {}", for_shell(params.source), for_shell(params.output));
    if (!params.title.empty()) {
        command += " --title " + for_shell(params.title);
    }
    return command;
}

/// An ensemble has no network, no-data value or viewing direction.
DrawResult draw_members(DrawParams const& params, Order const& order, Run const& run) {
    refuse_if<BadParameter>(!params.network.empty() || params.reading != io::ReadDemParams{} ||
                                params.look.azimuth_deg || params.look.elevation_deg || params.look.exaggeration,
                            "commands.run_draw",
                            "an ensemble has no network, no-data value or viewing direction: leave out --network, "
                            "--nodata, --azimuth, --elevation and --exaggeration");
    ensemble::DrawnEnsemble drawn = ensemble::draw_ensemble({.source = params.source,
                                                             .title = params.title,
                                                             .look = params.look,
                                                             .folder = order.folder,
                                                             .single = order.single,
                                                             .existing = params.existing,
                                                             .formats = order.formats,
                                                             .page = order.page,
                                                             .command = command_for_ensemble(params)},
                                                            run);
    return {std::move(drawn.files), std::move(drawn.findings)};
}

} // namespace

DrawResult run_draw(DrawParams const& params, Run const& run) {
    Order const order = order_of(params);
    if (order.ensemble) {
        return draw_members(params, order, run);
    }
    report::SceneRead read =
        report::read_scene({.source = params.source, .network = params.network, .reading = params.reading}, run);
    if (!params.title.empty()) {
        read.scene.title = params.title;
    }
    std::vector<Task> const tasks = tasks_of(order, read.scene);
    std::vector<std::string> names(tasks.size());
    std::transform(tasks.begin(), tasks.end(), names.begin(), [](Task const& task) { return task.name; });
    io::OutputFolder out(order.folder, io::Existing::add, io::files_there(order.folder, names, params.existing));
    DrawResult drawn{{}, std::move(read.findings)};
    for (std::size_t i = 0; i < tasks.size(); ++i) {
        run.at(static_cast<double>(i) / static_cast<double>(tasks.size()),
               tasks[i].kind ? name_of(*tasks[i].kind) : page_word);
        report::Look look = params.look;
        look.format = tasks[i].format;
        io::write_text(out.path(tasks[i].name),
                       tasks[i].kind
                           ? report::draw_picture(*tasks[i].kind, read.scene, look, run).bytes
                           : report::scene_page(read.scene, texts_of(drawn.findings), command_of(params), run));
        drawn.files.push_back(order.folder == "." && !order.single.empty()
                                  ? tasks[i].name
                                  : (fs::path(order.folder) / tasks[i].name).string());
    }
    run.at(1.0, "draw");
    out.commit();
    run.report(drawn.findings);
    return drawn;
}

} // namespace thalweg::commands
