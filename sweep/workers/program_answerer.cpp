#include "sweep/workers/program_answerer.hpp"

#include "sweep/files/descriptor.hpp"
#include "sweep/files/system_error.hpp"
#include "sweep/workers/program_process.hpp"
#include "sweep/workers/program_results.hpp"
#include "sweep/workers/worker_state.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace grainsweep::workers {
namespace {

constexpr std::size_t longest_reply = std::size_t{16} << 20U;
constexpr off_t longest_log = off_t{1} << 20U;
constexpr int look_milliseconds = 100;
constexpr int silence_milliseconds = 200;  // after the first reply of a program, where a second line may come

struct Pipe {
    Pipe() {
        std::array<int, 2> ends{};
        if (::pipe2(ends.data(), O_CLOEXEC) != 0)
            throw SystemError(fmt::format("no pipe to a program: {}", std::strerror(errno)));
        from = files::Descriptor(ends[0]);
        to = files::Descriptor(ends[1]);
    }
    files::Descriptor from, to;
};

void add_flag(const files::Descriptor& descriptor, int flag) {
    ::fcntl(descriptor.number(), F_SETFL, ::fcntl(descriptor.number(), F_GETFL) | flag);
}

/// Starts a program in its folder; `question`: nullptr for one that answers several. Throws SystemError.
std::unique_ptr<ProgramProcess> started(const campaign::Program& program, const campaign::Case* question,
                                        const ProgramFolder& folder, const std::array<int, 3>& streams,
                                        ProgramGuard& guard) {
    ProcessStart start{program_argv(program, question)};
    start.environment = program_environment(program, question);
    start.folder = folder.descriptor();
    start.streams = streams;
    start.memory = program.memory;
    start.file = program.disk;
    try {
        return std::make_unique<ProgramProcess>(start, guard);
    } catch (const std::runtime_error& error) {
        throw SystemError(error.what());
    }
}

}  // namespace

/// A program that stays alive and answers line by line.
class ProgramLines {
public:
    enum class Go { on, stop, give_up };
    enum class Heard { reply, end, ended_before, too_long, unasked, stopped, given_up };

    /// Starts the program in a folder of its own within `cases`. Throws SystemError if it cannot be started.
    ProgramLines(const campaign::Program& program, const std::filesystem::path& cases, ProgramGuard& guard)
        : folder_(cases / fmt::format("alive.{}{}", ::getpid(), running_suffix)) {
        std::signal(SIGPIPE, SIG_IGN);  // a write to one that ended is an error code
        fill_folder(folder_, program, nullptr);
        log_ = folder_.create("stderr.txt");
        add_flag(log_, O_APPEND);  // it is cut now and then
        Pipe question, reply;
        process_ =
            started(program, nullptr, folder_, {question.from.number(), reply.to.number(), log_.number()}, guard);
        in_ = std::move(question.to);
        out_ = std::move(reply.from);
        add_flag(in_, O_NONBLOCK);
        add_flag(out_, O_NONBLOCK);
        status_ =
            files::Descriptor(::open(fmt::format("/proc/{}/status", process_->id()).c_str(), O_RDONLY | O_CLOEXEC));
    }
    ProgramLines(const ProgramLines&) = delete;
    ProgramLines& operator=(const ProgramLines&) = delete;

    /// Writes the question and waits for the line of the answer; line() returns it without its line end. `look` is
    /// called about ten times a second. `ended_before`: the program had ended before the question.
    [[nodiscard]] Heard ask(const std::string& question, const std::function<Go()>& look) {
        shorten_log();
        std::string_view nothing;
        line_.clear();
        if (received_.empty() && exchange(nothing, 0) == Heard::end) return Heard::ended_before;
        if (!received_.empty() || !line_.empty()) {
            line_ = shortened(line_.empty() ? received_ : line_, 200);
            return Heard::unasked;
        }
        const std::string text = question + "\n";
        std::string_view rest = text;
        while (true) {
            if (const auto heard = exchange(rest, look_milliseconds)) return *heard;
            const auto go = look();
            if (go != Go::on) return go == Go::stop ? Heard::stopped : Heard::given_up;
        }
    }
    [[nodiscard]] const std::string& line() const { return line_; }

    /// Counts a reply that names no case. Returns whether one line came for one question: a second line would be taken
    /// for the next reply. Waits for it after the first reply of the program; ask() looks for it later.
    [[nodiscard]] bool came_alone() {
        if (nameless_++ > 0) return true;
        std::string reply = std::exchange(line_, {});
        std::string_view nothing;
        if (received_.empty()) (void)exchange(nothing, silence_milliseconds);
        if (line_.empty() && received_.empty()) {
            line_ = std::move(reply);
            return true;
        }
        line_ = shortened(line_.empty() ? received_ : line_, 200);
        --nameless_;  // it is no result
        return false;
    }
    /// Returns the number of replies that named no case.
    [[nodiscard]] std::int64_t nameless() const { return nameless_; }

    /// Ends the program. Then result() is valid.
    void end() {
        (void)in_.close();
        if (!process_->wait(0.05)) process_->end();
    }
    /// Returns whether the program ends by itself, at once, with exit code 0.
    [[nodiscard]] bool ended_well() {
        constexpr double time_to_end = 1;
        return process_->wait(time_to_end) && process_->result().status == 0;
    }
    [[nodiscard]] const ProgramEnd& result() const { return process_->result(); }
    [[nodiscard]] double cpu_seconds() const { return process_->cpu_seconds(); }
    /// Returns the largest resident memory so far in bytes; NaN if the system does not report it.
    [[nodiscard]] double peak_memory() const {
        std::array<char, 4096> text{};
        const auto length = ::pread(status_.number(), text.data(), text.size() - 1, 0);
        if (length <= 0) return std::numeric_limits<double>::quiet_NaN();
        const std::string_view all(text.data(), static_cast<std::size_t>(length));
        constexpr std::string_view name = "VmHWM:";
        const auto at = all.find(name);
        const auto digit = at == std::string_view::npos ? at : all.find_first_of("0123456789", at + name.size());
        if (digit == std::string_view::npos) return std::numeric_limits<double>::quiet_NaN();
        double kilobytes = 0;
        std::from_chars(all.data() + digit, all.data() + all.size(), kilobytes);
        return 1024 * kilobytes;
    }
    [[nodiscard]] const ProgramFolder& folder() const { return folder_; }

private:
    /// Takes a line from the received bytes. Returns false if no line is complete yet.
    [[nodiscard]] bool take_line() {
        const auto end = received_.find('\n', searched_);
        searched_ = received_.size();
        if (end == std::string::npos) return false;
        line_ = received_.substr(0, end);
        received_.erase(0, end + 1);
        searched_ = 0;
        return true;
    }
    /// Writes as much as the pipe accepts, and reads all that it contains.
    [[nodiscard]] std::optional<Heard> exchange(std::string_view& rest, int milliseconds) {
        std::array<pollfd, 2> ends = {pollfd{out_.number(), POLLIN, 0},
                                      pollfd{rest.empty() ? -1 : in_.number(), POLLOUT, 0}};
        if (::poll(ends.data(), ends.size(), milliseconds) <= 0) return std::nullopt;
        if (ends[1].revents != 0) {
            const auto length = ::write(in_.number(), rest.data(), rest.size());
            if (length > 0) rest.remove_prefix(static_cast<std::size_t>(length));
            if (length < 0 && errno != EAGAIN && errno != EINTR) rest = {};  // it has ended, or closed its input
        }
        if (ends[0].revents == 0) return std::nullopt;
        std::array<char, 65536> piece{};
        const auto length = ::read(out_.number(), piece.data(), piece.size());
        if (length == 0) return Heard::end;
        if (length < 0) return errno == EAGAIN || errno == EINTR ? std::nullopt : std::optional(Heard::end);
        received_.append(piece.data(), static_cast<std::size_t>(length));
        if (take_line()) return Heard::reply;
        return received_.size() > longest_reply ? std::optional(Heard::too_long) : std::nullopt;
    }
    void shorten_log() const {
        if (::lseek(log_.number(), 0, SEEK_END) > longest_log) (void)!::ftruncate(log_.number(), 0);
    }

    ProgramFolder folder_;
    files::Descriptor in_, out_, status_, log_;
    std::unique_ptr<ProgramProcess> process_;  // ended before its pipes are closed
    std::string received_, line_;
    std::size_t searched_ = 0;  ///< of received_, without a line end
    std::int64_t nameless_ = 0;
};

namespace {

namespace fs = std::filesystem;
using campaign::CaseResult;
using campaign::Outcome;
using campaign::Program;
using Clock = std::chrono::steady_clock;

constexpr double pulse_seconds = 0.1, first_size_look = 0.3;
constexpr std::int64_t most_kept = 100;  // folders of failed cases
constexpr std::size_t log_bytes = 2000;

double elapsed(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

std::int64_t exit_status(int status) {
    return WIFSIGNALED(status) ? -WTERMSIG(status) : WEXITSTATUS(status);
}

void close_result(CaseResult& result, Outcome outcome, std::string message) {
    result.outcome = outcome;
    result.message = std::move(message);
}

/// Why a running program is to be ended, besides that it is given up.
class Limits {
public:
    Limits(const ProgramOptions& options, const Program& program, const ProgramFolder& folder)
        : options_(options), program_(program), folder_(folder) {}

    /// Whether one is exceeded; `result` says so.
    bool exceeded(CaseResult& result) {
        const double now = elapsed(start_);
        if (options_.limit_seconds && now > *options_.limit_seconds) {
            close_result(result, Outcome::timed_out, fmt::format("no answer within {} s", *options_.limit_seconds));
            return true;
        }
        if (now < next_look_) return false;
        const bool full = writes_too_much(result);
        next_look_ = now + std::max(first_size_look, 10 * (elapsed(start_) - now));  // a tenth of the time at most
        return full;
    }
    bool writes_too_much(CaseResult& result) const {
        const auto size = folder_.size(program_.disk);
        if (size.bytes < program_.disk && size.files < most_files && !size.too_deep) return false;
        close_result(result, Outcome::rejected,
                     size.too_deep              ? std::string("it made folders within folders, more than 100 deep")
                     : size.files >= most_files ? fmt::format("it wrote {} files, more than a case may", size.files)
                                                : fmt::format("it wrote {:.6g} MB, and \"disk\" allows a case {:.6g}",
                                                              1e-6 * static_cast<double>(size.bytes),
                                                              1e-6 * static_cast<double>(program_.disk)));
        return true;
    }
    [[nodiscard]] double seconds() const { return elapsed(start_); }

private:
    static constexpr std::int64_t most_files = 100'000;

    const ProgramOptions& options_;
    const Program& program_;
    const ProgramFolder& folder_;
    Clock::time_point start_ = Clock::now();
    double next_look_ = first_size_look;
};

/// Converts a reply to the outcome of a case.
void take(ProgramReply&& reply, CaseResult& result) {
    const auto outcome = reply.kind == ProgramReply::Kind::measured   ? Outcome::completed
                         : reply.kind == ProgramReply::Kind::unstable ? Outcome::unstable
                                                                      : Outcome::rejected;
    close_result(result, outcome, std::move(reply.message));
    if (outcome == Outcome::completed) result.observations = std::move(reply.observations);
}

/// How it ended, and the last lines of its standard error, or, where that is silent, of its standard output.
std::string crash_sentence(int status, const ProgramFolder& folder) {
    auto log = folder.end_of("stderr.txt", log_bytes);
    if (log.empty()) log = folder.end_of("stdout.txt", log_bytes);
    return fmt::format("{}{}{}", describe_end("the program", status), log.empty() ? "" : "; it wrote: ", log);
}

std::string unasked_sentence(const ProgramLines& lines) {
    const auto earlier = lines.nameless();
    return fmt::format("the program wrote a line that was not asked for: {}{}", lines.line(),
                       earlier == 0 ? std::string()
                                    : fmt::format("; its {} before named no \"case\" and may be of other cases",
                                                  earlier == 1 ? "reply" : fmt::format("{} replies", earlier)));
}

std::unique_ptr<ProgramProcess> start_case(const Program& program, const campaign::Case& question,
                                           const ProgramFolder& folder, ProgramGuard& guard) {
    const auto out = folder.create("stdout.txt"), err = folder.create("stderr.txt");
    return started(program, &question, folder, {-1, out.number(), err.number()}, guard);
}

}  // namespace

ProgramAnswerer::ProgramAnswerer(std::shared_ptr<const Program> program, ProgramOptions options, ProgramGuard& guard)
    : program_(std::move(program)), options_(std::move(options)), guard_(guard) {}

ProgramAnswerer::~ProgramAnswerer() = default;

std::optional<CaseResult> ProgramAnswerer::answer(const campaign::Case& question, std::int64_t attempt,
                                                  const Pulse& pulse) {
    check_version();
    return program_->protocol == Program::Protocol::lines ? by_lines(question, attempt, pulse)
                                                          : by_files(question, attempt, pulse);
}

void ProgramAnswerer::check_version() {
    if (program_->version_command.empty() || std::exchange(version_checked_, true)) return;
    try {
        if (const auto here = ask_version(*program_, guard_); here != program_->version)
            throw SystemError(fmt::format("{} is version {} here, and the campaign was read with version {}",
                                          program_->version_command.front(), here, program_->version));
    } catch (const SystemError&) {
        throw;
    } catch (const std::runtime_error& why) {
        throw SystemError(
            fmt::format("the version of {} cannot be asked: {}", program_->version_command.front(), why.what()));
    }
}

std::optional<CaseResult> ProgramAnswerer::by_files(const campaign::Case& question, std::int64_t attempt,
                                                    const Pulse& pulse) {
    CaseResult result;
    result.attempt = {question.id, attempt};
    const bool stays = !options_.keep.empty();
    ProgramFolder folder(stays ? options_.keep.parent_path() /
                                     (options_.keep.filename().string() + std::string(running_suffix))
                               : options_.folder / fmt::format("{}.{}{}", question.id, attempt, running_suffix));
    fill_folder(folder, *program_, &question);
    Limits limits(options_, *program_, folder);
    const auto process = start_case(*program_, question, folder, guard_);
    bool ended_by_limit = false;
    for (double wait = 0.01; !process->wait(wait); wait = pulse_seconds) {
        if (!pulse()) {
            process->end();
            return std::nullopt;
        }
        if (!limits.exceeded(result)) continue;
        process->end();
        ended_by_limit = true;
        break;
    }
    const auto& end = process->result();
    result.cost.wall_seconds = limits.seconds();
    result.cost.cpu_seconds = end.cpu_seconds;
    result.program = {program_->version, end.peak_memory, exit_status(end.status)};
    if (!ended_by_limit && !limits.writes_too_much(result)) {
        if (end.status != 0)
            close_result(result, Outcome::crashed, crash_sentence(end.status, folder));
        else
            take(results_in(folder, *program_), result);
    }
    keep_or_remove(folder, result);
    return result;
}

void ProgramAnswerer::keep_or_remove(ProgramFolder& folder, const CaseResult& result) {
    if (!options_.keep.empty()) return folder.keep_as(options_.keep.filename().string());
    const bool failed = result.outcome != Outcome::completed;
    const bool all = program_->keep == Program::Keep::all;
    if (program_->keep == Program::Keep::none || (!failed && !all)) return;
    if (!all) {
        if (kept_ < 0) {
            std::error_code ignored;
            kept_ = 0;
            for (auto entry = fs::directory_iterator(options_.folder, ignored); entry != fs::directory_iterator();
                 entry.increment(ignored))
                if (!entry->path().filename().string().ends_with(running_suffix)) ++kept_;
        }
        if (kept_ > most_kept) return;
        ++kept_;
    }
    folder.keep_as(fmt::format("{}.{}", result.attempt.case_id, result.attempt.number));
}

std::optional<CaseResult> ProgramAnswerer::by_lines(const campaign::Case& question, std::int64_t attempt,
                                                    const Pulse& pulse) {
    CaseResult result;
    result.attempt = {question.id, attempt};
    const auto start = Clock::now();
    using Heard = ProgramLines::Heard;
    const auto ask = [&] {
        if (!lines_) lines_ = std::make_unique<ProgramLines>(*program_, options_.folder, guard_);
        Limits limits(options_, *program_, lines_->folder());
        const double before = lines_->cpu_seconds();
        const auto heard =
            lines_->ask(campaign::program_question(question.id, question.seed, program_->cores, question.inputs), [&] {
                if (!pulse()) return ProgramLines::Go::give_up;
                return limits.exceeded(result) ? ProgramLines::Go::stop : ProgramLines::Go::on;
            });
        result.cost.wall_seconds = elapsed(start);
        result.cost.cpu_seconds = std::max(0.0, lines_->cpu_seconds() - before);
        return heard;
    };
    auto heard = ask();
    if (heard == Heard::ended_before || (heard == Heard::end && lines_->ended_well())) {
        lines_.reset();  // it ended after the case before: no matter of this one
        heard = ask();
    }
    result.program = {program_->version, lines_->peak_memory(), std::nullopt};
    if (heard == Heard::reply) {
        try {
            auto reply = results_in(lines_->line(), question.id, *program_);
            if (reply.names_case || lines_->came_alone()) {
                take(std::move(reply), result);
                return result;
            }
            heard = Heard::unasked;
        } catch (const std::invalid_argument& why) {  // its next message could not be distinguished from this one
            close_result(result, Outcome::rejected, why.what());
        }
    } else if (heard == Heard::too_long) {
        close_result(result, Outcome::rejected, "it replied by a line of more than 16 MB");
    }
    lines_->end();
    const auto& end = lines_->result();
    result.program = {program_->version, end.peak_memory, exit_status(end.status)};
    if (heard == Heard::end || heard == Heard::ended_before)
        close_result(result, Outcome::crashed, crash_sentence(end.status, lines_->folder()));
    else if (heard == Heard::unasked)
        close_result(result, Outcome::crashed, unasked_sentence(*lines_));
    lines_.reset();
    if (heard == Heard::given_up) return std::nullopt;
    return result;
}

}  // namespace grainsweep::workers
