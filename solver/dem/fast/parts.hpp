// Parts into which threads divide all work other than sweeps: ranges of particles, of cells, of pairs. Results do not
// depend on their number, because counts and lists of the parts are joined in order.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "solver/dem/fast/columns.hpp"
#include "solver/threads/thread_pool.hpp"

namespace grainsweep::dem::fast {

/// Range of consecutive items.
struct Range {
    std::int32_t begin, end;
};

class Parts {
public:
    /// Makes one part, for the calling thread alone.
    Parts() = default;
    /// Makes one part per thread of the pool. `lists`: one list per part for the pairs that it finds.
    Parts(ThreadPool& pool, std::vector<PairColumns*> lists) : pool_(&pool), lists_(std::move(lists)) {}

    [[nodiscard]] int count() const { return pool_ == nullptr ? 1 : pool_->size(); }
    [[nodiscard]] PairColumns& lists(int part) const { return *lists_[static_cast<std::size_t>(part)]; }

    /// Calls work(part) for each part; see ThreadPool::run().
    template <class Work>
    void run(const Work& work) const {
        if (pool_ == nullptr)
            work(0);
        else
            pool_->run(work);
    }
    /// Returns the share of a part in `all` items; it begins at a multiple of `grain`.
    [[nodiscard]] Range share(int part, std::int32_t all, std::int32_t grain = 1) const {
        const std::int64_t grains = (std::int64_t{all} + grain - 1) / grain, parts = count();
        const auto bound = [&](std::int64_t k) {
            return static_cast<std::int32_t>(std::min<std::int64_t>(all, grains * k / parts * grain));
        };
        return {bound(part), bound(part + 1)};
    }
    /// Calls work(range) for the share of each part.
    template <class Work>
    void run_shares(std::int32_t all, const Work& work, std::int32_t grain = 1) const {
        run([&](int part) { work(share(part, all, grain)); });
    }
    /// Calls count(range) for the share of each part, which returns the number of items found there. Returns the number
    /// found before each part, and finally the total.
    template <class Count>
    [[nodiscard]] std::vector<std::int32_t> counted(std::int32_t all, const Count& count_in,
                                                    std::int32_t grain = 1) const {
        std::vector<std::int32_t> before(static_cast<std::size_t>(count()) + 1, 0);
        run([&](int part) { before[static_cast<std::size_t>(part) + 1] = count_in(share(part, all, grain)); });
        for (std::size_t k = 1; k < before.size(); ++k) before[k] += before[k - 1];
        return before;
    }

private:
    ThreadPool* pool_ = nullptr;
    std::vector<PairColumns*> lists_;
};

}  // namespace grainsweep::dem::fast
