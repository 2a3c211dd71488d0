#include "sweep/schedule/growth.hpp"

#include "sweep/campaign/experiments.hpp"
#include "sweep/campaign/identity.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/stored_identity.hpp"
#include "sweep/store/expression.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>

namespace grainsweep::schedule {

namespace {

/// Returns the answer of a settled case; NaN: none. Whether a value is missing is the answer of completed cases only.
double answer_of(const store::PlacedValue& value, const designs::CurvePlace& place) {
    if (!place.missing) return value.value;
    using enum campaign::Outcome;
    if (value.outcome != completed && value.outcome != skipped) return std::numeric_limits<double>::quiet_NaN();
    return std::isnan(value.value) ? 1 : 0;
}

}  // namespace

Answers known_answers(const store::Store& store, const store::CampaignRecord& record,
                      std::span<const std::string> observables) {
    Answers answers;
    std::vector<store::CampaignRecord> others;
    for (const auto& key : observables) {
        const auto slash = key.find('/');
        const store::CampaignRecord* asked = &record;
        if (slash != std::string::npos) {
            if (others.empty()) others = store.campaigns();
            const auto found = std::ranges::find(others, campaign::name_beside(record, key.substr(0, slash)),
                                                 &store::CampaignRecord::name);
            if (found == others.end()) continue;
            asked = &*found;
        }
        auto& known = answers[key];
        known.assign(static_cast<std::size_t>(asked->stored.candidates), std::numeric_limits<double>::quiet_NaN());
        const auto place = designs::place_on_curve(slash == std::string::npos ? key : key.substr(slash + 1));
        const auto values = place.at ? store.values_along(asked->name, place.observable, *place.at)
                                     : store.values(asked->name, place.observable);
        for (const auto& it : values) {
            const bool settled = it.outcome && *it.outcome != campaign::Outcome::abandoned;
            known[static_cast<std::size_t>(it.point)] = settled ? std::optional(answer_of(it, place)) : std::nullopt;
        }
    }
    return answers;
}

namespace {

/// Which points the `where` clause of a stored campaign accepts; empty: all, or an older version accepted a clause that
/// is refused now.
std::function<bool(std::span<const double>)> admission(const store::CampaignRecord& record) {
    if (record.condition.empty()) return {};
    auto space = campaign::space_of(record);
    if (!space) return {};
    std::vector<std::string> names;
    for (const auto& [name, value] : space->scene->defaults()) names.push_back(name);
    try {
        return [space = std::move(*space), filter = store::make_filter(record.condition, names)](
                   std::span<const double> u) { return filter(space.at(u)); };
    } catch (const campaign::InputError&) {
        return {};
    }
}

/// Returns the coordinate of a factor's value, or of its level, in the unit cube.
double coordinate_of(const campaign::Factor& factor, const store::Table::Cell& cell) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    const auto* real = std::get_if<double>(&cell);
    const auto* whole = std::get_if<std::int64_t>(&cell);
    const double value = real != nullptr ? *real : whole != nullptr ? static_cast<double>(*whole) : none;
    if (factor.continuous()) return factor.place(value);
    const auto* word = std::get_if<std::string>(&cell);
    const auto levels = factor.level_texts();
    const auto level = std::ranges::find(levels, word != nullptr ? *word : campaign::shortest(value));
    return level == levels.end() ? none : factor.middle_of(static_cast<std::size_t>(level - levels.begin()));
}

/// Adds the answers that were imported into a campaign and belong to no point of its design. `experiment`: of this
/// campaign; its keys begin with it.
void add_imported(std::vector<designs::FurtherAnswers>& all, const store::Store& store,
                  const store::CampaignRecord& record, const std::string& experiment,
                  std::span<const std::string> keys) {
    for (const auto& other : store.campaigns()) {
        if (other.imported_into != record.name || !campaign::asks_the_same(other, record)) continue;
        auto& further = all.emplace_back();
        further.factors = record.factors;
        const auto rows = store.query(store.rows_of(other.name) + " ORDER BY point, replicate");
        std::vector<std::size_t> columns;
        for (const auto& factor : record.factors)
            columns.push_back(
                static_cast<std::size_t>(std::ranges::find(rows.columns, factor.name) - rows.columns.begin()));
        for (const auto& row : rows.rows)
            for (std::size_t j = 0; j < columns.size(); ++j)
                further.coordinates.push_back(coordinate_of(record.factors[j], row.at(columns[j])));
        const std::string prefix = experiment.empty() ? "" : experiment + '/';
        for (const auto& key : keys) {
            if (!key.starts_with(prefix)) continue;
            const auto place = designs::place_on_curve(key.substr(prefix.size()));
            auto& answers = further.answers[key];
            if (place.at)
                answers.assign(rows.rows.size(), std::numeric_limits<double>::quiet_NaN());
            else
                for (const auto& one : store.values(other.name, place.observable))
                    answers.push_back(answer_of(one, place));
        }
    }
}

}  // namespace

void learn_answers(designs::DesignRequest& request, const store::Store& store, const store::CampaignRecord& record) {
    const auto& design = designs::design_named(record.design);
    request.answers = known_answers(store, record, design.rests_on(request));
    if (!design.calibrates) return;
    request.admits = admission(record);
    request.further.clear();
    const auto keys = design.rests_on(request);
    const auto experiments = campaign::experiments_of(record);
    if (experiments.empty()) add_imported(request.further, store, record, "", keys);
    for (const auto& experiment : experiments)
        for (const auto& other : store.campaigns())
            if (other.name == campaign::name_beside(record, experiment))
                add_imported(request.further, store, other, experiment, keys);
}

bool grow(campaign::Campaign& campaign, const store::Store& store) {
    const auto& design = designs::design_named(campaign.design);
    if (!design.grows) return false;
    const auto record = store.stored(campaign);
    if (!record) return false;
    const auto before = design.size(campaign.request);
    campaign.request.grown.reset();
    learn_answers(campaign.request, store, *record);
    campaign.request.grown = std::make_shared<const designs::PointSet>(design.sample(campaign.request));
    return design.size(campaign.request) > before;
}

}  // namespace grainsweep::schedule
