#include "sweep/cli/run_campaign.hpp"

#include "sweep/campaign/forecast.hpp"
#include "sweep/campaign/reader.hpp"
#include "sweep/campaign/wrong_question.hpp"
#include "sweep/cli/build_facts.hpp"
#include "sweep/cli/progress.hpp"
#include "sweep/schedule/judge.hpp"
#include "sweep/schedule/plan.hpp"
#include "sweep/schedule/scheduler.hpp"
#include "sweep/store/artefacts.hpp"
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

/// Questions without repetition, and which of them each place asks.
struct Questions {
    std::vector<campaign::Case> cases;
    std::vector<schedule::History> histories;
    std::vector<double> predicted;
    std::vector<std::size_t> places;
};

Questions collect(const campaign::Campaign& campaign, const std::vector<PlacedCase>& placed,
                  const std::vector<store::CaseState>& states) {
    Questions questions;
    std::unordered_map<campaign::CaseId, std::size_t> index;
    questions.places.reserve(placed.size());
    for (std::size_t i = 0; i < placed.size(); ++i) {
        const auto [at, fresh] = index.try_emplace(placed[i].question.id, questions.cases.size());
        questions.places.push_back(at->second);
        if (!fresh) continue;
        questions.cases.push_back(placed[i].question);
        questions.histories.push_back({states[i].attempts, states[i].failures, states[i].outcome});
        questions.predicted.push_back(campaign::predict(campaign.scene(), placed[i].question.inputs).seconds);
    }
    return questions;
}

std::unique_ptr<schedule::Judge> make_judge(const campaign::Campaign& campaign, const store::Store& store,
                                            const std::vector<PlacedCase>& placed) {
    if (!campaign.convergence) return nullptr;
    std::map<std::pair<std::int64_t, std::int64_t>, double> stored;
    for (const auto& value : store.values(campaign.name, campaign.convergence->observable)) {
        if (value.outcome) stored.emplace(std::pair(value.point, value.replicate), value.value);
    }
    std::vector<double> known;
    known.reserve(placed.size());
    for (const auto& one : placed) {
        const auto found = stored.find({one.point, one.replicate});
        known.push_back(found == stored.end() ? std::numeric_limits<double>::quiet_NaN() : found->second);
    }
    const auto option = [&](const char* name) -> std::optional<std::int64_t> {
        if (!campaign.request.options.contains(name)) return std::nullopt;
        return campaign.request.count(name);
    };
    const auto sequences = static_cast<std::size_t>(option("sequences").value_or(1));
    return std::make_unique<schedule::Judge>(*campaign.convergence, placed,
                                             schedule::independent_sequences(campaign.design, sequences), known,
                                             option("points"));
}

std::vector<std::string> worker_command(const campaign::Campaign& campaign, const fs::path& artefacts,
                                        const std::string& path) {
    std::vector<std::string> command = campaign.execution.launcher;
    const std::vector<std::string> own = {fs::read_symlink("/proc/self/exe").string(), "worker", "--artefacts",
                                          artefacts.string()};
    command.insert(command.end(), own.begin(), own.end());
    if (!path.empty()) command.insert(command.end(), {"--path", path});
    return command;
}

std::string describe(Ending ending, const schedule::Plan::Tally& tally, const schedule::Judge* judge) {
    switch (ending) {
        case Ending::finished:
            return tally.failed == 0 ? "all cases are settled"
                                     : fmt::format("all cases have their last word, {} of them failed", tally.failed);
        case Ending::converged:
            return fmt::format("converged after {} points: {}", *judge->converged_at(), judge->verdict());
        case Ending::limited:
            return fmt::format("stopped with {} cases left; run again to go on", tally.questions - tally.decided);
        case Ending::too_many_failures:
            return fmt::format("stopped after {} failed cases", tally.failed_now);
        case Ending::interrupted:
            return fmt::format("interrupted with {} cases left; run again to go on", tally.questions - tally.decided);
    }
    return {};
}

int exit_code(Ending ending, const schedule::Plan::Tally& tally) {
    if (ending == Ending::interrupted) return 130;
    if (ending == Ending::converged) return 0;
    return tally.failed == 0 && tally.decided == tally.questions ? 0 : 1;
}

}  // namespace

RunReport run_campaign(const RunRequest& request) {
    campaign::Campaign campaign = campaign::read_campaign(request.config);
    const auto unfolded = [&] {
        return campaign::asked_in(request.config, [&] {
            const auto filter = store::make_filter(campaign.where, campaign::filter_names(campaign));
            auto cases = campaign::unfold(campaign, filter);
            (void)campaign::forecast(campaign.scene(), cases);  // refuses impossible cases before anything is made
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
    fs::path artefacts = fs::absolute(database);
    artefacts.replace_extension(".artefacts");

    store::Store store(database, store::Store::Mode::create);
    const std::size_t workers = worker_count(campaign, request);
    ProgressLine line(request.quiet, workers);
    if (campaign::reorder_factors(campaign, store.factor_order(campaign.name))) {
        line.note(fmt::format("note: the factors of '{}' keep the order in which they are stored: {}", campaign.name,
                              campaign::factor_list(campaign.space)));
        placed = unfolded();
    }
    const auto states = campaign::asked_in(request.config, [&] { return store.enrol(campaign, placed, provenance()); });
    const auto judge = make_judge(campaign, store, placed);
    Questions questions = collect(campaign, placed, states);
    schedule::Rules rules;
    rules.attempts = campaign.limits.attempts;
    rules.stop_after_failures = request.stop_after_failures;
    rules.max_cases = request.max_cases;
    rules.again = request.again;
    schedule::Plan plan(std::move(questions.cases), questions.histories, std::move(questions.predicted),
                        std::move(questions.places), rules);

    workers::Pool pool(
        {worker_command(campaign, artefacts, request.path), workers, campaign.limits.wall_seconds, build_version()});
    store::ArtefactFolder folder(artefacts);
    schedule::Watchers watchers;
    watchers.progress = [&](const schedule::Progress& progress) { line.update(progress); };
    watchers.note = [&](const std::string& text) { line.note(text); };
    watchers.forget_checkpoint = [&](const campaign::CaseId& id) {
        folder.remove(workers::checkpoint_key(id, build_version()));
    };

    Ending ending{};
    {
        store::Recorder recorder(store);
        schedule::Scheduler scheduler(campaign.name, plan, pool, recorder, judge.get(), watchers);
        ending = scheduler.run();
    }
    const auto tally = plan.tally();
    return {exit_code(ending, tally), campaign.name, database, describe(ending, tally, judge.get())};
}

}  // namespace grainsweep::cli
