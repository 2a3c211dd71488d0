#include "sweep/study/box_search.hpp"

#include "sweep/campaign/joint_column.hpp"
#include "sweep/campaign/simplex.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <numeric>

namespace grainsweep::study {
namespace {

designs::PointSet sobol(std::size_t dimensions, std::size_t count) {
    return sobol_points({.levels = std::vector<std::size_t>(dimensions, 0),
                         .options = {{"points", static_cast<std::int64_t>(count)}, {"scramble", std::string("none")}}});
}

constexpr int digits_of_range = 3, digits_of_share = 3, digits_of_last_share = 12;

std::size_t levels_of(const ModelFactor& factor) {
    return factor.is_word() ? factor.choices() : factor.numbers.size();
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

double exact_number(const ModelFactor&, double exact) {
    return exact;
}

double rounded_number(const ModelFactor& factor, double exact) {
    const double low = factor.low(), high = factor.high();
    if (!(high > low)) return low;
    if (factor.step) return exact;
    const double size = factor.log() ? exact : high - low;
    const int exponent = static_cast<int>(std::floor(std::log10(size))) - digits_of_range;
    return std::clamp(rounded(exact, exponent), low, high);
}

/// The number of factor j at a point of all factors, as a design takes it.
double number_at(std::span<const ModelFactor> factors, std::size_t j, std::span<const double> u) {
    const auto& factor = factors[j];
    if (factor.distribution() == nullptr) return number_along(factor, u[j]);
    const auto joint = campaign::joint_value(
        factors.size(), j, u, [&](std::size_t k) { return campaign::column_of(factors[k].distribution()); });
    return joint ? *joint : factor.number(u[j]);
}

std::size_t places_of(const ModelFactor& factor, std::size_t count) {
    const auto levels = levels_of(factor);
    if (levels > 0) return levels;
    if (const auto multiples = along_axis(factor).multiples()) count = std::min(count, *multiples);
    return factor.high() > factor.low() ? count : 1;
}

/// Returns the numbers at the fractions (k + offset)/parts of the range, for k below count.
std::vector<double> numbers_at(const ModelFactor& factor, std::size_t count, double offset, std::size_t parts) {
    std::vector<double> numbers;
    for (std::size_t k = 0; k < count; ++k)
        numbers.push_back(number_along(factor, (static_cast<double>(k) + offset) / static_cast<double>(parts)));
    return numbers;
}

/// Puts shares in the place of the coordinates of shares; rounded, they still add to one.
void share_out(std::span<const ModelFactor> factors, std::span<const double> u, bool round, Setting& setting) {
    std::vector<std::size_t> places;
    std::vector<double> low, coordinates;
    for (std::size_t j = 0; j < factors.size(); ++j) {
        if (!factors[j].share) continue;
        places.push_back(j);
        low.push_back(factors[j].low());
        coordinates.push_back(u[j]);
    }
    if (places.size() < 2) return;  // one by itself, along its axis
    auto shares = campaign::shares_at(coordinates, low);
    if (round) {
        double others = 0;
        for (std::size_t k = 0; k + 1 < shares.size(); ++k) {
            const double most =
                1 - others - std::accumulate(low.begin() + static_cast<std::ptrdiff_t>(k) + 1, low.end(), 0.0);
            shares[k] = std::clamp(rounded(shares[k], -digits_of_share), low[k], std::max(low[k], most));
            others += shares[k];
        }
        shares.back() = std::max(low.back(), rounded(1 - others, -digits_of_last_share));
    }
    for (std::size_t k = 0; k < places.size(); ++k) setting[places[k]] = shares[k];
}

template <class Finish>
Setting setting_at(std::span<const ModelFactor> factors, std::span<const double> u, Finish finish, bool round) {
    Setting setting;
    for (std::size_t j = 0; j < factors.size(); ++j)
        setting.push_back(levels_of(factors[j]) > 0 ? number_along(factors[j], u[j])
                                                    : finish(factors[j], number_at(factors, j, u)));
    share_out(factors, u, round, setting);
    if (setting.size() > 1) fold(factors, setting);  // a factor by itself stands on its axis
    return setting;
}

}  // namespace

campaign::Factor along_axis(const ModelFactor& factor) {
    using enum campaign::Scale;
    if (factor.between() != nullptr) return factor;
    return {factor.name, campaign::Between{factor.low(), factor.high(), factor.log() ? log : linear}, factor.step};
}

std::string_view share_of(std::span<const ModelFactor> factors) {
    const bool drawn =
        std::ranges::any_of(factors, [](const auto& factor) { return factor.distribution() != nullptr; });
    return drawn ? "the distribution of the factors" : "the box";
}

double number_along(const ModelFactor& factor, double u) {
    if (factor.is_word()) return static_cast<double>(level_at(u, factor.choices()));
    if (!factor.numbers.empty()) return factor.numbers[level_at(u, factor.numbers.size())];
    return factor.between() != nullptr ? factor.number(u) : along_axis(factor).number(u);
}

designs::PointSet sobol_points(designs::DesignRequest request) {
    const auto& design = designs::design_named("sobol");
    designs::add_defaults(design, request.options);
    return design.sample(request);
}

Setting rounded_setting(std::span<const ModelFactor> factors, std::span<const double> u) {
    return setting_at(factors, u, rounded_number, true);
}

Setting exact_setting(std::span<const ModelFactor> factors, std::span<const double> u) {
    return setting_at(factors, u, exact_number, false);
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
            if (levels_of(factors[j]) == 0)
                point.u[j] = std::clamp(centre.u[j] + reach * (2 * set.point(p)[j] - 1), 0.0, 1.0);
        point.setting = rounded_setting(factors, point.u);
        if (!admits || admits(point.setting)) points.push_back(std::move(point));
    }
    return points;
}

std::vector<double> points_along(const ModelFactor& factor, std::size_t count) {
    const auto places = places_of(factor, count);
    if (levels_of(factor) > 0 || places == 1) return cells_along(factor, count);
    return numbers_at(factor, places, 0, places - 1);
}

std::vector<double> cells_along(const ModelFactor& factor, std::size_t count) {
    const auto places = places_of(factor, count);
    return numbers_at(factor, places, 0.5, places);
}

std::vector<double> cell_edges(const ModelFactor& factor, std::size_t count) {
    if (levels_of(factor) > 0) return {};
    const auto places = places_of(factor, count);
    return numbers_at(factor, places + 1, 0, places);
}

std::vector<Setting> settings_of_map(std::span<const ModelFactor> factors, const Setting& centre, std::size_t a,
                                     std::size_t b, std::size_t count) {
    const auto across = cells_along(factors[a], count), up = cells_along(factors[b], count);
    std::vector<Setting> settings;
    for (const double y : up)
        for (const double x : across) {
            settings.push_back(centre);
            place(factors, settings.back(), a, x);
            place(factors, settings.back(), b, y, std::span(&a, 1));
        }
    return settings;
}

}  // namespace grainsweep::study
