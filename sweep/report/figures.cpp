#include "sweep/report/figures.hpp"

#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/visible_text.hpp"
#include "sweep/report/figure_kinds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace grainsweep::report {
namespace {

/// In the order of the report.
const std::vector<FigureKind>& figure_kinds() {
    static const std::vector<FigureKind> kinds = {
        posterior_figure, distribution_figure, convergence_figure, effects_figure, sensitivity_figure, variance_figure,
        model_figure,     model_map_figure,    cases_figure,       map_figure,     against_figure,     curves_figure,
    };
    return kinds;
}

bool is_single(const PanelNames& panels) {
    return panels.size() == 1 && panels.front().empty();
}

campaign::InputError refused_name(const FigureSubject& subject, std::string_view name) {
    std::vector<std::string> names;
    for (const auto& info : figures_for(subject)) names.push_back(info.name);
    const std::string rule = fmt::format("campaign '{}' has no such figure; there are {}",
                                         subject.responses.campaign.name, campaign::listed(names));
    return campaign::input_error("NAME", fmt::format("'{}'", name), rule, campaign::nearest_word(name, names));
}

void refuse_useless_choice(const FigureSubject& subject, const FigureKind& kind) {
    const auto refuse = [&](std::string_view option, const std::string& value) {
        throw campaign::input_error(option, fmt::format("'{}'", value),
                                    fmt::format("the figure '{}' has no such choice", kind.name));
    };
    if (!kind.has.choice && !subject.across.empty()) refuse("--across", subject.across);
    if (!kind.has.choice && !subject.up.empty()) refuse("--up", subject.up);
    if (!kind.has.colour && !subject.colour.empty()) refuse("--colour", subject.colour);
    if (!kind.has.lines && subject.across_log) refuse("--across-axis", *subject.across_log ? "log" : "linear");
    if (!kind.has.lines && subject.lines)
        throw campaign::input_error("--lines", "", fmt::format("the figure '{}' has no such choice", kind.name));
    if (!kind.has.axis && subject.log) refuse("--axis", *subject.log ? "log" : "linear");
}

}  // namespace

std::vector<FigureInfo> figures_for(const FigureSubject& subject) {
    std::vector<FigureInfo> list;
    for (const auto& kind : figure_kinds()) {
        auto panels = kind.panels(subject);
        if (panels.empty()) continue;
        if (is_single(panels)) panels.clear();
        list.push_back({std::string(kind.name), std::string(kind.shows), std::move(panels)});
    }
    return list;
}

plot::Figure figure_named(const FigureSubject& subject, std::string_view name) {
    const auto colon = std::min(name.find(':'), name.size());
    const auto kind = std::ranges::find(figure_kinds(), name.substr(0, colon), &FigureKind::name);
    if (kind == figure_kinds().end()) throw refused_name(subject, name);
    auto panels = kind->panels(subject);
    if (panels.empty()) throw refused_name(subject, name);
    refuse_useless_choice(subject, *kind);
    if (colon < name.size()) {
        const std::string wanted(name.substr(colon + 1));
        if (std::ranges::find(panels, wanted) == panels.end() || wanted.empty())
            throw campaign::input_error(
                "NAME", fmt::format("'{}'", name),
                is_single(panels) ? fmt::format("the figure '{}' is one panel", kind->name)
                                  : fmt::format("the panels of '{}' are {}", kind->name, campaign::listed(panels)),
                campaign::nearest_word(wanted, panels));
        panels = {wanted};
    }
    return drawable(kind->draw(subject, panels));
}

NamedFigures panels_on_page(const FigureSubject& subject, OnPage place) {
    NamedFigures list;
    for (const auto& kind : figure_kinds()) {
        if (kind.place != place) continue;
        const auto panels = kind.panels(subject);
        if (panels.empty()) continue;
        auto figure = drawable(kind.draw(subject, panels));
        for (auto& panel : figure.panels) {
            const auto name = fmt::format("{}{}{}", kind.name, panel.name.empty() ? "" : ":", panel.name);
            list.emplace_back(name, plot::Figure{{std::move(panel)}, figure.keys});
        }
    }
    return list;
}

plot::Figure drawable(plot::Figure figure) {
    const auto clean = [](std::string& text) { text = campaign::visible(campaign::valid_utf8(text)); };
    for (auto& panel : figure.panels)
        for (auto* axis : {&panel.x, &panel.y, panel.scale ? &*panel.scale : nullptr}) {
            if (axis == nullptr) continue;
            clean(axis->title);
            std::ranges::for_each(axis->words, clean);
        }
    for (auto& key : figure.keys) clean(key.text);
    return figure;
}

study::History history_of(const FigureSubject& subject) {
    return subject.history != nullptr ? *subject.history : study::history_of(subject.responses, subject.response);
}

study::Influence influence_of(const FigureSubject& subject) {
    return subject.influence != nullptr ? *subject.influence : study::influence_of(subject.responses, subject.response);
}

PanelNames factor_panels(const FigureSubject& subject) {
    PanelNames names;
    for (const auto& factor : subject.responses.factors) names.push_back(factor.name);
    return names;
}

const study::FactorColumn& factor_named(const FigureSubject& subject, std::string_view name) {
    return *std::ranges::find(subject.responses.factors, name, &study::FactorColumn::name);
}

bool has_values(const FigureSubject& subject) {
    return std::ranges::any_of(subject.responses.judged(subject.response), [](double x) { return std::isfinite(x); });
}

PanelNames panel_of_values(const FigureSubject& subject) {
    return has_values(subject) ? PanelNames{""} : PanelNames{};
}

PanelNames panels_of_factors(const FigureSubject& subject) {
    return has_values(subject) ? factor_panels(subject) : PanelNames{};
}

std::vector<const study::FactorColumn*> by_influence(const FigureSubject& subject) {
    const auto influence = influence_of(subject);
    std::vector<std::pair<double, const study::FactorColumn*>> weighed;
    for (const auto& factor : influence.factors) {
        double weight = factor.effects ? factor.effects->mu_star : factor.total.value;
        if (!std::isfinite(weight)) weight = factor.first.value;
        const auto members = factor.members.empty() ? std::vector{factor.factor} : factor.members;
        for (const auto& name : members)
            weighed.emplace_back(std::isfinite(weight) ? weight : 0, &factor_named(subject, name));
    }
    std::ranges::stable_sort(weighed, std::ranges::greater{}, &std::pair<double, const study::FactorColumn*>::first);
    std::vector<const study::FactorColumn*> order;
    for (const auto& [weight, factor] : weighed) order.push_back(factor);
    return order;
}

Variable named_variable(const FigureSubject& subject, std::string_view option, const std::string& name) {
    const auto& responses = subject.responses;
    std::vector<std::string> names = {"point"};
    for (const auto& factor : responses.factors) {
        if (factor.name == name) return variable_of(factor);
        names.push_back(factor.name);
    }
    for (const auto& response : responses.observables) {
        if (response.name == name)
            return name == subject.response.name ? response_variable(subject) : variable_of(response);
        names.push_back(response.name);
    }
    if (name != "point")
        throw campaign::input_error(option, fmt::format("'{}'", name),
                                    fmt::format("is none of {}", campaign::listed(names)),
                                    campaign::nearest_word(name, names));
    const std::vector<double> points(responses.points.begin(), responses.points.end());
    const auto range = finite_range(points);
    return {name, "1", {}, range.low, range.high, false, points};
}

bool has_log_axis(const FigureSubject& subject, const NumberRange& range) {
    if (!subject.log.value_or(spans_decades(range))) return false;
    if (range.low > 0) return true;
    throw campaign::input_error(
        "--axis", "'log'",
        fmt::format("what the figure shows of '{}' reaches down to {:.4g}: it has no logarithmic axis",
                    subject.response.name, range.low));
}

Variable response_variable(const FigureSubject& subject) {
    auto variable = variable_of(subject.response);
    variable.log = has_log_axis(subject, {variable.low, variable.high});
    return variable;
}

std::vector<std::size_t> failed_rows(const study::Responses& responses) {
    std::vector<std::size_t> rows;
    for (std::size_t row = 0; row < responses.rows(); ++row)
        if (study::has_failed(responses.outcomes[row])) rows.push_back(row);
    return study::random_rows(std::move(rows), most_crosses);
}

plot::Points crosses(std::vector<double> x, std::vector<double> y) {
    return {std::move(x), std::move(y), {plot::black}, plot::Points::Shape::cross, 1.8};
}

plot::Key failed_key() {
    return {"failed cases", plot::black, plot::Key::Kind::cross};
}

plot::Colour ColourScale::of(double shown) const {
    const auto at = [&](double x) { return axis.log ? std::log(x) : x; };
    return plot::along_scale((at(shown) - at(axis.low)) / (at(axis.high) - at(axis.low)));
}

ColourScale colour_scale(const Quantity& quantity, const NumberRange& range, bool log) {
    return {number_axis(quantity, range, log && range.low > 0, 0)};
}

}  // namespace grainsweep::report
