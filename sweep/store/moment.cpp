#include "sweep/store/moment.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

namespace grainsweep::store {
namespace {

using namespace std::chrono;

std::string utc_of(system_clock::time_point moment) {
    const auto at = floor<milliseconds>(moment);
    const auto second = floor<seconds>(at);
    return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03d}Z", fmt::gmtime(system_clock::to_time_t(second)),
                       (at - second).count());
}

}  // namespace

std::string utc_now() {
    return utc_of(system_clock::now());
}

std::string RunClock::start() const {
    return utc_of(date_);
}

std::string RunClock::now() const {
    return utc_of(date_ + duration_cast<system_clock::duration>(steady_clock::now() - began_));
}

}  // namespace grainsweep::store
