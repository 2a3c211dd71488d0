// sensitivity, variance.
#include "sweep/report/figure_kinds.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace grainsweep::report {
namespace {

using namespace study;

/// A bar beside each factor.
struct Measure {
    std::string label;
    std::function<stats::SensitivityIndex(const FactorInfluence&)> of;
};

/// Returns the measures of a method for each factor; the last one orders the factors.
std::vector<Measure> measures_of(Influence::Method method) {
    const Measure first{"first order", [](const FactorInfluence& factor) { return factor.first; }};
    const Measure total{"total, with interactions", [](const FactorInfluence& factor) { return factor.total; }};
    const auto effect = [](auto value, bool with_error) {
        return [=](const FactorInfluence& factor) {
            stats::SensitivityIndex index;
            if (!factor.effects) return index;
            index.value = (*factor.effects).*value;
            if (with_error) index.half_width = factor.effects->mu_star_half_width;
            return index;
        };
    };
    switch (method) {
        case Influence::Method::morris:
            return {{"sigma, curvature and interactions", effect(&stats::ElementaryEffects::sigma, false)},
                    {"mu*, mean absolute effect", effect(&stats::ElementaryEffects::mu_star, true)}};
        case Influence::Method::saltelli:
            return {first, total};
        case Influence::Method::given_data:
            break;
    }
    return {first};
}

constexpr double mm_of_axis = 15, mm_per_bar = 5;

plot::Figure draw_sensitivity(const FigureSubject& subject, const PanelNames&) {
    const auto influence = influence_of(subject);
    const auto measures = measures_of(influence.method);
    auto factors = influence.factors;
    std::ranges::stable_sort(factors, [&](const auto& a, const auto& b) {
        return measures.back().of(a).value > measures.back().of(b).value;
    });
    std::vector<std::string> names;
    for (const auto& factor : factors) names.push_back(quantity_of(factor.factor, "1", 1).title);
    double most = 0;
    for (const auto& factor : factors)
        for (const auto& measure : measures) {
            const auto index = measure.of(factor);
            const double end = index.value + (std::isfinite(index.half_width) ? index.half_width : 0);
            if (std::isfinite(end)) most = std::max(most, end);
        }
    const bool shares = influence.method != Influence::Method::morris;
    const auto shown = shares ? quantity_of("share of the variance", "1", 1)
                              : quantity_of("change over the range", subject.response.unit, most);
    plot::Axis up = plot::axis_of_words("", names);
    std::swap(up.low, up.high);  // the first one on top
    plot::Panel panel{{shown.title, 0, shown.of(shares ? std::max(1.0, most) : 1.05 * most)}, up};
    plot::Figure figure;
    const double thickness = 0.8 / static_cast<double>(measures.size());
    for (std::size_t k = 0; k < measures.size(); ++k) {
        const auto tone = plot::category(k);
        plot::Bars bars{{}, {}, {}, tone, true};
        plot::Whiskers errors{{}, {}, {}, plot::black, true};
        for (std::size_t j = 0; j < factors.size(); ++j) {
            const auto index = measures[k].of(factors[j]);
            const double from = static_cast<double>(j) - 0.4 + thickness * static_cast<double>(k);
            bars.from.push_back(from);
            bars.to.push_back(from + 0.94 * thickness);
            bars.length.push_back(shown.of(index.value));
            errors.at.push_back(from + 0.47 * thickness);
            errors.value.push_back(bars.length.back());
            errors.half_width.push_back(shown.of(index.half_width));
        }
        panel.marks.push_back(bars);
        panel.marks.push_back(errors);
        if (measures.size() > 1) figure.keys.push_back({measures[k].label, tone, plot::Key::Kind::area});
    }
    const auto rows = static_cast<double>(factors.size() * measures.size());
    panel.height_mm = mm_of_axis + mm_per_bar * std::max(2.0, rows);
    figure.panels = {std::move(panel)};
    return figure;
}

/// Parts of the variance that are known, as the report lists them.
std::vector<std::pair<std::string, double>> parts_of(const stats::VarianceSplit& split) {
    std::vector<std::pair<std::string, double>> parts;
    for (const auto& [name, part] : {std::pair{"main effects", split.main_effects},
                                     {"interactions", split.interactions},
                                     {"scatter of single runs", split.scatter}})
        if (std::isfinite(part.value)) parts.emplace_back(name, part.value);
    if (parts.size() == 1 && std::isfinite(split.unexplained.value))
        parts.emplace_back("unexplained", split.unexplained.value);
    return parts;
}

PanelNames variance_panels(const FigureSubject& subject) {
    if (!has_values(subject)) return {};
    const auto parts = parts_of(influence_of(subject).split);
    return parts.size() < 2 ? PanelNames{} : PanelNames{""};
}

plot::Figure draw_variance(const FigureSubject& subject, const PanelNames&) {
    const auto parts = parts_of(influence_of(subject).split);
    std::vector<std::string> names;
    plot::Bars bars{{}, {}, {}, plot::blue, true};
    for (const auto& [name, share] : parts) {
        bars.from.push_back(static_cast<double>(names.size()) - 0.38);
        bars.to.push_back(static_cast<double>(names.size()) + 0.38);
        bars.length.push_back(100 * std::max(0.0, share));
        names.push_back(name);
    }
    plot::Axis up = plot::axis_of_words("", names);
    std::swap(up.low, up.high);
    plot::Panel panel{{"share of the variance (%)", 0, 100}, up, {bars}};
    panel.height_mm = mm_of_axis + mm_per_bar * static_cast<double>(parts.size());
    return {{std::move(panel)}};
}

PanelNames sensitivity_panels(const FigureSubject& subject) {
    if (!has_values(subject)) return {};
    const auto influence = influence_of(subject);
    const auto main = measures_of(influence.method).back();
    const bool known = std::ranges::any_of(influence.factors,
                                           [&](const auto& factor) { return std::isfinite(main.of(factor).value); });
    return known ? PanelNames{""} : PanelNames{};
}

}  // namespace

constinit const FigureKind sensitivity_figure{
    "sensitivity", "what each factor explains of the response, with 95 % errors", sensitivity_panels, draw_sensitivity};

constinit const FigureKind variance_figure{"variance", "parts of the variance: main effects, interactions, scatter",
                                           variance_panels, draw_variance};

}  // namespace grainsweep::report
