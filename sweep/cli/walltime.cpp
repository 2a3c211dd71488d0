#include "sweep/cli/walltime.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <iostream>

namespace grainsweep::cli {
namespace {

constexpr double longest_ago = 366 * 86'400.0;  // s: a job's end before that is none

/// Digits that are all of a text up to `separator`, which is taken, too.
std::optional<int> number_before(std::string_view& text, char separator, int most) {
    const auto end = std::min(text.find(separator), text.size());
    int number = 0;
    const auto read = std::from_chars(text.data(), text.data() + end, number);
    if (end == 0 || text.front() == '-' || read.ec != std::errc() || read.ptr != text.data() + end || number > most)
        return std::nullopt;
    text.remove_prefix(std::min(end + 1, text.size()));
    return number;
}

/// Seconds since 1970 of "2026-11-26T12:00:00", as squeue and scontrol print local time.
std::optional<double> date_in(std::string_view text) {
    const auto time = text.find_first_of("T ");
    if (time == std::string_view::npos) return std::nullopt;
    auto day_text = text.substr(0, time), clock = text.substr(time + 1);
    constexpr int last_year = 9999;
    const auto year = number_before(day_text, '-', last_year), month = number_before(day_text, '-', 12),
               day = number_before(day_text, '-', 31), hour = number_before(clock, ':', 23),
               minute = number_before(clock, ':', 59), second = number_before(clock, ':', 60);
    if (!year || !month || !day || !hour || !minute || !second || !day_text.empty() || !clock.empty())
        return std::nullopt;
    std::tm local{};
    local.tm_year = *year - 1900;
    local.tm_mon = *month - 1;
    local.tm_mday = *day;
    local.tm_hour = *hour;
    local.tm_min = *minute;
    local.tm_sec = *second;
    local.tm_isdst = -1;
    return static_cast<double>(std::mktime(&local));
}

std::optional<double> moment_in(std::string_view text, double now) {
    std::int64_t seconds = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seconds);
    const bool number = error == std::errc() && end == text.data() + text.size();
    const auto moment = number ? static_cast<double>(seconds) : date_in(text);
    if (!moment || *moment <= 0 || *moment < now - longest_ago) return std::nullopt;
    return moment;
}

std::string_view environment(const char* name) {
    const char* text = std::getenv(name);
    return text == nullptr ? std::string_view() : std::string_view(text);
}

}  // namespace

std::optional<TimeGiven> time_given(std::optional<double> configured, std::string_view job_end,
                                    std::string_view job_start, double now) {
    std::optional<TimeGiven> given;
    if (configured) given = {*configured, *configured};
    const auto end = moment_in(job_end, now);
    if (!end || (given && *end - now >= given->left)) return given;
    const auto start = moment_in(job_start, now);
    given = {*end - now, *end - (start && *start < *end ? *start : now)};
    if (configured) given->whole = std::min(given->whole, *configured);
    return given;
}

std::string unreadable_end(std::string_view job_end, double now) {
    constexpr std::array<std::string_view, 5> none = {"", "0", "NONE", "Unknown", "N/A"};
    if (std::ranges::find(none, job_end) != none.end() || moment_in(job_end, now)) return {};
    return fmt::format(
        "SLURM_JOB_END_TIME is '{}', which is not the end of this job (expected: seconds since 1970, or "
        "2026-11-26T12:00:00): set \"walltime\" in \"execution\", or the run will not stop in time",
        job_end);
}

double kept_back(double whole) {
    return std::min(std::clamp(whole / 10, 5.0, 30.0), whole / 2);
}

schedule::Walltime walltime_of(const campaign::Campaign& campaign) {
    using std::chrono::duration, std::chrono::steady_clock, std::chrono::system_clock;
    const double now = duration<double>(system_clock::now().time_since_epoch()).count();
    const auto given = time_given(campaign.execution.walltime, environment("SLURM_JOB_END_TIME"),
                                  environment("SLURM_JOB_START_TIME"), now);
    if (const auto warning = unreadable_end(environment("SLURM_JOB_END_TIME"), now); !warning.empty())
        std::cerr << "warning: " << warning << '\n';
    if (!given) return {};
    const double reserve = kept_back(given->whole);
    const auto start = steady_clock::now();
    schedule::Walltime walltime;
    walltime.left = [left = given->left - reserve, start] {
        return left - duration<double>(steady_clock::now() - start).count();
    };
    walltime.whole = given->whole - reserve;
    walltime.shortest_part = std::min(reserve, walltime.whole / 4);
    // A case of a program starts again from the beginning, because its state is not saved.
    walltime.cases_go_on = !campaign.scene().name.starts_with("program:");
    return walltime;
}

}  // namespace grainsweep::cli
