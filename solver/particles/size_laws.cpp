#include "solver/particles/size_laws.hpp"

#include <boost/math/special_functions/erf.hpp>
#include <boost/math/special_functions/gamma.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

namespace grainsweep::particles {
namespace {

/// Lines of a table; the first and the last stand for 0 and 1.
constexpr auto line_shares = std::to_array<double>({0.005, 0.01, 0.02, 0.035, 0.05, 0.07,  0.1,  0.13, 0.16, 0.2,  0.25,
                                                    0.3,   0.35, 0.4,  0.45,  0.5,  0.55,  0.6,  0.65, 0.7,  0.75, 0.8,
                                                    0.84,  0.87, 0.9,  0.93,  0.95, 0.965, 0.98, 0.99, 0.995});

double standard_quantile(double share) {
    return -std::numbers::sqrt2 * boost::math::erfc_inv(2 * share);
}

double standard_share(double z) {
    return boost::math::erfc(-z / std::numbers::sqrt2) / 2;
}

std::string table_line(double diameter, double below) {
    std::array<char, 64> line{};  // nine digits: the same text whatever the last bits of exp and log are
    std::snprintf(line.data(), line.size(), "%.9g,%.9g\n", diameter, below);
    return line.data();
}

/// A law by its quantiles, and the share of the volume below a diameter.
struct Law {
    std::function<double(double)> quantile;      ///< of d^power
    std::function<double(double)> volume_below;  ///< of a diameter
};

std::string table_by_volume(const Law& law) {
    std::string csv = "diameter,volume_below\n";
    for (std::size_t k = 0; k < line_shares.size(); ++k)
        csv += table_line(law.quantile(line_shares[k]), k == 0 ? 0 : k + 1 == line_shares.size() ? 1 : line_shares[k]);
    return csv;
}

/// Returns the diameter below which the share of the volume lies; `from` is smaller.
double volume_quantile(const Law& law, double share, double from) {
    double low = from, high = 2 * from;
    while (law.volume_below(high) < share) low = high, high *= 2;
    constexpr int halvings = 60;
    for (int k = 0; k < halvings; ++k) {
        const double middle = low + (high - low) / 2;
        (law.volume_below(middle) < share ? low : high) = middle;
    }
    return high;
}

/// Lines at the quantiles of the law, and beyond at those of its volume.
std::string table_up_to_all_volume(const Law& law) {
    const double first = law.quantile(line_shares.front());
    std::vector<double> sizes;
    for (const double share : line_shares) {
        sizes.push_back(law.quantile(share));
        sizes.push_back(volume_quantile(law, share, first));
    }
    std::ranges::sort(sizes);
    const double last = volume_quantile(law, line_shares.back(), first);
    constexpr double apart = 1.01;  // closer sizes give no more
    std::string csv = "diameter,volume_below\n" + table_line(first, 0);
    double before = first;
    for (const double size : sizes)
        if (size > apart * before && apart * size < last) {
            csv += table_line(size, law.volume_below(size));
            before = size;
        }
    return csv + table_line(last, 1);
}

}  // namespace

std::string lognormal_table(double median, double finer, double coarser, int power) {
    Law law;
    law.quantile = [=](double share) {
        const double z = standard_quantile(share);
        return median * std::exp((z < 0 ? finer : coarser) * z);
    };
    if (power == 3) return table_by_volume(law);
    // Of the density of z weighed by d^m, m = 3 - power: the integral of exp(m s z) phi(z) is exp(m^2 s^2/2) Phi(z - m
    // s).
    const double m = 3 - power;
    const double fine = std::exp(m * m * finer * finer / 2), coarse = std::exp(m * m * coarser * coarser / 2);
    const double all_fine = fine * standard_share(-m * finer), all_coarse = coarse * standard_share(m * coarser);
    law.volume_below = [=](double diameter) {
        const double x = std::log(diameter / median);
        if (x < 0) return fine * standard_share(x / finer - m * finer) / (all_fine + all_coarse);
        return 1 - coarse * standard_share(m * coarser - x / coarser) / (all_fine + all_coarse);
    };
    return table_up_to_all_volume(law);
}

double half_spread(double median, double tenth) {
    return std::abs(std::log(tenth / median)) / standard_quantile(0.9);
}

std::string rosin_rammler_table(double d63, double n, int power) {
    Law law;
    law.quantile = [=](double share) { return d63 * std::pow(-std::log1p(-share), 1 / n); };
    if (power == 3) return table_by_volume(law);
    // With t = (d/d63)^n the volume is the integral of t^(m/n) exp(-t), m = 3 - power: an incomplete gamma function.
    law.volume_below = [=](double diameter) {
        return boost::math::gamma_p(1 + (3 - power) / n, std::pow(diameter / d63, n));
    };
    return table_up_to_all_volume(law);
}

}  // namespace grainsweep::particles
