#include "solver/particles/size_laws.hpp"

#include <boost/math/special_functions/erf.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <functional>
#include <numbers>

namespace grainsweep::particles {
namespace {

/// Lines of a table; the first and the last stand for 0 and 1.
constexpr auto line_shares = std::to_array<double>({0.005, 0.01, 0.02, 0.035, 0.05, 0.07,  0.1,  0.13, 0.16, 0.2,  0.25,
                                                    0.3,   0.35, 0.4,  0.45,  0.5,  0.55,  0.6,  0.65, 0.7,  0.75, 0.8,
                                                    0.84,  0.87, 0.9,  0.93,  0.95, 0.965, 0.98, 0.99, 0.995});

double standard_quantile(double share) {
    return -std::numbers::sqrt2 * boost::math::erfc_inv(2 * share);
}

std::string table_of(const std::function<double(double)>& quantile, bool by_volume) {
    std::string csv = by_volume ? "diameter,volume_below\n" : "diameter,number_below\n";
    for (std::size_t k = 0; k < line_shares.size(); ++k) {
        const double below = k == 0 ? 0 : k + 1 == line_shares.size() ? 1 : line_shares[k];
        std::array<char, 64> line{};  // nine digits: the same text whatever the last bits of exp and log are
        std::snprintf(line.data(), line.size(), "%.9g,%.9g\n", quantile(line_shares[k]), below);
        csv += line.data();
    }
    return csv;
}

}  // namespace

std::string lognormal_table(double median, double finer, double coarser, bool by_volume) {
    return table_of(
        [&](double share) {
            const double z = standard_quantile(share);
            return median * std::exp((z < 0 ? finer : coarser) * z);
        },
        by_volume);
}

double half_spread(double median, double tenth) {
    return std::abs(std::log(tenth / median)) / standard_quantile(0.9);
}

std::string rosin_rammler_table(double d63, double n, bool by_volume) {
    return table_of([&](double share) { return d63 * std::pow(-std::log1p(-share), 1 / n); }, by_volume);
}

}  // namespace grainsweep::particles
