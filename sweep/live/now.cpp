#include "sweep/live/now.hpp"

#include "solver/plain_text.hpp"
#include "sweep/files/aside_file.hpp"
#include "sweep/files/processes.hpp"
#include "sweep/files/system_error.hpp"
#include "sweep/files/whole_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <limits>
#include <system_error>

namespace grainsweep::live {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view first_line = "grainsweep now 1";
constexpr auto lately = std::chrono::seconds(10);
constexpr std::size_t most_bytes = 1U << 20U;  // of 4096 workers: half of it

/// Up to the next separator, which is taken off too.
std::string_view take(std::string_view& text, char separator) {
    const auto end = std::min(text.find(separator), text.size());
    const auto part = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    return part;
}

std::optional<std::int64_t> count_in(std::string_view word) {
    std::int64_t count = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), count);
    return error == std::errc() && end == word.data() + word.size() ? std::optional(count) : std::nullopt;
}

std::string on_one_line(std::string text) {
    std::ranges::replace_if(
        text, [](unsigned char c) { return c < 0x20; }, ' ');
    return text;
}

/// Returns the running case of a line; empty if the line has another form.
std::optional<RunningCase> running_of(std::string_view words) {
    RunningCase one;
    one.case_id = take(words, ' ');
    if (one.case_id.find_first_not_of("0123456789abcdef") != std::string::npos) return std::nullopt;
    const auto attempt = count_in(take(words, ' '));
    const auto share = take(words, ' ');
    const auto seconds = number_in(take(words, ' '));
    if (!attempt || !seconds) return std::nullopt;
    one.attempt = *attempt;
    one.seconds = *seconds;
    one.share = number_in(share);
    one.host = words;
    return one;
}

/// Whether a process of this host, whose number anybody may have written, can be that of a run.
bool runs_here(std::int64_t process) {
    return process > 1 && process <= std::numeric_limits<pid_t>::max() &&
           files::process_runs(static_cast<pid_t>(process));
}

}  // namespace

fs::path now_file(const fs::path& database) {
    fs::path file = fs::absolute(database);
    return file.extension() == ".now" ? file += ".now" : file.replace_extension(".now");
}

std::string text_of(const Now& now) {
    std::string text = fmt::format(
        "{}\ncampaign {}\nhost {}\nprocess {}\nquestions {}\ndecided {}\nfailed {}\nsettled {}\nseconds {:.3f}\n"
        "seconds_left {:.3f}\nat_most {:d}\njudgement {}\n",
        first_line, now.campaign, on_one_line(now.host), now.process, now.questions, now.decided, now.failed,
        now.settled, now.seconds, now.seconds_left, now.at_most, on_one_line(now.judgement));
    for (const auto& one : now.running)
        text += fmt::format("case {} {} {} {:.1f} {}\n", one.case_id, one.attempt,
                            one.share ? fmt::format("{:.4f}", *one.share) : "?", one.seconds, on_one_line(one.host));
    return text;
}

std::optional<Now> now_of(std::string_view text) {
    if (take(text, '\n') != first_line) return std::nullopt;
    Now now;
    while (!text.empty()) {
        auto line = take(text, '\n');
        const auto word = take(line, ' ');
        const auto count = [&](std::int64_t& into) { into = count_in(line).value_or(0); };
        const auto number = [&](double& into) { into = number_in(line).value_or(0); };
        if (word == "campaign") now.campaign = line;
        if (word == "host") now.host = line;
        if (word == "judgement") now.judgement = line;
        if (word == "process") count(now.process);
        if (word == "questions") count(now.questions);
        if (word == "decided") count(now.decided);
        if (word == "failed") count(now.failed);
        if (word == "settled") count(now.settled);
        if (word == "seconds") number(now.seconds);
        if (word == "seconds_left") number(now.seconds_left);
        if (word == "at_most") now.at_most = line == "1";
        if (word == "case")
            if (auto one = running_of(line)) now.running.push_back(std::move(*one));
    }
    return now;
}

void write_now(const fs::path& file, const Now& now) {
    try {
        files::AsideFile aside(file);
        aside.write(text_of(now));
        aside.take_place_unsynced();
    } catch (const SystemError&) {  // a full disk ends the run where a result is lost, not here
    }
}

std::optional<Now> read_now(const fs::path& database) {
    const auto file = now_file(database);
    std::error_code error;
    const auto written = fs::last_write_time(file, error), present = fs::file_time_type::clock::now();
    if (error || present - written > lately || written - present > lately) return std::nullopt;
    const auto text = files::regular_file(file, error, most_bytes);
    auto now = error ? std::nullopt : now_of(text);
    if (now && now->host == files::own_host() && !runs_here(now->process)) return std::nullopt;
    return now;
}

}  // namespace grainsweep::live
