// posterior: result of a calibration.
#include "sweep/report/figure_kinds.hpp"
#include "sweep/study/calibration.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace grainsweep::report {
namespace {

using namespace study;

constexpr std::size_t most_draws = 1000;

/// A calibrated factor; values of the posterior's draws and of the settings that were run, in its unit. For levels they
/// are spread around the index of the level.
struct Calibrated {
    Variable variable;
    std::vector<double> draws, settings;
};

Calibrated calibrated_factor(const CalibrationReport& report, std::size_t j) {
    const auto& found = report.found;
    const auto& factor = found.factors[j];
    const auto [low, high, log] = factor.shown();
    const std::string unit = j < report.factors.size() ? report.factors[j].factor.unit : "1";
    Variable variable{factor.name, unit, factor.level_texts(), low, high, log, {}};
    const auto shown = [&](std::vector<double> values) {
        variable.values = std::move(values);
        std::vector<double> places;
        for (std::size_t row = 0; row < variable.values.size(); ++row) places.push_back(variable.place(row));
        return places;
    };
    const auto number = [&](double u) {
        return factor.continuous() ? factor.number(u) : static_cast<double>(factor.part(u));
    };
    std::vector<double> draws, settings;
    const auto all = found.posterior->rows();
    const std::size_t step = std::max<std::size_t>(1, all.size() / most_draws);
    for (std::size_t i = 0; i < all.size(); i += step) draws.push_back(number(all.row(i)[j]));
    const std::size_t width = found.factors.size();
    for (std::size_t i = 0; i + width <= found.settings.size(); i += width)
        settings.push_back(number(found.settings[i + j]));
    return {variable, shown(std::move(draws)), shown(std::move(settings))};
}

plot::Panel pair_panel(const Calibrated& a, const Calibrated& b) {
    const auto alpha = [](plot::Colour tone) { return plot::faded(tone, 0.6); };
    return {a.variable.axis(0),
            b.variable.axis(0),
            {plot::Points{a.settings, b.settings, {alpha(plot::blue)}},
             plot::Points{a.draws, b.draws, {alpha(plot::vermilion)}, plot::Points::Shape::dot, 0.8}}};
}

/// The posterior of a single factor, with its prior.
plot::Panel marginal_panel(const CalibrationReport& report, std::size_t j) {
    const auto one = calibrated_factor(report, j);
    const auto marginal = marginal_of(report.found, j);
    const auto shown = [&](double x) { return one.variable.shown(x); };
    plot::Bars bars{{}, {}, marginal.posterior, plot::vermilion};
    plot::Line prior{{}, {}, plot::blue};
    for (std::size_t k = 0; k < marginal.from.size(); ++k) {
        bars.from.push_back(shown(marginal.from[k]));
        bars.to.push_back(shown(marginal.to[k]));
        for (const double x : {bars.from.back(), bars.to.back()}) {
            prior.x.push_back(x);
            prior.y.push_back(marginal.prior[k]);
        }
    }
    const double most = std::max(std::ranges::max(marginal.posterior), std::ranges::max(marginal.prior));
    return {one.variable.axis(0), {"probability", 0, 1.06 * most}, {bars, prior}};
}

std::optional<CalibrationReport> with_posterior(const FigureSubject& subject) {
    auto report = calibration_report(subject.store, subject.responses.campaign);
    if (!report || !report->found.posterior || report->found.posterior->rows().size() == 0) return std::nullopt;
    return report;
}

/// Pairs of factors, whose panels are named "friction,gap".
std::vector<std::pair<std::size_t, std::size_t>> factor_pairs(std::size_t count) {
    std::vector<std::pair<std::size_t, std::size_t>> pairs;
    for (std::size_t j = 1; j < count; ++j)
        for (std::size_t i = 0; i < j; ++i) pairs.emplace_back(i, j);
    return pairs;
}

PanelNames posterior_panels(const FigureSubject& subject) {
    const auto report = with_posterior(subject);
    if (!report) return {};
    const auto& factors = report->found.factors;
    if (factors.size() == 1) return {""};
    PanelNames names;
    for (const auto& factor : factors) names.push_back(factor.name);
    for (const auto& [i, j] : factor_pairs(factors.size())) names.push_back(names[i] + "," + names[j]);
    return names;
}

plot::Figure draw_posterior(const FigureSubject& subject, const PanelNames& panels) {
    const auto report = *with_posterior(subject);
    const auto& factors = report.found.factors;
    plot::Figure figure;
    figure.keys = {{"settings run, prior", plot::blue}, {"posterior", plot::vermilion}};
    const auto add = [&](const std::string& name, const auto& panel) {
        if (std::ranges::count(panels, name) == 0) return;
        figure.panels.push_back(panel());
        figure.panels.back().name = name;
    };
    for (std::size_t j = 0; j < factors.size(); ++j)
        add(factors.size() == 1 ? "" : factors[j].name, [&] { return marginal_panel(report, j); });
    for (const auto& [i, j] : factor_pairs(factors.size()))
        add(factors[i].name + "," + factors[j].name,
            [&] { return pair_panel(calibrated_factor(report, i), calibrated_factor(report, j)); });
    return figure;
}

}  // namespace

constinit const FigureKind posterior_figure{"posterior",
                                            "calibrated factors: prior and posterior, and the settings that were run",
                                            posterior_panels, draw_posterior, OnPage::campaign};

}  // namespace grainsweep::report
