#include "sweep/designs/step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>
#include <string_view>

namespace grainsweep::designs {

double multiple_of(double step, std::int64_t number) {
    // The shortest decimal text of the step, as a whole number of units of its last digit.
    std::array<char, 32> text{};
    const auto end = std::to_chars(text.begin(), text.end(), step, std::chars_format::scientific).ptr;
    const std::string_view written(text.data(), static_cast<std::size_t>(end - text.begin()));
    const auto exponent_sign = written.find('e');
    std::string digits(written.substr(0, exponent_sign));
    int exponent = std::atoi(std::string(written.substr(exponent_sign + 1)).c_str());
    if (const auto point = digits.find('.'); point != std::string::npos) {
        exponent -= static_cast<int>(digits.size() - point - 1);
        digits.erase(point, 1);
    }
    const std::int64_t unit = std::strtoll(digits.c_str(), nullptr, 10);
    if (unit == 0 || std::abs(number) > std::numeric_limits<std::int64_t>::max() / unit)
        return static_cast<double>(number) * step;
    return std::strtod(fmt::format("{}e{}", unit * number, exponent).c_str(), nullptr);
}

Multiples multiples_in(double step, double low, double high) {
    Multiples found{std::llround(low / step), std::llround(high / step)};
    if (multiple_of(step, found.first) < low) ++found.first;
    if (multiple_of(step, found.last) > high) --found.last;
    return found;
}

bool is_multiple(double step, double x) {
    return std::abs(x / step) <= static_cast<double>(most_multiples) && multiple_of(step, std::llround(x / step)) == x;
}

double stepped(const Between& range, double step, double u) {
    const auto [first, last] = multiples_in(step, range.low, range.high);
    const Between widened{(static_cast<double>(first) - 0.5) * step, (static_cast<double>(last) + 0.5) * step,
                          range.scale};
    const double x = Factor{{}, widened}.number(u);
    const auto nearest = static_cast<std::int64_t>(std::floor(x / step + 0.5));
    return multiple_of(step, std::clamp(nearest, first, last));
}

double stepped(const stats::Distribution& distribution, double step, double u) {
    const auto nearest = static_cast<std::int64_t>(std::floor(distribution.quantile(u) / step + 0.5));
    const double x = multiple_of(step, nearest);
    return x < distribution.low()    ? multiple_of(step, nearest + 1)
           : x > distribution.high() ? multiple_of(step, nearest - 1)
                                     : x;
}

}  // namespace grainsweep::designs
