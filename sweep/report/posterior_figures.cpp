// posterior: result of a calibration.
#include "sweep/report/figure_kinds.hpp"
#include "sweep/study/calibration.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace grainsweep::report {
namespace {

using namespace study;

constexpr std::size_t most_draws = 1000, bins_of_draws = 24;

/// A calibrated factor; values in its unit of the posterior's draws and of the settings that were run.
struct Calibrated {
    Variable variable;
    std::vector<double> draws, settings;
};

Calibrated calibrated_factor(const CalibrationReport& report, std::size_t j) {
    const auto& found = report.found;
    const auto& range = found.ranges[j];
    const auto [low, high, log] = range.shown();
    const std::string unit = j < report.factors.size() ? report.factors[j].unit : "1";
    Calibrated one{{found.factors[j], unit, {}, low, high, log, {}}, {}, {}};
    const auto all = found.posterior->rows();
    const std::size_t step = std::max<std::size_t>(1, all.size() / most_draws);
    for (std::size_t i = 0; i < all.size(); i += step) one.draws.push_back(range.value_at(all.row(i)[j]));
    const std::size_t width = found.factors.size();
    for (std::size_t i = 0; i + width <= found.settings.size(); i += width)
        one.settings.push_back(range.value_at(found.settings[i + j]));
    return one;
}

plot::Panel pair_panel(const Calibrated& a, const Calibrated& b) {
    const auto x = a.variable.quantity(), y = b.variable.quantity();
    const auto alpha = [](plot::Colour tone) { return plot::faded(tone, 0.6); };
    return {a.variable.axis(0),
            b.variable.axis(0),
            {plot::Points{x.of(a.settings), y.of(b.settings), {alpha(plot::blue)}},
             plot::Points{x.of(a.draws), y.of(b.draws), {alpha(plot::vermilion)}, plot::Points::Shape::dot, 0.8}}};
}

/// The posterior of a single factor.
plot::Panel histogram_panel(const Calibrated& one) {
    const auto shown = one.variable.quantity();
    const auto axis = one.variable.axis(0);
    const auto at = [&](double x) { return axis.log ? std::log(x) : x; };
    const double low = at(one.variable.low), high = at(one.variable.high);
    const auto edge = [&](std::size_t k) {
        const double x = low + (high - low) * static_cast<double>(k) / static_cast<double>(bins_of_draws);
        return shown.of(axis.log ? std::exp(x) : x);
    };
    plot::Bars bars{{}, {}, std::vector<double>(bins_of_draws, 0), plot::vermilion};
    for (std::size_t k = 0; k < bins_of_draws; ++k) {
        bars.from.push_back(edge(k));
        bars.to.push_back(edge(k + 1));
    }
    for (const double x : one.draws) {
        const double share = std::clamp((at(x) - low) / (high - low), 0.0, 1.0);
        const auto bin = static_cast<std::size_t>(share * static_cast<double>(bins_of_draws));
        bars.length[std::min(bin, bins_of_draws - 1)] += 1 / static_cast<double>(one.draws.size());
    }
    const double most = *std::ranges::max_element(bars.length);
    return {axis, {"share of the draws", 0, 1.06 * most}, {bars}};
}

std::optional<CalibrationReport> with_posterior(const FigureSubject& subject) {
    auto report = calibration_report(subject.store, subject.responses.campaign);
    if (!report || !report->found.posterior || report->found.posterior->rows().size() == 0) return std::nullopt;
    return report;
}

/// Pairs of factors, "friction,gap"; of one factor its name.
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
    for (const auto& [i, j] : factor_pairs(factors.size())) names.push_back(factors[i] + "," + factors[j]);
    return names;
}

plot::Figure draw_posterior(const FigureSubject& subject, const PanelNames& panels) {
    const auto report = *with_posterior(subject);
    const auto& factors = report.found.factors;
    if (factors.size() == 1) return {{histogram_panel(calibrated_factor(report, 0))}};
    plot::Figure figure;
    figure.keys = {{"settings run", plot::blue}, {"posterior", plot::vermilion}};
    for (const auto& [i, j] : factor_pairs(factors.size()))
        if (std::ranges::count(panels, factors[i] + "," + factors[j]) > 0)
            figure.panels.push_back(pair_panel(calibrated_factor(report, i), calibrated_factor(report, j)));
    return figure;
}

}  // namespace

FigureKind posterior_figure() {
    return {"posterior", "calibrated factors: posterior and the settings that were run", posterior_panels,
            draw_posterior};
}

}  // namespace grainsweep::report
