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
#include <memory>
#include <thread>
#include <utility>

namespace grainsweep::cli {
namespace {

namespace fs = std::filesystem;
using schedule::Ending;

// Places of a campaign that are in the archive before its first case is handed out: a fraction of a second.
constexpr std::size_t entered_first = 16'384;

std::size_t worker_count(const campaign::Campaign& campaign, const RunRequest& request) {
    const std::int64_t asked = request.workers.value_or(campaign.execution.workers);
    return asked > 0 ? static_cast<std::size_t>(asked) : std::max(1U, std::thread::hardware_concurrency());
}

/// What the statistics of a campaign are over: every place that is stored. Where the run asks for a part of them, the
/// others are there too, by the id of their question alone, and not to be computed.
struct Placement {
    campaign::Cases placed;
    std::vector<store::CaseState> states;
    std::vector<bool> asked;      ///< empty: all are
    std::vector<double> seconds;  ///< predicted
    std::int64_t candidates = 0;

    [[nodiscard]] bool asks(std::size_t i) const { return asked.empty() || asked[i]; }
};

/// Of the places of a larger design those that are asked.
class PartOfADesign final : public campaign::Questions {
public:
    PartOfADesign(campaign::Cases asked, std::vector<std::uint32_t> numbers)
        : asked_(std::move(asked)), numbers_(std::move(numbers)) {}
    void make(std::size_t i, const campaign::Place&, campaign::Case& into) const override {
        asked_.question(numbers_[i], into);
    }
    void make_inputs(std::size_t i, const campaign::Place&, Inputs& into) const override {
        asked_.inputs(numbers_[i], into);
    }

private:
    campaign::Cases asked_;
    std::vector<std::uint32_t> numbers_;  ///< of each place, in asked_
};

/// Both are ordered by point, then replicate. Places that are asked and not stored yet are on their way.
Placement placement_of(const store::Store& store, const store::CampaignRecord& record, const campaign::Cases& asked,
                       std::vector<store::CaseState> states, std::vector<double> seconds) {
    if (!record.shrunk()) return {asked, std::move(states), {}, std::move(seconds), record.stored.candidates};
    const auto stored = store.placement(record.name);
    const auto position = [](const campaign::Place& place) { return std::pair(place.point, place.replicate); };
    Placement all;
    all.candidates = record.stored.candidates;
    std::vector<campaign::Place> places;
    std::vector<campaign::CaseHash> hashes;
    std::vector<std::uint32_t> numbers;
    const auto add = [&](bool now, std::size_t k, const campaign::Place& place, const campaign::CaseHash& hash,
                         const store::CaseState& state) {
        places.push_back(place);
        hashes.push_back(hash);
        numbers.push_back(now ? static_cast<std::uint32_t>(k) : 0);
        all.states.push_back(state);
        all.asked.push_back(now);
        all.seconds.push_back(now ? seconds[k] : 0);
    };
    std::size_t next = 0, old = 0;
    while (next < asked.size() || old < stored.places.size()) {
        const bool now = next < asked.size() &&
                         (old == stored.places.size() || position(asked.place(next)) <= position(stored.places[old]));
        if (now && old < stored.places.size() && position(asked.place(next)) == position(stored.places[old])) ++old;
        if (now) {
            add(true, next, asked.place(next), asked.hash(next), states[next]);
            ++next;
        } else {
            add(false, 0, stored.places[old], stored.hashes[old], stored.states[old]);
            ++old;
        }
    }
    all.placed = {std::move(places), std::move(hashes), std::make_shared<PartOfADesign>(asked, std::move(numbers))};
    return all;
}

schedule::Questions questions_of(const campaign::Campaign& campaign, const Placement& placement) {
    const auto& placed = placement.placed;
    const bool stops = campaign.convergence && campaign.convergence->stop;
    schedule::Questions questions;
    std::vector<std::uint32_t> at;  // where each question is asked
    auto& places = questions.places;
    places.reserve(placed.size());
    at.reserve(placed.size());
    questions.histories.reserve(placed.size());
    questions.predicted.reserve(placed.size());
    for (std::size_t i = 0; i < placed.size(); ++i) {
        if (placed.is_first(i)) {
            const auto& state = placement.states[i];
            places.push_back(static_cast<std::uint32_t>(at.size()));
            at.push_back(static_cast<std::uint32_t>(i));
            questions.histories.push_back({state.attempts, state.failures, state.outcome, false});
            questions.predicted.push_back(0);
            if (stops)
                questions.blocks.push_back(
                    static_cast<std::uint32_t>(placed.place(i).point / campaign.convergence->block));
        } else {
            places.push_back(places[placed.first(i)]);
        }
        const std::uint32_t question = places.back();
        auto& history = questions.histories[question];
        if (!placement.asks(i) || history.asked) continue;
        history.asked = true;
        at[question] = static_cast<std::uint32_t>(i);
        questions.predicted[question] = placement.seconds[i];
    }
    if (at.size() == placed.size()) places = {};
    questions.ask = [placed, at = std::move(at)](std::uint32_t question) { return placed.question(at[question]); };
    return questions;
}

std::unique_ptr<schedule::Judge> make_judge(const campaign::Campaign& campaign, const store::Store& store,
                                            const Placement& placement) {
    if (!campaign.convergence) return nullptr;
    const auto& placed = placement.placed;
    const auto stored = store.values(campaign.name, campaign.convergence->observable);
    std::vector<double> known(placed.size(), std::numeric_limits<double>::quiet_NaN());
    auto next = stored.begin();  // both are ordered by point, then replicate
    for (std::size_t i = 0; i < placed.size(); ++i) {
        const auto here = std::pair(std::int64_t{placed.place(i).point}, std::int64_t{placed.place(i).replicate});
        while (next != stored.end() && std::pair(next->point, next->replicate) < here) ++next;
        if (next == stored.end() || std::pair(next->point, next->replicate) != here) continue;
        if (next->outcome) known[i] = next->value;
    }
    const auto sequences = designs::independent_sequences(campaign.design, campaign.request);
    return std::make_unique<schedule::Judge>(*campaign.convergence, placed, static_cast<std::size_t>(sequences),
                                             std::move(known), placement.candidates);
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
        const auto id = workers::checkpointed_case(key);
        return id && store.is_settled(*id);
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
    auto states =
        campaign::asked_in(request.config, [&] { return store.enrol(campaign, placed, provenance(), entered_first); });
    for (const auto& note : store.notes()) line.note(note);
    const auto record = store.stored(campaign).value();
    say_first(line, campaign, forecast, record);
    std::unique_ptr<schedule::Judge> judge;
    schedule::Questions questions;
    {
        const auto placement = placement_of(store, record, placed, std::move(states), std::move(forecast.seconds));
        judge = make_judge(campaign, store, placement);
        questions = questions_of(campaign, placement);
    }
    schedule::Plan plan(std::move(questions), rules_of(campaign, request, workers));

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
    store.remember_file();
    const auto tally = plan.tally();
    return {exit_code(ending, tally), campaign.name, database, describe(ending, tally, judge.get()),
            judge ? std::optional(judge->converged_at().has_value()) : std::nullopt};
}

}  // namespace grainsweep::cli
