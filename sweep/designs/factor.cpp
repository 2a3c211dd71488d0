#include "sweep/designs/factor.hpp"

#include "solver/plain_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <limits>
#include <string>
#include <string_view>

namespace grainsweep::designs {
namespace {

/// Exactly low at 0 and high at 1, and by rounding never outside of them.
double value_in(const Between& range, double u) {
    if (u <= 0) return range.low;
    if (u >= 1) return range.high;
    const double x = range.scale == Scale::log ? range.low * std::pow(range.high / range.low, u)
                                               : range.low + u * (range.high - range.low);
    return std::clamp(x, range.low, range.high);
}

const Value& value_in(const Levels& range, double u) {
    const auto count = static_cast<double>(range.values.size());
    const double index = std::clamp(std::floor(count * u), 0.0, count - 1);  // the last level also at u = 1
    return range.values[static_cast<std::size_t>(index)];
}

double value_in(const stats::Distribution& range, double u) {
    return range.quantile(u);
}

std::size_t part_of(std::size_t count, double u) {
    return count == 0 ? 0 : std::min(static_cast<std::size_t>(u * static_cast<double>(count)), count - 1);
}

}  // namespace

std::string to_text(const Value& value) {
    if (const auto* real = std::get_if<double>(&value)) return *real == 0 ? "0" : shortest_text(*real);
    if (const auto* whole = std::get_if<std::int64_t>(&value)) return std::to_string(*whole);
    return std::get<std::string>(value);
}

bool Factor::log() const {
    if (const auto* drawn = distribution()) return std::holds_alternative<stats::Lognormal>(drawn->form());
    return between() != nullptr && between()->scale == Scale::log;
}

std::pair<double, double> Factor::ends() const {
    if (const auto* drawn = distribution()) return drawn->range();
    if (between() != nullptr) return {between()->low, between()->high};
    const auto numbers = level_numbers();
    if (numbers.empty()) return {};
    const auto [low, high] = std::ranges::minmax(numbers);
    return {low, high};
}

Value Factor::value(double u) const {
    if (step && distribution() != nullptr) return stepped(*distribution(), *step, u);
    if (step) return stepped(std::get<Between>(range), *step, u);
    return std::visit([u](const auto& form) -> Value { return value_in(form, u); }, range);
}

double Factor::place(double number) const {
    if (const auto* drawn = distribution()) return drawn->cumulative(number);
    const auto& [low, high, scale] = std::get<Between>(range);
    return scale == Scale::log ? std::log(number / low) / std::log(high / low) : (number - low) / (high - low);
}

std::string Factor::text(double u) const {
    return to_text(continuous() ? value(u) : levels()->values[part(u)]);
}

std::vector<std::string> Factor::level_texts() const {
    std::vector<std::string> texts;
    if (levels() != nullptr) std::ranges::transform(levels()->values, std::back_inserter(texts), to_text);
    return texts;
}

std::vector<double> Factor::level_numbers() const {
    std::vector<double> numbers;
    if (continuous()) return numbers;
    for (const auto& value : levels()->values) {
        const auto* word = std::get_if<std::string>(&value);
        const auto* whole = std::get_if<std::int64_t>(&value);
        const auto number = word != nullptr    ? any_number_in(*word)
                            : whole != nullptr ? std::optional(static_cast<double>(*whole))
                                               : std::get<double>(value);
        if (!number) return {};
        numbers.push_back(*number);
    }
    return numbers;
}

std::optional<std::size_t> Factor::multiples() const {
    if (!step || between() == nullptr || log()) return std::nullopt;
    return static_cast<std::size_t>(
        std::max<std::int64_t>(0, multiples_in(*step, between()->low, between()->high).count()));
}

std::size_t Factor::parts() const {
    if (levels() != nullptr) return levels()->values.size();
    constexpr std::size_t most = 64;
    const auto count = multiples().value_or(0);
    return count > most ? 0 : count;
}

std::size_t Factor::part(double u) const {
    return part_of(parts(), u);
}

double Factor::middle_of(std::size_t part) const {
    return (static_cast<double>(part) + 0.5) / static_cast<double>(parts());
}

double Factor::middle(double u) const {
    const std::size_t count = parts();  // of a step takes microseconds
    return count == 0 ? u : (static_cast<double>(part_of(count, u)) + 0.5) / static_cast<double>(count);
}

double Factor::number_or_index(double u) const {
    if (continuous()) return number(u);
    const auto numbers = level_numbers();
    return numbers.empty() ? static_cast<double>(part(u)) : numbers[part(u)];
}

Factor::Shown Factor::shown() const {
    if (!continuous()) {
        std::vector<double> numbers;
        for (std::size_t k = 0; k < parts(); ++k) numbers.push_back(number_or_index(middle_of(k)));
        const auto [low, high] = std::ranges::minmax(numbers);
        return {low, high};
    }
    const double outside = endless() ? 0.001 : 0;  // as stats::Distribution::range
    const double low = number(outside), high = number(1 - outside);
    return {low, high, low > 0 && std::abs(number(0.5) - std::sqrt(low * high)) < 1e-6 * (high - low)};
}

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
