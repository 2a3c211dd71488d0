#include "sweep/plot/ticks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace grainsweep::plot {
namespace {

constexpr double slack = 1e-9;
constexpr std::string_view minus = "\xE2\x88\x92";

std::string with_minus(const std::string& number) {
    return number.starts_with('-') ? std::string(minus) + number.substr(1) : number;
}

/// 10 with a raised exponent, else the number.
std::string power_label(double x) {
    static constexpr std::array<std::string_view, 10> raised = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    const double exponent = std::log10(x);
    if (std::abs(exponent) < 3.5 || std::abs(exponent - std::round(exponent)) > slack) return fmt::format("{:.6g}", x);
    std::string text = exponent < 0 ? "10⁻" : "10";
    for (const char digit : std::to_string(std::abs(std::lround(exponent))))
        text += raised[static_cast<std::size_t>(digit - '0')];
    return text;
}

std::vector<Tick> multiples(double low, double high, const std::vector<double>& factors) {
    std::vector<Tick> ticks;
    for (double decade = std::floor(std::log10(low) + slack); decade <= std::log10(high) + slack; ++decade)
        for (const double factor : factors) {
            const double x = factor * std::pow(10.0, decade);
            if (x >= low * (1 - slack) && x <= high * (1 + slack)) ticks.push_back({x, power_label(x)});
        }
    return ticks;
}

}  // namespace

std::vector<Tick> round_ticks(double low, double high, int most) {
    if (!(high > low)) return {{low, with_minus(fmt::format("{:.4g}", low))}};
    const double raw = (high - low) / most, size = std::pow(10.0, std::floor(std::log10(raw)));
    double step = 10 * size;
    for (const double factor : {1.0, 2.0, 5.0})
        if (factor * size >= raw * (1 - slack)) {
            step = factor * size;
            break;
        }
    const int decimals = std::max(0, static_cast<int>(-std::floor(std::log10(step) + slack)));
    std::vector<Tick> ticks;
    for (double k = std::ceil(low / step - slack); k * step <= high + slack * step; ++k)
        ticks.push_back({k * step, with_minus(fmt::format("{:.{}f}", k == 0 ? 0.0 : k * step, decimals))});
    return ticks;
}

std::vector<Tick> log_ticks(double low, double high, int most) {
    const double decades = std::log10(high / low);
    auto ticks = decades >= 1.7 ? multiples(low, high, {1}) : multiples(low, high, {1, 2, 5});
    if (decades < 0.8 || ticks.size() < 2) {
        // Round numbers are closer together towards the upper end; numbers without room are left out.
        ticks = round_ticks(low, high, most);
        std::erase_if(ticks, [&](const Tick& tick) { return tick.at < low * (1 - slack); });
    }
    const std::size_t every = (ticks.size() + static_cast<std::size_t>(most) - 1) / static_cast<std::size_t>(most);
    std::vector<Tick> kept;
    for (std::size_t k = 0; k < ticks.size(); k += std::max<std::size_t>(1, every)) kept.push_back(ticks[k]);
    return kept;
}

std::vector<Tick> ticks_of(const Axis& axis, int most) {
    const auto [low, high] = std::minmax(axis.low, axis.high);
    return axis.log ? log_ticks(low, high, most) : round_ticks(low, high, most);
}

std::vector<double> minor_ticks(const Axis& axis) {
    constexpr double most_decades = 20;  // of more, minor ticks would be a black bar
    if (!axis.log || std::log10(axis.high) - std::log10(axis.low) > most_decades) return {};
    std::vector<double> places;
    for (const auto& tick : multiples(axis.low, axis.high, {1, 2, 3, 4, 5, 6, 7, 8, 9})) places.push_back(tick.at);
    return places;
}

}  // namespace grainsweep::plot
