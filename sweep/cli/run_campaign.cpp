#include "sweep/cli/run_campaign.hpp"

#include "sweep/campaign/forecast.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/program.hpp"
#include "sweep/campaign/reader.hpp"
#include "sweep/campaign/stored_text.hpp"
#include "sweep/cli/adopt.hpp"
#include "sweep/cli/build_facts.hpp"
#include "sweep/cli/crew_options.hpp"
#include "sweep/cli/folder_beside.hpp"
#include "sweep/cli/program_campaign.hpp"
#include "sweep/cli/progress.hpp"
#include "sweep/cli/run_ending.hpp"
#include "sweep/cli/walltime.hpp"
#include "sweep/files/artefacts.hpp"
#include "sweep/schedule/growth.hpp"
#include "sweep/schedule/judge.hpp"
#include "sweep/schedule/plan.hpp"
#include "sweep/schedule/scheduler.hpp"
#include "sweep/spool/collect.hpp"
#include "sweep/spool/spool.hpp"
#include "sweep/store/campaign_name.hpp"
#include "sweep/store/expression.hpp"
#include "sweep/store/recorder.hpp"
#include "sweep/store/store.hpp"
#include "sweep/study/features.hpp"
#include "sweep/study/history.hpp"
#include "sweep/study/model_view.hpp"
#include "sweep/workers/end_requests.hpp"
#include "sweep/workers/memory_room.hpp"
#include "sweep/workers/pool.hpp"
#include "sweep/workers/staged_campaign.hpp"
#include "sweep/workers/worker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <iostream>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

namespace grainsweep::cli {
namespace {

using campaign::Outcome;
using schedule::Ending;
namespace fs = std::filesystem;

// ---- collect: answers of a spool

/// WorkerPool of a run that computes no case.
class NoCrew final : public workers::WorkerPool {
public:
    void expect(std::size_t) override {}
    [[nodiscard]] std::optional<workers::Place> place_for(double) override { return std::nullopt; }
    void give(const workers::Place&, const campaign::Attempt&, const campaign::Case&) override {}
    [[nodiscard]] std::optional<workers::PoolEvent> wait(std::chrono::milliseconds) override { return std::nullopt; }
    void retire() override {}
    void dismiss() override {}
};

constexpr std::size_t cases_at_once = 256;  // in one durable group

struct Ended {
    campaign::CaseId id;
    std::vector<spool::Answer> answers;
};

void write_ended(store::Store& store, const std::vector<Ended>& cases) {
    const auto write = [&] {
        for (const auto& one : cases) {
            const auto logged = store.attempts(one.id);
            std::int64_t number = logged.empty() ? 0 : logged.back().number;
            for (const auto& answer : one.answers) {
                auto result = answer.result;
                result.attempt.number = ++number;
                store.begin(result.attempt, answer.computer);
                (void)store.finish(result);
            }
        }
    };
    store.group(write, store::Store::Origin::imported);
}

/// As enrolling once more would find it.
void note_state(const campaign::Cases& cases, const Ended& one, std::vector<store::CaseState>& states) {
    for (auto place = cases.find(campaign::hash_of(one.id)); place; place = cases.next(*place)) {
        auto& state = states[*place];
        state.attempts += static_cast<std::int32_t>(one.answers.size());
        state.failures += static_cast<std::int32_t>(
            std::ranges::count_if(one.answers, [](const auto& answer) { return !settles(answer.result.outcome); }));
        state.outcome = one.answers.back().result.outcome;
    }
}

/// Returns the campaign of a spool. Throws InputError if there is none, or a file that it names has changed.
campaign::Campaign campaign_of_spool(const fs::path& spool) {
    const auto asked = spool::Spool::asked_in(spool);
    return campaign::asked_in(spool / "campaign", [&] { return campaign::parse_campaign(asked.text, asked.folder); });
}

/// Throws InputError if these are not the cases of the spool.
void refuse_other_cases(const fs::path& spool, const campaign::Cases& cases) {
    if (spool::Spool::asked_in(spool).cases == spool::hash_of_cases(cases)) return;
    throw campaign::input_error("DIR", spool.string(),
                                "its tasks computed other cases: a file of the campaign has changed since, "
                                "or this program is another version");
}

/// Imports the answers into the database, in which the cases must be enrolled, and into their states.
spool::Collected import_answers(const fs::path& spool, const campaign::Campaign& campaign, const campaign::Cases& cases,
                                store::Store& store, std::vector<store::CaseState>& states,
                                const std::function<void(const std::string&)>& note) {
    std::vector<Ended> group;
    const auto flush = [&] {
        if (!group.empty()) write_ended(store, group);
        for (const auto& one : group) note_state(cases, one, states);
        group.clear();
    };
    spool::Collector collector;
    collector.is_settled = [&](const campaign::CaseId& id) {
        const auto& state = states[cases.find(campaign::hash_of(id)).value()];
        return state.outcome && (settles(*state.outcome) || state.failures >= campaign.limits.attempts);
    };
    collector.import = [&](const campaign::CaseId& id, std::vector<spool::Answer> answers) {
        group.push_back({id, std::move(answers)});
        if (group.size() >= cases_at_once) flush();
    };
    collector.note = note;
    const auto collected = spool::collect(spool / "cases", campaign, cases, collector);
    flush();
    return collected;
}

// ---- run

// Places of a campaign that are in the archive before its first case is handed out: a fraction of a second.
constexpr std::size_t entered_first = 16'384;

/// Places for the statistics of a campaign: every stored place. If the run requests only a part of them, the others are
/// included by the ids of their cases and are not computed.
struct Placement {
    campaign::Cases placed;
    std::vector<store::CaseState> states;
    std::vector<bool> asked;      ///< empty: all are
    std::vector<double> seconds;  ///< predicted
    std::int64_t candidates = 0;

    [[nodiscard]] bool asks(std::size_t i) const { return asked.empty() || asked[i]; }
};

/// Requested part of a larger design.
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

/// Returns the judge of the campaign's rule, with the stored values; nullptr without a rule. `placed`: every stored
/// place.
std::unique_ptr<schedule::Judge> make_judge(const campaign::Campaign& campaign, const store::Store& store,
                                            const campaign::Cases& placed, std::int64_t candidates) {
    if (!campaign.convergence) return nullptr;
    const auto stored = store.values(campaign.name, campaign.convergence->observable);
    std::vector<double> known(placed.size(), std::numeric_limits<double>::quiet_NaN());
    auto next = stored.begin();  // both are ordered by point, then replicate
    for (std::size_t i = 0; i < placed.size(); ++i) {
        const auto here = std::pair(std::int64_t{placed.place(i).point}, std::int64_t{placed.place(i).replicate});
        while (next != stored.end() && std::pair(next->point, next->replicate) < here) ++next;
        if (next == stored.end() || std::pair(next->point, next->replicate) != here) continue;
        if (next->outcome) known[i] = next->value;
    }
    const auto sequences = static_cast<std::size_t>(designs::independent_sequences(campaign.design, campaign.request));
    std::optional<schedule::ModelView> view;
    if (campaign.convergence->traits().of_model)
        view = study::model_view(campaign, candidates,
                                 store::make_filter(campaign.where, campaign::filter_names(campaign)));
    const bool weigh = campaign::repeats_weigh(campaign.space.factors);
    return std::make_unique<schedule::Judge>(*campaign.convergence, placed, sequences, std::move(known), candidates,
                                             std::move(view), weigh);
}

schedule::Rules rules_of(const campaign::Campaign& campaign, const RunRequest& request, std::size_t workers) {
    return {.attempts = campaign.limits.attempts,
            .stop_after_failures = request.stop_after_failures,
            .max_cases = request.max_cases,
            .again = request.again,
            .workers = workers,
            .stop_after_alike = request.keep_going ? std::nullopt : std::optional(schedule::enough_alike)};
}

/// Removes half-written files of dead processes; the lock is held, so no other run owns them. Removes checkpoints of
/// settled cases. Checkpoints of other builds and instruction paths are recognised only by their contents.
void sweep(const files::ArtefactFolder& folder, const store::Store& store) {
    folder.sweep([&](std::string_view key) {
        const auto id = workers::checkpointed_case(key);
        return id && store.is_settled(*id);
    });
}

/// Returns a sentence on unfinished cases that start from the beginning in spite of a checkpoint; empty: there is none.
/// `hosts` may have other instruction paths than this one.
std::string passed_over(const files::ArtefactFolder& folder, const store::Store& store, bool hosts) {
    auto others = workers::checkpoints_of_others(folder, this_computer(), hosts);
    std::erase_if(others, [&](const auto& one) { return store.is_settled(one.first) || !store.find_case(one.first); });
    if (others.empty()) return {};
    const bool one = others.size() == 1;
    return fmt::format("note: {} unfinished case{} start{} {}", others.size(), one ? "" : "s", one ? "s" : "",
                       others.begin()->second);
}

/// Shows the information that the user needs before the first answer.
void say_first(ProgressLine& line, const campaign::Campaign& campaign, const campaign::Forecast& forecast,
               const store::CampaignRecord& record) {
    for (const auto& warning : campaign::warnings_of(campaign, forecast)) line.note("warning: " + warning);
    if (const auto note = study::extent_note(record); !note.empty()) line.note("note: " + note);
}

void refuse_what_cannot_start(const campaign::Campaign& campaign, const RunRequest& request, const fs::path& database) {
    if (request.calibrates && !designs::design_named(campaign.design).calibrates)
        throw campaign::input_error(
            request.config.string() + ": $", "",
            "key 'calibration' with the measurements is missing; for a campaign with a design use run");
    if (request.spool.empty()) refuse_launcher_that_is_not_there(campaign, request.config);
    if (const auto folder = fs::absolute(database).parent_path(); !fs::is_directory(folder))
        throw campaign::input_error("--db", database.string(), fmt::format("there is no folder '{}'", folder.string()));
    if (!request.adopt.empty() && !fs::exists(database))
        throw campaign::input_error("--adopt", fmt::format("'{}'", request.adopt),
                                    fmt::format("there is no database '{}'", database.string()));
    if (request.again && designs::design_named(campaign.design).grows)
        throw campaign::input_error("--again", to_string(*request.again),
                                    fmt::format("the later points of a {} design depend on the stored results; use "
                                                "another campaign name: settled cases are not computed again",
                                                campaign.design));
}

/// Puts another number of points in the place of the file's.
void ask_points(campaign::Campaign& campaign, std::int64_t points) {
    const auto& design = designs::design_named(campaign.design);
    const auto option = std::ranges::find(design.options, "points", &designs::OptionSpec::name);
    if (!design.extends || option == design.options.end())
        throw campaign::input_error("--points", std::to_string(points),
                                    fmt::format("a {} design cannot be extended by points", campaign.design));
    if (const double most = option->bounds.high; static_cast<double>(points) > most)
        throw campaign::input_error("--points", std::to_string(points), fmt::format("must be at most {:.0f}", most));
    campaign.request.options["points"] = points;
}

/// One run: a design that grows takes a round after the other, every other one.
class Run {
public:
    explicit Run(const RunRequest& request)
        : request_(request),
          campaign_(!request.text.empty() ? parse_with_program(request.text, request.config)
                    : request.spool.empty()
                        ? read_with_program(request.config, request.experiment)
                        : with_program(campaign_of_spool(request.spool), request.spool / "campaign")),
          workers_(worker_count(campaign_, request.workers)) {
        if (request.points) ask_points(campaign_, *request.points);
        unfold();
        if (!request.spool.empty()) refuse_other_cases(request.spool, placed_);
        database_ = request.database.empty() ? fs::path(campaign_.name + ".db") : request.database;
        refuse_what_cannot_start(campaign_, request, database_);
        artefacts_ =
            request.artefacts.empty() ? folder_beside(database_, of_artefacts) : fs::absolute(request.artefacts);
        const auto& design = designs::design_named(campaign_.design);
        const auto* const end = design.calibrates ? "in this wave" : design.grows ? "in this round" : "";
        line_.emplace(request.quiet, workers_ * threads_of_a_case(campaign_), end);
        if (request.spool.empty()) walltime_ = walltime_of(campaign_);
        store_.emplace(database_, store::Store::Mode::create,
                       request.network_disk ? store::Store::Disk::network : store::Store::Disk::found_out);
    }

    RunReport operator()() {
        campaign::asked_in(request_.config, [&] {
            refuse_another_program(*store_, campaign_, database_);
            return 0;
        });
        if (!request_.adopt.empty()) adopted_ = adopted_program(*store_, campaign_, request_.adopt);
        if (!request_.adopt_where.empty()) adopted_.where = adopted_cases();
        adopted_.cases = folder_beside(request_.artefacts.empty() ? database_ : artefacts_, of_cases);
        const bool is_new = store_->factor_order(campaign_.name).empty();
        if (is_new && !request_.goes_on) state_absent_version();
        if (campaign::reorder_factors(campaign_, store_->factor_order(campaign_.name))) {
            line_->note(fmt::format("note: the factors of '{}' keep their stored order: {}", campaign_.name,
                                    campaign::factor_list(campaign_.space)));
            unfold();
        }
        if (grow()) unfold();
        if (!request_.spool.empty()) return collect();
        bool first = true;
        do {
            enrol(std::exchange(first, false));
            compute();
            if (ending_ != Ending::finished || !grow()) break;
            if (const auto code = workers::requested_end()) {
                ending_ = code == interrupted_code ? Ending::interrupted : Ending::asked_to_end;
                break;
            }
            unfold();
        } while (true);
        store_->remember_file();
        const auto& grown = campaign_.request.grown;
        const auto in_vain = ending_ == Ending::finished && grown ? grown->without_result : "";
        return {in_vain.empty() ? exit_code(ending_, tally_) : 1,
                campaign_.name,
                database_,
                summary_of(ending_, tally_, judge_.get()) + (in_vain.empty() ? "" : "; " + in_vain),
                judge_ ? std::optional(judge_->converged_at().has_value()) : std::nullopt,
                ending_ == Ending::finished,
                static_cast<std::int64_t>(tally_.settled_now + tally_.failed_now),
                campaign::candidates_of(campaign_)};
    }

private:
    /// Unfolds the design, including the points that follow from stored answers. Refuses impossible cases when called
    /// first.
    void unfold() {
        placed_ = campaign::asked_in(request_.config, [&] {
            store::check_campaign_name(campaign_.name);
            study::check_features(campaign_);
            const auto filter = store::make_filter(campaign_.where, campaign::filter_names(campaign_));
            auto cases = campaign::unfold(campaign_, filter);
            forecast_ = campaign::forecast(campaign_.scene(), cases, workers::memory_room(campaign_));
            return cases;
        });
    }
    /// Whether answers that are known by now bring new points.
    bool grow() {
        return campaign::asked_in(request_.config, [&] { return schedule::grow(campaign_, *store_); });
    }
    /// Compiles --adopt-where.
    [[nodiscard]] campaign::Filter adopted_cases() const {
        if (request_.adopt.empty())
            throw campaign::input_error("--adopt-where", request_.adopt_where, "belongs to --adopt");
        return store::make_condition(request_.adopt_where, campaign::filter_names(campaign_), "--adopt-where").holds;
    }
    /// Returns the time limit of the stored campaign; empty: there is none, or no such campaign.
    [[nodiscard]] std::optional<double> limit_before() const {
        // A query checks no checksum: damaged cases are repaired when the campaign is enrolled.
        const auto texts = store_->query(fmt::format(
            "SELECT campaign_text FROM provenance JOIN campaign USING (campaign_id) WHERE name = '{}' ORDER "
            "BY provenance_id DESC LIMIT 1",
            campaign_.name));
        if (texts.rows.empty()) return campaign_.limits.wall_seconds;
        const auto* text = std::get_if<std::string>(&texts.rows.front().front());
        return text == nullptr ? std::nullopt : campaign::remarks_in(*text).wall_seconds;
    }
    /// States how many cases ran out of time if the limit is another now.
    void state_changed_limit(std::optional<double> before) {
        const auto now = campaign_.limits.wall_seconds;
        if (now == before || !before) return;
        std::int64_t over = 0;
        for (std::size_t i = 0; i < placed_.size(); ++i)
            over += placed_.is_first(i) && states_[i].outcome == Outcome::timed_out;
        if (over == 0) return;
        line_->note(
            fmt::format("note: limits.wall_seconds was {:.6g} and is {}; {} cases timed out under the old limit{}",
                        *before, now ? fmt::format("{:.6g}", *now) : "none", over,
                        request_.again == Outcome::timed_out
                            ? ""
                            : "; `run --again timed_out` gives those without attempts left new ones"));
    }
    void enrol(bool first) {
        const auto limit = first ? limit_before() : campaign_.limits.wall_seconds;
        states_ = campaign::asked_in(request_.config,
                                     [&] { return store_->enrol(campaign_, placed_, provenance(), entered_first); });
        for (const auto& note : store_->notes()) line_->note(note);
        if (first) state_changed_limit(limit);
        if (adopted_.program != nullptr) adopt();
        if (!request_.spool.empty())
            collected_ =
                import_answers(request_.spool, campaign_, placed_, *store_, states_, [](const std::string& text) {
                    // Every one of them, whatever a progress line would leave out.
                    std::cerr << "grainsweep: " << text << '\n';
                });
        const auto record = store_->stored(campaign_).value();
        stopped_before_ = record.stopped_at;
        if (first && !request_.goes_on) say_first(*line_, campaign_, forecast_, record);
        const auto placement = placement_of(*store_, record, placed_, std::move(states_), std::move(forecast_.seconds));
        judge_ = campaign::asked_in(
            request_.config, [&] { return make_judge(campaign_, *store_, placement.placed, placement.candidates); });
        questions_ = questions_of(campaign_, placement);
    }
    /// States once that versions of a program are not told apart.
    void state_absent_version() {
        const auto program = campaign::known_program(campaign_.scene().name);
        if (program != nullptr && program->version_command.empty())
            line_->note(fmt::format("note: without program.version, results of two versions of '{}' are not told apart",
                                    program->command.front()));
    }
    /// Adopts answers of the earlier program, then updates the states of the cases.
    void adopt() {
        for (const auto& change : adopted_.changes) line_->note("note: " + change.line());
        const auto counts = adopt_answers(*store_, campaign_, placed_, adopted_);
        std::string more;
        if (counts.read_again > 0)
            more +=
                fmt::format(", {} of them with further observables from the folders of their cases", counts.read_again);
        if (counts.without > 0)
            more += fmt::format("; {} cases without such a folder are computed again", counts.without);
        if (counts.excluded > 0)
            more += fmt::format("; {} cases that --adopt-where excludes are computed again", counts.excluded);
        line_->note(fmt::format("note: {} answers of '{}' are adopted{}", counts.answers, request_.adopt, more));
        states_ = store_->enrol(campaign_, placed_, provenance(), entered_first);
    }
    RunReport collect() {
        enrol(true);
        walltime_ = {};
        auto rules = rules_of(campaign_, request_, workers_);
        rules.stop_after_alike.reset();
        schedule::Plan plan(std::move(questions_), rules);
        plan.close();
        NoCrew crew;
        settle(plan, crew, {});
        store_->remember_file();
        auto ending =
            fmt::format("{} cases collected, {} were collected before", collected_.imported, collected_.known);
        if (const auto left = tally_.questions - tally_.decided; left > 0)
            ending += fmt::format(", {} have no result yet", left);
        if (tally_.failed > 0) ending += fmt::format(", {} failed", tally_.failed);
        if (collected_.unusable > 0) ending += fmt::format("; {} files were not imported", collected_.unusable);
        const int code = collected_.unusable > 0 ? 1 : exit_code(ending_, tally_);
        return {code, campaign_.name, database_, ending + standing(judge_.get()),
                judge_ ? std::optional(judge_->converged_at().has_value()) : std::nullopt};
    }
    /// Everything is on disk when this returns.
    void settle(schedule::Plan& plan, workers::WorkerPool& crew, schedule::Watchers watchers) {
        store::Recorder recorder(*store_);
        schedule::Scheduler scheduler(campaign_.name, plan, crew, recorder, judge_.get(), std::move(watchers),
                                      walltime_);
        ending_ = scheduler.run();
        tally_ = plan.tally();
        if (judge_ && stopped_before_ && judge_->overturns(*stopped_before_))
            store_->group([&] { store_->stop(campaign_.name, std::nullopt); });
    }
    void compute() {
        schedule::Plan plan(std::move(questions_), rules_of(campaign_, request_, workers_));
        if (const auto count = plan.tried_again(); count > 0)
            line_->note(fmt::format("note: {} failed cases of '{}' are tried again, because none has an answer yet",
                                    count, campaign_.name));
        // Where workers on other nodes see the artefacts, they see the folders of a program's cases, too.
        const auto cases = folder_beside(request_.artefacts.empty() ? database_ : artefacts_, of_cases);
        const StagedProgram staged(campaign::known_program(campaign_.scene().name), cases);
        workers::Pool pool(pool_options(campaign_, {artefacts_, cases}, workers_, request_.path));
        files::ArtefactFolder folder(artefacts_);
        sweep(folder, *store_);
        const bool hosts = !campaign_.execution.launcher.empty();
        if (const auto note = passed_over(folder, *store_, hosts); !note.empty()) line_->note(note);
        workers::stage_campaign(campaign_, folder);
        schedule::Watchers watchers;
        NowWriter now(database_, campaign_.name, workers_ * threads_of_a_case(campaign_));
        watchers.progress = [&](const schedule::Progress& progress) {
            line_->update(progress);
            now.update(progress);
        };
        watchers.note = [&](const std::string& text) { line_->note(text); };
        watchers.forget_checkpoint = [&](const campaign::CaseId& id) {
            folder.remove(workers::checkpoint_key(id, this_computer()));
        };
        settle(plan, pool, std::move(watchers));
        sweep(folder, *store_);
    }

    const RunRequest& request_;
    campaign::Campaign campaign_;
    std::size_t workers_;
    fs::path database_, artefacts_;
    std::optional<ProgressLine> line_;
    std::optional<store::Store> store_;
    Adopted adopted_;
    campaign::Cases placed_;
    campaign::Forecast forecast_;
    std::vector<store::CaseState> states_;
    std::unique_ptr<schedule::Judge> judge_;
    std::optional<std::int64_t> stopped_before_;  ///< points at which an earlier run stopped
    schedule::Questions questions_;
    Ending ending_{};
    schedule::Plan::Tally tally_;
    schedule::Walltime walltime_;
    spool::Collected collected_;
};

}  // namespace

RunReport run_campaign(const RunRequest& request) {
    return Run(request)();
}

RunReport run_part(const RunRequest& request) {
    auto report = run_campaign(request);
    if (const auto code = workers::requested_end(); code && report.finished) {
        report.exit_code = *code;
        report.finished = false;
        report.ending =
            fmt::format("{}; run again to resume", code == interrupted_code ? "interrupted" : "ended by a signal");
    }
    return report;
}

}  // namespace grainsweep::cli
