#include "sweep/workers/desk.hpp"

#include "solver/scenes/scene.hpp"
#include "sweep/files/descriptor.hpp"
#include "sweep/workers/asking_signals.hpp"
#include "sweep/workers/line_buffer.hpp"
#include "sweep/workers/worker_state.hpp"

#include <fmt/format.h>
#include <pthread.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <thread>
#include <utility>

namespace grainsweep::workers {
namespace {

constexpr int main_program_is_gone = 3;
constexpr int nonsense_was_written = 2;

/// What no main program writes ends the worker: what it would compute is not known to be what was asked.
[[noreturn]] void refuse(std::string_view line, std::string_view why) {
    const std::string sentence = fmt::format("grainsweep worker: standard input is not the main program's: {} ({})\n",
                                             shortened(line, 200), why);
    (void)std::fwrite(sentence.data(), 1, sentence.size(), stderr);
    std::_Exit(nonsense_was_written);
}

}  // namespace

Desk::Desk(const Limits& limits) : limits_(limits), progress_(std::numeric_limits<double>::quiet_NaN()) {
    hold_asking_signals();
    ::pthread_getcpuclockid(::pthread_self(), &computing_);
}

void Desk::open(const campaign::Computer& computer) {
    {
        const std::lock_guard lock(mutex_);
        write(Ready{protocol_number, computer});
        flush();
    }
    std::thread([this] { read(); }).detach();
    std::thread([this] {
        const auto asked = [this](int signal) {
            end(Ending::signal,
                fmt::format("its worker was asked to end by signal {} ({})", signal, ::strsignal(signal)));
        };
        attend(asked, [this] { tick(); });
    }).detach();
}

std::optional<Run> Desk::next() {
    std::unique_lock lock(mutex_);
    // With another case at hand its beginning goes out in one piece with the last answer.
    if (questions_.empty()) flush();
    changed_.wait(lock, [this] { return ending_ != Ending::none || !questions_.empty(); });
    if (ending_ != Ending::none) return std::nullopt;
    Run run = std::move(questions_.front());
    questions_.pop_front();
    return run;
}

void Desk::begin(const campaign::Attempt& attempt, bool resumed) {
    const std::lock_guard lock(mutex_);
    progress_ = std::numeric_limits<double>::quiet_NaN();
    running_ = attempt;
    write(Begun{attempt, resumed});
    flush();
}

void Desk::advanced(double progress) {
    progress_ = progress;
    ++looks_;
}

void Desk::answer(Done done) {
    const std::lock_guard lock(mutex_);
    const std::size_t before = outgoing_.size();
    write(done);
    if (const std::size_t length = outgoing_.size() - before; length > longest_line) {
        outgoing_.resize(before);
        done.result.outcome = campaign::Outcome::rejected;
        done.result.observations = {};
        done.result.message = fmt::format("what it measured takes {} MB, more than the {} MB of a message",
                                          length >> 20U, longest_line >> 20U);
        write(done);
    }
    running_.reset();
}

void Desk::give_back() {
    const std::lock_guard lock(mutex_);
    write(GiveBack{*running_, reason_});
    running_.reset();
}

void Desk::break_off(std::string reason) {
    mutex_.lock();
    reason_ = std::move(reason);
    if (running_) write(GiveBack{*running_, reason_, true});
    running_.reset();
    leave();
}

void Desk::close() {
    mutex_.lock();
    leave();
}

// Whatever is under way in the computing thread is not waited for: after this no line can follow.
void Desk::leave() {
    if (running_) write(GiveBack{*running_, reason_ + ", and it could not be saved in time"});
    for (const auto& run : questions_) write(GiveBack{{run.question.id, run.attempt}, reason_});
    flush();
    std::_Exit(ending_ == Ending::silence ? main_program_is_gone : 0);
}

void Desk::end(Ending why, std::string reason) {
    const std::lock_guard lock(mutex_);
    // Asked twice: at once. A host passes on a signal that all of its processes may have got: that is one request.
    if (ending_ == Ending::signal && why == Ending::signal && ending_for_ > 1) leave();
    if (ending_ == Ending::none || (ending_ == Ending::asked && why == Ending::signal)) {
        ending_ = why;
        reason_ = std::move(reason);
    }
    changed_.notify_all();
}

// ---- reading ---------------------------------------------------------------------------------------------------

void Desk::read() {
    LineBuffer lines(longest_line);
    std::array<char, 65536> piece{};
    while (true) {
        const auto length = ::read(STDIN_FILENO, piece.data(), piece.size());
        if (length < 0 && errno == EINTR) continue;
        if (length <= 0) std::_Exit(main_program_is_gone);  // an answer is of no use
        const bool fits = lines.feed({piece.data(), static_cast<std::size_t>(length)}, [this](std::string_view line) {
            take(line);
            return true;
        });
        if (!fits) refuse(lines.begun(), "a line without an end");
    }
}

void Desk::take(std::string_view line) {
    silence_ = 0;
    try {
        ToWorker message = decode_to_worker(line);
        if (std::holds_alternative<Stop>(message)) return end(Ending::asked, "given back before it was finished");
        if (const auto* threads = std::get_if<Threads>(&message))
            return allow_threads(static_cast<int>(threads->count));
        auto* run = std::get_if<Run>(&message);
        if (run == nullptr) return;
        const std::lock_guard lock(mutex_);
        questions_.push_back(std::move(*run));
        changed_.notify_all();
    } catch (const std::invalid_argument& error) {
        refuse(line, error.what());
    }
}

// ---- signals and time ------------------------------------------------------------------------------------------

void Desk::tick() {
    if (++silence_ > limits_.lease_seconds)
        end(Ending::silence, "its worker got no message from the main program for too long");
    const std::lock_guard lock(mutex_);
    if (ending_ != Ending::none && ++ending_for_ > limits_.give_back_seconds) leave();
    if (!running_ || !makes_headway()) return;
    write(Alive{*running_, progress_});
    flush();
}

// A thread that has neither reported nor used its processor since the last heartbeat is blocked, for example by a dead
// file server.
bool Desk::makes_headway() {
    timespec computed{};
    ::clock_gettime(computing_, &computed);
    const unsigned looks = looks_;
    const bool moved =
        looks != looks_seen_ || computed.tv_sec != computed_seen_.tv_sec || computed.tv_nsec != computed_seen_.tv_nsec;
    looks_seen_ = looks;
    computed_seen_ = computed;
    return moved;
}

// ---- writing ---------------------------------------------------------------------------------------------------

void Desk::write(const ToBoss& message) {
    outgoing_ += encode(message);
    outgoing_ += '\n';
}

void Desk::flush() {
    if (!files::write_all(STDOUT_FILENO, outgoing_)) std::_Exit(main_program_is_gone);
    outgoing_.clear();
}

}  // namespace grainsweep::workers
