#include "sweep/report/print_axes.hpp"

#include "solver/plain_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <system_error>
#include <utility>

namespace grainsweep::report {
namespace {

constexpr std::array<std::string_view, 10> raised_digits = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};

std::string raised(int number) {
    std::string text = number < 0 ? "⁻" : "";
    for (const char digit : std::to_string(std::abs(number)))
        text += raised_digits[static_cast<std::size_t>(digit - '0')];
    return text;
}

/// Whether a prefix may stand before the unit: m, mm/s, kJ/m³; not µm², nor mkg.
bool takes_prefix(std::string_view unit) {
    constexpr std::array<std::string_view, 7> plain = {"m", "s", "N", "Pa", "J", "W", "Hz"};
    const auto first = unit.substr(0, unit.find('/'));
    return std::ranges::find(plain, first) != plain.end() &&
           std::ranges::all_of(unit, [](unsigned char c) { return std::isalnum(c) != 0 || c == '/' || c == '^'; }) &&
           std::ranges::count(unit, '/') <= 1;
}

void replace_all(std::string& text, std::string_view word, std::string_view by) {
    for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + by.size()))
        text.replace(at, word.size(), by);
}

}  // namespace

std::string printed_unit(std::string_view unit) {
    if (unit == "1") return {};
    std::string text;
    for (std::size_t at = 0; at < unit.size(); ++at) {
        const char before = at > 0 ? unit[at - 1] : ' ';
        const bool may = std::isalpha(static_cast<unsigned char>(before)) != 0 || before == ')';
        std::size_t digit = at;
        if (digit < unit.size() && unit[digit] == '^') ++digit;
        const bool negative = digit < unit.size() && unit[digit] == '-';
        if (negative) ++digit;
        const auto is_digit = [&](std::size_t k) { return k < unit.size() && unit[k] >= '0' && unit[k] <= '9'; };
        if (may && is_digit(digit) && !is_digit(digit + 1) && !(digit + 1 < unit.size() && unit[digit + 1] == '.')) {
            const int power = unit[digit] - '0';
            text += raised(negative ? -power : power);
            at = digit;
        } else {
            text += unit[at];
        }
    }
    replace_all(text, "alpha", "α");
    replace_all(text, "rho", "ρ");
    replace_all(text, "DT", "ΔT");
    return text;
}

std::vector<double> Quantity::of(std::span<const double> numbers) const {
    std::vector<double> shown(numbers.begin(), numbers.end());
    for (double& x : shown) x *= factor;
    return shown;
}

Quantity quantity_of(std::string_view name, std::string_view unit, double largest) {
    static constexpr std::array<std::string_view, 7> prefixes = {"n", "µ", "m", "", "k", "M", "G"};
    std::string words(name), shown = printed_unit(unit);
    std::ranges::replace(words, '_', ' ');
    const auto thousands = [&] { return static_cast<int>(std::floor(std::log10(largest) / 3 + 1e-9)); };
    double factor = 1;
    const bool known = std::isfinite(largest) && largest > 0;
    if (known && takes_prefix(unit) && (largest < 0.1 || largest >= 1e4)) {
        const int k = std::clamp(thousands(), -3, 3);
        factor = std::pow(10.0, -3 * k);
        shown = std::string(prefixes[static_cast<std::size_t>(k + 3)]) + shown;
    } else if (known && !takes_prefix(unit) && (largest < 0.01 || largest >= 1e4)) {
        factor = std::pow(10.0, -3 * thousands());
        shown = fmt::format("10{}{}{}", raised(3 * thousands()), shown.empty() ? "" : " ", shown);
    }
    return {shown.empty() ? words : fmt::format("{} ({})", words, shown), factor};
}

Quantity quantity_of(std::string_view name, std::string_view unit, const NumberRange& range) {
    return quantity_of(name, unit, std::max(std::abs(range.low), std::abs(range.high)));
}

std::string quantity_text(double value, std::string_view unit) {
    double factor = 1;
    std::string shown = printed_unit(unit);
    if (takes_prefix(unit) && std::isfinite(value) && value != 0) {
        const auto scaled = quantity_of("", unit, std::abs(value));
        factor = scaled.factor;
        shown = scaled.title.substr(2, scaled.title.size() - 3);  // " (mm)"
    }
    return fmt::format("{:.4g}{}{}", factor * value, shown.empty() ? "" : " ", shown);
}

Quantity Variable::quantity() const {
    if (!levels.empty()) {
        double largest = 0;
        for (const double x : numbers_in(levels)) largest = std::max(largest, std::abs(x));
        return largest > 0 ? quantity_of(name, unit, largest) : quantity_of(name, "1", 1);
    }
    return name == "point" ? quantity_of(name, "", 1) : quantity_of(name, unit, NumberRange{low, high});
}

std::vector<std::string> Variable::shown_levels() const {
    const auto shown = quantity();
    std::vector<std::string> texts;
    for (const double x : numbers_in(levels)) texts.push_back(fmt::format("{:.6g}", shown.of(x)));
    return texts.empty() ? levels : texts;
}

plot::Axis Variable::axis(double margin) const {
    if (!levels.empty()) return plot::axis_of_words(quantity().title, shown_levels());
    return number_axis(quantity(), {low, high}, log && low > 0, margin);
}

std::vector<plot::Key> Variable::keys(plot::Key::Kind kind) const {
    std::vector<plot::Key> lines;
    for (const auto& level : shown_levels()) {
        const auto k = lines.size();
        lines.push_back({k == 0 ? fmt::format("{}: {}", quantity().title, level) : level, plot::category(k), kind});
    }
    return lines;
}

double Variable::place(std::size_t row) const {
    if (levels.empty()) return shown(values[row]);
    constexpr double golden = 0.618034;
    return values[row] + 0.5 * (std::fmod(static_cast<double>(row) * golden, 1.0) - 0.5);
}

Variable variable_of(const study::FactorColumn& factor) {
    const auto [low, high] = factor.continuous() ? factor.ends() : std::pair(0.0, 0.0);
    const auto range = high > low ? NumberRange{low, high} : finite_range(factor.values);
    return {factor.name, factor.unit, factor.seen_texts(), range.low, range.high, factor.log(), factor.values};
}

Variable variable_of(const study::ResponseColumn& response) {
    const auto range = finite_range(response.values);
    return {response.name, response.unit, {}, range.low, range.high, spans_decades(range), response.values};
}

Variable variable_of(const study::ModelFactor& factor) {
    std::vector<std::string> levels = factor.words;
    for (const double number : factor.numbers) levels.push_back(factor.text(number));
    return {factor.name, factor.unit, std::move(levels), factor.low(), factor.high(), factor.log(), {}};
}

NumberRange finite_range(std::span<const double> numbers) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const double x : numbers)
        if (std::isfinite(x)) low = std::min(low, x), high = std::max(high, x);
    if (low > high) return {};
    const double room = low == high ? 0.5 * (low == 0 ? 1 : std::abs(low)) : 0;
    return {low - room, high + room};
}

bool spans_decades(const NumberRange& range) {
    constexpr double two_decades = 100;
    return range.low > 0 && range.high > two_decades * range.low;
}

plot::Axis number_axis(const Quantity& quantity, const NumberRange& range, bool log, double margin) {
    const double low = quantity.of(range.low), high = quantity.of(range.high);
    if (!log) return {quantity.title, low - margin * (high - low), high + margin * (high - low), false, {}};
    const double room = std::pow(high / low, margin);
    // No room beyond the range of a double, where an end would be 0 or infinite.
    if (!(low / room > 0) || !std::isfinite(high * room)) return {quantity.title, low, high, true, {}};
    return {quantity.title, low / room, high * room, true, {}};
}

}  // namespace grainsweep::report
