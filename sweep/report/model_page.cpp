#include "sweep/report/model_page.hpp"

#include "sweep/report/model_tables.hpp"
#include "sweep/study/answers.hpp"
#include "sweep/study/box_search.hpp"
#include "sweep/study/factor_axis.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace grainsweep::report {

using namespace study;

namespace {

constexpr std::size_t points_of_slice = 31, cells_of_map = 21;
constexpr std::size_t points_averaged = 128, points_needed = 4;

/// A response model and what its pictures are taken through.
struct Pictured {
    const ModelCases& cases;
    const ObservableModel& model;
    const Admits& admits;
    Answers answers{cases};
    std::vector<BoxPoint> others = spread_points(cases.factors, {}, points_averaged);
    Setting middle = exact_setting(cases.factors, std::vector<double>(cases.factors.size(), 0.5));

    [[nodiscard]] bool has(const Setting& setting) const {
        return (!admits || admits(setting)) && answers.expected(std::span(&setting, 1)).front();
    }

    /// Mean over the other factors where those of `held` are as given; nothing where hardly any setting is admitted.
    [[nodiscard]] std::vector<double> averaged(std::span<const std::size_t> held,
                                               std::span<const Setting> values) const {
        std::vector<Setting> settings;
        std::vector<std::size_t> counts;
        for (const auto& value : values) {
            const auto before = settings.size();
            for (const auto& other : others) {
                Setting setting = other.setting;
                for (std::size_t k = 0; k < held.size(); ++k) setting[held[k]] = value[k];
                if (has(setting)) settings.push_back(std::move(setting));
            }
            counts.push_back(settings.size() - before);
        }
        const auto means = model.means(model.rows(settings));
        std::vector<double> averages;
        auto next = means.begin();
        for (const auto count : counts) {
            const auto end = next + static_cast<std::ptrdiff_t>(count);
            const double sum = std::accumulate(next, end, 0.0);
            averages.push_back(count < points_needed ? std::numeric_limits<double>::quiet_NaN()
                                                     : sum / static_cast<double>(count));
            next = end;
        }
        return averages;
    }
};

struct SliceCurve {
    std::vector<double> at, averaged;
    std::vector<Setting> slice;

    [[nodiscard]] double range() const {
        double low = std::numeric_limits<double>::infinity(), high = -low;
        for (const double x : averaged)
            if (std::isfinite(x)) low = std::min(low, x), high = std::max(high, x);
        return high > low ? high - low : 0;
    }
};

SliceCurve curve_of(const Pictured& pictured, std::size_t factor) {
    SliceCurve curve{points_along(pictured.cases.factors[factor], points_of_slice), {}, {}};
    std::vector<Setting> values;
    for (const double x : curve.at) {
        values.push_back({x});
        curve.slice.push_back(pictured.middle);
        curve.slice.back()[factor] = x;
    }
    curve.averaged = pictured.averaged(std::span(&factor, 1), values);
    return curve;
}

Json model_page_json(const Pictured& pictured, const SliceCurve& curve) {
    Json mean = Json::array(), mean_half_width = Json::array(), run_half_width = Json::array();
    const auto predictions = pictured.model.predict(curve.slice);
    for (std::size_t i = 0; i < curve.at.size(); ++i) {
        const bool there = pictured.has(curve.slice[i]);
        const auto shown = [&](double x) { return there ? Json(x) : Json(); };
        mean.push_back(shown(predictions[i].mean));
        mean_half_width.push_back(shown(predictions[i].mean_half_width()));
        run_half_width.push_back(shown(predictions[i].run_half_width()));
    }
    return {{"at", curve.at},
            {"averaged", curve.averaged},
            {"mean", mean},
            {"mean_half_width", mean_half_width},
            {"run_half_width", run_half_width}};
}

Json map_over(const Pictured& pictured, std::size_t a, std::size_t b) {
    const auto slice = settings_of_map(pictured.cases.factors, pictured.middle, a, b, cells_of_map);
    std::vector<Setting> held;
    for (const auto& setting : slice) held.push_back({setting[a], setting[b]});
    Json through = Json::array();
    const auto means = pictured.model.means(pictured.model.rows(slice));
    for (std::size_t i = 0; i < slice.size(); ++i) through.push_back(pictured.has(slice[i]) ? Json(means[i]) : Json());
    return map_json(pictured.cases.factors, a, b, cells_of_map)
        .add({{"averaged", pictured.averaged(std::array{a, b}, held)}, {"slice", through}});
}

}  // namespace

Json model_page_data(const ModelCases& cases, const ObservableModel& model,
                     const std::function<bool(const Setting&)>& admits) {
    const Pictured pictured{cases, model, admits};
    std::vector<SliceCurve> curves;
    for (std::size_t j = 0; j < cases.factors.size(); ++j) curves.push_back(curve_of(pictured, j));
    std::vector<std::size_t> order(curves.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, std::ranges::greater{}, [&](std::size_t j) { return curves[j].range(); });

    Json texts = Json::array();
    for (std::size_t j = 0; j < cases.factors.size(); ++j) texts.push_back(cases.factors[j].text(pictured.middle[j]));
    const auto drawn = [&](const SliceCurve& curve) { return model_page_json(pictured, curve); };
    return {{"observable", model.observable},
            {"unit", model.unit},
            {"says", model_lines(model)},
            {"factors", axes_json(cases.factors)},
            {"order", order},
            {"middle", {{"setting", pictured.middle}, {"texts", texts}}},
            {"failed", failed_json(cases)},
            {"curves", Json::list(curves, drawn)},
            {"map", order.size() < 2 ? Json() : map_over(pictured, order[0], order[1])}};
}

}  // namespace grainsweep::report
