// work: a task of a campaign without a main program. collect: what such tasks have answered becomes an archive.
#include "sweep/campaign/wrong_question.hpp"
#include "sweep/cli/command.hpp"
#include "sweep/cli/path_option.hpp"
#include "sweep/cli/run_campaign.hpp"
#include "sweep/cli/run_summary.hpp"
#include "sweep/cli/work_task.hpp"
#include "sweep/report/document.hpp"

#include <fmt/format.h>

#include <csignal>
#include <iostream>
#include <memory>
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

Command work_command() {
    return {
        "work", "computes a share of a campaign into a shared folder; see collect",
        [](Parser& parser, const Format& format) -> Action {
            const auto request = std::make_shared<WorkRequest>();
            parser.add_option("CONFIG", request->config, "campaign file")->required();
            parser.add_option("--spool", request->spool, "folder that all tasks share")->required()->type_name("DIR");
            parser
                .add_option("--share", request->share,
                            "part I of N that this task computes first; default: from the Slurm array, else 1/1")
                ->type_name("I/N");
            parser
                .add_option("-j", request->workers,
                            "worker processes, with execution.hosts per host; 0: all cores; default: "
                            "execution.workers")
                ->type_name("N")
                ->check(whole_number(0, 4096));
            parser
                .add_option("--lease", request->lease,
                            "seconds without a sign of life after which a task counts as dead; at least 2; the "
                            "same for all tasks")
                ->type_name("SECONDS");
            parser.add_flag("--quiet", request->quiet, "print no progress and no summary");
            declare_path(parser, request->path);
            return [request, &format] {
                if (!(request->lease >= 2 && request->lease <= 1e6))
                    throw campaign::wrong_question("--lease", fmt::format("{}", request->lease),
                                                   "must be a number from 2 to 1e6");
                use_path(request->path);
                std::signal(SIGHUP, SIG_IGN);
                std::signal(SIGPIPE, SIG_IGN);
                const auto report = work_on(*request);
                if (!request->quiet || format != Format::text) report::write(std::cout, document_of(report), format);
                return report.exit_code;
            };
        }};
}

Command collect_command() {
    return {"collect", "imports the results of work tasks into a database, at any time",
            [](Parser& parser, const Format& format) -> Action {
                const auto request = std::make_shared<RunRequest>();
                parser.add_option("DB", request->database, "database; created if it does not exist")->required();
                parser.add_option("DIR", request->spool, "folder that the tasks shared")->required();
                parser.add_flag("--network-disk", request->network_disk,
                                "allow a database on a network file system; only one node may write it at a time");
                parser.add_flag("--quiet", request->quiet, "print no summary");
                return [request, &format] {
                    std::signal(SIGPIPE, SIG_IGN);
                    const RunReport report = run_campaign(*request);
                    if (!request->quiet || format != Format::text) show_run(report, format);
                    return report.exit_code;
                };
            }};
}

}  // namespace

std::vector<Command> spool_commands() {
    return {work_command(), collect_command()};
}

}  // namespace grainsweep::cli
