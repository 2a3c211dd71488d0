#include "sweep/study/features.hpp"

#include "solver/plain_text.hpp"
#include "sweep/campaign/stored_text.hpp"
#include "sweep/store/expression.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace grainsweep::study {
namespace {

constexpr std::string_view features_path = "$.model.features";
constexpr double logarithm_from = 2.5;  // high/low

/// The levels as numbers, exact where the identity of the campaign has them; none where one is a word.
std::optional<std::vector<double>> ordered_numbers(const FactorColumn& column, const campaign::StatedFactor& stated) {
    std::map<std::string, double> exact;  // by the text a column shows
    for (const auto& level : stated.levels)
        if (const auto number = number_in(level)) exact.try_emplace(fmt::format("{:.6g}", *number), *number);
    std::vector<double> numbers;
    for (const auto& level : column.levels) {
        const auto shown = number_in(level);
        if (!shown) return std::nullopt;
        const auto found = exact.find(level);
        numbers.push_back(found == exact.end() ? *shown : found->second);
    }
    return numbers;
}

bool as_logarithm(const ModelFactor& factor) {
    return !factor.is_word() && factor.smallest() > 0 && factor.high >= logarithm_from * factor.low;
}

}  // namespace

Value ModelFactor::value(double number) const {
    if (is_word()) return words.at(static_cast<std::size_t>(number));
    return number;
}

std::string ModelFactor::text(double number) const {
    if (std::isnan(number)) return "varies";
    return is_word() ? words.at(static_cast<std::size_t>(number)) : fmt::format("{}", number);
}

std::vector<ModelFactor> model_factors(const Responses& responses) {
    const auto stated = campaign::factors_of(responses.campaign);
    const auto noise = campaign::remarks_in(responses.campaign.text).noise;
    std::vector<ModelFactor> factors;
    for (std::size_t j = 0; j < responses.factors.size(); ++j) {
        const auto& column = responses.factors[j];
        ModelFactor factor;
        factor.name = column.name;
        factor.unit = column.unit;
        factor.noise = std::ranges::find(noise, column.name) != noise.end();
        if (column.continuous()) {
            factor.low = column.low;
            factor.high = column.high;
            factor.log = column.log;
            factor.distribution = column.distribution;
        } else if (auto numbers = ordered_numbers(column, stated[j])) {
            std::ranges::sort(*numbers);
            factor.numbers = std::move(*numbers);
            if (!factor.numbers.empty()) factor.low = factor.numbers.front(), factor.high = factor.numbers.back();
        } else {
            factor.words = column.levels;
        }
        factors.push_back(std::move(factor));
    }
    return factors;
}

std::vector<Setting> settings_of(const Responses& responses, std::span<const ModelFactor> factors) {
    std::vector<Setting> settings(responses.rows(), Setting(factors.size()));
    const auto stated = campaign::factors_of(responses.campaign);
    for (std::size_t j = 0; j < factors.size(); ++j) {
        const auto& column = responses.factors[j];
        std::vector<double> of_level;  // columns keep the order of the campaign file
        if (!factors[j].numbers.empty()) of_level = *ordered_numbers(column, stated[j]);
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
    for (std::size_t j = 0; j < factors.size(); ++j) {
        const auto& factor = factors[j];
        if (!factor.varies()) continue;
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
    return features;
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
        for (std::size_t j = 0; j < known.size(); ++j) values.push_back(known[j].value(setting[j]));
        return numbers(values);
    };
    return features;
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
