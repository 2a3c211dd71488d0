// cases, map, against: the cases themselves.
#include "solver/plain_text.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/report/figure_kinds.hpp"
#include "sweep/study/effects.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <utility>

namespace grainsweep::report {
namespace {

using namespace study;

constexpr std::size_t most_dots = 1500;

/// Chosen variables of a figure: the variables named by the options, else the response and the most influential
/// factors.
struct Chosen {
    Variable across, up;
    std::optional<Variable> colour;
};

bool is_factor(const FigureSubject& subject, const std::string& name) {
    return std::ranges::count(subject.responses.factors, name, &FactorColumn::name) > 0;
}

/// Returns the variable along the horizontal axis, with the requested axis.
Variable across_variable(const FigureSubject& subject, const std::string& name) {
    auto variable = named_variable(subject, "--across", name);
    if (!subject.across_log || subject.lines) return variable;  // lines have their own axis
    if (!variable.levels.empty())
        throw campaign::input_error("--across-axis", "", fmt::format("'{}' has levels, and no axis of numbers", name));
    if (*subject.across_log && !(variable.low > 0))
        throw campaign::input_error(
            "--across-axis", "'log'",
            fmt::format("'{}' reaches down to {:.4g}: it has no logarithmic axis", name, variable.low));
    variable.log = *subject.across_log;
    return variable;
}

Chosen chosen_for_cases(const FigureSubject& subject) {
    std::vector<std::string> order;
    for (const auto* factor : by_influence(subject)) order.push_back(factor->name);
    const auto next = [&](const std::string& but) {
        const auto found = std::ranges::find_if(order, [&](const auto& name) { return name != but; });
        return found == order.end() ? std::string() : *found;
    };
    const auto across = !subject.across.empty() ? subject.across : order.empty() ? "point" : order.front();
    const auto up = !subject.up.empty() ? subject.up : subject.response.name;
    const bool chosen = !subject.across.empty() || !subject.up.empty();
    const auto colour = !subject.colour.empty() ? subject.colour : chosen ? std::string() : next(across);
    Chosen variables{across_variable(subject, across), named_variable(subject, "--up", up), std::nullopt};
    if (!colour.empty()) variables.colour = named_variable(subject, "--colour", colour);
    return variables;
}

/// Returns crosses for failed cases: at their place if both axes are factors, else at the edge, because the response
/// has no value.
std::optional<plot::Points> failed_marks(const FigureSubject& subject, const Variable& across, const Variable& up,
                                         const plot::Axis& x_axis, const plot::Axis& y_axis) {
    std::vector<double> x, y;
    for (const auto row : failed_rows(subject.responses)) {
        const bool placed_x = std::isfinite(across.values[row]), placed_y = std::isfinite(up.values[row]);
        if (!placed_x && !placed_y) continue;
        x.push_back(placed_x ? across.place(row) : x_axis.low);
        y.push_back(placed_y ? up.place(row) : y_axis.low);
    }
    if (x.empty()) return std::nullopt;
    return crosses(std::move(x), std::move(y));
}

void add_failed(plot::Figure& figure, plot::Panel& panel, const std::optional<plot::Points>& failed) {
    if (!failed) return;
    panel.marks.push_back(*failed);
    if (std::ranges::count(figure.keys, "failed cases", &plot::Key::text) == 0) figure.keys.push_back(failed_key());
}

/// Returns a factor with levels that are numbers as a factor of numbers, so that its axis has their distances.
FactorColumn with_numbers(FactorColumn factor) {
    const auto numbers = factor.seen_numbers();
    if (numbers.empty()) return factor;
    for (double& value : factor.values)
        if (std::isfinite(value)) value = numbers[static_cast<std::size_t>(value)];
    const auto range = finite_range(numbers);
    factor.seen.clear();
    factor.range = campaign::Between{range.low, range.high};
    return factor;
}

/// Adds the means of a response over a factor in the rows where `counts`: dots, joined, with their errors.
void add_line(plot::Panel& panel, const FigureSubject& subject, const FactorColumn& across, const Variable& up,
              const EffectErrors& errors, const std::function<bool(std::size_t)>& counts, plot::Colour tone) {
    auto values = subject.responses.judged(subject.responses.observable(up.name));
    std::vector<double> chosen(values.begin(), values.end());
    for (std::size_t row = 0; row < chosen.size(); ++row)
        if (!counts(row)) chosen[row] = std::numeric_limits<double>::quiet_NaN();
    const auto shown = variable_of(across);
    plot::Line line{{}, {}, tone, 1.2};
    plot::Whiskers whiskers{{}, {}, {}, tone};
    for (const auto& bin : main_effect(across, chosen, errors)) {
        line.x.push_back(shown.shown(bin.at));
        line.y.push_back(up.shown(bin.mean));
        whiskers.at.push_back(line.x.back());
        whiskers.value.push_back(line.y.back());
        whiskers.half_width.push_back(up.quantity().factor * bin.error);
    }
    plot::Points dots{line.x, line.y, {tone}, plot::Points::Shape::dot, 2};
    panel.marks.emplace_back(std::move(line));
    panel.marks.emplace_back(std::move(whiskers));
    panel.marks.emplace_back(std::move(dots));
}

plot::Figure draw_lines(const FigureSubject& subject) {
    const auto chosen = chosen_for_cases(subject);
    if (!is_factor(subject, chosen.across.name))
        throw campaign::input_error("--across", fmt::format("'{}'", chosen.across.name),
                                    "lines run over a factor: " + campaign::listed(factor_panels(subject)));
    const auto& observables = subject.responses.observables;
    if (std::ranges::find(observables, chosen.up.name, &ResponseColumn::name) == observables.end())
        throw campaign::input_error("--up", fmt::format("'{}'", chosen.up.name), "lines are means of an observable");
    auto across = with_numbers(factor_named(subject, chosen.across.name));
    if (subject.across_log) {
        const auto [low, high] = across.ends();
        if (!across.continuous() || (*subject.across_log && !(low > 0)))
            throw campaign::input_error("--across-axis", "", fmt::format("'{}' has no such axis", across.name));
        across.range =
            campaign::Between{low, high, *subject.across_log ? campaign::Scale::log : campaign::Scale::linear};
    }
    const auto& up = chosen.up;
    const auto errors = effect_errors(subject.responses, subject.responses.observable(up.name));
    plot::Figure figure;
    plot::Panel panel{variable_of(across).axis(0.04), up.axis(0.04)};
    const bool by_level = chosen.colour && !chosen.colour->levels.empty();
    if (!by_level && !subject.colour.empty())
        throw campaign::input_error("--colour", fmt::format("'{}'", subject.colour),
                                    "lines differ by a factor with levels, and this one has none");
    if (by_level) {
        figure.keys = chosen.colour->keys(plot::Key::Kind::line);
        for (std::size_t k = 0; k < chosen.colour->levels.size(); ++k)
            add_line(
                panel, subject, across, up, errors,
                [&, k](std::size_t row) { return chosen.colour->values[row] == static_cast<double>(k); },
                plot::category(k));
    } else {
        add_line(
            panel, subject, across, up, errors, [](std::size_t) { return true; }, plot::blue);
    }
    figure.panels = {std::move(panel)};
    return figure;
}

plot::Figure draw_cases(const FigureSubject& subject, const PanelNames&) {
    if (subject.lines) return draw_lines(subject);
    const auto [across, up, colour] = chosen_for_cases(subject);
    plot::Figure figure;
    plot::Panel panel{across.axis(), up.axis()};
    std::optional<ColourScale> scale;
    if (colour && colour->levels.empty()) {
        scale = colour_scale(colour->quantity(), {colour->low, colour->high}, colour->log);
        panel.scale = scale->axis;
    }
    plot::Points points;
    if (colour) points.tones.clear();
    for (std::size_t row = 0; row < subject.responses.rows(); ++row) {
        const double by = colour ? colour->values[row] : 0;
        if (!std::isfinite(across.values[row]) || !std::isfinite(up.values[row]) || !std::isfinite(by)) continue;
        points.x.push_back(across.place(row));
        points.y.push_back(up.place(row));
        if (colour)
            points.tones.push_back(scale ? scale->of(colour->quantity().of(by))
                                         : plot::category(static_cast<std::size_t>(by)));
    }
    if (colour) figure.keys = colour->keys(plot::Key::Kind::dot);
    const auto failed = failed_marks(subject, across, up, panel.x, panel.y);
    panel.marks.push_back(std::move(points));
    add_failed(figure, panel, failed);
    figure.panels = {std::move(panel)};
    return figure;
}

/// The two factors of a map.
std::pair<const FactorColumn*, const FactorColumn*> factors_of_map(const FigureSubject& subject) {
    const auto order = by_influence(subject);
    const auto pick = [&](std::string_view option, const std::string& name, const FactorColumn* but) {
        if (!name.empty()) {
            const auto variable = named_variable(subject, option, name);
            if (is_factor(subject, variable.name)) return &factor_named(subject, name);
            throw campaign::input_error(option, "'" + name + "'",
                                        "a map is over two factors: " + campaign::listed(factor_panels(subject)));
        }
        return *std::ranges::find_if(order, [&](const auto* factor) { return factor != but; });
    };
    // An option that names the most influential factor leaves the second one to the other axis.
    const FactorColumn* up = subject.up.empty() ? nullptr : pick("--up", subject.up, nullptr);
    const FactorColumn* across = pick("--across", subject.across, up);
    if (up == nullptr) up = pick("--up", subject.up, across);
    if (up == across)
        throw campaign::input_error("--up", "'" + subject.up + "'", "a map is over two different factors");
    return {across, up};
}

plot::Figure draw_map(const FigureSubject& subject, const PanelNames&) {
    const auto [a, b] = factors_of_map(subject);
    const auto cells = cell_means(*a, *b, subject.response);
    const auto across = variable_of(*a), up = variable_of(*b);
    const auto range = finite_range(cells.means);
    const auto shown = quantity_of("mean " + subject.response.name, subject.response.unit, range);
    const auto scale = colour_scale(shown, range, has_log_axis(subject, range));
    plot::Cells drawn;
    for (const double x : cells.x_edges) drawn.x_edges.push_back(across.shown(x));
    for (const double y : cells.y_edges) drawn.y_edges.push_back(up.shown(y));
    for (const double mean : cells.means)
        drawn.tones.push_back(std::isfinite(mean) ? std::optional(scale.of(shown.of(mean))) : std::nullopt);
    plot::Figure figure;
    plot::Panel panel{across.axis(0), up.axis(0)};
    for (auto [axis, edges] : {std::pair(&panel.x, &drawn.x_edges), {&panel.y, &drawn.y_edges}})
        if (axis->words.empty()) axis->low = edges->front(), axis->high = edges->back();
    panel.scale = scale.axis;
    const auto failed = failed_marks(subject, across, up, panel.x, panel.y);
    panel.marks.push_back(std::move(drawn));
    add_failed(figure, panel, failed);
    figure.panels = {std::move(panel)};
    return figure;
}

/// The response against a factor: cases, at most `most_dots` of them at random, and their binned mean.
plot::Panel against_panel(const FigureSubject& subject, plot::Figure& figure, const FactorColumn& factor) {
    const auto across = variable_of(factor), up = response_variable(subject);
    plot::Panel panel{across.axis(), up.axis(0.04)};
    panel.name = factor.name;
    std::vector<std::size_t> rows(subject.responses.settled);
    std::iota(rows.begin(), rows.end(), std::size_t{0});
    std::erase_if(rows, [&](std::size_t row) { return !std::isfinite(up.values[row]); });
    plot::Points cases{{}, {}, {plot::faded(plot::blue, 0.55)}};
    for (const auto row : random_rows(rows, most_dots)) {
        cases.x.push_back(across.place(row));
        cases.y.push_back(up.place(row));
    }
    plot::Line means{{}, {}, plot::vermilion, 1.2};
    for (const auto& bin : main_effect(factor, subject.responses.judged(subject.response), {})) {
        means.x.push_back(across.shown(bin.at));
        means.y.push_back(up.shown(bin.mean));
    }
    panel.marks.push_back(std::move(cases));
    if (factor.continuous())
        panel.marks.push_back(means);
    else
        panel.marks.push_back(plot::Points{means.x, means.y, {plot::vermilion}, plot::Points::Shape::diamond, 3});
    add_failed(figure, panel, failed_marks(subject, across, up, panel.x, panel.y));
    return panel;
}

plot::Figure draw_against(const FigureSubject& subject, const PanelNames& panels) {
    plot::Figure figure;
    figure.keys = {{"cases", plot::blue}, {"mean", plot::vermilion, plot::Key::Kind::line}};
    for (const auto& name : panels)
        figure.panels.push_back(against_panel(subject, figure, factor_named(subject, name)));
    return figure;
}

PanelNames map_panels(const FigureSubject& subject) {
    return has_values(subject) && subject.responses.factors.size() > 1 ? PanelNames{""} : PanelNames{};
}

}  // namespace

constinit const FigureKind cases_figure{
    "cases",        "one variable against another, a point per case, coloured by a third", panel_of_values, draw_cases,
    OnPage::script, {.choice = true, .colour = true, .axis = true, .lines = true}};

constinit const FigureKind map_figure{"map",          "mean response over two factors", map_panels, draw_map,
                                      OnPage::script, {.choice = true, .axis = true}};

constinit const FigureKind against_figure{"against",         "response against each factor: cases and binned mean",
                                          panels_of_factors, draw_against,
                                          OnPage::script,    {.axis = true}};

}  // namespace grainsweep::report
