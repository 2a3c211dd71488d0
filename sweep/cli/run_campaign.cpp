#include "sweep/cli/run_campaign.hpp"

#include "sweep/campaign/forecast.hpp"
#include "sweep/campaign/reader.hpp"
#include "sweep/campaign/wrong_question.hpp"
#include "sweep/cli/build_facts.hpp"
#include "sweep/cli/progress.hpp"
#include "sweep/report/history.hpp"
#include "sweep/schedule/judge.hpp"
#include "sweep/schedule/plan.hpp"
#include "sweep/schedule/scheduler.hpp"
#include "sweep/store/artefacts.hpp"
#include "sweep/store/campaign_name.hpp"
#include "sweep/store/expression.hpp"
#include "sweep/store/recorder.hpp"
#include "sweep/store/store.hpp"
#include "sweep/workers/pool.hpp"
#include "sweep/workers/worker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <thread>
#include <unordered_map>
#include <utility>

namespace grainsweep::cli {
namespace {

namespace fs = std::filesystem;
using campaign::PlacedCase;
using schedule::Ending;

std::size_t worker_count(const campaign::Campaign& campaign, const RunRequest& request) {
    const std::int64_t asked = request.workers.value_or(campaign.execution.workers);
    return asked > 0 ? static_cast<std::size_t>(asked) : std::max(1U, std::thread::hardware_concurrency());
}

/// What the statistics of a campaign are over: every place that is stored. Where the run asks for a part of them, the
/// others are there too, by the id of their question alone, and not to be computed.
struct Placement {
    std::vector<PlacedCase> placed;
    std::vector<store::CaseState> states;
    std::vector<bool> asked;
    std::int64_t candidates = 0;
};

Placement placement_of(const store::Store& store, const store::CampaignRecord& record, std::vector<PlacedCase> asked,
                       const std::vector<store::CaseState>& states) {
    if (!record.shrunk()) {
        const std::size_t places = asked.size();
        return {std::move(asked), states, std::vector<bool>(places, true), record.stored.candidates};
    }
    Placement all;
    all.candidates = record.stored.candidates;
    std::size_t next = 0;  // both are ordered by point, then replicate
    for (auto& place : store.placement(record.name)) {
        const bool now = next < asked.size() && asked[next].point == place.placed.point &&
                         asked[next].replicate == place.placed.replicate;
        all.placed.push_back(now ? std::move(asked[next++]) : std::move(place.placed));
        all.states.push_back(place.state);
        all.asked.push_back(now);
    }
    return all;
}

/// Questions without repetition, and which of them each place asks.
struct Questions {
    std::vector<campaign::Case> cases;
    std::vector<schedule::History> histories;
    std::vector<double> predicted;
    std::vector<std::size_t> places;
    std::vector<std::int64_t> blocks;  ///< after which the campaign may stop; empty: it does not
};

Questions collect(const campaign::Campaign& campaign, const Placement& placement) {
    const auto& placed = placement.placed;
    const bool stops = campaign.convergence && campaign.convergence->stop;
    Questions questions;
    std::unordered_map<campaign::CaseId, std::size_t> index;
    questions.places.reserve(placed.size());
    for (std::size_t i = 0; i < placed.size(); ++i) {
        const auto [at, fresh] = index.try_emplace(placed[i].question.id, questions.cases.size());
        questions.places.push_back(at->second);
        const bool now = placement.asked[i];
        if (fresh) {
            const auto& state = placement.states[i];
            questions.cases.push_back(placed[i].question);
            questions.histories.push_back({state.attempts, state.failures, state.outcome, false});
            questions.predicted.push_back(0);
            if (stops) questions.blocks.push_back(placed[i].point / campaign.convergence->block);
        }
        auto& history = questions.histories[at->second];
        if (!now || history.asked) continue;
        history.asked = true;
        questions.cases[at->second] = placed[i].question;
        questions.predicted[at->second] = campaign::predict(campaign.scene(), placed[i].question.inputs).seconds;
    }
    return questions;
}

std::unique_ptr<schedule::Judge> make_judge(const campaign::Campaign& campaign, const store::Store& store,
                                            const Placement& placement) {
    if (!campaign.convergence) return nullptr;
    std::map<std::pair<std::int64_t, std::int64_t>, double> stored;
    for (const auto& value : store.values(campaign.name, campaign.convergence->observable)) {
        if (value.outcome) stored.emplace(std::pair(value.point, value.replicate), value.value);
    }
    std::vector<double> known;
    known.reserve(placement.placed.size());
    for (const auto& one : placement.placed) {
        const auto found = stored.find({one.point, one.replicate});
        known.push_back(found == stored.end() ? std::numeric_limits<double>::quiet_NaN() : found->second);
    }
    const auto sequences = designs::independent_sequences(campaign.design, campaign.request);
    return std::make_unique<schedule::Judge>(*campaign.convergence, placement.placed,
                                             static_cast<std::size_t>(sequences), known, placement.candidates);
}

std::vector<std::string> worker_command(const fs::path& artefacts, const std::string& path) {
    std::vector<std::string> command = {fs::read_symlink("/proc/self/exe").string(), "worker", "--artefacts",
                                        artefacts.string()};
    if (!path.empty()) command.insert(command.end(), {"--path", path});
    return command;
}

/// What the last line says of convergence; empty where the campaign gives no rule.
std::string standing(const schedule::Judge* judge) {
    if (judge == nullptr) return {};
    if (const auto points = judge->converged_at()) return fmt::format("; converged at {} points", *points);
    return "; not converged: " + judge->verdict();
}

workers::PoolOptions pool_options(const campaign::Campaign& campaign, const fs::path& artefacts,
                                  const RunRequest& request) {
    workers::PoolOptions options;
    options.launcher = campaign.execution.launcher;
    options.command = worker_command(artefacts, request.path);
    options.workers = worker_count(campaign, request);
    options.limits = {campaign.limits.wall_seconds, campaign.execution.start_seconds,
                      campaign.execution.silence_seconds};
    options.expected.program = this_computer();
    for (const auto& observable : campaign.scene().observables)
        options.expected.measured.emplace(observable.name, observable.shape);
    return options;
}

/// Beside the database: x.artefacts for x.db, and never the database itself.
fs::path artefact_folder(const fs::path& database) {
    fs::path folder = fs::absolute(database);
    if (folder.extension() == ".artefacts") return folder += ".artefacts";
    return folder.replace_extension(".artefacts");
}

std::string describe(Ending ending, const schedule::Plan::Tally& tally, const schedule::Judge* judge) {
    switch (ending) {
        case Ending::finished:
            return tally.failed == 0
                       ? "all cases are settled" + standing(judge)
                       : fmt::format("all cases are done, {} of them failed{}", tally.failed, standing(judge));
        case Ending::converged:
            return fmt::format("converged after {} points: {}", *judge->converged_at(), judge->verdict());
        case Ending::limited:
            return fmt::format("stopped with {} cases left; run again to go on{}", tally.questions - tally.decided,
                               standing(judge));
        case Ending::too_many_failures:
            return fmt::format("stopped after {} failed cases{}", tally.failed_now, standing(judge));
        case Ending::interrupted:
            return fmt::format("interrupted with {} cases left; run again to go on{}", tally.questions - tally.decided,
                               standing(judge));
    }
    return {};
}

int exit_code(Ending ending, const schedule::Plan::Tally& tally) {
    if (ending == Ending::interrupted) return 130;
    if (ending == Ending::converged) return 0;
    return tally.failed == 0 && tally.decided == tally.questions ? 0 : 1;
}

schedule::Rules rules_of(const campaign::Campaign& campaign, const RunRequest& request, std::size_t workers) {
    return {.attempts = campaign.limits.attempts,
            .stop_after_failures = request.stop_after_failures,
            .max_cases = request.max_cases,
            .again = request.again,
            .workers = workers};
}

/// The lock is held: what dead processes left half written belongs to no run. A checkpoint is of no use once its case
/// is settled; those of other builds and instruction paths are found by their contents alone.
void sweep(const store::ArtefactFolder& folder, const store::Store& store) {
    folder.sweep([&](std::string_view key) {
        PlacedCase place;
        const auto id = workers::checkpointed_case(key);
        if (id) place.question.id = *id;
        return id && store.settled({&place, 1}) == 1;
    });
}

/// What must be known before the first answer comes.
void say_first(ProgressLine& line, const campaign::Campaign& campaign, const campaign::Forecast& forecast,
               const store::CampaignRecord& record) {
    for (const auto& warning : campaign::warnings_of(campaign, forecast)) line.note("warning: " + warning);
    if (const auto note = report::extent_note(record); !note.empty()) line.note("note: " + note);
}

}  // namespace

RunReport run_campaign(const RunRequest& request) {
    campaign::Campaign campaign = campaign::read_campaign(request.config);
    campaign::Forecast forecast;
    const auto unfolded = [&] {
        return campaign::asked_in(request.config, [&] {
            store::check_campaign_name(campaign.name);
            const auto filter = store::make_filter(campaign.where, campaign::filter_names(campaign));
            auto cases = campaign::unfold(campaign, filter);
            forecast = campaign::forecast(campaign.scene(), cases);  // refuses impossible cases before anything is made
            return cases;
        });
    };
    auto placed = unfolded();

    const auto& launcher = campaign.execution.launcher;
    if (!launcher.empty() && !workers::Pool::can_start(launcher.front()))
        throw campaign::wrong_question(request.config.string() + ": $.execution.launcher[0]", launcher.front(),
                                       "there is no such program to start workers with");

    const fs::path database = request.database.empty() ? fs::path(campaign.name + ".db") : request.database;
    if (const auto folder = fs::absolute(database).parent_path(); !fs::is_directory(folder))
        throw campaign::wrong_question("--db", database.string(),
                                       fmt::format("there is no folder '{}'", folder.string()));
    const fs::path artefacts = artefact_folder(database);

    store::Store store(database, store::Store::Mode::create);
    const std::size_t workers = worker_count(campaign, request);
    ProgressLine line(request.quiet, workers);
    if (campaign::reorder_factors(campaign, store.factor_order(campaign.name))) {
        line.note(fmt::format("note: the factors of '{}' keep the order in which they are stored: {}", campaign.name,
                              campaign::factor_list(campaign.space)));
        placed = unfolded();
    }
    const auto states = campaign::asked_in(request.config, [&] { return store.enrol(campaign, placed, provenance()); });
    for (const auto& note : store.notes()) line.note(note);
    const auto record = store.stored(campaign).value();
    say_first(line, campaign, forecast, record);
    const auto placement = placement_of(store, record, std::move(placed), states);
    const auto judge = make_judge(campaign, store, placement);
    Questions questions = collect(campaign, placement);
    schedule::Plan plan(std::move(questions.cases), questions.histories, std::move(questions.predicted),
                        std::move(questions.places), rules_of(campaign, request, workers), questions.blocks);

    workers::Pool pool(pool_options(campaign, artefacts, request));
    store::ArtefactFolder folder(artefacts);
    sweep(folder, store);
    schedule::Watchers watchers;
    watchers.progress = [&](const schedule::Progress& progress) { line.update(progress); };
    watchers.note = [&](const std::string& text) { line.note(text); };
    watchers.forget_checkpoint = [&](const campaign::CaseId& id) {
        folder.remove(workers::checkpoint_key(id, this_computer()));
    };

    Ending ending{};
    {
        store::Recorder recorder(store);
        schedule::Scheduler scheduler(campaign.name, plan, pool, recorder, judge.get(), watchers);
        ending = scheduler.run();
    }
    sweep(folder, store);
    const auto tally = plan.tally();
    return {exit_code(ending, tally), campaign.name, database, describe(ending, tally, judge.get()),
            judge ? std::optional(judge->converged_at().has_value()) : std::nullopt};
}

}  // namespace grainsweep::cli
