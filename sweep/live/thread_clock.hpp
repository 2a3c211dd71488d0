// Processor time of the calling thread: what work costs, however busy the machine is.
#pragma once

#include <ctime>

namespace grainsweep::live {

/// Returns the processor time that this thread has used, s.
inline double thread_seconds() {
    std::timespec spent{};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &spent);
    return static_cast<double>(spent.tv_sec) + 1e-9 * static_cast<double>(spent.tv_nsec);
}

}  // namespace grainsweep::live
