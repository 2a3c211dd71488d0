#include "sweep/cli/progress.hpp"

#include "sweep/campaign/visible_text.hpp"
#include "sweep/cli/build_facts.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <system_error>
#include <utility>

namespace grainsweep::cli {
namespace {

using namespace std::chrono_literals;

// On a terminal the bar moves smoothly; in a log a line every few seconds is enough.
constexpr auto terminal_interval = 100ms;
constexpr auto log_interval = 5s;
constexpr std::size_t bar_width = 30;
constexpr std::size_t most_notes = 20, most_alike = 2;
constexpr std::size_t note_bytes = 500;

std::size_t terminal_width() {
    winsize size{};
    return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

/// Whether the terminal shows colours and the user has not forbidden them (no-color.org).
bool wants_colour() {
    const char* const forbidden = std::getenv("NO_COLOR");
    const char* const terminal = std::getenv("TERM");
    return (forbidden == nullptr || *forbidden == '\0') && terminal != nullptr && std::string_view(terminal) != "dumb";
}

/// Standard error may be a full disk, a closed terminal or a pipe without a reader: the campaign goes on without it.
void show(std::string_view text) {
    (void)std::fwrite(text.data(), 1, text.size(), stderr);
    (void)std::fflush(stderr);
}

/// Returns a worker's text for a terminal: without control characters, and at most a few lines long.
std::string one_line(std::string text) {
    const bool cut = text.size() > note_bytes;
    if (cut) {
        text.resize(note_bytes);
        while (!text.empty() && (static_cast<unsigned char>(text.back()) & 0xC0U) == 0x80U) text.pop_back();
        if (!text.empty() && static_cast<unsigned char>(text.back()) >= 0xC0U) text.pop_back();  // half a character
    }
    std::ranges::replace_if(
        text, [](unsigned char c) { return c < 0x20 || c == 0x7F; }, ' ');
    text = campaign::visible(text);
    while (text.ends_with(' ')) text.pop_back();
    return cut ? text + " ..." : text;
}

/// Returns a text without the words that have digits.
std::string without_numbers(std::string_view text) {
    std::string words;
    for (std::size_t at = 0; at < text.size();) {
        const auto end = std::min(text.find(' ', at), text.size());
        const auto word = text.substr(at, end - at);
        if (word.find_first_of("0123456789") == std::string_view::npos) words.append(word) += ' ';
        at = end + 1;
    }
    return words;
}

}  // namespace

std::string duration(double seconds) {
    if (!std::isfinite(seconds) || seconds < 0) return "?";
    const auto s = static_cast<long long>(std::llround(seconds));
    if (s < 60) return fmt::format("{} s", s);
    if (s < 3600) return fmt::format("{} min {} s", s / 60, s % 60);
    if (s < 86400) return fmt::format("{} h {} min", s / 3600, s % 3600 / 60);
    return fmt::format("{} d {} h", s / 86400, s % 86400 / 3600);
}

double seconds_left(const schedule::Progress& progress, std::size_t cores) {
    const double to_go = progress.to_compute, done = progress.computed;
    const bool telling = done > 0.02 * (done + to_go);
    return to_go * (telling ? progress.seconds / done : 1 / static_cast<double>(std::max<std::size_t>(cores, 1)));
}

ProgressLine::ProgressLine(bool quiet, std::size_t cores, std::string end)
    : quiet_(quiet),
      terminal_(::isatty(STDERR_FILENO) == 1),
      coloured_(terminal_ && wants_colour()),
      cores_(std::max<std::size_t>(cores, 1)),
      end_(std::move(end)) {}

ProgressLine::~ProgressLine() {
    if (line_open_) show("\n");
    if (unshown_notes_ > 0)
        show(fmt::format("... and {} more notes{}; the database has every attempt\n", unshown_notes_,
                         shown_notes_ < most_notes ? " like these" : ""));
}

void ProgressLine::update(const schedule::Progress& progress) {
    if (quiet_) return;
    const auto now = Clock::now();
    const bool last = progress.tally.decided == progress.tally.questions;
    const std::chrono::milliseconds interval = terminal_ ? terminal_interval : log_interval;
    if (!last && now - shown_ < interval) return;
    if (!terminal_ && shown_ == Clock::time_point{} && !last) {  // the first line after a first interval
        shown_ = now;
        return;
    }
    const std::string text = describe(progress);
    if (text == last_) return;
    shown_ = now;
    last_ = text;
    if (terminal_) {
        show("\r\033[K" + on_terminal(text, progress.tally));
        line_open_ = true;
    } else {
        show(text + '\n');
    }
}

void ProgressLine::note(const std::string& text) {
    if (shown_notes_ == most_notes || ++notes_[without_numbers(text)] > most_alike) {
        ++unshown_notes_;
        return;
    }
    ++shown_notes_;
    erase();
    show(one_line(text) + '\n');
    last_.clear();
}

void ProgressLine::erase() {
    if (line_open_) show("\r\033[K");
    line_open_ = false;
}

std::string ProgressLine::on_terminal(const std::string& text, const schedule::Plan::Tally& tally) const {
    const auto painted = [&](std::string_view code, const std::string& words) {
        return coloured_ ? fmt::format("\033[{}m{}\033[0m", code, words) : words;
    };
    const std::size_t width = terminal_width() - 1;
    auto line = text.substr(0, width);
    const auto room = width - line.size();
    const auto failed = fmt::format("{} failed", tally.failed);
    if (const auto at = line.find(", " + failed); at != std::string::npos)
        line.replace(at + 2, failed.size(), painted("31", failed));
    constexpr std::size_t narrowest = 8, around = 3;  // columns; brackets and a space
    if (room < narrowest + around) return line;
    const auto bar = std::min(bar_width, room - around);
    const double share =
        tally.questions == 0 ? 1 : static_cast<double>(tally.decided) / static_cast<double>(tally.questions);
    const auto full = static_cast<std::size_t>(share * static_cast<double>(bar));
    return "[" + painted("32", std::string(full, '#')) + std::string(bar - full, '.') + "] " + line;
}

std::string ProgressLine::describe(const schedule::Progress& progress) const {
    const auto& tally = progress.tally;
    const double rate = progress.seconds > 0 ? static_cast<double>(progress.durable) / progress.seconds : 0;
    const double left = seconds_left(progress, cores_);

    auto text = fmt::format("{}/{} cases", tally.decided, tally.questions);
    if (rate > 0) {
        text += rate >= 0.5 ? fmt::format(", {:.3g}/s", rate) : fmt::format(", {:.3g}/min", 60 * rate);
    }
    if (tally.decided < tally.questions)
        text += fmt::format(", {}{} left{}{}", progress.at_most ? "at most " : "", duration(left),
                            end_.empty() ? "" : " ", end_);
    if (tally.failed > 0) text += fmt::format(", {} failed", tally.failed);
    if (!progress.judgement.empty()) text += "; " + progress.judgement;
    return text;
}

NowWriter::NowWriter(const std::filesystem::path& database, std::string campaign, std::size_t cores)
    : file_(live::now_file(database)), cores_(cores) {
    now_.campaign = std::move(campaign);
    now_.host = this_computer().host;
    now_.process = ::getpid();
}

NowWriter::~NowWriter() {
    std::error_code ignored;
    std::filesystem::remove(file_, ignored);
}

void NowWriter::update(const schedule::Progress& progress) {
    const auto now = Clock::now();
    if (now - written_ < std::chrono::seconds(1)) return;
    written_ = now;
    const auto& tally = progress.tally;
    now_.questions = static_cast<std::int64_t>(tally.questions);
    now_.decided = static_cast<std::int64_t>(tally.decided);
    now_.failed = static_cast<std::int64_t>(tally.failed);
    now_.settled = static_cast<std::int64_t>(progress.durable);
    now_.seconds = progress.seconds;
    now_.seconds_left = seconds_left(progress, cores_);
    now_.at_most = progress.at_most;
    now_.judgement = progress.judgement;
    now_.running.clear();
    for (const auto& [id, one] : progress.under_way)
        now_.running.push_back({id, one.attempt, one.share, progress.seconds - one.given,
                                one.computer ? one.computer->host : std::string()});
    live::write_now(file_, now_);
}

}  // namespace grainsweep::cli
