#include "sweep/workers/job_cores.hpp"

#include "solver/own_cores.hpp"
#include "solver/plain_text.hpp"
#include "sweep/files/whole_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string_view>
#include <system_error>
#include <vector>

namespace grainsweep::workers {
namespace {

namespace fs = std::filesystem;

/// The parts of a file between line ends, or between blanks as well; empty where it cannot be read.
std::vector<std::string> parts_of(const fs::path& file, std::string_view between) {
    std::error_code error;
    constexpr std::size_t longest = std::size_t{1} << 20U;
    const std::string text = files::whole_file(file, error, longest);
    if (error) return {};
    std::vector<std::string> parts(1);
    for (const char c : text) {
        if (between.find(c) == std::string_view::npos)
            parts.back() += c;
        else if (!parts.back().empty())
            parts.emplace_back();
    }
    if (parts.back().empty()) parts.pop_back();
    return parts;
}

std::vector<std::string> words_of(const fs::path& file) {
    return parts_of(file, " \n");
}

/// Cores of a quota and its period, whole ones.
std::optional<std::size_t> cores_of(const std::string& quota, const std::string& period) {
    const auto time = number_in(quota), of = number_in(period);
    if (!time || !of || !(*time > 0) || !(*of > 0)) return std::nullopt;  // "max", -1
    return static_cast<std::size_t>(std::clamp(std::floor(*time / *of), 1.0, 1e6));
}

std::optional<std::size_t> quota_of_group(const fs::path& group) {
    if (const auto words = words_of(group / "cpu.max"); words.size() == 2) return cores_of(words[0], words[1]);
    const auto quota = words_of(group / "cpu.cfs_quota_us"), period = words_of(group / "cpu.cfs_period_us");
    if (quota.size() == 1 && period.size() == 1) return cores_of(quota[0], period[0]);
    return std::nullopt;
}

/// The smallest quota of a group and all above it, within the folder where groups are mounted. A container may see its
/// own group as the root while its path is a path of the host; missing folders are skipped.
std::optional<std::size_t> quota_above(const fs::path& mount, const fs::path& path) {
    std::optional<std::size_t> least;
    for (fs::path group = path.relative_path();; group = group.parent_path()) {
        if (const auto cores = quota_of_group(mount / group)) least = std::min(least.value_or(*cores), *cores);
        if (group.empty()) return least;
    }
}

std::optional<std::size_t> count_in(const std::optional<std::string>& text) {
    if (!text) return std::nullopt;
    // "16(x2),8": of the first node, which a job's script runs on
    const auto number = number_in(std::string_view(*text).substr(0, text->find_first_of("(,")));
    if (!number || !(*number >= 1) || *number > 1e6) return std::nullopt;
    return static_cast<std::size_t>(*number);
}

}  // namespace

std::optional<std::size_t> quota_cores(const fs::path& root) {
    const fs::path mounts = root / "sys/fs/cgroup";
    std::optional<std::size_t> least;
    for (const std::string& line : parts_of(root / "proc/self/cgroup", "\n")) {  // "4:cpu,cpuacct:/job_1", "0::/job_1"
        const auto first = line.find(':'), second = line.find(':', first + 1);
        if (second == std::string::npos) continue;
        const std::string controllers = "," + line.substr(first + 1, second - first - 1) + ",";
        const bool unified = controllers == ",,";
        if (!unified && controllers.find(",cpu,") == std::string::npos) continue;
        const auto own = controllers.substr(1, controllers.size() - 2);
        for (const fs::path& mount : unified ? std::vector<fs::path>{mounts, mounts / "unified"}
                                             : std::vector<fs::path>{mounts / own, mounts / "cpu"})
            if (const auto cores = quota_above(mount, line.substr(second + 1)))
                least = std::min(least.value_or(*cores), *cores);
    }
    return least;
}

std::optional<std::size_t> slurm_cores(const Environment& environment) {
    const auto of_task = count_in(environment("SLURM_CPUS_PER_TASK"));
    const auto of_node = count_in(environment("SLURM_CPUS_ON_NODE"));
    if (!of_task) return of_node;
    const bool in_step = environment("SLURM_STEP_ID").has_value();
    const std::size_t tasks = in_step ? 1 : count_in(environment("SLURM_TASKS_PER_NODE")).value_or(1);
    return std::min(*of_task * tasks, of_node.value_or(*of_task * tasks));
}

std::size_t job_cores() {
    static const std::size_t cores = [] {
        const auto environment = [](const char* name) -> std::optional<std::string> {
            const char* text = std::getenv(name);
            return text == nullptr ? std::nullopt : std::optional<std::string>(text);
        };
        auto least = static_cast<std::size_t>(own_cores());
        for (const auto& limit : {quota_cores("/"), slurm_cores(environment)})
            least = std::min(least, limit.value_or(least));
        return least;
    }();
    return cores;
}

}  // namespace grainsweep::workers
