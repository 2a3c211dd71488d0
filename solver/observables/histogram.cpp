#include "solver/observables/histogram.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>

namespace grainsweep::observables {

std::vector<std::pair<double, double>> log_histogram(std::span<const double> values, int per_decade, double floor) {
    std::map<std::int64_t, std::int64_t> counts;
    constexpr double most = 1e300;  // NaN counts as the floor, infinity as this
    for (const double value : values)
        ++counts[static_cast<std::int64_t>(
            std::floor(std::log10(value > floor ? std::min(value, most) : floor) * per_decade))];
    std::vector<std::pair<double, double>> shares;
    for (const auto& [bin, count] : counts)
        shares.emplace_back(std::pow(10, (static_cast<double>(bin) + 0.5) / per_decade),
                            static_cast<double>(count) / static_cast<double>(values.size()));
    return shares;
}

}  // namespace grainsweep::observables
