#include "sweep/study/box_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>

namespace grainsweep::study {
namespace {

designs::PointSet sobol(std::size_t dimensions, std::size_t count) {
    return sobol_points({.levels = std::vector<std::size_t>(dimensions, 0),
                         .options = {{"points", static_cast<std::int64_t>(count)}, {"scramble", std::string("none")}}});
}

bool has_levels(const ModelFactor& factor) {
    return factor.is_word() || !factor.numbers.empty();
}

std::size_t level_at(double u, std::size_t levels) {
    return std::min(static_cast<std::size_t>(u * static_cast<double>(levels)), levels - 1);
}

/// The decimal number nearest to x with its last digit at 10^exponent.
double rounded(double x, int exponent) {
    if (exponent > 0) {
        const double unit = std::pow(10.0, exponent);
        return std::round(x / unit) * unit;
    }
    return std::strtod(fmt::format("{:.{}f}", x, -exponent).c_str(), nullptr);
}

double exact_number_at(const ModelFactor& factor, double u) {
    using enum campaign::Scale;
    const campaign::Between range{factor.low, factor.high, factor.log ? log : linear};
    return std::get<double>(campaign::value_at({factor.name, range}, u));
}

double rounded_number_at(const ModelFactor& factor, double u) {
    if (!(factor.high > factor.low)) return factor.low;
    constexpr int digits = 3;
    const double exact = exact_number_at(factor, u);
    const double size = factor.log ? exact : factor.high - factor.low;
    const int exponent = static_cast<int>(std::floor(std::log10(size))) - digits;
    return std::clamp(rounded(exact, exponent), factor.low, factor.high);
}

template <class NumberAt>
Setting setting_at(std::span<const ModelFactor> factors, std::span<const double> u, NumberAt number_at) {
    Setting setting;
    for (std::size_t j = 0; j < factors.size(); ++j) {
        const auto& factor = factors[j];
        if (factor.is_word())
            setting.push_back(static_cast<double>(level_at(u[j], factor.words.size())));
        else if (!factor.numbers.empty())
            setting.push_back(factor.numbers[level_at(u[j], factor.numbers.size())]);
        else
            setting.push_back(number_at(factor, u[j]));
    }
    return setting;
}

}  // namespace

designs::PointSet sobol_points(designs::DesignRequest request) {
    const auto& design = designs::design_named("sobol");
    for (const auto& option : design.options)
        if (option.default_value) request.options.try_emplace(option.name, *option.default_value);
    return design.sample(request);
}

Setting rounded_setting(std::span<const ModelFactor> factors, std::span<const double> u) {
    return setting_at(factors, u, rounded_number_at);
}

Setting exact_setting(std::span<const ModelFactor> factors, std::span<const double> u) {
    return setting_at(factors, u, exact_number_at);
}

std::vector<BoxPoint> spread_points(std::span<const ModelFactor> factors, const Admits& admits, std::size_t count) {
    const auto set = sobol(factors.size(), count);
    std::vector<BoxPoint> points;
    for (std::size_t p = 0; p < set.size(); ++p) {
        const auto u = set.point(p);
        BoxPoint point{{u.begin(), u.end()}, rounded_setting(factors, u)};
        if (!admits || admits(point.setting)) points.push_back(std::move(point));
    }
    return points;
}

std::vector<BoxPoint> points_about(const BoxPoint& centre, double reach, std::span<const ModelFactor> factors,
                                   const Admits& admits, std::size_t count) {
    const auto set = sobol(factors.size(), count);
    std::vector<BoxPoint> points;
    for (std::size_t p = 0; p < set.size(); ++p) {
        BoxPoint point = centre;
        for (std::size_t j = 0; j < factors.size(); ++j)
            if (!has_levels(factors[j]))
                point.u[j] = std::clamp(centre.u[j] + reach * (2 * set.point(p)[j] - 1), 0.0, 1.0);
        point.setting = rounded_setting(factors, point.u);
        if (!admits || admits(point.setting)) points.push_back(std::move(point));
    }
    return points;
}

}  // namespace grainsweep::study
