// run, calibrate: compute a campaign file into an archive, the campaigns of a calibration's experiments in turn.
// worker: the process that `run` starts once for each worker.
#include "sweep/campaign/experiments.hpp"
#include "sweep/campaign/forecast.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/reader.hpp"
#include "sweep/campaign/stored_text.hpp"
#include "sweep/cli/build_facts.hpp"
#include "sweep/cli/command.hpp"
#include "sweep/cli/compute_options.hpp"
#include "sweep/cli/program_campaign.hpp"
#include "sweep/cli/run_campaign.hpp"
#include "sweep/cli/run_ending.hpp"
#include "sweep/files/aside_file.hpp"
#include "sweep/store/expression.hpp"
#include "sweep/study/calibration_files.hpp"
#include "sweep/study/corrected.hpp"
#include "sweep/workers/end_requests.hpp"
#include "sweep/workers/host.hpp"
#include "sweep/workers/worker.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <map>
#include <optional>
#include <ranges>
#include <string>
#include <utility>
#include <vector>

namespace grainsweep::cli {
namespace {

using report::Format;
namespace fs = std::filesystem;

/// Setting and predicted cost of its cases. Measured time would make the course depend on the machine.
struct CostedSetting {
    std::string name;
    double seconds = 0;
    campaign::CaseHash first_case{};
};

/// `run` of a campaign with an error goal ("accuracy" as an object).
///
/// Each setting is a campaign beside NAME in the same database, with the first points of the same design and the same
/// seeds: NAME_fast, NAME_balanced, ..., NAME_reference. A pilot of two points per sequence chooses the setting of
/// NAME, which has most cases. Then cases are added to NAME and NAME_reference until the error from numerics and
/// statistics is within the tolerance at two checks in a row. If a check finds `reference` alone cheaper than further
/// pairs, only NAME_reference continues. The next cases depend only on stored values and predicted costs. So the same
/// cases run after an interruption, and with one worker or many.
class AccurateRun {
public:
    explicit AccurateRun(const RunRequest& request)
        : request_(request), asked_(read_with_program(request.config)), goal_(*campaign::remarks_in(asked_.text).goal) {
        if (request_.database.empty()) request_.database = asked_.name + ".db";
        sequences_ = designs::independent_sequences(asked_.design, asked_.request);
        most_ = campaign::candidates_of(asked_);
        measure_ = study::name_at(asked_.name, measure());
    }

    RunReport operator()() {
        campaign::asked_in(request_.config, [&] { find_settings(); });
        if (!goal_.setting) goal_.setting = stored_setting();
        if (!goal_.setting && !choose()) return std::move(*ended_);
        forget_earlier_checks();
        while (advance()) {
        }
        ended_->campaign = asked_.name;
        if (!ended_->finished) return std::move(*ended_);
        const store::Store store(request_.database, store::Store::Mode::read);
        const auto records = store.campaigns();
        const auto record = std::ranges::find(records, asked_.name, &store::CampaignRecord::name);
        const auto found = study::corrected_of(store, *record);
        ended_->ending = found->verdict();
        ended_->converged = found->within;
        return std::move(*ended_);
    }

private:
    [[nodiscard]] std::string text_at(const std::string& setting, std::int64_t points, bool keeps_goal) const {
        return campaign::at_setting(asked_.text,
                                    {.name = keeps_goal ? asked_.name : study::name_at(asked_.name, setting),
                                     .setting = setting,
                                     .points = points,
                                     .numerical = asked_.common_random_numbers,
                                     .keeps_goal = keeps_goal});
    }
    /// Those that differ, `reference` last.
    void find_settings() {
        const auto add = [&](const std::string& name) {
            const auto at = parse_with_program(text_at(name, pilot_rounds * sequences_, false), request_.config);
            const auto cases = campaign::unfold(at, store::make_filter(at.where, campaign::filter_names(at)));
            const auto cost = campaign::forecast(at.scene(), cases);
            settings_.push_back({name, cost.total_seconds / static_cast<double>(cost.questions), cases.hash(0)});
        };
        add(measure());
        for (const auto& name : std::views::keys(asked_.scene().accuracy)) {
            if (name == campaign::AccuracyGoal::measure) continue;
            add(name);
            const auto before = std::span(settings_).first(settings_.size() - 1);
            const bool known = std::ranges::count(before, settings_.back().first_case, &CostedSetting::first_case) > 0;
            if (known && name != goal_.setting) settings_.pop_back();
        }
        std::ranges::rotate(settings_, settings_.begin() + 1);
    }
    /// That of an earlier run.
    [[nodiscard]] std::optional<std::string> stored_setting() const {
        const auto store = store::Store::read_if_begun(request_.database);
        if (!store) return std::nullopt;
        for (const auto& record : store->campaigns())
            if (record.name == asked_.name)
                if (const auto goal = campaign::remarks_in(record.text).goal) return goal->setting;
        return std::nullopt;
    }
    /// Runs the pilot. False: it did not end.
    bool choose() {
        const std::int64_t points = pilot_rounds * sequences_;
        for (const auto& setting : settings_)
            if (!compute(text_at(setting.name, points, false))) return false;
        const store::Store store(request_.database, store::Store::Mode::read);
        std::vector<std::vector<double>> values;
        const auto factors = study::first_factors(store, measure_, points);
        stats::Pilot pilot{{}, static_cast<std::size_t>(sequences_), factors.view()};
        for (const auto& setting : settings_)
            values.push_back(
                study::first_values(store, study::name_at(asked_.name, setting.name), goal_.observable, points).values);
        for (std::size_t k = 0; k < settings_.size(); ++k) pilot.levels.push_back({values[k], settings_[k].seconds});
        goal_.setting = settings_[stats::cheapest_level(rule(), pilot)].name;
        say(fmt::format("most cases run at {}", *goal_.setting));
        return true;
    }
    /// Their tolerance may have been another. The checks are judged again from stored values.
    void forget_earlier_checks() const {
        if (!fs::exists(request_.database)) return;
        auto store = open_store();
        store.group([&] {
            for (const auto& record : store.campaigns())
                if (record.name == asked_.name || record.name == measure_) store.forget_checks(record.name);
        });
        store.remember_file();
    }
    /// Runs the cases of the next check and judges them. False: there is no more to do, or they did not end.
    bool advance() {
        if (points_ == 0) {
            const auto first = stats::first_sizes(sequences_, goal_.setting != campaign::AccuracyGoal::measure);
            points_ = std::min(first.points, most_);
            pairs_ = first.pairs;
        }
        if (pairs_ > 0 && !compute(text_at(measure(), pairs_, false))) return false;
        const auto& judged = alone_ ? measure_ : asked_.name;
        if (!compute(alone_ ? text_at(measure(), points_, false) : text_at(*goal_.setting, points_, true)))
            return false;
        auto store = open_store();
        const auto first = study::first_values(store, judged, goal_.observable, points_);
        std::vector<double> expensive;
        if (pairs_ > 0) expensive = study::first_values(store, measure_, goal_.observable, pairs_).values;
        const auto factors = study::first_factors(store, judged, points_);
        const stats::PairedValues values{first.values, expensive, static_cast<std::size_t>(sequences_), factors.view()};
        const auto check = stats::two_level_check(rule(), values);
        const bool within = passed_ && check.passes;
        store.group([&] { store.record(judged, study::row_of(check, goal_, first.without_value, within)); });
        store.remember_file();
        if (within || check.last()) return false;
        passed_ = check.passes;
        if (pairs_ > 0 && stats::alone_costs_less(rule(), values))
            go_on_alone(values);
        else
            go_on(check.next_points, check.next_pairs);
        return true;
    }
    void go_on(std::int64_t points, std::int64_t pairs) {
        points_ = points;
        pairs_ = pairs;
        say(fmt::format("next check at {} cases and {} pairs", points_, pairs_));
    }
    /// With `reference`, of which the pairs so far are the first cases.
    void go_on_alone(const stats::PairedValues& values) {
        alone_ = true;
        passed_ = false;
        const auto own = stats::two_level_check(rule(), {values.expensive, {}, values.sequences, values.points});
        say(fmt::format("{} alone costs less than further pairs", measure()));
        go_on(std::min(most_, std::max(own.next_points, stats::first_sizes(sequences_, false).points)), 0);
    }
    [[nodiscard]] store::Store open_store() const {
        return {request_.database, store::Store::Mode::create,
                request_.network_disk ? store::Store::Disk::network : store::Store::Disk::found_out};
    }
    [[nodiscard]] static std::string measure() { return std::string(campaign::AccuracyGoal::measure); }
    [[nodiscard]] stats::TwoLevelRule rule() const {
        return {study::gates_of(goal_), goal_.tolerance, most_, goal_.setting ? cost_ratio() : 1};
    }
    [[nodiscard]] double cost_ratio() const {
        const auto chosen = std::ranges::find(settings_, *goal_.setting, &CostedSetting::name);
        const bool known = chosen != settings_.end() && chosen->seconds > 0 && settings_.back().seconds > 0;
        return known ? settings_.back().seconds / chosen->seconds : 1;
    }
    /// Runs a campaign to its end. False: it did not come there.
    bool compute(std::string text) {
        RunRequest one = request_;
        one.text = std::move(text);
        one.goes_on = ended_.has_value();
        if (request_.max_cases) one.max_cases = *request_.max_cases - settled_;
        auto report = run_part(one);
        settled_ += report.settled;
        if (report.finished && request_.max_cases && settled_ >= *request_.max_cases) {
            report.finished = false;
            report.ending = "stopped; run again to resume";
            report.exit_code = std::max(report.exit_code, 1);
        }
        if (ended_ && report.finished) report.exit_code = std::max(report.exit_code, ended_->exit_code);
        ended_ = std::move(report);
        return ended_->finished;
    }
    void say(const std::string& text) const {
        if (!request_.quiet) std::cerr << fmt::format("{}: {}\n", asked_.name, text);
    }

    RunRequest request_;
    campaign::Campaign asked_;
    campaign::AccuracyGoal goal_;
    std::int64_t sequences_ = 1, most_ = 0, points_ = 0, pairs_ = 0, settled_ = 0;
    std::vector<CostedSetting> settings_;
    std::string measure_;  ///< campaign of `reference` beside the campaign of the goal
    bool passed_ = false;  ///< the check before
    bool alone_ = false;   ///< the pairs were given up for `reference` alone
    std::optional<RunReport> ended_;
};

/// The campaigns of all experiments in turn.
RunReport run_in_turn(const RunRequest& request, const std::vector<std::string>& names) {
    RunRequest one = request;
    std::map<std::string, std::int64_t> points;
    std::int64_t settled = 0;
    for (bool news = true; news; one.goes_on = true) {
        news = false;
        std::optional<RunReport> first;
        int code = 0;
        for (const auto& name : names) {
            one.experiment = name;
            if (request.max_cases) one.max_cases = *request.max_cases - settled;
            auto report = run_part(one);
            settled += report.settled;
            code = std::max(code, report.exit_code);
            const bool spent = request.max_cases && settled >= *request.max_cases;
            news = news || points[name] != report.points;
            points[name] = report.points;
            if (!first) first = report;
            if (!report.finished || spent) {
                first->exit_code = spent && report.finished ? 1 : report.exit_code;
                first->ending = report.finished ? "stopped; run again to resume" : report.ending;
                first->finished = false;
                return *first;
            }
        }
        first->exit_code = code;
        if (!news) return *first;
    }
    return {};
}

void write_beside(const std::filesystem::path& database, const std::string& name, const std::string& text) {
    files::AsideFile file(database.parent_path() / name);
    file.write(text);
    file.take_place();
}

/// For a calibration that has ended: writes the posterior, writes a powder if requested, and adds the verdict.
void conclude(RunReport& report, const RunRequest& request) {
    const store::Store archive(report.database, store::Store::Mode::read);
    const auto records = archive.campaigns();
    const auto record = std::ranges::find(records, report.campaign, &store::CampaignRecord::name);
    const auto found = study::calibration_report(archive, *record);
    if (!found || !found->found.posterior) return;
    const auto name = campaign::name_in_file(*record), draws = name + "_posterior.csv";
    write_beside(report.database, draws, study::posterior_csv(found->found));
    if (request.powder) {
        const auto result = study::powder_result(*found, draws);
        if (!result) throw campaign::input_error("--powder", "", "none of the factors is a property of a powder");
        const auto folder = std::filesystem::absolute(report.database).parent_path();
        const auto text = campaign::powder_with(request.config, name, *result, folder);
        if (text.sizes) write_beside(report.database, text.sizes->first, text.sizes->second);
        write_beside(report.database, name + "_powder.json", text.json);
    }
    if (!found->verdict) return;
    report.ending = fmt::format("{}; {}", found->verdict->sentence, report.ending);
    if (!found->verdict->reproduced && report.exit_code == 0) report.exit_code = 1;
}

/// Runs the campaign of the file. For a calibration with several experiments it runs each in turn, as far as the
/// answers of the others permit, until none has new points. A campaign with an error goal runs as AccurateRun.
/// A finished calibration writes NAME_posterior.csv beside the database; its report ends with the verdict, and its exit
/// code is 1 if a measurement is not reproduced.
RunReport run_file(const RunRequest& request) {
    if (request.spool.empty() && campaign::states_goal(request.config)) return AccurateRun(request)();
    const auto names =
        request.spool.empty() ? campaign::read_experiment_names(request.config) : std::vector<std::string>{};
    auto asked = request;
    if (!names.empty() && request.database.empty())
        asked.database =
            campaign::name_in_file(campaign::identity_of(campaign::read_campaign(request.config, names.front()))) +
            ".db";
    auto report = names.empty() ? run_campaign(asked) : run_in_turn(asked, names);
    if (report.finished) conclude(report, request);
    return report;
}

campaign::Outcome outcome_asked_again(const std::string& word) {
    if (const auto outcome = campaign::outcome_named(word)) return *outcome;
    std::vector<std::string> words;
    for (const auto outcome : campaign::outcomes) words.emplace_back(to_string(outcome));
    throw campaign::input_error("--again", word, "must be one of " + campaign::listed(words),
                                campaign::nearest_word(word, words));
}

/// Whether standard output has no reader: a pipe without a reader, a closed terminal or descriptor.
bool reader_is_gone() {
    if (errno == EPIPE || errno == EIO || errno == EBADF) return true;
    pollfd output{STDOUT_FILENO, POLLOUT, 0};
    return ::poll(&output, 1, 0) == 1 && (output.revents & (POLLERR | POLLHUP | POLLNVAL)) != 0;
}

/// The campaign is over and stored: that its summary finds no reader does not change how it ended.
void forgive_a_reader_that_is_gone() {
    errno = 0;
    std::cout.flush();
    if (std::cout && std::fflush(stdout) == 0) return;
    if (!reader_is_gone()) return;
    const int nothing = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (nothing < 0 || ::dup2(nothing, STDOUT_FILENO) < 0) return;
    ::close(nothing);
    std::clearerr(stdout);
    std::cout.clear();
}

struct RunArguments : RunRequest {
    std::string outcome;  ///< of --again
};

void declare_run(Parser& parser, RunArguments& request) {
    parser.add_option("CONFIG", request.config, "campaign file");
    parser.add_option("--db FILE", request.database, "database; default: NAME.db in the current folder");
    parser.add_option(
        "--artefacts DIR", request.artefacts,
        "folder for checkpoints and shared starting states, visible to all nodes; default: beside the database");
    parser
        .add_option("-j N", request.workers,
                    "worker processes, with execution.hosts per host; 0: all cores; default: execution.workers")
        ->check(whole_number(0, 4096));
    parser.add_option("-k N", request.stop_after_failures, "start no more cases after N failed cases; 0: no limit")
        ->check(whole_number(0));
    parser.add_flag("--keep-going", request.keep_going,
                    "compute the other cases, too, when the first 8 all fail for one reason");
    parser.add_option("--again OUTCOME", request.outcome,
                      "rerun cases with this outcome, for example unstable or crashed");
    parser.add_option("--adopt CAMPAIGN", request.adopt,
                      "take over the answers of a campaign whose program has changed without a change of its results");
    parser.add_option("--adopt-where SQL", request.adopt_where,
                      "with --adopt: take over only the cases whose inputs fulfil this condition, compute the others");
    parser.add_option("--max-cases N", request.max_cases, "finish at most N cases in this run; 0: all")
        ->check(whole_number(0));
    parser
        .add_option("--points N", request.points,
                    "points of the design in place of the file's; a design that extends keeps its first points")
        ->check(whole_number(1));
    parser.add_flag("--network-disk", request.network_disk,
                    "allow a database on a network file system; only one node may write it at a time");
    parser.add_flag("--all", request.all, "print every observable and moment at the end, not only the main ones");
    parser.add_flag("--quiet", request.quiet, "print no progress and no tables");
    declare_path(parser, request.path);
}

int run(RunArguments& request, Format format) {
    use_path(request.path);
    // A campaign outlives the terminal it was started from, and the reader of its output.
    std::signal(SIGHUP, SIG_IGN);
    std::signal(SIGPIPE, SIG_IGN);
    workers::answer_end_requests();
    if (!request.outcome.empty()) request.again = outcome_asked_again(request.outcome);
    for (auto* limit : {&request.stop_after_failures, &request.max_cases})
        if (*limit == 0) limit->reset();
    const RunReport report = run_file(request);
    if (!request.quiet || format != Format::text) show_run(report, format, request.all);
    forgive_a_reader_that_is_gone();
    return report.exit_code;
}

void declare_calibrate(Parser& parser, RunArguments& request) {
    declare_run(parser, request);
    parser.add_flag("--powder", request.powder,
                    "write NAME_powder.json beside the database: the powder at the best setting");
}

/// `run` that requires something to calibrate.
int calibrate(RunArguments& request, Format format) {
    request.calibrates = true;
    return run(request, format);
}

struct WorkerArguments {
    workers::WorkerOptions options;
    std::string path;
};

void declare_worker(Parser& parser, WorkerArguments& arguments) {
    auto& options = arguments.options;
    parser.add_option("--artefacts", options.artefacts, "folder for checkpoints and shared starting states");
    parser.add_option("--checkpoint-seconds", options.checkpoint_seconds, "seconds between two checkpoints of a case");
    parser.add_option("--lease-seconds", options.lease_seconds, "seconds without a message after which it ends");
    parser.add_option("--cases", options.cases, "folder for the cases of a program");
    parser.add_option("--limit-seconds", options.limit_seconds, "time limit of a case of a program, s");
    declare_path(parser, arguments.path);
}

int work(WorkerArguments& arguments, Format) {
    use_path(arguments.path);
    arguments.options.computer = this_computer();
    return workers::work(arguments.options);
}

int host(const WorkerArguments& arguments, Format) {
    const auto& options = arguments.options;
    workers::HostOptions host;
    host.lease_seconds = options.lease_seconds;
    host.command = {std::filesystem::read_symlink("/proc/self/exe").string(),
                    "worker",
                    "--checkpoint-seconds",
                    fmt::format("{}", options.checkpoint_seconds),
                    "--lease-seconds",
                    fmt::format("{}", options.lease_seconds)};
    if (!options.artefacts.empty())
        host.command.insert(host.command.end(), {"--artefacts", options.artefacts.string()});
    if (!options.cases.empty()) host.command.insert(host.command.end(), {"--cases", options.cases.string()});
    if (options.limit_seconds)
        host.command.insert(host.command.end(), {"--limit-seconds", fmt::format("{}", *options.limit_seconds)});
    if (!arguments.path.empty()) host.command.insert(host.command.end(), {"--path", arguments.path});
    return workers::host(host);
}

}  // namespace

std::vector<Command> run_commands() {
    return {
        command<RunArguments>("run", "runs the cases of a campaign; run it again to resume", declare_run, run),
        command<RunArguments>("calibrate",
                              "runs waves of cases to find the inputs that reproduce measurements; resumes",
                              declare_calibrate, calibrate),
        hidden(command<WorkerArguments>("worker", "computes cases for a run, which starts it", declare_worker, work)),
        hidden(command<WorkerArguments>("host",
                                        "runs the workers of one node for a run, which starts it "
                                        "(execution.hosts)",
                                        declare_worker, host))};
}

}  // namespace grainsweep::cli
