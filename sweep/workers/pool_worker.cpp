#include "sweep/workers/pool_worker.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace grainsweep::workers {
namespace {

constexpr double longest_silent_start = 30;  // s, before a remark

}  // namespace

std::string PoolWorker::name() const {
    const auto& by = state.computer();
    return by ? fmt::format("worker {} on {}", child->id(), by->host) : fmt::format("worker {}", child->id());
}

Lost PoolWorker::account(double now, const std::string& reason) const {
    Lost lost;
    lost.running = state.running();
    lost.queued = state.waiting();
    lost.seconds = state.running_seconds(now);
    lost.reason = reason;
    if (const auto& log = child->log(); !log.empty()) lost.reason += "; it wrote: " + log;
    if (!state.was_ready() && !state.banner().empty()) lost.reason += "; before that: " + state.banner();
    return lost;
}

std::optional<std::string> PoolWorker::overdue_remark(const TimeLimits& limits, double now,
                                                      const std::string& command) {
    if (!state.was_ready()) {
        const double limit = limits.start ? std::min(longest_silent_start, *limits.start / 2) : longest_silent_start;
        if (remarked || now - state.launched() < limit) return std::nullopt;
        remarked = true;
        return fmt::format("waiting for {} to be ready, {:.0f} s so far: started with '{}'", name(),
                           now - state.launched(), command);
    }
    const double silence = state.silence(now);
    if (!limits.silence || silence < *limits.silence / 2) {
        remarked = false;
    } else if (!std::exchange(remarked, true) && state.cases() > 0) {
        return fmt::format("waiting for a sign of life of {}, {:.0f} s so far", name(), silence);
    }
    return std::nullopt;
}

}  // namespace grainsweep::workers
