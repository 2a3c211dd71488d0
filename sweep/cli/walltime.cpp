#include "sweep/cli/walltime.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdlib>

namespace grainsweep::cli {
namespace {

std::optional<double> moment_in(std::string_view text) {
    std::int64_t seconds = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seconds);
    if (error != std::errc() || end != text.data() + text.size() || seconds <= 0) return std::nullopt;
    return static_cast<double>(seconds);
}

std::string_view environment(const char* name) {
    const char* text = std::getenv(name);
    return text == nullptr ? std::string_view() : std::string_view(text);
}

}  // namespace

std::optional<TimeGiven> time_given(double configured, std::string_view job_end, std::string_view job_start,
                                    double now) {
    std::optional<TimeGiven> given;
    if (configured > 0) given = {configured, configured};
    const auto end = moment_in(job_end);
    if (!end || (given && *end - now >= given->left)) return given;
    const auto start = moment_in(job_start);
    given = {*end - now, *end - (start && *start < *end ? *start : now)};
    if (configured > 0) given->whole = std::min(given->whole, configured);
    return given;
}

double kept_back(double whole) {
    return std::min(std::clamp(whole / 10, 5.0, 30.0), whole / 2);
}

schedule::Walltime walltime_of(const campaign::Campaign& campaign) {
    using std::chrono::duration, std::chrono::steady_clock, std::chrono::system_clock;
    const double now = duration<double>(system_clock::now().time_since_epoch()).count();
    const auto given = time_given(campaign.execution.walltime, environment("SLURM_JOB_END_TIME"),
                                  environment("SLURM_JOB_START_TIME"), now);
    if (!given) return {};
    const double reserve = kept_back(given->whole);
    const auto start = steady_clock::now();
    schedule::Walltime walltime;
    walltime.left = [left = given->left - reserve, start] {
        return left - duration<double>(steady_clock::now() - start).count();
    };
    walltime.whole = given->whole - reserve;
    walltime.shortest_part = std::min(reserve, walltime.whole / 4);
    // A program that answers a case begins anew: nothing of it is saved.
    walltime.cases_go_on = !campaign.scene().name.starts_with("program:");
    return walltime;
}

}  // namespace grainsweep::cli
