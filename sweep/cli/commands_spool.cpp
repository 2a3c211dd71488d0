// work: runs one task of a campaign without a main program. collect: stores the answers of such tasks in an archive.
#include "sweep/campaign/wrong_question.hpp"
#include "sweep/cli/command.hpp"
#include "sweep/cli/path_option.hpp"
#include "sweep/cli/run_campaign.hpp"
#include "sweep/cli/run_summary.hpp"
#include "sweep/cli/work_task.hpp"
#include "sweep/report/document.hpp"
#include "sweep/workers/end_requests.hpp"

#include <fmt/format.h>

#include <csignal>
#include <iostream>
#include <string>

namespace grainsweep::cli {
namespace {

using report::Format;

report::Document document_of(const WorkReport& report) {
    const std::string share = fmt::format("{}/{}", report.part, report.of);
    report::Document shown{.rows = {{"campaign", "share", "cases", "answered", "computed", "ending", "exit_code"},
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
        throw campaign::wrong_question("--lease", fmt::format("{}", request.lease), "must be a number from 2 to 1e6");
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
