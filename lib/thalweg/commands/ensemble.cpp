// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/commands/ensemble.hpp>

#include <algorithm>
#include <exception>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include <thalweg/commands/internal/make.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/ensemble/ensemble.hpp>
#include <thalweg/recipe/recipe_files.hpp>

namespace thalweg::commands {

namespace {

constexpr char const* files_key = "output.files=";
constexpr char const* table_word = "table";

/// Takes the word table out of the files asked for: it is always written.
/// \return whether it stood alone
bool take_table(std::vector<std::string>& assignments) {
    bool is_alone = false;
    for (std::string& assignment : assignments) {
        if (!assignment.starts_with(files_key)) {
            continue;
        }
        std::string others;
        std::string const words = assignment.substr(std::string_view(files_key).size()) + ",";
        for (std::size_t begin = 0; begin < words.size();) {
            std::size_t const end = words.find(',', begin);
            std::string const word = words.substr(begin, end - begin);
            if (word != table_word) {
                others += (others.empty() ? "" : ",") + word;
            }
            begin = end + 1;
        }
        is_alone = others.empty();
        assignment = is_alone ? fmt::format("{}dem", files_key) : files_key + others;
    }
    return is_alone;
}

void require_ranges(EnsembleParams const& params) {
    constexpr std::int64_t most_members = 1'000'000'000;
    constexpr std::int64_t most_in_a_shard = 1'000'000;
    constexpr std::int64_t most_shares = 1'000'000;
    refuse_if<BadParameter>(params.members < 1 || params.members > most_members, "commands.run_ensemble",
                            "an ensemble has 1 to {} members, not {}", most_members, params.members);
    refuse_if<BadParameter>(params.members_a_shard < 0 || params.members_a_shard > most_in_a_shard,
                            "commands.run_ensemble", "--shards {}: a tar file holds 1 to {} members",
                            params.members_a_shard, most_in_a_shard);
    refuse_if<BadParameter>(
        params.shares < 1 || params.shares > most_shares || params.share < 1 || params.share > params.shares,
        "commands.run_ensemble", "--share {}/{}: write K/N, K from 1 to N", params.share, params.shares);
    refuse_if<BadParameter>(
        params.existing == io::Existing::replace, "commands.run_ensemble",
        "--overwrite does not go with an ensemble: it goes on where it stopped. To begin anew, name "
        "another folder or remove {}",
        params.output);
}

/// Throws the reason of the first member's recipe where none of the first ones is possible.
void require_possible(ensemble::Ensemble const& ensemble) {
    constexpr std::int64_t most_tried = 100;
    std::exception_ptr first;
    for (std::int64_t i = 0; i < std::min(ensemble.members, most_tried); ++i) {
        try {
            recipe::check_recipe(recipe_of(ensemble, ensemble::member_of(ensemble, i)));
            return;
        } catch (Error const&) {
            first = first ? first : std::current_exception();
        }
    }
    std::rethrow_exception(first);
}

ensemble::EnsembleOrder ensemble_asked(EnsembleParams const& params) {
    require_ranges(params);
    ensemble::EnsembleOrder asked{.vary = params.vary, .folder = params.output, .share = {params.share, params.shares}};
    auto make = static_cast<MakeParams const&>(params);
    bool const only_table = take_table(make.set);
    ensemble::Ensemble& ensemble = asked.ensemble;
    ensemble.recipe = recipe_asked(make);
    ensemble.recipe.seed = params.first_seed.value_or(ensemble.recipe.seed);
    ensemble.members = params.members;
    constexpr auto greatest = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
    refuse_if<BadParameter>(ensemble.recipe.seed > greatest - static_cast<std::uint64_t>(params.members),
                            "commands.run_ensemble", "the last member's seed would be above {}", greatest);
    for (std::string const& text : params.vary) {
        ensemble::VariedKey vary = ensemble::read_varied_key(text);
        refuse_if<BadParameter>(
            std::ranges::any_of(ensemble.vary, [&](ensemble::VariedKey const& v) { return v.key == vary.key; }),
            "commands.run_ensemble", "--vary {}: the key varies twice", text);
        ensemble.vary.push_back(std::move(vary));
    }
    recipe::OutputRecipe& output = ensemble.recipe.output;
    if (!output.files) {
        output.files = {recipe::OutputFiles::dem, recipe::OutputFiles::network};
    }
    asked.files.members_a_shard = params.members_a_shard;
    asked.files.folders = params.members_a_shard == 0 && !only_table;
    refuse_if<BadParameter>(params.members_a_shard > 0 &&
                                (only_table || std::ranges::any_of(*output.files,
                                                                   [](recipe::OutputFiles file) {
                                                                       return file != recipe::OutputFiles::dem &&
                                                                              file != recipe::OutputFiles::network;
                                                                   })),
                            "commands.run_ensemble",
                            "--shards: a tar file holds dem and network of each member, no other files");
    require_possible(ensemble);
    return asked;
}

ensemble::EnsembleResult of_first_rank(EnsembleParams const& params, ensemble::Ranks* ranks, Run const& run) {
    ensemble::EnsembleOrder asked;
    std::optional<recipe::UserFiles> files;
    try {
        asked = ensemble_asked(params);
        files.emplace(asked.ensemble.recipe, run);
    } catch (...) {
        if (ranks != nullptr) {
            ranks->start(false);
        }
        throw;
    }
    return ensemble::make_members(asked, ranks, run);
}

ensemble::EnsembleResult of_other_rank(ensemble::Ranks& ranks, EnsembleParams const& params, Run const& run) {
    if (!ranks.start(true)) { // the first rank says why
        return {.members = params.members};
    }
    ensemble::EnsembleOrder asked;
    try {
        asked = ensemble_asked(params);
    } catch (...) {
        ranks.say_goodbye(false);
        throw;
    }
    return ensemble::help_to_make(asked, ranks, run);
}

} // namespace

ensemble::EnsembleResult run_ensemble(EnsembleParams const& params, Run const& run) {
    return of_first_rank(params, nullptr, run);
}

ensemble::EnsembleResult run_ensemble_on(ensemble::Ranks& ranks, EnsembleParams const& params, Run const& run) {
    Run own = run;
    own.threads = run.threads > 0 ? run.threads : 1;
    return ranks.rank() == 0 ? of_first_rank(params, &ranks, own) : of_other_rank(ranks, params, own);
}

recipe::Forecast forecast_ensemble(EnsembleParams const& params, Run const& run) {
    ensemble::EnsembleOrder asked = ensemble_asked(params);
    ensemble::Ensemble& ensemble = asked.ensemble;
    recipe::UserFiles const files(ensemble.recipe, run);
    recipe::Forecast out = recipe::forecast(recipe_of(ensemble, ensemble::member_of(ensemble, 0)), run);
    auto const workers = std::min<std::int64_t>(params.members, ensemble::threads_of(run));
    out.memory_bytes *= workers;
    out.seconds *= static_cast<double>(params.members);
    return out;
}

} // namespace thalweg::commands
