#include "solver/scenes/kit/rare_sizes.hpp"

#include "solver/scenes/kit/sentence.hpp"

#include <cmath>

namespace grainsweep::kit {
namespace {

constexpr double part = 0.1;     // of the volume
constexpr double fewest = 3;     // spheres that hold it
constexpr double finest = 1e-9;  // share by number from which the volume is summed
constexpr double growth = 1.02;  // from one share to the next

/// Share by number of the largest spheres that hold `part` of the volume, E[d^3; u > 1 - s] summed over s.
double share_of_largest(const particles::SizeDistribution& sizes) {
    const double whole = sizes.moment(3);
    double held = 0, above = 0;
    for (double share = finest; share < 1; share *= growth) {
        held += std::pow(sizes.diameter(1 - (above + share) / 2), 3) * (share - above);
        above = share;
        if (held >= part * whole) return share;
    }
    return 1;
}

}  // namespace

void warn_of_rare_sizes(std::vector<Warning>& warnings, const particles::SizeDistribution& sizes, double diameter,
                        double count) {
    if (sizes.equal() || count <= 0) return;
    const double share = share_of_largest(sizes);
    if (share * count >= fewest) return;
    warnings.push_back({"sizes too rare for the number of particles",
                        sentence("spheres above %.3g m hold a tenth of the volume, and %.3g of %.0f particles are so "
                                 "large on average: the case cannot represent the distribution, take more particles",
                                 sizes.diameter(1 - share) * diameter, share * count, count)});
}

}  // namespace grainsweep::kit
