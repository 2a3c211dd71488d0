#include "stats/assisted_moments.hpp"
#include "stats/confidence.hpp"
#include "stats/moment_statistics.hpp"
#include "tests/support/known_responses.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <variant>
#include <vector>

namespace grainsweep::tests::stats_assisted_moments_test {

using namespace stats;

struct Asked {
    KnownCampaign campaign;
    std::vector<double> integration;
    std::vector<double> noise;
    std::size_t dimensions;

    [[nodiscard]] AssistedInput input() const {
        return {
            {campaign.points, dimensions}, campaign.values, campaign.sequences, {integration, dimensions}, 8, noise, 0};
    }
};

Asked ask(const KnownResponse& response, std::int64_t n, std::uint64_t seed = 1) {
    return {ask_known(response, n, seed),
            integration_points(response.dimensions, 9),
            {response.noise * response.noise},
            response.dimensions};
}

AssistedMoments answered(const Asked& asked, const AssistedMoments* previous = nullptr) {
    const auto answer = assisted_moments(asked.input(), {}, previous);
    if (const auto* refusal = std::get_if<Refusal>(&answer)) throw std::runtime_error(refusal->sentence);
    return std::get<AssistedMoments>(answer);
}

std::string refused(const Asked& asked) {
    const auto answer = assisted_moments(asked.input());
    return std::holds_alternative<Refusal>(answer) ? std::get<Refusal>(answer).sentence : "not refused";
}

TEST(MomentStatistics, AreThoseOfMomentsAndTheirGradientsThoseOfDifferences) {
    const std::vector<double> sample{0.3, 1.2, -0.7, 2.5, 0.1, 0.9};
    RawMoments raw{};
    for (const double y : sample)
        for (std::size_t p = 0; p < 4; ++p) raw[p] += std::pow(y, static_cast<double>(p + 1)) / 6;
    const Summary summary = summarise(sample);
    const auto all = moment_statistics(raw);
    EXPECT_NEAR(all[0].value, summary.mean, 1e-14);
    EXPECT_NEAR(all[1].value, summary.sd, 1e-14);
    EXPECT_NEAR(all[2].value, summary.g1, 1e-13);
    EXPECT_NEAR(all[3].value, summary.kurtosis, 1e-13);
    for (std::size_t p = 0; p < 4; ++p) {
        RawMoments up = raw, down = raw;
        up[p] += 1e-6;
        down[p] -= 1e-6;
        for (std::size_t k = 0; k < 4; ++k)
            EXPECT_NEAR(all[k].gradient[p], (moment_statistics(up)[k].value - moment_statistics(down)[k].value) / 2e-6,
                        1e-7);
    }
}

TEST(AssistedMoments, CoverTheTruthFromAFractionOfTheError) {
    // Few campaigns here; coverage over 100 of each response is counted by slow_assisted.
    const KnownResponse response = known_responses()[2];  // smooth
    const auto with = true_statistics(response, true), without = true_statistics(response, false);
    int covered = 0, covered_without = 0;
    double shorter = 0;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        const auto a = answered(ask(response, 104, seed));
        EXPECT_LT(a.model_error, 0.35);
        for (std::size_t k = 0; k < 4; ++k) {
            const auto& s = a.statistics[k];
            covered += std::abs(s.assisted.value - with[k]) <= s.assisted.half_width ? 1 : 0;
            covered_without += std::abs(s.without_scatter.value - without[k]) <= s.without_scatter.half_width ? 1 : 0;
            shorter += s.assisted.half_width / s.plain.half_width / 12;
        }
    }
    EXPECT_GE(covered, 9);
    EXPECT_GE(covered_without, 9);
    EXPECT_LT(shorter, 0.8);
}

TEST(AssistedMoments, AreThePlainOnesWhereTheModelSaysNothing) {
    // Noise alone: the model is constant, its closure cancels, and the estimate is not taken.
    const auto asked = ask(known_responses()[4], 104);
    const auto a = answered(asked);
    EXPECT_GT(a.model_error, 0.9);
    EXPECT_TRUE(a.remark.starts_with("the plain estimates stand: left-out sequences are predicted with an error of "));
    const Summary plain = summarise(asked.campaign.values);
    for (std::size_t k = 0; k < 4; ++k) {
        EXPECT_FALSE(a.statistics[k].takes_assisted);
        EXPECT_EQ(a.statistics[k].plain.value, plain.of(assisted_statistics[k]));
        EXPECT_EQ(a.statistics[k].chosen().value, a.statistics[k].plain.value);
    }
    EXPECT_NEAR(a.of(Statistic::mean).assisted.value, plain.mean, a.of(Statistic::mean).plain.half_width);
    EXPECT_THROW((void)a.of(Statistic::skewness), std::invalid_argument);
}

TEST(AssistedMoments, TheCheckBeforeDecidesWhatIsTaken) {
    const auto asked = ask(known_responses()[2], 104);
    AssistedMoments before;
    for (auto& s : before.statistics) s.shorter = true;
    before.statistics[0].shorter = false;
    const auto answer = answered(asked, &before);
    EXPECT_FALSE(answer.statistics[0].takes_assisted);
    for (std::size_t k = 1; k < 4; ++k) EXPECT_TRUE(answer.statistics[k].takes_assisted);
    // Without one, the first half of the cases is the check before.
    const auto alone = answered(asked);
    auto first = asked;
    first.campaign.points.resize(52 * 3);
    first.campaign.values.resize(52);
    first.campaign.sequences.resize(52);
    const auto check = answered(first);
    for (std::size_t k = 0; k < 4; ++k) {
        EXPECT_EQ(alone.statistics[k].takes_assisted, check.statistics[k].shorter);
        EXPECT_EQ(alone.statistics[k].assisted.value, answer.statistics[k].assisted.value);  // and nothing else changes
    }
}

TEST(AssistedMoments, ScatterIsSubtractedByTheLawOfTotalCumulance) {
    const auto asked = ask(known_responses()[2], 200);
    const auto a = answered(asked);
    const double variance = std::pow(a.of(Statistic::sd).assisted.value, 2);
    EXPECT_NEAR(variance - std::pow(a.of(Statistic::sd).without_scatter.value, 2), 0.01, 1e-12);
    EXPECT_NEAR(a.budget[0].scatter, 0.01 / variance, 1e-12);
    EXPECT_NEAR(a.budget[0].response + a.budget[0].scatter, 1, 1e-12);
    EXPECT_NEAR(a.budget[1].scatter, 0, 1e-12);  // the same noise everywhere has no third cumulant
    // 6 E[(m - E m)^2] v + 3 v^2 over the squared variance, the response's own variance being what is left
    EXPECT_NEAR(a.budget[2].scatter, (6 * (variance - 0.01) * 0.01 + 3e-4) / (variance * variance), 1e-12);
    auto unknown = asked;
    unknown.noise.clear();
    const auto b = answered(unknown);
    EXPECT_TRUE(std::isnan(b.of(Statistic::sd).without_scatter.value));
    EXPECT_EQ(b.of(Statistic::sd).assisted.value, a.of(Statistic::sd).assisted.value);
}

TEST(AssistedMoments, ASmoothResponseWithoutNoiseStatesTheErrorOfItsIntegral) {
    KnownResponse response = known_responses()[2];
    response.noise = 0;
    const auto truth = true_statistics(response, false);
    const auto a = answered(ask(response, 160));
    EXPECT_LT(a.model_error, 0.02);
    for (std::size_t k = 0; k < 4; ++k)
        EXPECT_LE(std::abs(a.statistics[k].assisted.value - truth[k]), 1.5 * a.statistics[k].assisted.half_width) << k;
}

TEST(AssistedMoments, SayNothingOfATailThatTheModelDoesNotForesee) {
    // exp of a normal quantile seems a smooth function of u, whose cases end at 1/256 from a pole. The mean is
    // exp(1/2).
    const KnownResponse lognormal{"lognormal", 2,
                                  [](std::span<const double> u) { return std::exp(normal_quantile(u[0])); }, 0, 1};
    int held = 0, taken = 0, endless = 0;
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        const auto a = answered(ask(lognormal, 128, seed));
        endless += a.endless ? 1 : 0;
        taken += a.of(Statistic::kurtosis).takes_assisted ? 1 : 0;
        const auto& mean = a.of(Statistic::mean);
        taken += mean.takes_assisted ? 1 : 0;
        held += std::abs(mean.chosen().value - std::exp(0.5)) <= mean.chosen().half_width ? 1 : 0;
    }
    EXPECT_GE(endless, 2);
    EXPECT_LE(taken, 2) << "of twelve";
    EXPECT_GE(held, 4);
}

TEST(AssistedMoments, RefusesInWords) {
    const auto good = ask(known_responses()[2], 104);
    auto rare = good;
    for (std::size_t i = 0; i < rare.campaign.values.size(); ++i)
        rare.campaign.values[i] = i % 13 == 0 ? 1.0 + 0.001 * static_cast<double>(i) : 0;
    EXPECT_EQ(refused(rare),
              "no moments with an error that holds: only 8 of 104 responses differ from 0, 30 are needed for either "
              "estimate");
    auto constant = good;
    std::ranges::fill(constant.campaign.values, 3.0);
    EXPECT_EQ(refused(constant), "no model-assisted moments: the response is constant");
    EXPECT_TRUE(refused(ask(known_responses()[2], 24))
                    .starts_with("no model-assisted moments: too few cases, 24 with a value"));
    auto one = good;
    std::ranges::fill(one.campaign.sequences, 0U);
    EXPECT_TRUE(refused(one).starts_with("no model-assisted moments: they need at least 4"));
    auto wrong = good;
    wrong.integration.pop_back();
    EXPECT_THROW((void)assisted_moments(wrong.input()), std::invalid_argument);
}

TEST(AssistedMoments, ContradictedByThePlainOnesTheyAreWithdrawn) {
    // Integration points of another box than the cases': a model integrated in the wrong place.
    auto asked = ask(known_responses()[2], 200);
    for (double& u : asked.integration) u = 0.3 * u;
    const auto a = answered(asked);
    EXPECT_FALSE(a.of(Statistic::mean).takes_assisted);
    EXPECT_NE(a.remark.find("is withdrawn: it contradicts the plain "), std::string::npos);
    // Each that is withdrawn has its sentence, and no other one has.
    std::size_t withdrawn = 0;
    for (const Statistic statistic : assisted_statistics) {
        const bool named = a.remark.find("model-assisted " + std::string(to_string(statistic))) != std::string::npos;
        EXPECT_EQ(named, a.of(statistic).withdrawn) << to_string(statistic);
        EXPECT_FALSE(a.of(statistic).withdrawn && a.of(statistic).takes_assisted);
        withdrawn += named ? 1 : 0;
    }
    EXPECT_GE(withdrawn, 2U);
}

TEST(AssistedMoments, MissingValuesAreLeftOut) {
    auto asked = ask(known_responses()[2], 120);
    asked.campaign.values[5] = std::numeric_limits<double>::quiet_NaN();
    const auto a = answered(asked);
    EXPECT_EQ(a.cases, 119U);
    EXPECT_EQ(a.excluded, 1U);
}

}  // namespace grainsweep::tests::stats_assisted_moments_test
