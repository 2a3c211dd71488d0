#include "sweep/report/window_page.hpp"

#include "sweep/report/figure_kinds.hpp"
#include "sweep/report/model_panels.hpp"
#include "sweep/report/model_tables.hpp"
#include "sweep/report/packed_column.hpp"
#include "sweep/report/page.hpp"
#include "sweep/report/page_files.hpp"
#include "sweep/report/page_template.hpp"
#include "sweep/report/window_tables.hpp"
#include "sweep/study/box_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <ostream>

namespace grainsweep::report {

using namespace study;

namespace {

constexpr std::size_t points_of_curve = 41;

WindowCurve curve_through(const ModelCases& cases, const WindowRequest& request, const Window& window,
                          const Admits& admits, const Setting& centre, std::size_t factor) {
    WindowCurve curve{points_along(cases.factors[factor], points_of_curve), {}, {}};
    std::vector<Setting> settings(curve.at.size(), centre);
    for (std::size_t i = 0; i < settings.size(); ++i) place(cases.factors, settings[i], factor, curve.at[i]);
    curve.judged = judge_settings(cases, request, window, admits, settings);
    for (std::size_t k = 0; k < window.models.size(); ++k) {
        auto& response = curve.responses.emplace_back(ModelCurve{curve.at, {}, {}, {}, {}});
        for (const auto& one : curve.judged) response.add(one.predictions[k], one.believed);
    }
    return curve;
}

double width_of(std::span<const Judgement> judged, double (*of)(const Judgement&)) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const auto& one : judged) {
        low = std::min(low, of(one));
        high = std::max(high, of(one));
    }
    return high > low ? high - low : 0;
}

/// Whether the first objective is an observable.
bool modelled_objective(const Window& window) {
    return !window.goals.empty() && window.goals.front().model;
}

std::string name_of(const Goal& goal, const ModelCases& cases, const Window& window) {
    return goal.model ? window.models[*goal.model].observable : cases.factors[*goal.factor].name;
}

double probability_of(const Judgement& one) {
    return one.probability;
}
double objective_of(const Judgement& one) {
    return one.objectives.front().mean;
}

/// Returns the variance of the means of `values` in groups by a factor: eight groups of equal count, or the factor's
/// values if there are at most eight. 0 if no point has a value of the factor.
double variance_by(std::span<const Setting> settings, std::span<const double> values, std::size_t factor) {
    constexpr std::size_t most_groups = 8;
    struct Group {
        double sum = 0;
        std::size_t count = 0;
    };
    std::map<double, Group> by_value;
    double mean = 0;
    for (std::size_t i = 0; i < settings.size(); ++i) {
        if (std::isnan(settings[i][factor])) return 0;
        auto& group = by_value[settings[i][factor]];
        group.sum += values[i];
        ++group.count;
        mean += values[i] / static_cast<double>(values.size());
    }
    const auto least = by_value.size() <= most_groups ? 1 : settings.size() / most_groups;
    double variance = 0;
    Group group;
    for (const auto& [value, one] : by_value) {
        group.sum += one.sum;
        group.count += one.count;
        if (group.count < least) continue;
        const double off = group.sum / static_cast<double>(group.count) - mean;
        variance += off * off * static_cast<double>(group.count) / static_cast<double>(values.size());
        group = {};
    }
    return variance;
}

/// Orders factors by their effect on the condition in the whole box; the factors of a map come first.
void put_decisive_first(std::vector<std::size_t>& order, const ModelCases& cases, const WindowRequest& request,
                        const Window& window, const Admits& admits) {
    constexpr std::size_t most_points = 1024;  // of the searched ones, which are a Sobol sequence
    if (request.where.empty()) return;
    const auto settings = std::span(window.searched).first(std::min(most_points, window.searched.size()));
    std::vector<double> probabilities;
    for (const auto& one : judge_settings(cases, request, window, admits, settings))
        probabilities.push_back(one.probability);
    std::vector<double> weights;
    for (std::size_t j = 0; j < cases.factors.size(); ++j) weights.push_back(variance_by(settings, probabilities, j));
    std::ranges::stable_sort(order, std::ranges::greater{}, [&](std::size_t j) { return weights[j]; });
}

/// Factors by how much they matter, see the header.
std::vector<std::size_t> order_of(std::span<const WindowCurve> curves, bool objective, double whole_range) {
    std::vector<double> weights;
    for (const auto& curve : curves) {
        double weight = width_of(curve.judged, probability_of);
        if (objective && whole_range > 0) weight += width_of(curve.judged, objective_of) / whole_range;
        weights.push_back(weight);
    }
    std::vector<std::size_t> order(curves.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, std::ranges::greater{}, [&](std::size_t j) { return weights[j]; });
    return order;
}

Json responses_of(const Window& window, const Judgement& one) {
    Json list = Json::array();
    for (std::size_t k = 0; k < window.models.size(); ++k) {
        const auto& p = one.predictions[k];
        const auto shown = [&](double x) { return one.believed ? Json(x) : Json(); };
        list.push_back({{"mean", shown(p.mean)},
                        {"mean_half_width", shown(p.mean_half_width())},
                        {"run_half_width", shown(p.run_half_width())}});
    }
    return list;
}

Json window_page_json(const ModelCases& cases, const Window& window, const Judgement& one) {
    Json texts = Json::array();
    for (std::size_t j = 0; j < cases.factors.size(); ++j) texts.push_back(cases.factors[j].text(one.setting[j]));
    return {{"setting", one.setting},
            {"texts", texts},
            {"probability", one.probability},
            {"responses", responses_of(window, one)}};
}

WindowMap window_map(const ModelCases& cases, const WindowRequest& request, const Window& window, const Admits& admits,
                     const Setting& centre, std::size_t a, std::size_t b) {
    constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
    const auto settings = settings_of_map(cases.factors, centre, a, b, points_of_curve);
    const auto judged = judge_settings(cases, request, window, admits, settings);
    WindowMap map{{a, b, points_of_curve}, {}, {}};
    for (std::size_t i = 0; i < settings.size(); ++i) {
        const bool there = !admits || admits(settings[i]);
        map.probability.push_back(there ? judged[i].probability : nothing);
        if (modelled_objective(window))
            map.objective.push_back(there && judged[i].believed ? judged[i].objectives.front().mean : nothing);
    }
    return map;
}

NumberRange range_of_response(const WindowPictures& pictures, std::size_t k, double bands) {
    std::vector<double> ends;
    for (const auto& curve : pictures.curves)
        for (std::size_t i = 0; i < curve.at.size(); ++i)
            for (const double sign : {-bands, bands})
                ends.push_back(curve.responses[k].mean[i] + sign * curve.responses[k].run_half_width[i]);
    return finite_range(ends);
}

/// Draws the figures of a page.
struct WindowPainter {
    const ModelCases& cases;
    const WindowRequest& request;
    const Window& window;
    const WindowPictures& pictures;
    const Setting& centre;

    [[nodiscard]] static Json drawn(const std::string& title, const std::string& says, plot::Figure figure) {
        return {{"title", title},
                {"says", says},
                {"svg", plot::drawn(drawable(std::move(figure)), figure_width_mm, plot::FileType::svg)}};
    }
    [[nodiscard]] double place_of(std::size_t j) const { return place_on_axis(cases.factors[j], centre[j]); }

    [[nodiscard]] Json map(const std::vector<double>& values, const Quantity& shown, const NumberRange& range,
                           const std::string& title, const std::string& says) const {
        const auto& map = *pictures.map;
        plot::Figure figure{{cells_panel(cases, map, values, shown, colour_scale(shown, range))}};
        if (!cases.failed.empty()) figure.keys = {failed_key()};
        std::vector<bool> inside;
        for (const double p : map.probability) inside.push_back(p >= 1 - window.risk);
        enclose(figure.panels.front(), inside);
        figure.panels.front().marks.push_back(
            plot::Points{{place_of(map.across)}, {place_of(map.up)}, {plot::black}, plot::Points::Shape::ring, 3});
        return drawn(title, says, std::move(figure));
    }

    [[nodiscard]] Json maps() const {
        Json list = Json::array();
        if (!pictures.map) return list;
        const auto& objective = pictures.map->objective;
        const auto pair =
            fmt::format("{} and {}", cases.factors[pictures.map->across].name, cases.factors[pictures.map->up].name);
        list.push_back(map(pictures.map->probability, quantity_of("probability", "1", 1), {},
                           "Process window: " + (request.where.empty() ? std::string("no condition") : request.where),
                           fmt::format("Probability of the condition against {}.", pair)));
        if (std::ranges::none_of(objective, [](double x) { return std::isfinite(x); })) return list;
        const auto& model = window.models.front();
        const auto range = finite_range(objective);
        list.push_back(map(objective, quantity_of(model.observable, model.unit, range), range,
                           fmt::format("{} against {}", model.observable, pair), "Predicted mean."));
        return list;
    }

    /// A curve, and the setting that it passes through.
    [[nodiscard]] Json curve(std::size_t j, const ModelCurve& curve, const Quantity& up, const plot::Axis& axis,
                             const std::string& name) const {
        plot::Figure figure{{curve_panel(cases, j, curve, up, axis)}, curve_keys(cases, curve)};
        figure.panels.front().marks.push_back(plot::Marker{place_of(j)});
        figure.keys.push_back({"setting", plot::black, plot::Key::Kind::dashes});
        return drawn(fmt::format("{} against {}", name, cases.factors[j].name), "", std::move(figure));
    }

    [[nodiscard]] Json curves() const {
        Json list = Json::array();
        for (std::size_t k = 0; k < window.models.size(); ++k) {
            const auto& model = window.models[k];
            const auto range = range_of_response(pictures, k, 1);
            const auto up = quantity_of(model.observable, model.unit, range);
            for (const auto j : pictures.order)
                list.push_back(curve(j, pictures.curves[j].responses[k], up, number_axis(up, range), model.observable));
        }
        for (const auto j : pictures.order) {
            if (request.where.empty()) break;
            ModelCurve probability{pictures.curves[j].at, {}, {}, {}, {}};
            for (const auto& one : pictures.curves[j].judged) probability.mean.push_back(one.probability);
            list.push_back(curve(j, probability, quantity_of("probability", "1", 1), {"probability", -0.04, 1.04},
                                 "probability of the condition"));
        }
        return list;
    }
};

const Judgement& centre_of(const Window& window) {
    return window.best ? *window.best : window.surest.value();
}

}  // namespace

WindowPictures window_pictures(const ModelCases& cases, const WindowRequest& request, const Window& window,
                               const Admits& admits) {
    const auto& centre = centre_of(window).setting;
    WindowPictures pictures;
    for (std::size_t j = 0; j < cases.factors.size(); ++j)
        pictures.curves.push_back(curve_through(cases, request, window, admits, centre, j));
    const bool modelled = modelled_objective(window);
    double whole_range = 0;
    if (modelled) {
        const auto& model = window.models.front();
        const auto means = model.means(model.case_features);
        const auto [low, high] = std::ranges::minmax(means);
        whole_range = high - low;
    }
    auto& order = pictures.order;
    order = order_of(pictures.curves, modelled, whole_range);
    put_decisive_first(order, cases, request, window, admits);
    if (order.size() > 1) pictures.map = window_map(cases, request, window, admits, centre, order[0], order[1]);
    return pictures;
}

Json window_page_data(const ModelCases& cases, const WindowRequest& request, const Window& window,
                      const Admits& admits) {
    const auto pictures = window_pictures(cases, request, window, admits);
    const auto& centre = centre_of(window);
    const bool objective = !request.objectives.empty();
    Json responses = Json::array(), others = Json::array();
    for (std::size_t k = 0; k < window.models.size(); ++k) {
        const auto range = range_of_response(pictures, k, 0);
        responses.push_back({{"name", window.models[k].observable},
                             {"unit", window.models[k].unit},
                             {"low", range.low},
                             {"high", range.high}});
    }
    for (std::size_t k = 2; k < pictures.order.size(); ++k) others.push_back(pictures.order[k]);
    const auto settings = [&](const std::vector<Judgement>& judged) {
        return Json::list(judged, [&](const Judgement& one) { return window_page_json(cases, window, one); });
    };
    const WindowPainter painter{cases, request, window, pictures, centre.setting};
    const Json figures = {{"maps", painter.maps()}, {"curves", painter.curves()}};
    return {
        {"campaigns", std::array{Json{{"name", cases.campaign.name}, {"figures", base64(deflated(figures.text()))}}}},
        {"campaign", cases.campaign.name},
        {"scene", shown_scene(cases.campaign.scene)},
        {"where", request.where},
        {"objective", objective ? Json(request.objectives.front().name) : Json()},
        {"goal", goal_text(request)},
        {"volume", window.volume ? Json(volume_text(*window.volume)) : Json()},
        {"single_run", request.judged == stats::Judged::single_run},
        {"risk", request.risk},
        {"share", window.share_of_box},
        {"share_error", window.share_error},
        {"share_of", share_of(cases.factors)},
        {"factors", axes_json(cases.factors)},
        {"meets", window.best.has_value()},
        {"best", window_page_json(cases, window, centre)},
        {"failed", !cases.failed.empty()},
        {"failed_near", cases.failed.empty() ? "" : near_text(cases, window.answers->near(centre.setting))},
        {"others", others},
        {"responses", responses},
        {"models", Json::list(window.models, model_lines)},
        {"front", settings(window.front)},
        {"next", settings(window.next)},
        {"against", window.against ? Json(name_of(*window.against, cases, window)) : Json()},
        {"notes", window.notes}};
}

void write_window_page(std::ostream& out, const Json& data, std::string_view database) {
    Json all = data;
    all.add("databases", std::array{database});
    write_figures(out, "", page_files().window, safe_in_script(all));
}

}  // namespace grainsweep::report
