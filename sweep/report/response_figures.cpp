// distribution, convergence, effects.
#include "sweep/report/figure_kinds.hpp"
#include "sweep/study/effects.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace grainsweep::report {
namespace {

using namespace study;

plot::Figure draw_distribution(const FigureSubject& subject, const PanelNames&) {
    const auto variable = response_variable(subject);
    const auto shown = variable.quantity();
    const auto at = [&](double x) { return variable.log ? std::log(x) : x; };
    std::vector<double> values;
    for (const double x : subject.responses.judged(subject.response)) values.push_back(at(x));
    const auto histogram = histogram_of(values);
    plot::Bars bars;
    const auto count = static_cast<double>(histogram.counts.size());
    // All values equal: one bar of a width of its own.
    const auto range = histogram.high > histogram.low ? NumberRange{histogram.low, histogram.high}
                                                      : finite_range(std::vector{histogram.low});
    const double width = (range.high - range.low) / count, gap = 0.04 * width;
    const auto edge = [&](double x) { return shown.of(variable.log ? std::exp(x) : x); };
    for (std::size_t k = 0; k < histogram.counts.size(); ++k) {
        const double left = range.low + static_cast<double>(k) * width;
        bars.from.push_back(edge(left + gap));
        bars.to.push_back(edge(left + width - gap));
        bars.length.push_back(static_cast<double>(histogram.counts[k]));
    }
    const double most = *std::ranges::max_element(bars.length);
    const NumberRange ends = variable.log ? NumberRange{std::exp(range.low), std::exp(range.high)} : range;
    return {{{number_axis(shown, ends, variable.log, 0.02), {"cases", 0, 1.06 * most}, {bars}}}};
}

/// Returns the range of a moment's axis. Bands of the first checks may leave the frame, because their errors can be
/// many times larger than later ones.
NumberRange moment_range(const std::vector<const stats::Checkpoint*>& checks, stats::Statistic statistic) {
    std::vector<double> numbers;
    for (std::size_t k = 0; k < checks.size(); ++k) {
        const auto& one = checks[k]->of(statistic);
        numbers.push_back(one.value);
        if (4 * k < checks.size() && checks.size() > 3) continue;
        numbers.push_back(one.value - one.error);
        numbers.push_back(one.value + one.error);
    }
    return finite_range(numbers);
}

plot::Panel moment_panel(const FigureSubject& subject, const History& history, stats::Statistic statistic) {
    constexpr std::size_t most_checks = 150, most_dots = 40;
    const auto checks = checks_to_show(history, most_checks);
    const auto range = moment_range(checks, statistic);
    const std::string name(stats::to_string(statistic));
    const bool of_unit = statistic == stats::Statistic::mean || statistic == stats::Statistic::sd;
    const auto shown =
        quantity_of(fmt::format("{} of {}", name, subject.response.name), of_unit ? subject.response.unit : "1", range);
    plot::Line line;
    plot::Band band;
    for (const auto* check : checks) {
        const auto& one = check->of(statistic);
        line.x.push_back(static_cast<double>(check->points));
        line.y.push_back(shown.of(one.value));
        band.low.push_back(shown.of(one.value - one.error));
        band.high.push_back(shown.of(one.value + one.error));
    }
    band.x = line.x;
    plot::Panel panel{{"design points", 0, 1.02 * line.x.back()}, number_axis(shown, range), {band, line}};
    panel.name = name;
    if (line.x.size() <= most_dots) panel.marks.push_back(plot::Points{line.x, line.y});
    return panel;
}

/// Returns the points at which the campaign stopped, else those at which its rule was first satisfied.
std::optional<std::int64_t> end_of(const FigureSubject& subject, const History& history) {
    if (subject.responses.campaign.stopped_at) return subject.responses.campaign.stopped_at;
    const auto converged = std::ranges::find(history.checks, true, &stats::Checkpoint::converged);
    if (!history.has_rule || converged == history.checks.end()) return std::nullopt;
    return converged->points;
}

plot::Figure draw_convergence(const FigureSubject& subject, const PanelNames& panels) {
    const auto history = history_of(subject);
    plot::Figure figure;
    for (const auto statistic : stats::statistics)
        if (std::ranges::count(panels, stats::to_string(statistic)) > 0)
            figure.panels.push_back(moment_panel(subject, history, statistic));
    figure.keys = {{"all points so far", plot::blue, plot::Key::Kind::line},
                   {"95 % error", plot::faded(plot::blue, 0.2), plot::Key::Kind::area}};
    if (const auto end = end_of(subject, history)) {
        for (auto& panel : figure.panels) panel.marks.push_back(plot::Marker{static_cast<double>(*end)});
        figure.keys.push_back(
            {subject.responses.campaign.stopped_at ? "stopped" : "converged", plot::black, plot::Key::Kind::dashes});
    }
    return figure;
}

PanelNames convergence_panels(const FigureSubject& subject) {
    if (!subject.responses.ordered_sample() || !has_values(subject)) return {};
    if (checks_to_show(history_of(subject), 2).empty()) return {};
    PanelNames names;
    for (const auto statistic : stats::statistics) names.emplace_back(stats::to_string(statistic));
    return names;
}

plot::Panel effect_panel(const FactorColumn& factor, const std::vector<EffectBin>& bins, const plot::Axis& up,
                         const Quantity& shown) {
    const auto variable = variable_of(factor);
    plot::Points means;
    plot::Whiskers errors;
    for (const auto& bin : bins) {
        means.x.push_back(variable.shown(bin.at));
        means.y.push_back(shown.of(bin.mean));
        errors.half_width.push_back(shown.of(bin.error));
    }
    errors.at = means.x;
    errors.value = means.y;
    plot::Panel panel{variable.axis(), up};
    panel.name = factor.name;
    if (factor.continuous()) panel.marks.push_back(plot::Line{means.x, means.y});
    panel.marks.push_back(errors);
    panel.marks.push_back(means);
    return panel;
}

/// All factors share one scale, so that a single panel can be compared with the others.
plot::Figure draw_effects(const FigureSubject& subject, const PanelNames& panels) {
    const auto judged = subject.responses.judged(subject.response);
    const auto errors = effect_errors(subject.responses, subject.response);
    std::vector<std::vector<EffectBin>> bins;
    std::vector<double> ends;
    for (const auto& factor : subject.responses.factors) {
        bins.push_back(main_effect(factor, judged, errors));
        for (const auto& bin : bins.back()) {
            const double error = std::isfinite(bin.error) ? bin.error : 0;
            ends.push_back(bin.mean - error);
            ends.push_back(bin.mean + error);
        }
    }
    const auto range = finite_range(ends);
    const auto shown = quantity_of(fmt::format("mean {}", subject.response.name), subject.response.unit, range);
    const auto axis = number_axis(shown, range, has_log_axis(subject, range));
    plot::Figure figure;
    for (std::size_t j = 0; j < bins.size(); ++j) {
        const auto& factor = subject.responses.factors[j];
        if (std::ranges::count(panels, factor.name) > 0)
            figure.panels.push_back(effect_panel(factor, bins[j], axis, shown));
    }
    return figure;
}

}  // namespace

constinit const FigureKind distribution_figure{"distribution",   "distribution of the response",
                                               panel_of_values,  draw_distribution,
                                               OnPage::response, {.axis = true}};

constinit const FigureKind convergence_figure{"convergence",
                                              "moments against the number of design points, with 95 % errors",
                                              convergence_panels, draw_convergence};

constinit const FigureKind effects_figure{"effects",         "mean response against each factor, with 95 % errors",
                                          panels_of_factors, draw_effects,
                                          OnPage::response,  {.axis = true}};

}  // namespace grainsweep::report
