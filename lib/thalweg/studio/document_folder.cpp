// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/studio/document_folder.hpp>

#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/recipe/make_input.hpp>
#include <thalweg/recipe/presets.hpp>
#include <thalweg/recipe/recipe_files.hpp>
#include <thalweg/studio/drawing_files.hpp>
#include <thalweg/studio/internal/journal.hpp>

namespace thalweg::studio {

namespace fs = std::filesystem;

namespace {

constexpr char const* recipe_name = "recipe.toml";
constexpr char const* history_name = "history.jsonl";
constexpr char const* lock_name = "history.lock";
constexpr std::int64_t largest_recipe = 2 << 20;
constexpr std::int64_t largest_history = 1 << 30;

[[noreturn]] void fail_at(std::string const& path) {
    throw IoError("studio.DocumentFolder", fmt::format("{}: {}", path, std::generic_category().message(errno)));
}

/// A recipe as the user's words or a folder of make give it, with the values of a preset.
recipe::Recipe first_recipe(std::string const& input, std::string const& preset) {
    std::string const made = (fs::path(input) / recipe_name).string();
    std::error_code ignored;
    recipe::Recipe recipe = input.empty() ? recipe::default_recipe()
                                          : recipe::recipe_from(fs::is_regular_file(made, ignored) ? made : input);
    return preset.empty() ? recipe : recipe::with_preset(std::move(recipe), preset);
}

/// Locks a document for this process. Throws BadInput where another has it.
int locked(std::string const& path) {
    int const file = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (file < 0) {
        fail_at(path);
    }
    if (flock(file, LOCK_EX | LOCK_NB) != 0) {
        bool const is_open = errno == EWOULDBLOCK;
        ::close(file);
        refuse_if<BadInput>(is_open, "studio.DocumentFolder", "{} is open in another window or process: close it there",
                            fs::path(path).parent_path().string());
        fail_at(path);
    }
    return file;
}

void replace_file(std::string const& path, std::string const& text) {
    io::OutputFile out(path, io::Existing::replace);
    io::write_text(out.staging(), text);
    out.commit();
}

/// Drops what was written of a line; if that fails too, it is an edit more when the document is opened again.
void forget_after(std::string const& path, std::int64_t bytes) {
    [[maybe_unused]] int const ignored = ::truncate(path.c_str(), bytes);
}

/// Throws BadInput for a file that lies elsewhere by a link.
void require_no_way_out(std::string const& folder, Document const& document) {
    std::error_code error;
    std::string const inputs = (fs::canonical(folder, error) / "inputs").string() + "/";
    for (std::string const& name : recipe::file_names(document.recipe)) {
        fs::path const place = fs::canonical(fs::path(folder) / name, error);
        refuse_if<BadInput>(!error && !place.string().starts_with(inputs), "studio.DocumentFolder",
                            "{} of {} leads out of inputs/ by a link: replace it by a copy", name, folder);
    }
}

/// A document with a text as it is.
Document unchanged(std::string const& toml) {
    return apply({}, {"", {ReplaceLines{0, "", toml}}}).document;
}

/// A name that nothing has: NAME, NAME.2, NAME.3.
std::string free_name(fs::path const& path) {
    fs::path free = path;
    for (int number = 2; fs::exists(fs::symlink_status(free)); ++number) {
        free = fmt::format("{}.{}", path.string(), number);
    }
    return free.string();
}

} // namespace

void new_document(std::string const& folder, std::string const& input, std::string const& preset, Run const& run) {
    io::OutputFolder out(folder);
    recipe::Recipe recipe = first_recipe(input, preset);
    recipe::UserFiles const files(recipe, run);
    if (recipe.grid.cell_m == 0.0) { // to be chosen from rivers, which no recipe file can say, or from a DEM
        recipe = recipe::settled_recipe(recipe, run);
    }
    recipe::check_recipe(recipe);
    Document const document = document_of(recipe::write_recipe(recipe::keep_inputs(recipe, out)));
    io::write_text(out.path(recipe_name), document.toml);
    io::write_text(out.path(history_name), line_of_beginning(document.toml));
    out.commit();
}

void new_sheet(std::string const& folder, std::string const& preset) {
    Grid const grid{512, 512, 30.0, 500000.0, 5000000.0, "EPSG:32631"};
    io::OutputFolder out(folder);
    Document const usual = document_of(recipe::write_recipe(first_recipe("", preset)));
    Edit const edit = empty_sheet(usual, grid,
                                  [&](std::string const& key, std::string const& name,
                                      std::function<void(std::string const& path)> const& write) {
                                      std::string const file = "inputs/1/" + name;
                                      write(out.path(file));
                                      return TakeInput{key, file};
                                  });
    Document const document = apply(usual, edit).document;
    io::write_text(out.path(recipe_name), document.toml);
    io::write_text(out.path(history_name), line_of_beginning(document.toml));
    out.commit();
}

bool is_document(std::string const& folder) {
    std::error_code ignored;
    return fs::is_regular_file(fs::symlink_status(fs::path(folder) / history_name, ignored));
}

DocumentFolder::DocumentFolder(std::string folder) : folder_(std::move(folder)) {
    refuse_if<BadInput>(!is_document(folder_), "studio.DocumentFolder",
                        "{} is not the folder of a document: it has no {}", folder_, history_name);
    lock_ = locked((fs::path(folder_) / lock_name).string());
    try {
        open();
    } catch (...) {
        ::close(lock_);
        throw;
    }
}

DocumentFolder::~DocumentFolder() {
    ::close(lock_);
}

void DocumentFolder::open() {
    std::string const recipe_path = (fs::path(folder_) / recipe_name).string();
    std::string const path = (fs::path(folder_) / history_name).string();
    std::error_code ignored;
    bool const has_recipe = fs::exists(recipe_path, ignored);
    std::string const found = has_recipe ? io::read_text(recipe_path, largest_recipe) : "";
    std::string const text = io::read_text(path, largest_history);
    Journal journal = read_journal(text, found);
    bool const is_readable = journal.lines > 0;
    refuse_if<BadInput>(!is_readable && !has_recipe, "studio.DocumentFolder", "{} has neither a recipe nor a history",
                        folder_);
    // A recipe that is no state of the history came later.
    bool const is_newer = has_recipe && found != journal.toml && !journal.passed;
    Document document = is_newer ? document_of(found) : unchanged(journal.toml);
    document.recipe.folder = folder_;
    document.revision = 0;
    require_no_way_out(folder_, document);
    if (!is_readable) {
        journal.first_toml = document.toml;
    } else if (document.toml != journal.toml) {
        // The history may end in what no recipe is: its text alone is taken.
        Edit const edit{"recipe.toml as it was found", {ReplaceRecipe{found}}};
        journal.history = edited({{journal.toml, {}, 0}, std::move(journal.history)}, edit).history;
        notes_.emplace_back("recipe.toml was changed elsewhere: that is an edit now");
    }
    mend(path, text, journal, document.toml == journal.toml);
    if (found != document.toml) {
        replace_file(recipe_path, document.toml);
    }
    session_ = {std::move(document), std::move(journal.history)};
}

void DocumentFolder::mend(std::string const& path, std::string const& text, Journal const& journal, bool is_whole) {
    bool const is_cut = journal.bytes < text.size();
    if (!journal.fault.empty()) {
        std::string const kept = free_name(path + ".damaged");
        io::copy_file(path, kept);
        notes_.push_back(
            fmt::format("line {} of {} cannot be read ({}): what was edited from there on cannot be undone; "
                        "the file is kept as {}",
                        journal.lines + 1, history_name, journal.fault, fs::path(kept).filename().string()));
    } else if (is_cut) {
        notes_.push_back(fmt::format("the last line of {} was not written to its end, and is dropped", history_name));
    }
    std::string const shortest = journal_of(journal.first_toml, journal.history);
    bool const is_long = text.size() > 2 * shortest.size(); // of edits that can no longer be redone
    bool const stays = is_whole && !is_cut && !is_long;
    if (!stays) {
        replace_file(path, shortest);
    }
    bytes_ = static_cast<std::int64_t>(stays ? text.size() : shortest.size());
}

void DocumentFolder::append(std::string const& line) {
    std::string const path = (fs::path(folder_) / history_name).string();
    int const file = ::open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC | O_NOFOLLOW);
    if (file < 0) {
        fail_at(path);
    }
    std::size_t written = 0;
    while (written < line.size()) {
        ssize_t const count = ::write(file, line.data() + written, line.size() - written);
        if (count < 0 && errno != EINTR) {
            break;
        }
        written += count > 0 ? static_cast<std::size_t>(count) : 0;
    }
    bool const done = written == line.size() && (fsync(file) == 0 || errno == EINVAL);
    int const reason = errno;
    ::close(file);
    if (!done) {
        forget_after(path, bytes_);
        errno = reason;
        fail_at(path);
    }
}

void DocumentFolder::save(Document after, std::string const& line) {
    append(line);
    try {
        replace_file((fs::path(folder_) / recipe_name).string(), after.toml);
    } catch (...) {
        forget_after((fs::path(folder_) / history_name).string(), bytes_);
        throw;
    }
    bytes_ += static_cast<std::int64_t>(line.size());
    session_.document = std::move(after);
}

// A history may be long: each call copies the change alone that it is about.

void DocumentFolder::edit(Edit const& edit) {
    Session after = edited({session_.document, {}}, edit);
    if (!after.history.done.empty()) {
        save(std::move(after.document), line_of(after.history.done.back()));
        move_last(after.history.done, session_.history.done);
        session_.history.undone.clear();
    }
}

bool DocumentFolder::undo() {
    History& history = session_.history;
    bool const has_one = !history.done.empty();
    if (has_one) {
        save(undone({session_.document, {{history.done.back()}, {}}}).document, line_of_undo());
        move_last(history.done, history.undone);
    }
    return has_one;
}

bool DocumentFolder::redo() {
    History& history = session_.history;
    bool const has_one = !history.undone.empty();
    if (has_one) {
        save(redone({session_.document, {{}, {history.undone.back()}}}).document, line_of_redo());
        move_last(history.undone, history.done);
    }
    return has_one;
}

std::string DocumentFolder::free_input() const {
    fs::path const inputs = fs::path(folder_) / "inputs";
    refuse_if<BadInput>(fs::is_symlink(fs::symlink_status(inputs)), "studio.DocumentFolder",
                        "{} is a link, and a document writes into its own folder alone: put the folder in its place",
                        inputs.string());
    int number = 1;
    while (fs::exists(fs::symlink_status(fs::path(folder_) / fmt::format("inputs/{}", number)))) {
        ++number;
    }
    return fmt::format("inputs/{}", number);
}

TakeInput DocumentFolder::take(std::string const& key, std::string const& path, Run const& run) const {
    std::string const below = free_input();
    io::OutputFolder out((fs::path(folder_) / below).string());
    std::string const name = recipe::keep_user_file(path, out, run);
    out.commit();
    return {key, fmt::format("{}/{}", below, name)};
}

TakeInput DocumentFolder::put(std::string const& key, std::string const& name,
                              std::function<void(std::string const& path)> const& write) const {
    std::string const below = free_input();
    io::OutputFolder out((fs::path(folder_) / below).string());
    write(out.path(name));
    out.commit();
    return {key, fmt::format("{}/{}", below, name)};
}

} // namespace thalweg::studio
