// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/studio/studio.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <filesystem>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <thalweg/core/run/messages.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/report/live_page.hpp>
#include <thalweg/report/report.hpp>
#include <thalweg/studio/document_folder.hpp>
#include <thalweg/studio/drawing.hpp>
#include <thalweg/studio/drawing_files.hpp>
#include <thalweg/studio/engine.hpp>
#include <thalweg/studio/internal/messages.hpp>

namespace thalweg::studio {
namespace {

namespace fs = std::filesystem;

using Clock = std::chrono::steady_clock;

std::string type_of(std::string const& name) {
    static constexpr std::pair<std::string_view, char const*> types[] = {{".html", "text/html; charset=utf-8"},
                                                                         {".json", "application/json"},
                                                                         {".svg", "image/svg+xml"},
                                                                         {".png", "image/png"},
                                                                         {".tif", "image/tiff"},
                                                                         {".toml", "application/toml"}};
    std::string const ending = fs::path(name).extension().string();
    auto const* const found = std::ranges::find(types, ending, [](auto const& type) { return type.first; });
    return found == std::end(types) ? "application/octet-stream" : found->second;
}

Job job_of(Document const& document) {
    return {document.revision, document.recipe, document.toml};
}

/// Rivers of a recipe as they were made last, for who edits them.
struct ShownRivers {
    std::string toml; ///< of the recipe
    Grid grid;
    StreamNetwork network = {};
    Mask land = {};
    AttributeTable attributes = {};
    bool has_heights = false; ///< of a file
    std::int64_t told = 0;    ///< number of the job whose rivers the pages have
};

bool has_random_points(recipe::Recipe const& recipe) {
    return recipe.skeleton && recipe.skeleton->scatter > 0;
}

std::string mask_of(recipe::Recipe const& recipe) {
    return recipe.surface ? recipe.surface->mask : "";
}

double seconds_since(Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

} // namespace

/// Document, engine and server. The server's thread edits, the engine's tells what comes of it, a third one writes.
class StudioSession {
public:
    explicit StudioSession(StudioParams params)
        : params_(std::move(params)), folder_(params_.folder),
          server_(params_.serve, {.get = [this](std::string const& path) { return answer(path); },
                                  .opened = [this](serve::Client client) { welcome(client); },
                                  .text = [this](serve::Client client, std::string_view text) { hear(client, text); }}),
          engine_(watcher(), params_.threads) {}

    std::string address() const { return server_.address(); }

    void run(std::stop_token const& stop) {
        begin();
        server_.run(stop);
        writing_ = {}; // asked to stop, and waited for
        engine_.stop();
    }

private:
    // On the server's thread.

    std::optional<serve::Answer> answer(std::string const& path) {
        if (path.empty()) {
            report::LivePage page = report::live_page(recipe::title_of(folder_.document().recipe),
                                                      page_parameters(fs::absolute(params_.folder).string()));
            return serve::Answer{std::move(page.html), "text/html; charset=utf-8", std::move(page.policy)};
        }
        constexpr std::string_view files = "files/";
        constexpr std::int64_t largest = std::int64_t{1} << 31;
        WrittenFolder const written = [this] { // reading may take long
            std::scoped_lock const lock(guard_);
            return written_;
        }();
        if (!path.starts_with(files) ||
            std::ranges::find(written.files, path.substr(files.size())) == written.files.end()) {
            return std::nullopt;
        }
        std::string const name = path.substr(files.size());
        std::string const file = (fs::path(written.folder) / name).string();
        std::error_code error;
        refuse_if<BadInput>(!fs::is_regular_file(fs::symlink_status(file, error)), "studio.Studio",
                            "{} is no longer there: export it again.", file);
        return serve::Answer{io::read_text(file, largest), type_of(name)};
    }

    void welcome(serve::Client client) {
        std::scoped_lock const lock(guard_);
        server_.send_text(client, document_words());
        for (std::string const& words : folder_.notes()) {
            server_.send_text(client, say_message(words));
        }
        if (!drawing_words_.empty()) {
            server_.send_text(client, drawing_words_);
        }
        if (!cluster_.empty()) {
            server_.send_text(client, cluster_);
        }
        for (std::optional<ShownHeights> const* shown : {&coarse_, &full_}) {
            if (*shown) {
                server_.send_binary(client, heights_message(job_of_shown_, **shown, nullptr));
            }
        }
        if (!scene_.empty()) {
            server_.send_text(client, scene_);
        }
        if (!findings_.empty()) {
            server_.send_text(client, findings_);
        }
        server_.send_text(client, state_.empty() ? idle_message({}, 0.0) : state_);
    }

    void hear(serve::Client client, std::string_view text) {
        std::optional<Request> request;
        auto const refuse = [&](std::string_view why, std::optional<Vec2> const& at = {}) {
            server_.send_text(client, refused_message(request ? request->id : id_of(text), why, at));
        };
        try {
            request = request_of(text);
            obey(client, *request);
        } catch (NotDrawn const& error) {
            refuse(error.what(),
                   error.at && drawing_grid_ ? std::optional(in_cells(*drawing_grid_, *error.at)) : std::nullopt);
        } catch (Error const& error) {
            refuse(error.what());
        } catch (std::exception const& error) {
            refuse(fmt::format("this failed: {}", words_of(error)));
        }
    }

    void obey(serve::Client client, Request const& request) {
        std::vector<std::string> said;
        switch (request.kind) {
        case Request::Kind::edit:
            folder_.edit(request.edit);
            changed();
            break;
        case Request::Kind::undo:
            folder_.undo();
            changed();
            break;
        case Request::Kind::redo:
            folder_.redo();
            changed();
            break;
        case Request::Kind::attempt: {
            Document const tried = apply(folder_.document(), request.edit).document;
            if (!is_empty_sheet()) {
                engine_.make(job_of(tried));
                is_stale_ = true;
            }
            break;
        }
        case Request::Kind::stop:
            engine_.stop();
            is_stale_ = true;
            break;
        case Request::Kind::write: write(client, request); return; // answers when it is done
        case Request::Kind::draw: said = draw(request); break;
        }
        server_.send_text(client, done_message(request.id, folder_.document().revision, engine_.last(), said));
    }

    /// Draws a step. Returns what is to be said of it.
    std::vector<std::string> draw(Request const& request) {
        Document const& document = folder_.document();
        refuse_if<BadInput>(request.revision >= 0 && request.revision != document.revision, "studio.Studio",
                            "the document was changed meanwhile: draw on what is shown now");
        bool had_heights = false;
        Drawing const before = drawing_now(had_heights);
        drawing_grid_ = before.grid;
        DrawStep const step = request.step(before.grid);
        PutInput const put = [this](std::string const& key, std::string const& name,
                                    std::function<void(std::string const& path)> const& write) {
            return folder_.put(key, name, write);
        };
        DrawResult after = drawn(before, step);
        bool const was_drawn = is_drawn(document.recipe);
        std::string const mask_before = mask_of(document.recipe);
        Edit const edit = std::holds_alternative<Clear>(step) ? empty_sheet(document, before.grid, put)
                                                              : edit_between(document, before, after, put);
        if (edit.steps.empty()) {
            return after.said;
        }
        bool const had_raster = !mask_before.empty() && before.masks.empty();
        bool const had_random_points = has_random_points(document.recipe);
        folder_.edit(edit);
        if (had_raster && mask_of(document.recipe) != mask_before) {
            after.said.emplace_back("the raster that was the mask went; undo brings it back");
        }
        if (had_random_points && !has_random_points(document.recipe)) {
            after.said.emplace_back("the random points of skeleton.scatter went; undo brings them back");
        }
        if (!was_drawn && is_drawn(folder_.document().recipe) && !before.rivers.empty()) {
            after.said.push_back(fmt::format("the network is drawn lines now, {}; undo brings it back as it was{}",
                                             after.drawing.rivers.size(),
                                             had_heights ? "; the heights of its file did not come along" : ""));
        }
        drawing_ = std::move(after.drawing);
        drawing_files_ = files_of_drawing();
        changed();
        return after.said;
    }

    /// What the names of files say of a drawing.
    std::string files_of_drawing() const {
        recipe::Recipe const& recipe = folder_.document().recipe;
        if (!is_drawn(recipe) || !grid_of(recipe)) {
            return "";
        }
        Grid const grid = *grid_of(recipe);
        auto const skeleton = recipe.skeleton.value_or(recipe::SkeletonRecipe{});
        return fmt::format(
            "{}\n{}\n{}\n{}\n{}\n{}\n{} {} {} {} {} {}", recipe.network->lines.path, recipe.network->tokunaga.strokes,
            recipe.surface ? recipe.surface->equilibrium.lakes : std::string(), mask_of(recipe), skeleton.points,
            skeleton.ridge_lines, grid.width, grid.height, grid.cell_m, grid.west, grid.north, grid.crs);
    }

    /// The drawing of the document. Throws BadInput while its rivers are made.
    Drawing drawing_now(bool& had_heights) {
        if (drawing_) {
            return *drawing_;
        }
        recipe::Recipe const& recipe = folder_.document().recipe;
        ShownRivers rivers;
        {
            std::scoped_lock const lock(guard_);
            refuse_if<BadInput>(!shown_rivers_ || shown_rivers_->toml != folder_.document().toml, "studio.Studio",
                                "the rivers of this recipe are still being made: draw when they are there");
            rivers = *shown_rivers_;
        }
        had_heights = rivers.has_heights;
        return drawing_shown(recipe, rivers);
    }

    static Drawing drawing_shown(recipe::Recipe const& recipe, ShownRivers const& rivers) {
        Drawing drawing = read_drawing(recipe, rivers.grid);
        if (!is_drawn(recipe)) {
            Drawing shown = drawing_of(rivers.grid, rivers.network, rivers.land, rivers.attributes);
            drawing.rivers = std::move(shown.rivers);
            drawing.coasts = std::move(shown.coasts);
            drawing.attributes = std::move(shown.attributes);
        }
        return drawing;
    }

    void changed() {
        is_stale_ = false;
        {
            std::scoped_lock const lock(guard_);
            server_.send_text(serve::everyone, document_words());
        }
        begin();
    }

    /// Begins the terrain of the document, once there are rivers.
    void begin() {
        std::string fault;
        if (std::string files = files_of_drawing(); files.empty() || files != drawing_files_) {
            drawing_.reset();
            drawing_files_ = std::move(files);
        }
        recipe::Recipe const& recipe = folder_.document().recipe;
        if (!drawing_ && !drawing_files_.empty()) {
            try {
                drawing_ = read_drawing(recipe, *grid_of(recipe));
            } catch (Error const& error) { // the engine will say it too
                drawing_files_.clear();
            }
        }
        bool const is_empty = drawing_ && drawing_->rivers.empty();
        std::scoped_lock const lock(guard_);
        document_toml_ = folder_.document().toml;
        revision_ = folder_.document().revision;
        drawing_words_ = drawing_ ? drawing_message(*drawing_, revision_, true) : "";
        if (drawing_) {
            server_.send_text(serve::everyone, drawing_words_);
        }
        if (!is_empty) {
            engine_.make(job_of(folder_.document()));
            return;
        }
        engine_.stop();
        last_discarded_job_ = engine_.last(); // what is on its way of them is not shown any more
        Job nothing = job_of(folder_.document());
        nothing.number = last_discarded_job_;
        cluster_.clear();
        scene_.clear();
        findings_ = findings_message(nothing, {});
        server_.send_text(serve::everyone, findings_);
        coarse_.reset();
        full_.reset();
        state_ = idle_message(nothing, 0.0);
        server_.send_text(serve::everyone, state_);
    }

    bool is_empty_sheet() const { return drawing_ && drawing_->rivers.empty(); }

    std::string document_words() const { return document_message(folder_.document(), folder_.history(), command()); }

    /// The command that makes the terrain shown.
    std::string command() const {
        std::string const recipe = (fs::absolute(params_.folder) / "recipe.toml").lexically_normal().string();
        return fmt::format("thalweg make {} -o OUT", for_shell(recipe));
    }

    void write(serve::Client client, Request const& request) {
        refuse_if<BadInput>(is_writing_, "studio.Studio", "the last export is still being written; wait for it");
        refuse_if<BadInput>(is_empty_sheet(), "studio.Studio", "there is no river yet: draw one");
        if (is_stale_) {
            changed();
        }
        is_writing_ = true;
        writing_ = std::jthread([this, client, request, job = engine_.last(),
                                 revision = folder_.document().revision](std::stop_token const& stop) {
            std::string answer;
            try {
                answer = written_message(request.id, revision, written_now(job, request.file, stop));
            } catch (std::exception const& error) {
                answer = refused_message(request.id, words_of(error));
            }
            is_writing_ = false;
            server_.send_text(client, std::move(answer));
        });
    }

    // On the thread that writes.

    WrittenFolder written_now(std::int64_t job, std::string const& file, std::stop_token const& stop) {
        auto const made = engine_.wait(job, stop);
        refuse_if<BadInput>(made == nullptr, "studio.Studio",
                            "there is no terrain of this recipe to write: it failed, or the recipe was changed "
                            "meanwhile; export again when it is there");
        bool const is_whole = file.empty();
        fs::path const below = params_.export_folder.empty() ? params_.folder : params_.export_folder;
        fs::path const folder = is_whole ? below / "terrain" : fs::path(params_.folder) / ".terrain";
        refuse_if<BadInput>(fs::is_symlink(fs::symlink_status(folder)), "studio.Studio",
                            "{} is a link: remove it, or export elsewhere (--export)", folder.string());
        fs::create_directories(below);
        Run run;
        run.stop = stop;
        run.threads = params_.threads;
        WrittenFolder written;
        written.files = report::write_terrain(*made, folder.string(), io::Existing::replace, run);
        written.folder = fs::absolute(folder).lexically_normal().string();
        refuse_if<BadInput>(!is_whole && std::ranges::find(written.files, file) == written.files.end(), "studio.Studio",
                            "make writes no {} of this recipe", file);
        written.url = is_whole ? "" : "files/" + file;
        std::scoped_lock const lock(guard_);
        written_ = written;
        return written;
    }

    // On the engine's thread.

    Watcher watcher() {
        return {.at = [this](Job const& job, std::string_view stage, double share) { tell_share(job, stage, share); },
                .found = [this](Job const& job, std::vector<Finding> const& found) { show_findings(job, found); },
                .rivers = [this](Job const& job, recipe::Recipe const& recipe, make::Planform const& planform,
                                 Run const& run) { show_rivers(job, recipe, planform, run); },
                .heights = [this](Job const& job, Heights const& heights) { show_heights(job, heights); },
                .made = [this](Job const& job, make::MakeResult const& made) { show_scene(job, "land", made); },
                .measured =
                    [this](Job const& job, std::shared_ptr<make::MakeResult const> const& made) {
                        show_scene(job, "measured", *made);
                        end(job, idle_message(job, seconds_since(job.asked)));
                    },
                .failed = [this](Job const& job, std::string_view error) { end(job, failed_message(job, error)); },
                .stopped =
                    [this](Job const& job) {
                        if (job.number == engine_.last()) { // else the later one tells
                            end(job, idle_message(job, seconds_since(job.asked), JobEnd::stopped));
                        }
                    }};
    }

    void tell_share(Job const& job, std::string_view stage, double share) {
        constexpr double often_s = 0.1;
        bool const is_new = job.number != last_told_job_ || stage != last_told_stage_;
        if (is_new || seconds_since(told_at_) > often_s) {
            last_told_job_ = job.number;
            last_told_stage_ = stage;
            told_at_ = Clock::now();
            end(job, busy_message(job, stage, share));
        }
    }

    void show_findings(Job const& job, std::vector<Finding> const& found) {
        std::string findings = findings_message(job, found);
        std::scoped_lock const lock(guard_);
        if (job.number > last_discarded_job_) {
            findings_ = findings;
            server_.send_text(serve::everyone, std::move(findings));
        }
    }

    void show_rivers(Job const& job, recipe::Recipe const& recipe, make::Planform const& planform, Run const& run) {
        constexpr std::int64_t side = 256;
        std::string scene = scene_message(
            job, "rivers", report::live_scene(report::planform_preview(recipe, planform), job.toml, command(), run));
        std::string cluster = cluster_message(job, report::cluster_arms(recipe, side, run));
        ShownRivers shown{job.toml,
                          planform.grid,
                          planform.network,
                          planform.land,
                          planform.file.attributes,
                          planform.file_heights.has_value()};
        std::scoped_lock const lock(guard_);
        if (job.number <= last_discarded_job_) {
            return;
        }
        shown_rivers_ = std::move(shown);
        server_.send_text(serve::everyone, std::move(scene));
        cluster_ = cluster;
        server_.send_text(serve::everyone, std::move(cluster));
    }

    void show_heights(Job const& job, Heights const& given) {
        std::optional<report::LiveHeights> heights = report::live_heights(given.dem, given.grid);
        if (!heights) {
            return;
        }
        ShownHeights shown{given.grid, given.is_finished, std::move(*heights), given.sea};
        std::optional<ShownHeights>& before = given.is_finished ? full_ : coarse_;
        std::scoped_lock const lock(guard_);
        if (job.number <= last_discarded_job_) {
            return;
        }
        if (!job.recipe.network) {
            shown_rivers_ = ShownRivers{job.toml, given.grid};
        }
        server_.send_binary(serve::everyone, heights_message(job, shown, before ? &*before : nullptr));
        before = std::move(shown);
        job_of_shown_ = job;
    }

    void show_scene(Job const& job, char const* level, make::MakeResult const& made) {
        std::string scene = scene_message(job, level, report::live_scene(made, job.toml, command()));
        std::scoped_lock const lock(guard_);
        if (job.number <= last_discarded_job_) {
            return;
        }
        scene_ = scene;
        server_.send_text(serve::everyone, std::move(scene));
        if (!made.recipe.network) { // else it came with the rivers
            cluster_ = cluster_message(job, {});
            server_.send_text(serve::everyone, cluster_);
        }
        if (shown_rivers_ && shown_rivers_->toml == job.toml && shown_rivers_->told != job.number &&
            job.toml == document_toml_ && drawing_words_.empty()) {
            shown_rivers_->told = job.number;
            drawing_words_ =
                drawing_message(drawing_shown(job.recipe, *shown_rivers_), revision_, is_drawn(job.recipe));
            server_.send_text(serve::everyone, drawing_words_);
        }
    }

    void end(Job const& job, std::string state) {
        std::scoped_lock const lock(guard_);
        if (job.number <= last_discarded_job_) {
            return;
        }
        state_ = state;
        server_.send_text(serve::everyone, std::move(state));
    }

    StudioParams const params_;
    DocumentFolder folder_;
    bool is_stale_ = false; ///< the terrain shown is not that of the document: its job was stopped, or tried an edit
    std::optional<Drawing> drawing_;   ///< that files of the document hold; nothing: see shown_rivers_
    std::string drawing_files_;        ///< which
    std::optional<Grid> drawing_grid_; ///< of the last step
    std::atomic<bool> is_writing_ = false;

    std::mutex guard_; ///< of what follows: sent to all and to who comes later
    std::string cluster_;
    std::string scene_;
    std::string findings_; ///< of the last job
    std::string state_;
    std::optional<ShownHeights> coarse_;
    std::optional<ShownHeights> full_;
    Job job_of_shown_;
    WrittenFolder written_;
    std::optional<ShownRivers> shown_rivers_;
    std::string drawing_words_; ///< "": not known yet
    std::string document_toml_;
    std::int64_t revision_ = 0;
    std::int64_t last_discarded_job_ =
        0; ///< results of jobs up to this number are discarded: the sheet was emptied since

    Clock::time_point told_at_{}; ///< of the engine's thread, like what follows
    std::int64_t last_told_job_ = 0;
    std::string last_told_stage_;

    serve::Server server_;
    Engine engine_;        ///< after the server, which it tells
    std::jthread writing_; ///< the last member: it uses all others
};

std::string document_for(std::string const& input, std::string const& folder, bool is_blank, std::string const& preset,
                         Run const& run) {
    constexpr char const* usual = "studio";
    refuse_if<BadParameter>(is_blank && !input.empty(), "studio.document_for",
                            "studio: an empty sheet begins with nothing: leave out {}, or --blank", input);
    bool const is_new = is_blank || !preset.empty();
    refuse_if<BadParameter>(!preset.empty() && !input.empty() && is_document(input), "studio.document_for",
                            "studio: a preset begins a document, and {} is one: leave out --preset, and choose it on "
                            "the page",
                            input);
    std::string const meant = !input.empty() ? input : folder.empty() ? usual : folder;
    if (!is_new && is_document(meant)) {
        return meant;
    }
    std::string fresh = folder.empty() ? usual : folder;
    std::error_code unknown;
    for (int number = 2; folder.empty() && fs::exists(fresh, unknown) && !fs::is_empty(fresh, unknown); ++number) {
        fresh = fmt::format("{}-{}", usual, number);
    }
    is_blank ? new_sheet(fresh, preset) : new_document(fresh, input, preset, run);
    return fresh;
}

Studio::Studio(StudioParams params) : desk_(std::make_unique<StudioSession>(std::move(params))) {}
Studio::~Studio() = default;

std::string Studio::address() const {
    return desk_->address();
}

void Studio::run(std::stop_token const& stop) {
    desk_->run(stop);
}

} // namespace thalweg::studio
