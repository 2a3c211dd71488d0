// run: computes a campaign file into an archive. worker: the process that `run` starts once for each worker.
#include "sweep/campaign/wrong_question.hpp"
#include "sweep/cli/build_facts.hpp"
#include "sweep/cli/command.hpp"
#include "sweep/cli/path_option.hpp"
#include "sweep/cli/run_experiments.hpp"
#include "sweep/cli/run_summary.hpp"
#include "sweep/workers/end_requests.hpp"
#include "sweep/workers/host.hpp"
#include "sweep/workers/worker.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <string>

namespace grainsweep::cli {
namespace {

using report::Format;

campaign::Outcome outcome_asked_again(const std::string& word) {
    if (const auto outcome = campaign::outcome_named(word)) return *outcome;
    std::vector<std::string> words;
    for (const auto outcome : campaign::outcomes) words.emplace_back(to_string(outcome));
    throw campaign::wrong_question("--again", word, "must be one of " + campaign::listed(words),
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
    parser.add_option("--again OUTCOME", request.outcome,
                      "rerun cases with this outcome, for example unstable or crashed");
    parser.add_option("--adopt CAMPAIGN", request.adopt,
                      "take over the answers of a campaign whose program differs only in the contents of its files");
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
