#include "sweep/store/moment.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>

namespace grainsweep::store {

std::string utc_now() {
    using namespace std::chrono;
    const auto now = floor<milliseconds>(system_clock::now());
    const auto second = floor<seconds>(now);
    return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03d}Z", fmt::gmtime(system_clock::to_time_t(second)),
                       (now - second).count());
}

}  // namespace grainsweep::store
