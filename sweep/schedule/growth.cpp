#include "sweep/schedule/growth.hpp"

#include "sweep/campaign/experiments.hpp"
#include "sweep/campaign/identity.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/stored_request.hpp"
#include "sweep/store/expression.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>

namespace grainsweep::schedule {

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
        const auto [name, at] = designs::place_on_curve(slash == std::string::npos ? key : key.substr(slash + 1));
        const auto values = at ? store.values_along(asked->name, name, *at) : store.values(asked->name, name);
        for (const auto& it : values) {
            const bool settled = it.outcome && *it.outcome != campaign::Outcome::abandoned;
            known[static_cast<std::size_t>(it.point)] = settled ? std::optional(it.value) : std::nullopt;
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
double coordinate_of(const campaign::StatedFactor& factor, const store::Table::Cell& cell) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    const auto* real = std::get_if<double>(&cell);
    const auto* whole = std::get_if<std::int64_t>(&cell);
    const double value = real != nullptr ? *real : whole != nullptr ? static_cast<double>(*whole) : none;
    if (factor.distribution) return factor.distribution->cumulative(value);
    if (factor.between) {
        const auto& [low, high, scale] = *factor.between;
        return scale == campaign::Scale::log ? std::log(value / low) / std::log(high / low)
                                             : (value - low) / (high - low);
    }
    for (std::size_t k = 0; k < factor.levels.size(); ++k) {
        const auto* word = std::get_if<std::string>(&cell);
        const bool same = word != nullptr ? *word == factor.levels[k] : campaign::shortest(value) == factor.levels[k];
        if (same) return (static_cast<double>(k) + 0.5) / static_cast<double>(factor.levels.size());
    }
    return none;
}

/// Returns the answers that were imported into a campaign and belong to no point of its design.
designs::FurtherAnswers imported_answers(const store::Store& store, const store::CampaignRecord& record,
                                         std::span<const std::string> observables) {
    designs::FurtherAnswers further;
    const auto factors = campaign::factors_of(record);
    for (const auto& other : store.campaigns()) {
        if (other.imported_into != record.name || other.factors != record.factors || other.fixed != record.fixed)
            continue;
        const auto rows = store.query(store.rows_of(other.name) + " ORDER BY point, replicate");
        std::vector<std::size_t> columns;
        for (const auto& factor : factors)
            columns.push_back(
                static_cast<std::size_t>(std::ranges::find(rows.columns, factor.name) - rows.columns.begin()));
        for (const auto& row : rows.rows)
            for (std::size_t j = 0; j < factors.size(); ++j)
                further.coordinates.push_back(coordinate_of(factors[j], row.at(columns[j])));
        for (const auto& key : observables) {
            const auto [name, at] = designs::place_on_curve(key);
            auto& answers = further.answers[key];
            if (at)
                answers.resize(answers.size() + rows.rows.size(), std::numeric_limits<double>::quiet_NaN());
            else
                for (const auto& one : store.values(other.name, name)) answers.push_back(one.value);
        }
    }
    return further;
}

}  // namespace

void learn_answers(designs::DesignRequest& request, const store::Store& store, const store::CampaignRecord& record) {
    const auto& design = designs::design_named(record.design);
    request.answers = known_answers(store, record, design.rests_on(request));
    if (!design.calibrates) return;
    request.admits = admission(record);
    if (request.shared.empty()) request.further = imported_answers(store, record, design.rests_on(request));
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
