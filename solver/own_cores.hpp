// Number of processors on which the system lets this process run (taskset, or the cpuset of a container or job).
#pragma once

#include <sched.h>

#include <algorithm>
#include <memory>
#include <thread>

namespace grainsweep {

/// Returns the number, at least 1. Machines with more processors than a cpu_set_t can hold need a larger set.
[[nodiscard]] inline int own_cores() {
    for (int most = CPU_SETSIZE; most <= 1 << 20; most *= 2) {
        const std::unique_ptr<cpu_set_t, void (*)(cpu_set_t*)> set(CPU_ALLOC(most), [](cpu_set_t* s) { CPU_FREE(s); });
        const std::size_t bytes = CPU_ALLOC_SIZE(most);
        if (set && ::sched_getaffinity(0, bytes, set.get()) == 0) return std::max(1, CPU_COUNT_S(bytes, set.get()));
    }
    return static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

}  // namespace grainsweep
