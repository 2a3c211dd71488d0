#include "tests/support/interpolation.hpp"

#include <algorithm>
#include <cstddef>

namespace grainsweep::tests {

double cubic(const std::vector<double>& x, const std::vector<double>& y, double at) {
    auto next = static_cast<std::size_t>(std::ranges::lower_bound(x, at) - x.begin());
    next = std::clamp<std::size_t>(next, 2, x.size() - 2);
    double sum = 0;
    for (std::size_t a = next - 2; a < next + 2; ++a) {
        double weight = 1;
        for (std::size_t b = next - 2; b < next + 2; ++b)
            if (a != b) weight *= (at - x[b]) / (x[a] - x[b]);
        sum += weight * y[a];
    }
    return sum;
}

}  // namespace grainsweep::tests
