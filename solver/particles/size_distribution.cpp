#include "solver/particles/size_distribution.hpp"

#include <boost/math/special_functions/erf.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace grainsweep::particles {
namespace {

constexpr std::array<double, 5> class_shares = {0.0444, 0.2276, 0.4078, 0.2691, 0.0511};  // Wu (2020), table 3.2
constexpr double cut = 0.005;  // share left out at each end of the lognormal distribution

double normal_below(double x) {
    return 0.5 * std::erfc(-x / std::numbers::sqrt2);
}

double normal_quantile(double p) {
    return -std::numbers::sqrt2 * boost::math::erfc_inv(2 * p);
}

double class_diameter(double width, std::size_t k) {
    return 1 + width * (static_cast<double>(k) - 2);
}

/// E[d^power] of the truncated lognormal with median 1.
double truncated_moment(double spread, double power) {
    const double end = normal_quantile(1 - cut);
    const double shift = power * spread;
    return std::exp(0.5 * shift * shift) * (normal_below(end - shift) - normal_below(-end - shift)) / (1 - 2 * cut);
}

}  // namespace

SizeDistribution SizeDistribution::weibull_classes(double width) {
    SizeDistribution sizes;
    sizes.law_ = Classes{width};
    return sizes;
}

SizeDistribution SizeDistribution::lognormal(double spread) {
    SizeDistribution sizes;
    sizes.law_ = Lognormal{.spread = spread, .median = 1 / truncated_moment(spread, 1)};
    return sizes;
}

SizeDistribution SizeDistribution::uniform(double half_width) {
    SizeDistribution sizes;
    sizes.law_ = Uniform{half_width};
    return sizes;
}

SizeDistribution SizeDistribution::table(SizeTable table) {
    SizeDistribution sizes;
    sizes.law_ = std::move(table);
    return sizes;
}

double SizeDistribution::diameter(double u) const {
    if (const auto* classes = std::get_if<Classes>(&law_)) {
        std::size_t k = 0;
        for (double below = class_shares[0]; k + 1 < class_shares.size() && u >= below; below += class_shares[k]) ++k;
        return class_diameter(classes->width, k);
    }
    if (const auto* law = std::get_if<Lognormal>(&law_))
        return law->median * std::exp(law->spread * normal_quantile(cut + (1 - 2 * cut) * u));
    if (const auto* law = std::get_if<Uniform>(&law_)) return 1 + law->half_width * (2 * u - 1);
    if (const auto* table = std::get_if<SizeTable>(&law_)) return table->diameter(u);
    return 1;
}

double SizeDistribution::smallest() const {
    return diameter(0);
}

double SizeDistribution::largest() const {
    return diameter(std::nextafter(1.0, 0.0));
}

double SizeDistribution::moment(int power) const {
    if (const auto* classes = std::get_if<Classes>(&law_)) {
        double sum = 0;
        for (std::size_t k = 0; k < class_shares.size(); ++k)
            sum += class_shares[k] * std::pow(class_diameter(classes->width, k), power);
        return sum;
    }
    if (const auto* law = std::get_if<Lognormal>(&law_))
        return std::pow(law->median, power) * truncated_moment(law->spread, power);
    if (const auto* law = std::get_if<Uniform>(&law_)) {
        double sum = 0;  // ((1 + w)^(n + 1) - (1 - w)^(n + 1))/(2 w (n + 1)) without the division by w
        for (int k = 0; k <= power; ++k)
            sum += std::pow(1 + law->half_width, k) * std::pow(1 - law->half_width, power - k);
        return sum / (power + 1);
    }
    if (const auto* table = std::get_if<SizeTable>(&law_)) return table->moment(power);
    return 1;
}

}  // namespace grainsweep::particles
