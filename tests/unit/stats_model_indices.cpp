#include "stats/confidence.hpp"
#include "stats/model_indices.hpp"
#include "stats/random.hpp"
#include "tests/support/ask_design.hpp"
#include "tests/support/known_responses.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <variant>
#include <vector>

namespace grainsweep::tests::stats_model_indices_test {

using namespace stats;

struct Learned {
    std::vector<double> points;
    std::vector<std::size_t> groups;
    ResponseModel model;
};

template <class Response>
Learned learn(std::size_t d, std::int64_t n, const Response& response) {
    const auto set = ask_design("halton", d, {{"points", n}, {"sequences", std::int64_t{8}}});
    std::vector<double> values;
    std::vector<std::size_t> groups;
    for (std::size_t i = 0; i < set.size(); ++i) {
        values.push_back(response(set.point(i)));
        groups.push_back(i % 8);
    }
    return {set.coordinates, groups,
            std::get<ResponseModel>(fit_response({set.coordinates, d}, values, {.map = LearnedMap::never}))};
}

TEST(ModelIndices, LinearAndProductResponsesAreKnown) {
    // y = x1 + 2 x2 + 3 x1 x2 over [0, 1]^2: effects (1 + 1.5) x1, (2 + 1.5) x2 and 3 (x1 - 1/2)(x2 - 1/2).
    const auto learned = learn(2, 80, [](auto u) { return u[0] + 2 * u[1] + 3 * u[0] * u[1]; });
    const auto indices = model_indices(learned.model, 2, learned.groups);
    const double first = 6.25 / 12, second = 12.25 / 12, both = 9.0 / 144, whole = first + second + both;
    EXPECT_NEAR(indices.first[0].value, first / whole, 0.005);
    EXPECT_NEAR(indices.first[1].value, second / whole, 0.005);
    EXPECT_NEAR(indices.total[0].value, (first + both) / whole, 0.005);
    EXPECT_NEAR(indices.interactions[1].value, both / whole, 0.005);
    EXPECT_NEAR(indices.pairs[0].value, both / whole, 0.005);
    EXPECT_LT(indices.total[0].half_width, 0.05);
}

TEST(ModelIndices, IshigamiFromFewerPointsThanADesignForIt) {
    // S = 0.3139, 0.4424, 0; T = 0.5576, 0.4424, 0.2437; all interaction is of x1 and x3 (Ishigami & Homma 1990).
    const auto learned = learn(3, 400, [](auto u) {
        const auto x = [&](std::size_t j) { return std::numbers::pi * (2 * u[j] - 1); };
        return std::sin(x(0)) + 7 * std::pow(std::sin(x(1)), 2) + 0.1 * std::pow(x(2), 4) * std::sin(x(0));
    });
    const auto indices = model_indices(learned.model, 3, learned.groups);
    const double first[] = {0.3139, 0.4424, 0}, total[] = {0.5576, 0.4424, 0.2437};
    for (std::size_t j = 0; j < 3; ++j) {
        EXPECT_NEAR(indices.first[j].value, first[j], 0.03);
        EXPECT_NEAR(indices.total[j].value, total[j], 0.03);
    }
    EXPECT_NEAR(indices.pairs[1].value, 0.2437, 0.03);
    EXPECT_NEAR(indices.pairs[0].value, 0, 0.02);
    EXPECT_NEAR(indices.pairs[2].value, 0, 0.02);
}

TEST(ModelIndices, FeaturesMayBeFunctionsOfTheFactors) {
    // The model knows one feature, x1 + x2; the indices are those of the two factors.
    const auto set = ask_design("halton", 2, {{"points", std::int64_t{60}}});
    std::vector<double> feature, values;
    for (std::size_t i = 0; i < set.size(); ++i) {
        feature.push_back(set.point(i)[0] + set.point(i)[1]);
        values.push_back(feature.back());
    }
    const auto model = std::get<ResponseModel>(fit_response({feature, 1}, values, {.low = {0}, .high = {2}}));
    const FeatureMap sum = [](Rows factors) {
        std::vector<double> features;
        for (std::size_t i = 0; i < factors.size(); ++i) features.push_back(factors.row(i)[0] + factors.row(i)[1]);
        return features;
    };
    const auto indices = model_indices(model, 2, {}, sum);
    EXPECT_NEAR(indices.first[0].value, 0.5, 0.005);
    EXPECT_NEAR(indices.total[1].value, 0.5, 0.005);
    EXPECT_THROW((void)model_indices(model, 2), std::invalid_argument);
    EXPECT_THROW((void)model_indices(model, 2, std::vector<std::size_t>(3, 0), sum), std::invalid_argument);
}

TEST(ModelIndices, OfAnAdditiveResponseHaveNoInteractionsAndErrorsThatHold) {
    // 0.8, 0.2 and 0, and nothing together: a factor that does nothing is no more than its error from 0.
    const auto learned = learn(3, 240, [](auto u) { return u[0] + 0.5 * u[1]; });
    const auto indices = model_indices(learned.model, 3, learned.groups);
    const double first[] = {0.8, 0.2, 0};
    for (std::size_t j = 0; j < 3; ++j) {
        EXPECT_LE(std::abs(indices.first[j].value - first[j]), indices.first[j].half_width) << j;
        EXPECT_LE(std::abs(indices.total[j].value - first[j]), indices.total[j].half_width) << j;
        EXPECT_LT(indices.first[j].half_width, 0.01);
    }
    for (const auto& pair : indices.pairs) {
        EXPECT_LT(std::abs(pair.value), 1e-6);
        EXPECT_LE(std::abs(pair.value), pair.half_width);
    }
    for (const auto* kind : {&indices.first, &indices.total, &indices.interactions, &indices.pairs})
        EXPECT_TRUE(std::ranges::all_of(*kind, [](const auto& index) { return index.half_width > 0; }));
}

TEST(ModelIndices, AnEffectLostInTheScatterIsNotZeroForSure) {
    // Shares of the mean response 0.9975, 0.0025 and 0; 15 % of the variance is scatter. The model may leave x2 out.
    std::uint64_t i = 0;
    const auto learned =
        learn(3, 128, [&](auto u) { return u[0] + 0.05 * u[1] + 0.12 * normal_at(Stream(5, 78), i++); });
    const auto indices = model_indices(learned.model, 3, learned.groups);
    const double error = std::pow(learned.model.quality().leave_one_out_error, 2);
    for (const auto* kind : {&indices.first, &indices.total, &indices.interactions, &indices.pairs})
        for (const auto& index : *kind) EXPECT_GE(index.half_width, 7.8 * error / 128);
    EXPECT_LE(std::abs(indices.total[1].value - 0.0025), indices.total[1].half_width);
    EXPECT_LE(indices.total[2].value, indices.total[2].half_width);
}

TEST(ModelIndices, IntervalsHoldTheTruthOfIshigami) {
    const auto learned = learn(3, 400, [](auto u) {
        const auto x = [&](std::size_t j) { return std::numbers::pi * (2 * u[j] - 1); };
        return std::sin(x(0)) + 7 * std::pow(std::sin(x(1)), 2) + 0.1 * std::pow(x(2), 4) * std::sin(x(0));
    });
    const auto indices = model_indices(learned.model, 3, learned.groups);
    const double first[] = {0.3139, 0.4424, 0}, total[] = {0.5576, 0.4424, 0.2437}, pairs[] = {0, 0.2437, 0};
    for (std::size_t j = 0; j < 3; ++j) {
        EXPECT_LE(std::abs(indices.first[j].value - first[j]), indices.first[j].half_width) << j;
        EXPECT_LE(std::abs(indices.total[j].value - total[j]), indices.total[j].half_width) << j;
        EXPECT_LE(std::abs(indices.pairs[j].value - pairs[j]), indices.pairs[j].half_width) << j;
        EXPECT_LT(indices.total[j].half_width, 0.05);
    }
}

/// 400 rows of two normal columns with the correlation r, in the order (a, b) or (b, a).
std::shared_ptr<const JointSample> normal_rows(double r, bool swapped) {
    std::vector<double> a, b;
    for (std::size_t i = 0; i < 400; ++i) {
        a.push_back(normal_quantile(to_unit(bits_at(11, 1, i)) * 0.998 + 0.001));
        b.push_back(r * a.back() + std::sqrt(1 - r * r) * normal_quantile(to_unit(bits_at(11, 2, i)) * 0.998 + 0.001));
    }
    return std::make_shared<const JointSample>(swapped ? std::vector{b, a} : std::vector{a, b});
}

/// Shapley effects of a, b and an independent c in [0, 1], whatever the order of the columns.
template <class Response>
std::vector<double> shared_variance(double r, bool swapped, const Response& response) {
    const auto sample = normal_rows(r, swapped);
    const auto features = [&](Rows points) {
        std::vector<double> rows;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const auto u = points.row(i);
            const auto row = sample->row_at(u.first(2));
            rows.insert(rows.end(), {sample->column(0)[row], sample->column(1)[row], u[2]});
        }
        return rows;
    };
    const auto set = ask_design("halton", 3, {{"points", std::int64_t{160}}, {"sequences", std::int64_t{8}}});
    const auto x = features({set.coordinates, 3});
    std::vector<double> values;
    std::vector<std::size_t> groups;
    const std::size_t a = swapped ? 1 : 0;
    for (std::size_t i = 0; i < 160; ++i) {
        values.push_back(response(x[3 * i + a], x[3 * i + 1 - a], x[3 * i + 2]));
        groups.push_back(i % 8);
    }
    const auto model = std::get<ResponseModel>(
        fit_response({x, 3}, values, {.low = {-4, -4, 0}, .high = {4, 4, 1}, .map = LearnedMap::never}));
    const FactorRoles roles{{}, {}, {SampleColumn{sample, 0}, SampleColumn{sample, 1}, std::nullopt}};
    const auto found = model_indices(model, 3, groups, features, roles).shapley;
    return {found.at(a).value, found.at(1 - a).value, found.at(2).value};
}

// Of y = a the normal b has r^2/2, of which it explains r^2 alone and nothing beside a (Owen & Prieur 2017, SIAM/ASA J.
// Uncertain. Quantif. 5, 986); a + b + c/2 is symmetric in a and b.
TEST(ModelIndices, ShapleyEffectsShareTheVarianceOfDependentFactors) {
    const double r = 0.8;
    for (const bool swapped : {false, true}) {
        const auto alone = shared_variance(r, swapped, [](double a, double, double) { return a; });
        EXPECT_NEAR(alone[1], r * r / 2, 0.04) << swapped;
        EXPECT_NEAR(alone[0], 1 - r * r / 2, 0.04) << swapped;
        EXPECT_NEAR(alone[2], 0, 0.01);
        const auto both = shared_variance(r, swapped, [](double a, double b, double c) { return a + b + c / 2; });
        EXPECT_NEAR(both[0], both[1], 0.04) << swapped;
        EXPECT_NEAR(both[0] + both[1] + both[2], 1, 1e-9);
        EXPECT_NEAR(both[2], 1.0 / 48 / (2 + 2 * r + 1.0 / 48), 0.01);
    }
}

// y = x1 + 2 u with noise u: x1 acts on the mean alone, so no part of its range reduces the share of the noise.
TEST(ModelIndices, NoPartOfAControlThatDoesNotInteractIsSignificant) {
    const auto added = learn(2, 80, [](auto u) { return u[0] + 2 * u[1] + 0.2 * std::sin(40 * u[0] + 17 * u[1]); });
    const auto multiplied = learn(2, 80, [](auto u) { return u[0] + 2 * u[0] * u[1]; });
    const FactorRoles roles{{false, true}, {}, {}};
    EXPECT_FALSE(model_indices(added.model, 2, added.groups, {}, roles).noise->controls.front().significant());
    const auto found = model_indices(multiplied.model, 2, multiplied.groups, {}, roles).noise->controls.front();
    EXPECT_TRUE(found.significant());
    EXPECT_EQ(found.from, 0);
}

}  // namespace grainsweep::tests::stats_model_indices_test
