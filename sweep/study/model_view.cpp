#include "sweep/study/model_view.hpp"

#include "sweep/campaign/input_error.hpp"
#include "sweep/study/box_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

namespace grainsweep::study {
namespace {

constexpr std::size_t integration_sets = 8;
constexpr std::int64_t points_of_set = 4096, fewest_of_set = 64;
constexpr std::uint64_t first_seed = 1000;  // of the points to integrate over: the same for every campaign

double as_number(const Value& value) {
    if (const auto* whole = std::get_if<std::int64_t>(&value)) return static_cast<double>(*whole);
    return std::get<double>(value);
}

/// Points in the unit cube -> features.
class Mapped {
public:
    explicit Mapped(const campaign::Campaign& campaign)
        : factors_(campaign.space.factors), described_(model_factors(campaign)) {
        features_ =
            campaign.features.empty() ? default_features(described_) : written_features(described_, campaign.features);
    }
    [[nodiscard]] std::size_t dimensions() const { return features_.names.size(); }
    [[nodiscard]] const std::string& name(std::size_t k) const { return features_.names[k]; }
    [[nodiscard]] std::vector<double> operator()(std::span<const double> u) const {
        Setting setting(factors_.size());
        for (std::size_t j = 0; j < factors_.size(); ++j) {
            const Value value = campaign::value_at(factors_, j, u);
            const auto& words = described_[j].words;
            setting[j] =
                words.empty()
                    ? as_number(value)
                    : static_cast<double>(std::ranges::find(words, std::get<std::string>(value)) - words.begin());
        }
        return features_.of(setting);
    }

private:
    std::vector<campaign::Factor> factors_;
    std::vector<ModelFactor> described_;
    Features features_;
};

void check_defined(const Mapped& mapped, const std::vector<double>& features) {
    for (std::size_t k = 0; k < features.size(); ++k)
        if (!std::isfinite(features[k]))
            throw campaign::input_error(fmt::format("$.model.features[{}]", k), mapped.name(k),
                                        "is undefined somewhere in the ranges of the factors, and the rule "
                                        "\"assisted\" integrates a model over all of them");
}

/// Features of scramblings of one size: of each as many points as every one has within the `where` clause.
std::vector<double> view_points(const campaign::Campaign& campaign, const Mapped& mapped,
                                const campaign::Filter& filter) {
    std::array<std::vector<double>, integration_sets> parts;
    std::size_t least = std::numeric_limits<std::size_t>::max();
    for (std::size_t k = 0; k < integration_sets; ++k) {
        const auto set = sobol_points({.levels = campaign.request.levels,
                                       .options = {{"points", points_of_set}, {"scramble", std::string("random")}},
                                       .seed = first_seed + k});
        for (std::size_t i = 0; i < set.size(); ++i) {
            if (!campaign.where.empty() && !filter(campaign.space.at(set.point(i)))) continue;
            const auto features = mapped(set.point(i));
            check_defined(mapped, features);
            parts[k].insert(parts[k].end(), features.begin(), features.end());
        }
        least = std::min(least, parts[k].size());
    }
    if (least < fewest_of_set * mapped.dimensions())
        throw campaign::input_error("$.where", campaign.where,
                                    fmt::format("leaves less than {} % of the ranges, too little to integrate a "
                                                "model over: give narrower ranges, or the rule \"replicates\"",
                                                100 * fewest_of_set / points_of_set));
    std::vector<double> all;
    for (const auto& part : parts)
        all.insert(all.end(), part.begin(), part.begin() + static_cast<std::ptrdiff_t>(least));
    return all;
}

}  // namespace

std::vector<ModelFactor> model_factors(const campaign::Campaign& campaign) {
    std::vector<ModelFactor> factors;
    for (const auto& given : campaign.space.factors) {
        auto& factor = factors.emplace_back(ModelFactor{given});
        if (factor.has_words())
            factor.words = factor.level_texts();
        else
            factor.numbers = factor.level_numbers();
        std::ranges::sort(factor.numbers);
    }
    return factors;
}

schedule::ModelView model_view(const campaign::Campaign& campaign, std::int64_t candidates,
                               const campaign::Filter& filter) {
    const auto mapped = std::make_shared<const Mapped>(campaign);
    const std::size_t d = mapped->dimensions();
    schedule::ModelView view;
    view.space.dimensions = d;
    view.space.scramblings = integration_sets;
    view.space.integration = view_points(campaign, *mapped, filter);
    view.space.low.assign(d, std::numeric_limits<double>::infinity());
    view.space.high.assign(d, -std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < view.space.integration.size(); ++i) {
        auto &low = view.space.low[i % d], &high = view.space.high[i % d];
        low = std::min(low, view.space.integration[i]);
        high = std::max(high, view.space.integration[i]);
    }
    for (std::size_t k = 0; k < d; ++k)
        if (!(view.space.high[k] > view.space.low[k]))
            throw campaign::input_error(fmt::format("$.model.features[{}]", k), mapped->name(k),
                                        "is the same everywhere in the ranges of the factors");
    designs::DesignRequest request = campaign.request;
    request.options["points"] = std::max(candidates, campaign::candidates_of(campaign));
    const auto design =
        std::make_shared<const designs::PointSet>(designs::design_named(campaign.design).sample(request));
    view.features = [mapped, design](std::size_t point) { return (*mapped)(design->point(point)); };
    return view;
}

}  // namespace grainsweep::study
