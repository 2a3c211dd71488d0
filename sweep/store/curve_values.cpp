// Values at one place along the curves of a campaign: what a measured curve is compared with.
#include "sweep/store/archive.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <utility>

namespace grainsweep::store {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

struct Sample {
    double time, bin, value;
};

/// Places along a curve, ascending, and the values there.
struct Curve {
    std::vector<double> places, values;

    /// Between two places on the line through them; NaN outside of them all.
    [[nodiscard]] double value_at(double at) const {
        const auto k = static_cast<std::size_t>(std::ranges::lower_bound(places, at) - places.begin());
        if (k == places.size()) return none;
        if (places[k] == at) return values[k];
        if (k == 0) return none;
        return std::lerp(values[k - 1], values[k], (at - places[k - 1]) / (places[k] - places[k - 1]));
    }
};

/// A program writes samples in any order. For a profile measured more than once, the last time counts. Several samples
/// at one place are averaged. Samples of a profile without a bin do not count.
Curve curve_of(std::vector<Sample> samples) {
    const bool binned = std::ranges::any_of(samples, [](const Sample& s) { return !std::isnan(s.bin); });
    const auto place = [binned](const Sample& s) { return binned ? s.bin : s.time; };
    std::erase_if(samples, [&](const Sample& s) { return std::isnan(place(s)); });
    double last = none;
    for (const auto& s : samples) last = s.time <= last ? last : s.time;
    if (binned && !std::isnan(last)) std::erase_if(samples, [last](const Sample& s) { return s.time != last; });
    std::ranges::stable_sort(samples, {}, place);
    Curve curve;
    double count = 0;  // samples at the last place
    for (const auto& s : samples) {
        if (curve.places.empty() || place(s) != curve.places.back()) {
            curve.places.push_back(place(s));
            curve.values.push_back(s.value);
            count = 1;
        } else {
            curve.values.back() += (s.value - curve.values.back()) / ++count;
        }
    }
    return curve;
}

/// Calls `each` for every case of the campaign, by point and replicate, with its curve.
void for_each_curve(const Store::Impl& archive, std::string_view campaign, std::string_view observable,
                    const std::function<void(PlacedValue, const Curve&)>& each) {
    const auto& db = archive.db;
    const std::int64_t campaign_key = archive.campaign_key(campaign);
    const std::int64_t observable_key = measured_key(db, campaign_key, campaign, observable, false);
    auto rows = db.ask(
        "SELECT p.point, p.sequence, p.replicate, c.outcome, o.time, o.bin, o.value, o.sample, p.case_key FROM "
        "campaign_case AS p JOIN sim_case AS c ON c.case_key = p.case_key LEFT JOIN observation AS o ON o.case_key = "
        "p.case_key AND "
        "o.observable_id = ?1 WHERE p.campaign_id = ?2 ORDER BY p.point, p.replicate, o.sample",
        observable_key, campaign_key);
    std::optional<PlacedValue> placed;
    std::vector<Sample> samples;
    const auto close = [&] {
        if (placed) each(*placed, curve_of(std::exchange(samples, {})));
    };
    while (rows.next()) {
        const auto point = rows.get<std::int64_t>(0), replicate = rows.get<std::int64_t>(2);
        if (!placed || placed->point != point || placed->replicate != replicate) {
            close();
            placed = {.point = point,
                      .sequence = rows.get<std::int64_t>(1),
                      .replicate = replicate,
                      .case_key = rows.get<std::int64_t>(8),
                      .outcome = outcome_at(rows, 3),
                      .value = none};
        }
        if (!rows.is_null(7)) samples.push_back({rows.get<double>(4), rows.get<double>(5), rows.get<double>(6)});
    }
    close();
}

}  // namespace

std::vector<PlacedValue> Store::values_along(std::string_view campaign, std::string_view observable, double at) const {
    impl_->require_sound();
    std::vector<PlacedValue> values;
    for_each_curve(*impl_, campaign, observable, [&](PlacedValue placed, const Curve& curve) {
        placed.value = curve.value_at(at);
        values.push_back(placed);
    });
    return values;
}

std::vector<CurveExtent> Store::curve_extents(std::string_view campaign, std::string_view observable) const {
    impl_->require_sound();
    std::vector<CurveExtent> extents;
    for_each_curve(*impl_, campaign, observable, [&](PlacedValue placed, const Curve& curve) {
        if (!curve.places.empty()) extents.push_back({placed.point, curve.places.front(), curve.places.back()});
    });
    return extents;
}

}  // namespace grainsweep::store
