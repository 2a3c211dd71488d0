// Responses on which the coverage of intervals is counted: with and without scatter, jumps, kinks, heavy tails,
// corners, and factors with a distribution.
#pragma once

#include "stats/confidence.hpp"
#include "stats/moments.hpp"
#include "stats/random.hpp"
#include "tests/support/ask_design.hpp"
#include "tests/support/known_responses.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace grainsweep::tests {

/// A response y(x) with normal scatter; x is a quantile function of each coordinate of the design.
struct JudgedResponse {
    using Point = std::span<const double>;

    std::string name;
    std::size_t dimensions;
    std::function<double(Point)> mean;
    double noise = 0;                                ///< standard deviation of a single run
    std::vector<std::function<double(double)>> x{};  ///< empty: the coordinates themselves
    /// Mean, sd, Pearson's skewness, g1 and kurtosis.
    std::array<double, stats::statistics.size()> truth{};

    [[nodiscard]] std::vector<double> features(Point u) const {
        std::vector<double> features(u.begin(), u.end());
        for (std::size_t j = 0; j < x.size(); ++j) features[j] = x[j](u[j]);
        return features;
    }
};

struct JudgedCampaign {
    std::vector<double> features, values;
    std::vector<std::size_t> sequences;
};

/// n points in 8 random sequences.
inline JudgedCampaign ask_judged(const JudgedResponse& response, const std::string& design, std::int64_t n,
                                 std::uint64_t seed) {
    const auto set = ask_design(design, response.dimensions, {{"points", n}, {"sequences", std::int64_t{8}}}, seed);
    const stats::Stream stream(seed, 77);
    JudgedCampaign campaign;
    for (std::size_t i = 0; i < set.size(); ++i) {
        const auto features = response.features(set.point(i));
        campaign.features.insert(campaign.features.end(), features.begin(), features.end());
        const double scatter = response.noise > 0 ? response.noise * normal_at(stream, i) : 0;
        campaign.values.push_back(response.mean(features) + scatter);
        campaign.sequences.push_back(i % 8);
    }
    return campaign;
}

struct JudgedIntegration {
    std::vector<double> features, low, high;
};

/// Features of so many scramblings of 2^power Sobol points, and their box.
inline JudgedIntegration integration_of(const JudgedResponse& response, unsigned power, std::uint64_t scramblings) {
    JudgedIntegration all;
    const std::size_t d = response.dimensions;
    all.low.assign(d, std::numeric_limits<double>::infinity());
    all.high.assign(d, -std::numeric_limits<double>::infinity());
    for (std::uint64_t k = 0; k < scramblings; ++k) {
        const auto set =
            ask_design("sobol", d, {{"points", std::int64_t{1} << power}, {"scramble", std::string("random")}}, 99 + k);
        for (std::size_t i = 0; i < set.size(); ++i) {
            const auto features = response.features(set.point(i));
            for (std::size_t j = 0; j < d; ++j) {
                all.low[j] = std::min(all.low[j], features[j]);
                all.high[j] = std::max(all.high[j], features[j]);
            }
            all.features.insert(all.features.end(), features.begin(), features.end());
        }
    }
    return all;
}

/// Values at 2^20 Sobol points, with the scatter as a further factor.
inline std::vector<double> dense_values(const JudgedResponse& response) {
    const std::size_t d = response.dimensions + (response.noise > 0 ? 1 : 0);
    const auto set =
        ask_design("sobol", d, {{"points", std::int64_t{1} << 20}, {"scramble", std::string("random")}}, 5);
    std::vector<double> values;
    for (std::size_t i = 0; i < set.size(); ++i) {
        const auto u = set.point(i);
        const double scatter = response.noise > 0 ? response.noise * stats::normal_quantile(u.back()) : 0;
        values.push_back(response.mean(response.features(u.first(response.dimensions))) + scatter);
    }
    return values;
}

inline std::array<double, 5> dense_statistics(const JudgedResponse& response) {
    const auto summary = stats::summarise(dense_values(response));
    return {summary.mean, summary.sd, summary.skewness, summary.g1, summary.kurtosis};
}

inline std::vector<JudgedResponse> judged_responses() {
    using Point = JudgedResponse::Point;
    const auto normal = [](double u) { return stats::normal_quantile(u); };
    std::vector<JudgedResponse> all = {
        {"spreading", 4, [](Point u) { return spreading_response(u); }, 0.0188},
        {"smooth", 3, [](Point u) { return std::sin(3 * u[0]) + u[1] * u[1] + u[1] * u[2]; }, 0.1},
        {"exact", 3, [](Point u) { return std::sin(3 * u[0]) + u[1] * u[1] + u[1] * u[2]; }},
        {"waves", 3, [](Point u) { return std::sin(25 * u[0]) * std::cos(18 * u[1]) + 0.3 * u[2]; }, 0.1},
        {"noise", 3, [](Point) { return 1.0; }, 0.2},
        {"product", 3, [](Point u) { return u[0] * u[1] * u[2]; }},
        {"jump", 2, [](Point u) { return (u[0] < 0.2 ? 1 : 0) + 0.1 * u[1]; }},
        {"jump in the middle", 2, [](Point u) { return (u[0] < 0.47 ? 1 : 0) + 0.1 * u[1]; }},
        {"hidden jump", 2, [](Point u) { return (u[0] < 0.3 ? 1 : 0) + 2 * u[1]; }},
        {"jump across", 2, [](Point u) { return (u[0] + 0.3 * u[1] > 0.6 ? 1 : 0) + 0.2 * u[1]; }, 0.05},
        {"g-function", 3,
         [](Point u) {
             return std::abs(4 * u[0] - 2) * (std::abs(4 * u[1] - 2) + 1) / 2 * (std::abs(4 * u[2] - 2) + 9) / 10;
         }},
        {"corner", 3, [](Point u) { return u[0] > 0.95 ? 1 + u[1] : 0.1 * u[2]; }},
        {"exponential of a sum", 4, [](Point u) { return std::exp(1.5 * (u[0] + u[1] + u[2] + u[3])); }},
        {"waiting time", 1, [](Point u) { return -std::log(u[0]); }},
        {"waiting time of two", 2, [](Point u) { return -std::log(u[0]) + u[1]; }},
        {"lognormal", 2, [normal](Point u) { return std::exp(normal(u[0])); }},
        {"lognormal, narrow", 2, [normal](Point u) { return std::exp(0.5 * normal(u[0])) * (1 + 0.2 * u[1]); }},
        {"lognormal factor", 2, [](Point x) { return x[0]; }, 0, {[normal](double u) {
             return std::exp(0.5 * normal(u));
         }}},
        {"exp of a normal factor", 2, [](Point x) { return std::exp(x[0]); }, 0, {normal}},
        {"two normal factors", 2, [](Point x) { return x[0] + 0.5 * x[1] * x[1]; }, 0, {normal, normal}},
    };
    const auto lognormal = [](double s) {
        const double w = std::exp(s * s), mean = std::exp(s * s / 2), sd = mean * std::sqrt(w - 1);
        return std::array<double, 5>{mean, sd, 3 * (mean - 1) / sd, (w + 2) * std::sqrt(w - 1),
                                     w * w * w * w + 2 * w * w * w + 3 * w * w - 3};
    };
    for (auto& response : all) {
        response.truth = dense_statistics(response);
        if (response.name == "waiting time") response.truth = {1, 1, 3 * (1 - std::numbers::ln2), 2, 9};
        if (response.name == "lognormal" || response.name == "exp of a normal factor") response.truth = lognormal(1);
        if (response.name == "lognormal factor") response.truth = lognormal(0.5);
    }
    return all;
}

}  // namespace grainsweep::tests
