// work: runs one task of a campaign without a main program. collect: stores the answers of such tasks in an archive.
#include "sweep/campaign/forecast.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/stored_text.hpp"
#include "sweep/cli/build_facts.hpp"
#include "sweep/cli/command.hpp"
#include "sweep/cli/compute_options.hpp"
#include "sweep/cli/crew_options.hpp"
#include "sweep/cli/program_campaign.hpp"
#include "sweep/cli/progress.hpp"
#include "sweep/cli/run_campaign.hpp"
#include "sweep/cli/run_ending.hpp"
#include "sweep/cli/walltime.hpp"
#include "sweep/designs/design.hpp"
#include "sweep/files/artefacts.hpp"
#include "sweep/report/document.hpp"
#include "sweep/report/result.hpp"
#include "sweep/report/results/runs.hpp"
#include "sweep/spool/task.hpp"
#include "sweep/store/expression.hpp"
#include "sweep/study/features.hpp"
#include "sweep/workers/end_requests.hpp"
#include "sweep/workers/memory_room.hpp"
#include "sweep/workers/pool.hpp"
#include "sweep/workers/staged_campaign.hpp"
#include "sweep/workers/worker.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>
#include <string_view>

namespace grainsweep::cli {
namespace {

using report::Format;
using schedule::Ending;

struct WorkRequest {
    std::filesystem::path config, spool;
    std::string share;                    ///< "i/n"; empty: from the Slurm array, or 1/1
    std::optional<std::int64_t> workers;  ///< overrides the campaign file; 0: all cores
    double lease = 300;
    bool quiet = false;
    std::string path;  ///< instruction path of the workers; empty: the widest of each
};

struct WorkReport {
    int exit_code = 0;
    std::string campaign;
    std::int64_t part = 1, of = 1;
    std::int64_t cases = 0, answered = 0, computed = 0;
    std::string ending;  ///< one sentence
};

constexpr std::int64_t most_parts = 1'000'000;

std::optional<std::int64_t> whole_in(std::string_view text) {
    std::int64_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (text.empty() || error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return number;
}

std::optional<std::int64_t> whole_of_environment(const char* name) {
    const char* text = std::getenv(name);
    return text == nullptr ? std::nullopt : whole_in(text);
}

/// Arrays may begin anywhere and have steps; the place among their numbers counts.
spool::Share share_of_array() {
    const auto id = whole_of_environment("SLURM_ARRAY_TASK_ID");
    const auto count = whole_of_environment("SLURM_ARRAY_TASK_COUNT");
    if (!id || !count || *count < 1) return {};
    const auto first = whole_of_environment("SLURM_ARRAY_TASK_MIN").value_or(0);
    const auto step = whole_of_environment("SLURM_ARRAY_TASK_STEP").value_or(1);
    const auto place = step > 0 && *id >= first ? (*id - first) / step : *id;
    return {place % *count + 1, *count};
}

spool::Share share_asked(const std::string& word) {
    if (word.empty()) return share_of_array();
    const auto slash = std::min(word.find('/'), word.size());
    const auto part = whole_in(std::string_view(word).substr(0, slash)).value_or(0);
    const auto of = whole_in(std::string_view(word).substr(std::min(slash + 1, word.size()))).value_or(0);
    if (part < 1 || part > of || of > most_parts)
        throw campaign::input_error("--share", word, "must be I/N with I from 1 to N, for example 2/16");
    return {part, of};
}

void refuse_what_follows_from_answers(const campaign::Campaign& campaign, const std::filesystem::path& config) {
    if (designs::design_named(campaign.design).grows)
        throw campaign::input_error(config.string() + ": $", campaign.design,
                                    "its later points depend on results, which a task of work does not have; use run");
    if (campaign::remarks_in(campaign.text).goal)
        throw campaign::input_error(config.string() + ": $.accuracy", "",
                                    "how many cases reach this tolerance depends on results, which a task of work "
                                    "does not have; use run, or name a setting");
    if (campaign.convergence && campaign.convergence->stop)
        throw campaign::input_error(
            config.string() + ": $.convergence.stop", "true",
            "tasks of work compute every point, and collect checks convergence; set it to false, or use run");
}

std::string described(Ending ending, const spool::Task::Tally& tally) {
    const std::size_t left = tally.cases - tally.answered;
    switch (ending) {
        case Ending::finished:
            return tally.failed == 0 ? "all cases are settled"
                                     : fmt::format("all cases are finished, {} of them failed", tally.failed);
        case Ending::out_of_time:
            return fmt::format("out of time with {} cases left; run work again to resume", left);
        case Ending::asked_to_end:
            return fmt::format("ended by a signal with {} cases left; run work again to resume", left);
        case Ending::interrupted:
            return fmt::format("interrupted with {} cases left; run work again to resume", left);
        case Ending::too_long:
            return fmt::format(
                "stopped with {} cases left, each predicted to exceed the time limit; extend it "
                "(execution.walltime, or the job's time limit)",
                left);
        default:
            return tally.elsewhere == left
                       ? fmt::format("nothing left for this task; other tasks compute the last {} cases", left)
                       : fmt::format("stopped with {} cases left; run work again to resume", left);
    }
}

int exit_code_of(Ending ending, const spool::Task::Tally& tally) {
    if (ending == Ending::interrupted) return 130;
    if (ending == Ending::out_of_time || ending == Ending::asked_to_end) return 75;
    return tally.failed == 0 && tally.answered + tally.elsewhere == tally.cases ? 0 : 1;
}

/// Runs the task. Throws InputError for a campaign whose points depend on answers.
WorkReport work_on(const WorkRequest& request) {
    const auto share = share_asked(request.share);
    const auto campaign = read_with_program(request.config);
    refuse_what_follows_from_answers(campaign, request.config);
    refuse_launcher_that_is_not_there(campaign, request.config);
    campaign::Forecast forecast;
    const auto cases = campaign::asked_in(request.config, [&] {
        study::check_features(campaign);
        auto unfolded =
            campaign::unfold(campaign, store::make_filter(campaign.where, campaign::filter_names(campaign)));
        forecast = campaign::forecast(campaign.scene(), unfolded, workers::memory_room());
        return unfolded;
    });
    const auto beside = std::filesystem::absolute(request.config).parent_path();
    const spool::Spool spool(std::filesystem::absolute(request.spool),
                             {beside, spool::hash_of_cases(cases), campaign.text}, campaign.scene());
    const std::size_t workers = worker_count(campaign, request.workers);
    ProgressLine line(request.quiet, workers * threads_of_a_case(campaign));
    for (const auto& warning : campaign::warnings_of(campaign, forecast)) line.note("warning: " + warning);

    spool::TaskRules rules{share, campaign.limits.attempts, request.lease, walltime_of(campaign)};
    files::ArtefactFolder artefacts(spool.artefacts());
    workers::stage_campaign(campaign, artefacts);
    spool::Task::Watchers watchers;
    watchers.progress = [&, began = std::chrono::steady_clock::now()](const spool::Task::Tally& tally) {
        schedule::Progress progress;
        progress.tally.questions = tally.cases;
        progress.tally.decided = tally.answered;
        progress.tally.settled_now = progress.durable = tally.computed;
        progress.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
        progress.computed = static_cast<double>(tally.computed);  // cases: the others are as long on average
        progress.to_compute = static_cast<double>(tally.cases - tally.answered);
        line.update(progress);
    };
    watchers.note = [&](const std::string& text) { line.note(text); };
    watchers.forget_checkpoint = [&](const campaign::CaseId& id) {
        artefacts.remove(workers::checkpoint_key(id, this_computer()));
    };
    // Tasks come and go: each has a folder of its own for the cases of a program.
    const auto cases_here =
        std::filesystem::absolute(request.spool) / fmt::format("cases-{}-{}", this_computer().host, ::getpid());
    const StagedProgram staged(campaign::known_program(campaign.scene().name), cases_here);
    workers::Pool pool(pool_options(campaign, {spool.artefacts(), cases_here}, workers, request.path));
    spool::Task task(spool, cases, forecast.seconds, pool, std::move(rules), std::move(watchers));
    const Ending ending = task.run();
    const auto& tally = task.tally();
    return {exit_code_of(ending, tally),
            campaign.name,
            share.part,
            share.of,
            static_cast<std::int64_t>(tally.cases),
            static_cast<std::int64_t>(tally.answered),
            static_cast<std::int64_t>(tally.computed),
            described(ending, tally)};
}

report::Document document_of(const WorkReport& report) {
    const std::string share = fmt::format("{}/{}", report.part, report.of);
    report::Document shown{.rows = {report::columns_of(report::results::work),
                                    {{report.campaign, share, report.cases, report.answered, report.computed,
                                      report.ending, std::int64_t{report.exit_code}}}}};
    shown.value = report::to_json(shown.rows, 0);
    return shown.say(fmt::format("{}, share {}: {} of {} cases have a result, {} of them from this task\n{}",
                                 report.campaign, share, report.answered, report.cases, report.computed,
                                 report.ending));
}

void declare_work(Parser& parser, WorkRequest& request) {
    parser.add_option("CONFIG", request.config, "campaign file");
    parser.add_option("--spool DIR", request.spool, "folder that all tasks share")->required();
    parser.add_option("--share I/N", request.share,
                      "part I of N that this task computes first; default: from the Slurm array, else 1/1");
    parser
        .add_option("-j N", request.workers,
                    "worker processes, with execution.hosts per host; 0: all cores; default: execution.workers")
        ->check(whole_number(0, 4096));
    parser.add_option("--lease SECONDS", request.lease,
                      "seconds without a sign of life after which a task counts as dead; at least 2; the same for all "
                      "tasks");
    parser.add_flag("--quiet", request.quiet, "print no progress and no summary");
    declare_path(parser, request.path);
}

int work_on_share(const WorkRequest& request, Format format) {
    if (!(request.lease >= 2 && request.lease <= 1e6))
        throw campaign::input_error("--lease", fmt::format("{}", request.lease), "must be a number from 2 to 1e6");
    use_path(request.path);
    std::signal(SIGHUP, SIG_IGN);
    std::signal(SIGPIPE, SIG_IGN);
    workers::answer_end_requests();
    const auto report = work_on(request);
    if (!request.quiet || format != Format::text) report::write(std::cout, document_of(report), format);
    return report.exit_code;
}

void declare_collect(Parser& parser, RunRequest& request) {
    parser.add_option("DB", request.database, "database; created if it does not exist");
    parser.add_option("DIR", request.spool, "folder that the tasks shared");
    parser.add_flag("--network-disk", request.network_disk,
                    "allow a database on a network file system; only one node may write it at a time");
    parser.add_flag("--all", request.all, "print every observable and moment, not only the main ones");
    parser.add_flag("--quiet", request.quiet, "print no summary");
}

int collect(const RunRequest& request, Format format) {
    std::signal(SIGPIPE, SIG_IGN);
    workers::answer_end_requests();
    const RunReport report = run_campaign(request);
    if (!request.quiet || format != Format::text) show_run(report, format, request.all);
    return report.exit_code;
}

}  // namespace

std::vector<Command> spool_commands() {
    return {command<WorkRequest>("work", "computes a share of a campaign into a shared folder; see collect",
                                 declare_work, work_on_share),
            command<RunRequest>("collect", "imports the results of work tasks into a database, at any time",
                                declare_collect, collect)};
}

}  // namespace grainsweep::cli
