#include "solver/observables/histogram.hpp"

#include <cstdint>
#include <map>

namespace grainsweep::observables {

std::vector<std::pair<double, double>> histogram(std::span<const double> values, double width) {
    std::map<std::int64_t, std::int64_t> counts;
    for (const double value : values) ++counts[static_cast<std::int64_t>(value / width)];
    std::vector<std::pair<double, double>> shares;
    for (const auto& [bin, count] : counts)
        shares.emplace_back((static_cast<double>(bin) + 0.5) * width,
                            static_cast<double>(count) / static_cast<double>(values.size()));
    return shares;
}

}  // namespace grainsweep::observables
