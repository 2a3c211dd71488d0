#include "sweep/workers/worker_state.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <stdexcept>
#include <utility>

namespace grainsweep::workers {
namespace {

// A launcher may greet; one that floods is no launcher.
constexpr std::size_t most_banner_bytes = std::size_t{64} << 10U;
constexpr std::size_t kept_banner_bytes = 500;
// A message is a sentence or the last lines of a log.
constexpr std::size_t longest_message = std::size_t{8} << 10U;
// One heartbeat a second is usual. What a pipe holds may come at once after the main program was stopped, and is less.
constexpr int most_heartbeats = 10'000;

std::string described(const campaign::Computer& program) {
    return fmt::format("{} ({}, build {})", program.version, program.commit, program.build.substr(0, 12));
}

bool same_program(const campaign::Computer& a, const campaign::Computer& b) {
    return a.version == b.version && a.commit == b.commit && a.build == b.build;
}

}  // namespace

std::string shortened(std::string_view text, std::size_t bytes) {
    if (text.size() <= bytes) return std::string(text);
    const auto inside_character = [&](std::size_t at) {
        return (static_cast<unsigned char>(text[at]) & 0xC0U) == 0x80U;
    };
    while (bytes > 0 && inside_character(bytes)) --bytes;
    return fmt::format("{} ...", text.substr(0, bytes));
}

WorkerState::Meaning WorkerState::receive(std::string_view line, double now) {
    if (phase_ == Phase::dismissed) return Nothing{};
    if (phase_ == Phase::starting || !was_ready()) return receive_starting(line, now);
    if (phase_ == Phase::leaving && cases() == 0) return Nothing{};  // a launcher that tidies up behind it
    try {
        ToBoss message = decode_to_boss(line);
        received_at_ = now;
        if (auto* done = std::get_if<Done>(&message)) return understand(*done);
        if (auto* begun = std::get_if<Begun>(&message)) return understand(*begun, now);
        if (const auto* alive = std::get_if<Alive>(&message)) return understand(*alive, now);
        if (auto* back = std::get_if<GiveBack>(&message)) return understand(*back, now);
        return Complaint{"the worker said twice that it is ready"};
    } catch (const std::invalid_argument& error) {
        return Complaint{fmt::format("the worker wrote something that is no message: {} ({})", shortened(line, 200),
                                     shortened(error.what(), 200))};
    }
}

WorkerState::Meaning WorkerState::receive_starting(std::string_view line, double now) {
    try {
        const ToBoss message = decode_to_boss(line);
        const auto* ready = std::get_if<Ready>(&message);
        if (ready == nullptr) return Complaint{"the worker answered before it was ready"};
        if (ready->protocol != protocol_number)
            return Complaint{fmt::format("the worker is {} with protocol {}, the main program has {}",
                                         described(ready->computer), ready->protocol, protocol_number)};
        if (!same_program(ready->computer, expected_->program))
            return Complaint{fmt::format("the worker is {}, the main program is {}", described(ready->computer),
                                         described(expected_->program))};
        computer_ = std::make_shared<const campaign::Computer>(ready->computer);
        received_at_ = now;
        if (phase_ == Phase::starting) phase_ = Phase::serving;
        return Nothing{};
    } catch (const std::invalid_argument&) {
        banner_bytes_ += line.size() + 1;
        if (banner_.size() < kept_banner_bytes) {
            if (!banner_.empty()) banner_ += " | ";
            banner_ += shortened(line, kept_banner_bytes - std::min(banner_.size(), kept_banner_bytes));
        }
        if (banner_bytes_ > most_banner_bytes)
            return Complaint{fmt::format("it wrote {} bytes before a worker was ready: {}", banner_bytes_, banner_)};
        return Banner{shortened(line, kept_banner_bytes)};
    }
}

WorkerState::Meaning WorkerState::understand(Begun& begun, double now) {
    if (running_ || waiting_.empty() || waiting_.front() != begun.attempt)
        return Complaint{"the worker began a case that was not its next"};
    running_ = {std::move(waiting_.front()), begun.resumed, now};
    waiting_.pop_front();
    has_begun_any_ = true;
    return Nothing{};
}

WorkerState::Meaning WorkerState::understand(const Alive& alive, double now) {
    if (!is_running(alive.attempt)) return Complaint{"the worker gave a sign of life of a case it had not begun"};
    if (now - second_ > 1) {
        second_ = now;
        heartbeats_ = 0;
    }
    if (++heartbeats_ > most_heartbeats)
        return Complaint{fmt::format("the worker gave {} signs of life within a second", heartbeats_)};
    return Heartbeat{alive.attempt, alive.progress};
}

WorkerState::Meaning WorkerState::understand(Done& done) {
    auto& result = done.result;
    if (!is_running(result.attempt)) return Complaint{"the worker answered a case it had not begun"};
    if (result.outcome == campaign::Outcome::abandoned) return Complaint{"the worker answered 'abandoned'"};
    if (const auto name = campaign::undeclared(result.observations, expected_->measured))
        return Complaint{
            fmt::format("the worker measured '{}', which its scene does not declare so", shortened(*name, 100))};
    const bool measured =
        result.outcome == campaign::Outcome::completed || result.outcome == campaign::Outcome::skipped;
    if (!measured) result.observations = {};  // numbers of a failure are no answer
    result.message = shortened(result.message, longest_message);
    running_.reset();
    return Finished{std::move(result), done.checkpointed};
}

WorkerState::Meaning WorkerState::understand(GiveBack& back, double now) {
    const auto found = std::ranges::find(waiting_, back.attempt);
    const bool running = is_running(back.attempt);
    if (!running && found == waiting_.end()) return Complaint{"the worker gave back a case it was not given"};
    GivenBack event{back.attempt, shortened(back.reason, longest_message), running ? running_seconds(now) : 0,
                    phase_ == Phase::leaving, back.broken};
    if (running)
        running_.reset();
    else
        waiting_.erase(found);
    phase_ = Phase::leaving;
    return event;
}

bool WorkerState::is_running(const campaign::Attempt& attempt) const {
    return running_ && running_->attempt == attempt;
}

void WorkerState::give(const campaign::Attempt& attempt, double now) {
    assert(phase_ == Phase::serving);
    if (cases() == 0) received_at_ = now;  // before, nothing was expected of it
    waiting_.push_back(attempt);
}

void WorkerState::stop() {
    if (phase_ == Phase::starting || phase_ == Phase::serving) phase_ = Phase::leaving;
}

double WorkerState::silence(double now) const {
    return cases() == 0 && phase_ != Phase::leaving ? 0 : now - received_at_;
}

WorkerState::Overdue WorkerState::overdue(const TimeLimits& limits, double now) const {
    const auto over = [](double seconds, std::optional<double> limit) { return limit && seconds > *limit; };
    if (phase_ == Phase::dismissed) return Overdue::nothing;
    if (!was_ready()) return over(now - launched_, limits.start) ? Overdue::start : Overdue::nothing;
    if (running_ && over(now - running_->began, limits.wall)) return Overdue::answer;
    return over(silence(now), limits.silence) ? Overdue::silence : Overdue::nothing;
}

std::optional<campaign::Attempt> WorkerState::running() const {
    return running_ ? std::optional(running_->attempt) : std::nullopt;
}

}  // namespace grainsweep::workers
