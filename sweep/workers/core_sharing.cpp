#include "sweep/workers/core_sharing.hpp"

#include "sweep/workers/message.hpp"

#include <algorithm>
#include <map>
#include <numeric>

namespace grainsweep::workers {
namespace {

void allow(PoolWorker& worker, std::int64_t threads) {
    if (std::exchange(worker.threads, threads) != threads) worker.child->write(encode(Threads{threads}) + "\n");
}

/// The case that it computes or is about to begin.
campaign::Attempt first_case(const PoolWorker& worker) {
    const auto running = worker.state.running();
    return running ? *running : worker.state.waiting().front();
}

}  // namespace

std::vector<std::int64_t> shared_cores(std::size_t cores, std::size_t waiting, std::span<const double> seconds_left) {
    std::vector<std::int64_t> threads(seconds_left.size(), 1);
    if (threads.empty() || cores <= threads.size()) return threads;
    const std::size_t idle = cores - threads.size(), over = idle - std::min(idle, waiting);
    std::vector<std::size_t> longest_first(threads.size());
    std::iota(longest_first.begin(), longest_first.end(), std::size_t{0});
    std::ranges::stable_sort(longest_first,
                             [&](std::size_t a, std::size_t b) { return seconds_left[a] > seconds_left[b]; });
    for (std::size_t k = 0; k < threads.size(); ++k) {
        const std::size_t more = over / threads.size() + (k < over % threads.size() ? 1 : 0);
        threads[longest_first[k]] += static_cast<std::int64_t>(std::min<std::size_t>(more, most_threads - 1));
    }
    return threads;
}

void CoreSharing::begin(PoolWorker& worker) const {
    if (threads_) allow(worker, *threads_);
}

void CoreSharing::share(std::span<const std::shared_ptr<PoolWorker>> workers, std::size_t waiting,
                        const WorkerPool::SecondsLeft& left) {
    if (threads_ || (!shared_ && waiting >= cores_)) return;
    Shares now;
    std::map<std::size_t, std::vector<PoolWorker*>> at_work;  // by node
    for (const auto& worker : workers) {
        if (worker->state.phase() != WorkerState::Phase::serving || worker->state.cases() == 0) continue;
        at_work[worker->child->node()].push_back(worker.get());
        now.emplace_back(worker.get(), worker->threads);
    }
    if (now == shares_ && waiting == waiting_) return;
    shares_.clear();
    shared_ = false;
    waiting_ = waiting;
    for (const auto& [node, there] : at_work) {
        std::vector<double> seconds;
        for (const auto* worker : there) seconds.push_back(left(first_case(*worker)));
        const auto threads = shared_cores(cores_, waiting, seconds);
        for (std::size_t k = 0; k < there.size(); ++k) {
            allow(*there[k], threads[k]);
            shared_ |= threads[k] > 1;
        }
    }
    for (const auto& [worker, before] : now) shares_.emplace_back(worker, worker->threads);
}

}  // namespace grainsweep::workers
