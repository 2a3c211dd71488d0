#include "sweep/report/model_page.hpp"

#include "sweep/study/answers.hpp"
#include "sweep/study/box_search.hpp"

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

/// Response model, and the settings that its pictures pass through.
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

    /// Returns the mean over the other factors for given values of the factors `held`; NaN if hardly any setting is
    /// admitted.
    [[nodiscard]] std::vector<double> averaged(std::span<const std::size_t> held,
                                               std::span<const Setting> values) const {
        std::vector<Setting> settings;
        std::vector<std::size_t> counts;
        for (const auto& value : values) {
            const auto before = settings.size();
            for (const auto& other : others) {
                Setting setting = other.setting;
                for (std::size_t k = 0; k < held.size(); ++k)
                    place(cases.factors, setting, held[k], value[k], held.first(k));
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

ModelCurve curve_of(const Pictured& pictured, std::size_t factor) {
    ModelCurve curve{points_along(pictured.cases.factors[factor], points_of_slice), {}, {}, {}, {}};
    std::vector<Setting> values, slice;
    for (const double x : curve.at) {
        values.push_back({x});
        slice.push_back(pictured.middle);
        place(pictured.cases.factors, slice.back(), factor, x);
    }
    curve.averaged = pictured.averaged(std::span(&factor, 1), values);
    const auto predictions = pictured.model.predict(slice);
    for (std::size_t i = 0; i < slice.size(); ++i) curve.add(predictions[i], pictured.has(slice[i]));
    return curve;
}

ModelMap map_over(const Pictured& pictured, std::size_t a, std::size_t b) {
    const auto slice = settings_of_map(pictured.cases.factors, pictured.middle, a, b, cells_of_map);
    std::vector<Setting> held;
    for (const auto& setting : slice) held.push_back({setting[a], setting[b]});
    ModelMap map{{a, b, cells_of_map}, pictured.averaged(std::array{a, b}, held), {}};
    map.slice = pictured.model.means(pictured.model.rows(slice));
    for (std::size_t i = 0; i < slice.size(); ++i)
        if (!pictured.has(slice[i])) map.slice[i] = std::numeric_limits<double>::quiet_NaN();
    return map;
}

}  // namespace

void ModelCurve::add(const stats::Prediction& point, bool shown) {
    const auto drawn = [&](double x) { return shown ? x : std::numeric_limits<double>::quiet_NaN(); };
    mean.push_back(drawn(point.mean));
    mean_half_width.push_back(drawn(point.mean_half_width()));
    run_half_width.push_back(drawn(point.run_half_width()));
}

double ModelCurve::range() const {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const double x : averaged)
        if (std::isfinite(x)) low = std::min(low, x), high = std::max(high, x);
    return high > low ? high - low : 0;
}

ModelPictures model_pictures(const ModelCases& cases, const ObservableModel& model,
                             const std::function<bool(const Setting&)>& admits) {
    const Pictured pictured{cases, model, admits};
    ModelPictures pictures{pictured.middle, {}, std::vector<std::size_t>(cases.factors.size()), std::nullopt};
    for (std::size_t j = 0; j < cases.factors.size(); ++j) pictures.curves.push_back(curve_of(pictured, j));
    auto& order = pictures.order;
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, std::ranges::greater{}, [&](std::size_t j) { return pictures.curves[j].range(); });
    if (order.size() > 1) pictures.map = map_over(pictured, order[0], order[1]);
    return pictures;
}

}  // namespace grainsweep::report
