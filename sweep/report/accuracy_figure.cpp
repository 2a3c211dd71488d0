#include "sweep/report/accuracy_figure.hpp"

#include "sweep/report/print_axes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace grainsweep::report {
namespace {

using study::Bias;
using study::NumericsCost;

constexpr double fewest = 8, most = 1e5;  // points of a campaign
constexpr int places = 24;                // of a curve
constexpr double room = 1.15;             // beyond the numbers
constexpr double normal_975 = 1.96;       // half-width of 95 % in standard errors

/// Named settings are dots and lines, the settings with one moved input diamonds and dashes.
struct Style {
    plot::Colour tone;
    bool moved;
};

std::vector<Style> styles_of(std::span<const NumericsCost> costs) {
    std::vector<Style> styles;
    std::size_t named = 0, moves = 0;
    for (const auto& cost : costs) {
        const bool moved = cost.numerics.moved;
        styles.push_back({plot::category(moved ? moves++ : named++), moved});
    }
    styles.back().tone = plot::black;
    return styles;
}

/// A setting and its bias of one observable.
struct Shown {
    Style style;
    const NumericsCost& cost;
    const Bias& of;

    [[nodiscard]] double percent(double x) const { return 100 * x / std::abs(of.mean); }
};

std::vector<Shown> settings_with(std::span<const NumericsCost> costs, const std::string& observable) {
    std::vector<Shown> all;
    const auto styles = styles_of(costs);
    for (std::size_t k = 0; k < costs.size(); ++k) {
        const auto found = std::ranges::find(costs[k].biases, observable, &Bias::observable);
        if (found == costs[k].biases.end() || !(costs[k].seconds > 0) || !std::isfinite(found->bias) ||
            !(std::abs(found->mean) > 0))
            continue;
        all.push_back({styles[k], costs[k], *found});
    }
    return all;
}

std::string title_of(const std::string& what, const std::string& observable) {
    return fmt::format("{} of {} (%)", what, quantity_of(observable, "1", 1).title);
}

plot::Panel bias_panel(const std::vector<Shown>& shown, const std::string& observable, double tolerance) {
    double low = shown.front().cost.seconds, high = low, farthest = 100 * tolerance;
    plot::Panel panel;
    for (const auto& one : shown) {
        const double x = one.cost.seconds, y = one.percent(one.of.bias);
        const double half = std::isfinite(one.of.half_width) ? one.percent(one.of.half_width) : 0;
        low = std::min(low, x), high = std::max(high, x), farthest = std::max(farthest, std::abs(y) + half);
        const auto shape = one.style.moved ? plot::Points::Shape::diamond : plot::Points::Shape::dot;
        panel.marks.push_back(plot::Whiskers{{x}, {y}, {half}, one.style.tone});
        panel.marks.push_back(plot::Points{{x}, {y}, {one.style.tone}, shape, 2});
    }
    low /= 1.5, high *= 1.5;
    for (const double y : {-100 * tolerance, 0.0, 100 * tolerance})
        panel.marks.push_back(plot::Line{{low, high}, {y, y}, plot::grey, 0.5, y != 0});
    panel.x = {"processor time of a case (s)", low, high, true};
    panel.y = {title_of("bias", observable), -room * farthest, room * farthest};
    return panel;
}

plot::Panel error_panel(const std::vector<Shown>& shown, const std::string& observable, double tolerance) {
    double low = 1e300, high = 0, least = 100 * tolerance, largest = least;
    plot::Panel panel;
    for (const auto& one : shown) {
        if (!std::isfinite(one.of.spread)) continue;
        plot::Line curve{{}, {}, one.style.tone, 1, one.style.moved};
        for (int i = 0; i < places; ++i) {
            const double points = fewest * std::pow(most / fewest, static_cast<double>(i) / (places - 1));
            const double error = std::hypot(one.of.bias, normal_975 * one.of.spread / std::sqrt(points));
            curve.x.push_back(points * one.cost.seconds);
            curve.y.push_back(one.percent(error));
        }
        low = std::min(low, curve.x.front()), high = std::max(high, curve.x.back());
        least = std::min(least, curve.y.back()), largest = std::max(largest, curve.y.front());
        panel.marks.push_back(std::move(curve));
    }
    panel.marks.push_back(plot::Line{{low, high}, {100 * tolerance, 100 * tolerance}, plot::grey, 0.5, true});
    panel.x = {"processor time of the campaign (s)", low, high, true};
    panel.y = {title_of("error of the mean", observable), std::max(least, 1e-3 * largest) / room, room * largest, true};
    return panel;
}

}  // namespace

plot::Figure accuracy_figure(std::span<const NumericsCost> costs, std::span<const std::string> observables,
                             double tolerance) {
    plot::Figure figure;
    for (const auto& observable : observables) {
        const auto shown = settings_with(costs, observable);
        if (shown.empty()) continue;
        figure.panels.push_back(bias_panel(shown, observable, tolerance));
        if (std::ranges::any_of(shown, [](const Shown& one) { return std::isfinite(one.of.spread); }))
            figure.panels.push_back(error_panel(shown, observable, tolerance));
    }
    const auto styles = styles_of(costs);
    for (std::size_t k = 0; k < costs.size(); ++k)
        figure.keys.push_back({costs[k].numerics.says, styles[k].tone,
                               styles[k].moved ? plot::Key::Kind::diamond : plot::Key::Kind::dot});
    return figure;
}

}  // namespace grainsweep::report
