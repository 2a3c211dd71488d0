#include "sweep/cli/crew_options.hpp"

#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/program.hpp"
#include "sweep/cli/build_facts.hpp"
#include "sweep/workers/job_cores.hpp"
#include "sweep/workers/process_start.hpp"

#include <algorithm>
#include <vector>

namespace grainsweep::cli {
namespace {

constexpr double time_to_end_a_program = 30;  // s

std::vector<std::string> own_command(const std::string& command, const campaign::Campaign& campaign,
                                     const WorkerFolders& folders, const std::string& path) {
    std::vector<std::string> argv = {std::filesystem::read_symlink("/proc/self/exe").string(), command, "--artefacts",
                                     folders.artefacts.string()};
    if (campaign::is_program(campaign.scene().name)) argv.insert(argv.end(), {"--cases", folders.cases.string()});
    if (campaign::is_program(campaign.scene().name) && campaign.limits.wall_seconds)
        argv.insert(argv.end(), {"--limit-seconds", campaign::shortest(*campaign.limits.wall_seconds)});
    if (!path.empty()) argv.insert(argv.end(), {"--path", path});
    return argv;
}

}  // namespace

unsigned threads_of_a_case(const campaign::Campaign& campaign) {
    const bool program = campaign::is_program(campaign.scene().name);
    return program ? 1 : static_cast<unsigned>(campaign.execution.threads.value_or(1));
}

std::size_t worker_count(const campaign::Campaign& campaign, std::optional<std::int64_t> asked) {
    const auto& execution = campaign.execution;
    const auto program = campaign::known_program(campaign.scene().name);
    const auto of_a_case = program ? static_cast<unsigned>(program->cores_of_a_case()) : threads_of_a_case(campaign);
    const auto configured = execution.hosts ? execution.workers_per_host : execution.workers;
    const std::int64_t number = asked ? *asked : configured.value_or(0);  // 0 asks for all
    const std::size_t each =
        number > 0 ? static_cast<std::size_t>(number) : std::max<std::size_t>(1, workers::job_cores() / of_a_case);
    return each * static_cast<std::size_t>(execution.hosts.value_or(1));
}

workers::PoolOptions pool_options(const campaign::Campaign& campaign, const WorkerFolders& folders, std::size_t workers,
                                  const std::string& path) {
    const auto& execution = campaign.execution;
    workers::PoolOptions options;
    options.launcher = execution.launcher;
    options.command = own_command("worker", campaign, folders, path);
    options.workers = workers;
    options.hosts = execution.hosts;
    if (options.hosts) options.host_command = own_command("host", campaign, folders, path);
    // A program uses cores of its own. Workers that a launcher starts one by one have the cores that it gives each of
    // them.
    const bool apart = !options.launcher.empty() && !options.hosts;
    options.threads = execution.threads;
    if (campaign::is_program(campaign.scene().name) || (apart && !execution.threads)) options.threads = 1;
    options.limits = {campaign.limits.wall_seconds, execution.start_seconds, execution.silence_seconds};
    // The worker of a program ends one that takes too long; this is for a worker that cannot.
    if (campaign::is_program(campaign.scene().name) && options.limits.wall)
        *options.limits.wall += time_to_end_a_program;
    options.expected.program = this_computer();
    options.expected.measured = campaign.scene().observables;
    return options;
}

void refuse_launcher_that_is_not_there(const campaign::Campaign& campaign, const std::filesystem::path& config) {
    const auto& launcher = campaign.execution.launcher;
    if (launcher.empty() || !workers::find_program(launcher.front()).empty()) return;
    throw campaign::input_error(config.string() + ": $.execution.launcher[0]", launcher.front(),
                                "this launcher program does not exist");
}

}  // namespace grainsweep::cli
