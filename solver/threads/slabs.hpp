// Range of indices divided into slabs, one for each thread of a case.
#pragma once

#include "solver/threads/thread_pool.hpp"

#include <cstddef>
#include <memory>

namespace grainsweep {

/// Threads shared by a computation and its parts; copies share them. All threads work on the slabs in parallel. The
/// work must not throw, and its result must not depend on the division.
class Slabs {
public:
    /// Makes one slab, for the calling thread.
    Slabs() = default;
    /// Makes slabs for `threads` threads, including the calling one; at least one.
    explicit Slabs(int threads) : pool_(threads > 1 ? std::make_shared<ThreadPool>(threads) : nullptr) {}

    [[nodiscard]] int count() const { return pool_ == nullptr ? 1 : pool_->size(); }

    /// Calls work(slab) for 0 ... count() - 1; returns when all have ended.
    template <class Work>
    void each(const Work& work) const {
        if (pool_ == nullptr)
            work(0);
        else
            pool_->run(work);
    }
    /// Calls work(from, to) for parts of equal length that cover first ... last.
    template <class Work>
    void over(std::ptrdiff_t first, std::ptrdiff_t last, const Work& work) const {
        const std::ptrdiff_t length = last - first + 1, parts = count();
        if (parts == 1 && length > 0) return work(first, last);
        each([&](int slab) {
            const std::ptrdiff_t from = first + length * slab / parts, end = first + length * (slab + 1) / parts;
            if (from < end) work(from, end - 1);
        });
    }

private:
    std::shared_ptr<ThreadPool> pool_;
};

}  // namespace grainsweep
