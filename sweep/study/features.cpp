#include "sweep/study/features.hpp"

#include "solver/plain_text.hpp"
#include "solver/scenes/scene.hpp"
#include "sweep/campaign/expressions.hpp"
#include "sweep/campaign/program.hpp"
#include "sweep/campaign/stored_identity.hpp"
#include "sweep/campaign/stored_text.hpp"
#include "sweep/store/expression.hpp"
#include "sweep/store/when_clauses.hpp"
#include "sweep/study/box_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace grainsweep::study {
namespace {

constexpr std::string_view features_path = "$.model.features";
constexpr double logarithm_from = 2.5;  // high/low

/// Words of a column that the campaign lists; the default of a factor that does not count may come behind them.
std::size_t listed_words(const FactorColumn& column) {
    const auto seen = column.seen_texts(), listed = column.level_texts();
    if (column.when.empty()) return seen.size();
    return static_cast<std::size_t>(
        std::ranges::count_if(seen, [&](const auto& word) { return std::ranges::count(listed, word) > 0; }));
}

/// The place of the default among the numbers or words of a factor.
double number_of_default(ModelFactor& factor, const Value& value) {
    if (!factor.is_word()) return std::get<double>(campaign::coerced(value, Value{0.0}));
    const auto& word = std::get<std::string>(value);
    auto found = std::ranges::find(factor.words, word);
    if (found == factor.words.end()) {
        found = factor.words.insert(found, word);
        ++factor.unlisted;
    }
    return static_cast<double>(found - factor.words.begin());
}

/// Compiles the `when` of stored factors.
void add_conditions(std::vector<ModelFactor>& factors, const campaign::Identity& identity) {
    const auto scene = find_scene(identity.scene);
    campaign::ParameterSpace space{scene, identity.factors, {}};
    const auto conditional = [](const auto& factor) { return !factor.when.empty(); };
    if (scene == nullptr || std::ranges::none_of(space.factors, conditional)) return;
    space.expressions = campaign::expressions_of(identity, *scene);
    Inputs inputs = scene->defaults();
    for (const auto& [name, value] : campaign::fixed_values(identity, *scene)) inputs[name] = value;
    for (std::size_t j = 0; j < factors.size(); ++j)
        if (conditional(space.factors[j]))
            factors[j].standard = number_of_default(factors[j], campaign::default_of(*scene, factors[j].name));
    const auto known = factors;
    std::size_t order = 0;
    for (auto& clause : store::when_clauses(space)) {
        const auto factor = std::ranges::find(factors, clause.factor, &ModelFactor::name);
        factor->order = order++;
        factor->counts = [known, inputs, holds = std::move(clause.holds)](std::span<const double> setting) mutable {
            for (std::size_t j = 0; j < known.size(); ++j) {
                Value& slot = inputs.find(known[j].name)->second;
                slot = campaign::coerced(known[j].value_of(setting[j]), slot);
            }
            return holds(inputs);
        };
    }
}

/// Middle of the range, first of the levels: one of the values that a campaign may list.
double neutral(const ModelFactor& factor) {
    if (factor.is_word()) return 0;
    if (!factor.numbers.empty()) return factor.numbers.front();
    const double middle = 0.5;
    return exact_setting(std::span(&factor, 1), std::span(&middle, 1)).front();
}

/// Features of settings in which factors that do not count stand in the middle.
Features of_seen_settings(Features features, std::span<const ModelFactor> factors) {
    if (std::ranges::none_of(factors, [](const auto& factor) { return static_cast<bool>(factor.counts); }))
        return features;
    features.of = [of = std::move(features.of), known = std::vector(factors.begin(), factors.end())](auto setting) {
        return of(as_seen(known, {setting.begin(), setting.end()}));
    };
    return features;
}

bool as_logarithm(const ModelFactor& factor) {
    return !factor.is_word() && factor.smallest() > 0 && factor.high() >= logarithm_from * factor.low();
}

}  // namespace

void fold(std::span<const ModelFactor> factors, Setting& setting) {
    std::vector<std::size_t> conditional;
    for (std::size_t j = 0; j < factors.size(); ++j)
        if (factors[j].counts) conditional.push_back(j);
    std::ranges::sort(conditional, {}, [&](std::size_t j) { return factors[j].order; });
    for (const auto j : conditional)
        if (!factors[j].counts(setting)) setting[j] = factors[j].standard;
}

Setting as_seen(std::span<const ModelFactor> factors, Setting setting) {
    if (std::ranges::none_of(factors, [](const auto& factor) { return static_cast<bool>(factor.counts); }))
        return setting;
    fold(factors, setting);
    const Setting folded = setting;
    for (std::size_t j = 0; j < factors.size(); ++j)
        if (factors[j].counts && !factors[j].counts(folded)) setting[j] = neutral(factors[j]);
    return setting;
}

void place(std::span<const ModelFactor> factors, Setting& setting, std::size_t j, double x,
           std::span<const std::size_t> kept) {
    setting[j] = x;
    if (!factors[j].share) return;
    std::vector<std::size_t> others;
    double rest = 1 - x, room = 0;
    for (std::size_t k = 0; k < factors.size(); ++k) {
        if (!factors[k].share || k == j) continue;
        if (std::ranges::find(kept, k) != kept.end()) {
            rest -= setting[k];
            continue;
        }
        others.push_back(k);
        rest -= factors[k].low();
        room += setting[k] - factors[k].low();
    }
    for (const auto k : others) {
        const double part = room > 0 ? (setting[k] - factors[k].low()) / room : 1 / static_cast<double>(others.size());
        setting[k] = factors[k].low() + part * std::max(0.0, rest);
    }
}

std::optional<double> sum_of_shares(std::span<const ModelFactor> factors, const Setting& setting) {
    std::optional<double> sum;
    for (std::size_t j = 0; j < factors.size(); ++j)
        if (factors[j].share) sum = sum.value_or(0) + setting[j];
    return sum;
}

double ModelFactor::low() const {
    if (!numbers.empty()) return numbers.front();
    return continuous() ? ends().first : 0;
}

double ModelFactor::high() const {
    if (!numbers.empty()) return numbers.back();
    return continuous() ? ends().second : 0;
}

Value ModelFactor::value_of(double number) const {
    if (is_word()) return words.at(static_cast<std::size_t>(number));
    return number;
}

std::string ModelFactor::text(double number) const {
    if (std::isnan(number)) return "varies";
    return is_word() ? words.at(static_cast<std::size_t>(number)) : fmt::format("{}", number);
}

std::vector<ModelFactor> model_factors(const Responses& responses) {
    const auto noise = campaign::remarks_in(responses.campaign.text).noise;
    std::vector<ModelFactor> factors;
    for (const auto& column : responses.factors) {
        ModelFactor factor{column};
        factor.noise = std::ranges::find(noise, column.name) != noise.end();
        factor.numbers = column.seen_numbers();
        if (!factor.numbers.empty()) {
            const auto listed = column.level_numbers();
            if (!column.when.empty())
                std::erase_if(factor.numbers, [&](double x) { return std::ranges::count(listed, x) == 0; });
            std::ranges::sort(factor.numbers);
        } else if (!column.continuous()) {
            factor.words = column.seen_texts();
            factor.unlisted = factor.words.size() - listed_words(column);
        }
        factors.push_back(std::move(factor));
    }
    add_conditions(factors, responses.campaign);
    return factors;
}

std::vector<Setting> settings_of(const Responses& responses, std::span<const ModelFactor> factors) {
    std::vector<Setting> settings(responses.rows(), Setting(factors.size()));
    for (std::size_t j = 0; j < factors.size(); ++j) {
        const auto& column = responses.factors[j];
        const auto of_level = factors[j].numbers.empty() ? std::vector<double>() : column.seen_numbers();
        for (std::size_t row = 0; row < settings.size(); ++row) {
            const double value = column.values[row];
            settings[row][j] = of_level.empty() ? value : of_level[static_cast<std::size_t>(value)];
        }
    }
    return settings;
}

Features default_features(std::span<const ModelFactor> factors, std::span<const Ratio> ratios) {
    using Part = std::function<double(std::span<const double>)>;
    Features features;
    std::vector<Part> parts;
    std::size_t last_share = factors.size();
    for (std::size_t j = 0; j < factors.size(); ++j)
        if (factors[j].share) last_share = j;
    for (std::size_t j = 0; j < factors.size(); ++j) {
        const auto& factor = factors[j];
        if (!factor.varies() || j == last_share) continue;  // the last share follows from the others
        const auto ratio = std::ranges::find(ratios, j, &Ratio::over);
        if (ratio != ratios.end()) {
            features.names.push_back(fmt::format("log({}/{})", factor.name, factors[ratio->under].name));
            parts.emplace_back([j, k = ratio->under](auto x) { return std::log(x[j] / x[k]); });
        } else if (factor.is_word()) {
            for (std::size_t word = 1; word < factor.words.size(); ++word) {
                features.names.push_back(fmt::format("{} = '{}'", factor.name, factor.words[word]));
                parts.emplace_back([j, word](auto x) { return x[j] == static_cast<double>(word) ? 1.0 : 0.0; });
            }
        } else if (as_logarithm(factor)) {
            features.names.push_back(fmt::format("log({})", factor.name));
            parts.emplace_back([j](auto x) { return std::log(x[j]); });
        } else {
            features.names.push_back(factor.name);
            parts.emplace_back([j](auto x) { return x[j]; });
        }
    }
    features.of = [parts = std::move(parts)](std::span<const double> setting) {
        std::vector<double> numbers;
        numbers.reserve(parts.size());
        for (const auto& part : parts) numbers.push_back(part(setting));
        return numbers;
    };
    return of_seen_settings(std::move(features), factors);
}

Features written_features(std::span<const ModelFactor> factors, std::span<const std::string> expressions) {
    std::vector<std::string> names;
    for (const auto& factor : factors) names.push_back(factor.name);
    Features features;
    features.names.assign(expressions.begin(), expressions.end());
    features.of = [numbers = store::make_numbers(expressions, names, features_path),
                   known = std::vector(factors.begin(), factors.end())](std::span<const double> setting) {
        std::vector<Value> values;
        values.reserve(known.size());
        for (std::size_t j = 0; j < known.size(); ++j) values.push_back(known[j].value_of(setting[j]));
        return numbers(values);
    };
    return of_seen_settings(std::move(features), factors);
}

std::vector<double> rows_of(const Features& features, std::span<const Setting> settings) {
    std::vector<double> rows;
    for (const auto& setting : settings) {
        const auto row = features.of(setting);
        rows.insert(rows.end(), row.begin(), row.end());
    }
    return rows;
}

FeatureBox box_of(std::span<const double> rows, std::size_t width) {
    if (rows.empty()) return {std::vector<double>(width, 0), std::vector<double>(width, 1)};
    FeatureBox box{std::vector<double>(width, std::numeric_limits<double>::infinity()),
                   std::vector<double>(width, -std::numeric_limits<double>::infinity())};
    for (std::size_t i = 0; i < rows.size(); ++i) {
        box.low[i % width] = std::min(box.low[i % width], rows[i]);
        box.high[i % width] = std::max(box.high[i % width], rows[i]);
    }
    for (std::size_t j = 0; j < width; ++j)
        if (!(box.high[j] > box.low[j])) box.high[j] = box.low[j] + std::max(1.0, 1e-9 * std::abs(box.low[j]));
    return box;
}

std::vector<Ratio> candidate_ratios(std::span<const ModelFactor> factors) {
    std::vector<Ratio> ratios;
    for (std::size_t over = 0; over < factors.size(); ++over)
        for (std::size_t under = 0; under < factors.size(); ++under) {
            const auto &a = factors[over], &b = factors[under];
            const bool lengths = over != under && a.unit == b.unit && !a.unit.empty() && a.unit != "1";
            if (lengths && !a.is_word() && !b.is_word() && a.smallest() > 0 && b.smallest() > 0 && a.varies() &&
                b.varies())
                ratios.push_back({over, under});
        }
    return ratios;
}

void check_features(const campaign::Campaign& campaign) {
    if (campaign.features.empty()) return;
    std::vector<std::string> names;
    for (const auto& factor : campaign.space.factors) names.push_back(factor.name);
    (void)store::make_numbers(campaign.features, names, features_path);
}

}  // namespace grainsweep::study
