#include "sweep/report/accuracy.hpp"

#include "sweep/campaign/input_error.hpp"
#include "sweep/report/print_axes.hpp"
#include "sweep/study/error_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace grainsweep::report {
namespace {

using Cell = store::Table::Cell;
using study::Bias;
using study::NumericsCost;

std::string share_text(double share) {
    return std::isfinite(share) ? fmt::format("{:.2g} %", 100 * share) : "-";
}

store::Table text_table(std::span<const NumericsCost> costs, const std::string& observable) {
    store::Table table{{"setting", "core-s a case", "pairs", "bias", "of the mean", "at most"}, {}};
    std::vector<const NumericsCost*> by_cost;
    for (const auto& cost : costs) by_cost.push_back(&cost);
    std::ranges::stable_sort(by_cost, {}, &NumericsCost::seconds);
    for (const auto* one : by_cost) {
        const auto& cost = *one;
        const auto found = std::ranges::find(cost.biases, observable, &Bias::observable);
        if (found == cost.biases.end()) continue;
        const bool last = one == &costs.back();
        table.rows.push_back({cost.numerics.says, to_cell(cost.seconds), static_cast<std::int64_t>(found->pairs),
                              last ? Cell{"the measure"} : Cell{study::with_error(found->bias, found->half_width)},
                              last ? Cell{} : Cell{share_text(found->bias / std::abs(found->mean))},
                              last ? Cell{} : Cell{share_text(found->relative_bound())}});
    }
    return table;
}

/// Returns a text with the number of points that would be enough: with them the bias of the cheapest suitable setting,
/// if it is as found, is within the tolerance, its error included.
std::string points_text(std::span<const NumericsCost> costs, std::span<const std::string> observables,
                        double tolerance) {
    const NumericsCost* cheapest = nullptr;
    double points = 0;
    for (const auto& cost : costs.first(costs.size() - 1)) {
        if (!(cost.seconds < costs.back().seconds)) continue;  // dearer, or without an answer
        double needed = 0;
        for (const auto& name : observables) {
            const auto one = std::ranges::find(cost.biases, name, &Bias::observable);
            const double room = tolerance * std::abs(one->mean) - std::abs(one->bias);
            const double ratio = room > 0 ? one->half_width / room : std::numeric_limits<double>::infinity();
            needed = std::max(needed, static_cast<double>(one->pairs) * ratio * ratio);
        }
        if (!std::isfinite(needed) || (cheapest != nullptr && cost.seconds >= cheapest->seconds)) continue;
        cheapest = &cost;
        points = needed;
    }
    return cheapest == nullptr
               ? std::string()
               : fmt::format("; about {:.2g} points would show it of {}", points, cheapest->numerics.says);
}

store::Table all_rows(std::string_view campaign, std::span<const NumericsCost> costs) {
    store::Table table{{"campaign", "setting", "observable", "unit", "cases", "answered", "core_seconds", "pairs",
                        "mean", "bias", "bias_error", "scatter", "spread", "relative_bound"},
                       {}};
    for (const auto& cost : costs)
        for (const auto& one : cost.biases)
            table.rows.push_back({std::string(campaign), cost.numerics.says, one.observable, one.unit,
                                  static_cast<std::int64_t>(cost.cases), static_cast<std::int64_t>(cost.answered),
                                  to_cell(cost.seconds), static_cast<std::int64_t>(one.pairs), to_cell(one.mean),
                                  to_cell(one.bias), to_cell(one.half_width), to_cell(one.scatter), to_cell(one.spread),
                                  to_cell(one.relative_bound())});
    return table;
}

std::vector<std::string> names_in(std::span<const NumericsCost> costs) {
    std::vector<std::string> names;
    for (const auto& one : costs.back().biases) names.push_back(one.observable);
    return names;
}

// ---- figure

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

Document accuracy_document(std::string_view campaign, std::span<const NumericsCost> costs,
                           std::span<const std::string> observables, double tolerance) {
    Document document;
    if (costs.empty()) return document;
    const auto known = names_in(costs);
    for (const auto& name : observables)
        if (std::ranges::count(known, name) == 0)
            throw campaign::input_error("--observable", name,
                                        fmt::format("no case has a value of it; there are {}", campaign::listed(known)),
                                        campaign::nearest_word(name, known));
    const std::vector<std::string> asked =
        observables.empty() ? known : std::vector<std::string>(observables.begin(), observables.end());
    for (const auto& name : asked) {
        const auto& reference = *std::ranges::find(costs.back().biases, name, &Bias::observable);
        document.say(fmt::format("{}: {}{}, mean {:.6g}", campaign, name,
                                 reference.unit.empty() || reference.unit == "1" ? "" : " (" + reference.unit + ")",
                                 reference.mean));
        document.show(text_table(costs, name));
        document.say();
    }
    const auto best = study::cheapest_within(costs, asked, tolerance);
    const auto& measure = costs.back();
    const auto subject = asked.size() == 1 ? asked.front() : fmt::format("{} observables", asked.size());
    document.say(
        best ? fmt::format("within {} of {} at 95 %: {}, {:.3g} core-s a case, {:.3g} times cheaper than {}",
                           share_text(tolerance), subject, costs[*best].numerics.says, costs[*best].seconds,
                           measure.seconds / costs[*best].seconds, measure.numerics.says)
             : fmt::format("no cheaper setting is shown to be within {} of {} at 95 %: {} takes {:.3g} core-s a "
                           "case{}",
                           share_text(tolerance), subject, measure.numerics.says, measure.seconds,
                           points_text(costs, asked, tolerance)));
    document.rows = all_rows(campaign, costs);
    const auto setting_json = [](const NumericsCost& cost) {
        const auto bias_json = [](const Bias& one) {
            return Result<results::bias>{{"observable", one.observable},
                                         {"unit", one.unit},
                                         {"pairs", one.pairs},
                                         {"mean", one.mean},
                                         {"bias", one.bias},
                                         {"bias_error", one.half_width},
                                         {"scatter", one.scatter},
                                         {"spread", one.spread},
                                         {"relative_bound", one.relative_bound()}};
        };
        return Result<results::numerics>{
            {"setting", cost.numerics.says}, {"campaign", cost.numerics.campaign},
            {"cases", cost.cases},           {"answered", cost.answered},
            {"core_seconds", cost.seconds},  {"biases", Json::list(cost.biases, bias_json)}};
    };
    document.value = Result<results::accuracy>{{"campaign", campaign},
                                               {"tolerance", tolerance},
                                               {"observables", asked},
                                               {"cheapest", best ? Json(costs[*best].numerics.says) : Json()},
                                               {"settings", Json::list(costs, setting_json)}};
    return document;
}

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

store::Table corrected_table(const study::Corrected& corrected) {
    store::Table table{{"statistic", *corrected.goal.setting, "corrected", "numerics", "statistics", "together"}, {}};
    for (const auto& one : corrected.check.moments)
        table.rows.push_back({std::string(to_string(one.statistic)),
                              study::with_error(one.cheap, std::numeric_limits<double>::quiet_NaN()),
                              study::with_error(one.value, one.together), share_text(one.relative(one.numerics)),
                              share_text(one.relative(one.statistics)), share_text(one.relative(one.together))});
    return table;
}

Result<results::corrected> corrected_json(const study::Corrected& corrected) {
    Json moments = Json::object();
    for (const auto& one : corrected.check.moments)
        moments.add(to_string(one.statistic), Result<results::corrected_moment>{{"value", one.value},
                                                                                {"error", one.together},
                                                                                {"numerics", one.numerics},
                                                                                {"statistics", one.statistics},
                                                                                {"uncorrected", one.cheap}});
    return {{"observable", corrected.goal.observable},
            {"setting", *corrected.goal.setting},
            {"cases", corrected.check.points},
            {"pairs", corrected.check.pairs},
            {"tolerance", corrected.goal.tolerance},
            {"within", corrected.within},
            {"core_seconds", corrected.core_seconds},
            {"alone_core_seconds", corrected.alone ? Json(*corrected.alone) : Json()},
            {"statistics", moments}};
}

}  // namespace grainsweep::report
