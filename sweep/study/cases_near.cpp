#include "sweep/study/cases_near.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace grainsweep::study {
namespace {

double place_in_range(const ModelFactor& factor, double x) {
    if (!(factor.high > factor.low)) return 0;
    if (!factor.log) return (x - factor.low) / (factor.high - factor.low);
    const double positive = std::max(x, std::numeric_limits<double>::min());
    return std::log(positive / factor.low) / std::log(factor.high / factor.low);
}

void append_coordinates(std::vector<double>& row, std::span<const ModelFactor> factors, const Setting& setting) {
    for (std::size_t j = 0; j < factors.size(); ++j) {
        const auto& factor = factors[j];
        if (!factor.is_word()) row.push_back(place_in_range(factor, setting[j]));
        for (std::size_t word = 0; word < factor.words.size(); ++word)
            row.push_back(setting[j] == static_cast<double>(word) ? 1 / std::numbers::sqrt2 : 0);
    }
}

/// Failed cases, then the answered ones.
stats::NearestCases nearest_of(const ModelCases& cases) {
    std::vector<double> rows;
    std::vector<bool> failed(cases.failed.size(), true);
    failed.resize(cases.failed.size() + cases.settings.size(), false);
    for (const auto& one : cases.failed) append_coordinates(rows, cases.factors, one.setting);
    for (const auto& setting : cases.settings) append_coordinates(rows, cases.factors, setting);
    const std::size_t width = failed.empty() ? 0 : rows.size() / failed.size();
    return {std::move(rows), width, std::move(failed)};
}

/// "3 crashed, 1 unstable" of the failed cases at `rows`.
std::string outcomes_text(const ModelCases& cases, std::span<const std::size_t> rows) {
    std::string text;
    for (const auto outcome : campaign::outcomes) {
        const auto n = std::ranges::count(rows, outcome, [&](std::size_t i) { return cases.failed[i].outcome; });
        if (n > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", n, campaign::to_string(outcome));
    }
    return text;
}

std::vector<std::size_t> all_failed(const ModelCases& cases) {
    std::vector<std::size_t> rows(cases.failed.size());
    std::iota(rows.begin(), rows.end(), std::size_t{0});
    return rows;
}

}  // namespace

CasesNear::CasesNear(const ModelCases& cases) : factors_(cases.factors), nearest_(nearest_of(cases)) {}

std::vector<double> CasesNear::coordinates(const Setting& setting) const {
    std::vector<double> row;
    append_coordinates(row, factors_, setting);
    return row;
}

std::string near_text(const ModelCases& cases, const Near& near) {
    if (near.failed.empty()) return fmt::format("none of the {} nearest cases failed", near.cases);
    return fmt::format("{} of the {} nearest cases failed ({})", near.failed.size(), near.cases,
                       outcomes_text(cases, near.failed));
}

std::string failed_text(const ModelCases& cases) {
    if (cases.failed.empty()) return {};
    return fmt::format("{} of {} cases failed ({})", cases.failed.size(), cases.failed.size() + cases.settings.size(),
                       outcomes_text(cases, all_failed(cases)));
}

}  // namespace grainsweep::study
