// Values at one place along the curves of a campaign: what a measured curve is compared with.
#include "sweep/campaign/wrong_question.hpp"
#include "sweep/store/archive.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace grainsweep::store {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

struct Sample {
    double time, bin, value;
};

/// Samples of one curve in their order; of a profile measured more than once those of its last time.
double value_at(const std::vector<Sample>& samples, double at) {
    const double last = samples.empty() ? none : samples.back().time;
    double x0 = none, y0 = none;
    for (const auto& sample : samples) {
        const bool binned = !std::isnan(sample.bin);
        if (binned && !std::isnan(last) && sample.time != last) continue;
        const double x = binned ? sample.bin : sample.time;
        if (x == at) return sample.value;
        if (x0 < at && at < x) return std::lerp(y0, sample.value, (at - x0) / (x - x0));
        x0 = x;
        y0 = sample.value;
    }
    return none;
}

std::int64_t curve_key(const Connection& db, std::int64_t campaign_key, std::string_view campaign,
                       std::string_view observable) {
    auto rows = db.ask(
        "SELECT b.name, b.observable_id FROM observable AS b NOT INDEXED JOIN campaign AS g NOT INDEXED ON b.scene = "
        "g.scene AND b.revision = g.revision WHERE g.campaign_id = ? AND b.shape <> 'scalar' ORDER BY b.observable_id",
        campaign_key);
    std::vector<std::string> curves;
    while (rows.next()) {
        curves.push_back(rows.get<std::string>(0));
        if (curves.back() == observable) return rows.get<std::int64_t>(1);
    }
    throw campaign::wrong_question(
        "observable", observable,
        fmt::format("the series and profiles of '{}' are {}", campaign, campaign::listed(curves)),
        campaign::nearest_word(observable, curves));
}

}  // namespace

std::vector<PlacedValue> Store::values_along(std::string_view campaign, std::string_view observable, double at) const {
    impl_->require_sound();
    const auto& db = impl_->db;
    const std::int64_t key = impl_->campaign_key(campaign);
    const std::int64_t observable_key = curve_key(db, key, campaign, observable);
    auto rows = db.ask(
        "SELECT p.point, p.sequence, p.replicate, c.outcome, o.time, o.bin, o.value, o.sample, p.case_key FROM "
        "campaign_case AS p JOIN sim_case AS c ON c.case_key = p.case_key LEFT JOIN observation AS o ON o.case_key = "
        "p.case_key AND "
        "o.observable_id = ?1 WHERE p.campaign_id = ?2 ORDER BY p.point, p.replicate, o.sample",
        observable_key, key);
    std::vector<PlacedValue> values;
    std::vector<Sample> samples;
    const auto close = [&] {
        if (!values.empty()) values.back().value = value_at(samples, at);
        samples.clear();
    };
    while (rows.next()) {
        const auto point = rows.get<std::int64_t>(0), replicate = rows.get<std::int64_t>(2);
        if (values.empty() || values.back().point != point || values.back().replicate != replicate) {
            close();
            values.push_back(
                {.point = point,
                 .sequence = rows.get<std::int64_t>(1),
                 .replicate = replicate,
                 .case_key = rows.get<std::int64_t>(8),
                 .outcome = rows.is_null(3) ? std::nullopt : campaign::outcome_named(rows.get<std::string_view>(3)),
                 .value = none});
        }
        if (!rows.is_null(7)) samples.push_back({rows.get<double>(4), rows.get<double>(5), rows.get<double>(6)});
    }
    close();
    return values;
}

}  // namespace grainsweep::store
