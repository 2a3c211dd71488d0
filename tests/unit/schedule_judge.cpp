#include "stats/random.hpp"
#include "sweep/schedule/judge.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

namespace grainsweep::tests::schedule_judge_test {

using namespace schedule;
using testing::HasSubstr;
using testing::StartsWith;

constexpr double none = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t sequences = 4;

/// Shifted golden-ratio sequences, so that statistics settle quickly: sequence s, member i.
double response(std::int64_t point) {
    const auto s = static_cast<double>(point % std::int64_t{sequences});
    const auto i = static_cast<double>(point / std::int64_t{sequences});
    const double u = std::fmod(0.6180339887498949 * i + 0.137 * (s + 1) * (s + 1), 1.0);
    return 1 + u * u;
}

std::vector<campaign::PlacedCase> place(std::int64_t points, std::int64_t repeats = 1) {
    std::vector<campaign::PlacedCase> placed;
    for (std::int64_t p = 0; p < points; ++p) {
        for (std::int64_t r = 0; r < repeats; ++r) {
            campaign::PlacedCase one;
            one.question.id = "case" + std::to_string(p) + "/" + std::to_string(r);
            one.point = p;
            one.sequence = p % std::int64_t{sequences};
            one.replicate = r;
            placed.push_back(one);
        }
    }
    return placed;
}

Observations answer(double y) {
    Observations observations;
    observations.scalars["y"] = y;
    return observations;
}

campaign::Convergence wanted(std::int64_t block = 40, double tolerance = 0.01) {
    campaign::Convergence rule;
    rule.observable = "y";
    rule.block = block;
    rule.tolerance = tolerance;
    return rule;
}

Judge judge_of(const campaign::Convergence& rule, const std::vector<campaign::PlacedCase>& placed) {
    return {rule, placed, sequences, std::vector<double>(placed.size(), none)};
}

std::vector<double> known(const std::vector<campaign::PlacedCase>& placed) {
    std::vector<double> values;
    for (const auto& one : placed) values.push_back(response(one.point));
    return values;
}

/// Bit for bit, NaN equal to NaN.
bool same(const store::ConvergenceRow& a, const store::ConvergenceRow& b) {
    const auto figures = [](const store::ConvergenceRow& r) {
        return std::array{r.mean,           r.sd,
                          r.skewness,       r.g1,
                          r.kurtosis,       r.mean_error,
                          r.sd_error,       r.g1_error,
                          r.skewness_error, r.kurtosis_error,
                          r.zero_share};
    };
    const auto x = figures(a), y = figures(b);
    return a.observable == b.observable && a.points == b.points && a.excluded == b.excluded &&
           a.converged == b.converged &&
           std::ranges::equal(x, y, [](double p, double q) { return p == q || (std::isnan(p) && std::isnan(q)); });
}

TEST(Judge, DoesNotDependOnWhoFinishedFirst) {
    const auto placed = place(400);
    Judge calm(wanted(40, 0.03), placed, sequences, known(placed));
    const auto expected = calm.judge(placed.size());
    ASSERT_GE(expected.size(), 3U);
    ASSERT_TRUE(calm.converged_at());
    ASSERT_LT(*calm.converged_at(), 400);

    for (std::uint64_t shuffle = 0; shuffle < 5; ++shuffle) {
        Judge judge = judge_of(wanted(40, 0.03), placed);
        std::vector<bool> there(placed.size());
        std::size_t prefix = 0;
        std::vector<store::ConvergenceRow> rows;
        for (const auto i : stats::permutation(400, stats::Generator(shuffle))) {
            judge.learn(placed[i].question.id, answer(response(placed[i].point)));
            there[i] = true;
            while (prefix < there.size() && there[prefix]) ++prefix;
            for (auto& row : judge.judge(prefix)) rows.push_back(row);
        }
        EXPECT_EQ(judge.converged_at(), calm.converged_at());
        EXPECT_EQ(judge.verdict(), calm.verdict());
        ASSERT_EQ(rows.size(), expected.size());
        for (std::size_t k = 0; k < rows.size(); ++k) EXPECT_TRUE(same(rows[k], expected[k])) << k;
    }
}

TEST(Judge, ResumedFromTheArchiveItSaysTheSame) {
    const auto placed = place(200);
    Judge calm(wanted(), placed, sequences, known(placed));
    const auto expected = calm.judge(200);
    auto half = known(placed);
    std::fill(half.begin() + 90, half.end(), none);
    Judge judge(wanted(), placed, sequences, half);
    auto rows = judge.judge(90);
    EXPECT_EQ(rows.size(), std::min<std::size_t>(2, expected.size()));
    for (std::size_t i = 90; i < 200; ++i) judge.learn(placed[i].question.id, answer(response(placed[i].point)));
    for (auto& row : judge.judge(200)) rows.push_back(row);
    ASSERT_EQ(rows.size(), expected.size());
    for (std::size_t k = 0; k < rows.size(); ++k) EXPECT_TRUE(same(rows[k], expected[k])) << k;
}

TEST(Judge, StopsAtTheFirstConvergedBlockAndGoesOnWhereItShallNotStop) {
    const auto placed = place(400);
    auto rule = wanted(40, 0.05);
    Judge stopping(rule, placed, sequences, known(placed));
    const auto short_history = stopping.judge(400);
    ASSERT_TRUE(stopping.converged_at());
    EXPECT_EQ(short_history.back().points, *stopping.converged_at());
    EXPECT_TRUE(short_history.back().converged);
    EXPECT_THAT(stopping.verdict(), testing::MatchesRegex("mean [0-9.]+ %, sd [0-9.]+ %, kurtosis [0-9.]+ %, "
                                                          "g1 [0-9.]+ % < 5 %"));
    EXPECT_TRUE(stopping.judge(400).empty());

    rule.stop = false;
    Judge watching(rule, placed, sequences, known(placed));
    EXPECT_EQ(watching.judge(400).size(), 10U);
    EXPECT_EQ(watching.converged_at(), stopping.converged_at());
}

TEST(Judge, ABlockIsAStretchOfPointNumbersWhateverWasFilteredOut) {
    auto placed = place(120);
    std::erase_if(placed, [](const auto& one) { return one.point % 3 == 1; });  // as `where` does
    Judge judge(wanted(40), placed, sequences, known(placed));
    const auto rows = judge.judge(placed.size());
    ASSERT_EQ(rows.size(), 3U);
    EXPECT_EQ(rows[0].points, 40);
    double sum = 0;
    int n = 0;
    for (std::int64_t p = 0; p < 40; ++p) {
        if (p % 3 == 1) continue;
        sum += response(p);
        ++n;
    }
    EXPECT_NEAR(rows[0].mean, sum / n, 1e-14);
    EXPECT_EQ(rows[0].excluded, 0);
}

TEST(Judge, AFilteredTailCompletesItsBlockOnlyWhereTheDesignIsKnownToReachSoFar) {
    auto placed = place(80);
    std::erase_if(placed, [](const auto& one) { return one.point >= 77; });
    Judge blind(wanted(40), placed, sequences, known(placed));
    EXPECT_EQ(blind.judge(placed.size()).size(), 1U);
    Judge knowing(wanted(40), placed, sequences, known(placed), 80);
    EXPECT_EQ(knowing.judge(placed.size()).size(), 2U);
}

TEST(Judge, AnIncompleteBlockIsNeverJudged) {
    const auto placed = place(100);
    Judge judge(wanted(40), placed, sequences, known(placed));
    EXPECT_TRUE(judge.judge(39).empty());
    EXPECT_EQ(judge.verdict(), "first check of y at 40 points");
    EXPECT_EQ(judge.judge(40).size(), 1U);
    EXPECT_EQ(judge.judge(100).size(), 1U);  // 80; never 100
}

TEST(Judge, APointCountsWhenAllItsRepeatsAreThere) {
    const auto placed = place(8, 3);
    auto rule = wanted(4);
    rule.rule = "all_change";
    Judge judge(rule, placed, sequences, known(placed));
    EXPECT_TRUE(judge.judge(11).empty());
    const auto rows = judge.judge(12);
    ASSERT_EQ(rows.size(), 1U);
    EXPECT_NEAR(rows[0].mean, (response(0) + response(1) + response(2) + response(3)) / 4, 1e-15);
}

TEST(Judge, FailedCasesAreLeftOutAndCounted) {
    const auto placed = place(80);
    Judge judge = judge_of(wanted(40), placed);
    for (const auto& one : placed) {
        const bool fails = one.point % 10 == 7;
        judge.learn(one.question.id, fails ? Observations{} : answer(response(one.point)));
    }
    const auto rows = judge.judge(80);
    ASSERT_EQ(rows.size(), 2U);
    EXPECT_EQ(rows[0].excluded, 4);
    EXPECT_EQ(rows[1].excluded, 8);
    EXPECT_TRUE(std::isfinite(rows[1].kurtosis));
}

TEST(Judge, OneQuestionAnswersEveryPlaceWhereItIsAsked) {
    auto placed = place(8);
    for (auto& one : placed) one.question.id = "the same";
    auto rule = wanted(8);
    rule.rule = "all_change";
    Judge judge = judge_of(rule, placed);
    judge.learn("the same", answer(2.5));
    judge.learn("of another campaign", answer(7));
    const auto rows = judge.judge(8);
    ASSERT_EQ(rows.size(), 1U);
    EXPECT_EQ(rows[0].mean, 2.5);
    EXPECT_EQ(rows[0].excluded, 0);
    EXPECT_TRUE(std::isnan(rows[0].kurtosis));
}

TEST(Judge, ACaseThatStandsAtManyPointsCountsOnce) {
    auto placed = place(400);
    for (auto& one : placed) one.question.id = "case" + std::to_string(one.point % 6);
    auto values = known(placed);
    for (std::size_t i = 6; i < values.size(); ++i) values[i] = values[i % 6];
    Judge judge(wanted(40, 0.5), placed, sequences, values);
    const auto rows = judge.judge(400);
    ASSERT_EQ(rows.size(), 10U);
    double mean = 0;
    for (std::size_t i = 0; i < 6; ++i) mean += values[i] / 6;
    for (const auto& row : rows) {
        EXPECT_NEAR(row.mean, mean, 1e-12);
        EXPECT_FALSE(row.converged);
    }
    EXPECT_FALSE(judge.converged_at());
    EXPECT_THAT(judge.verdict(), HasSubstr("the 6 different cases are known"));
}

TEST(Judge, EqualValuesAreNamed) {
    const auto placed = place(80);
    Judge judge(wanted(40), placed, sequences, std::vector<double>(80, 1.0));
    (void)judge.judge(80);
    EXPECT_EQ(judge.verdict(),
              "all values are equal after 80 points (80 values): their scatter is unknown, and up to 3.7 % of the box "
              "may have other values");
}

TEST(Judge, NamesThatNoCaseHasAValue) {
    const auto placed = place(80);
    Judge judge(wanted(40), placed, sequences, std::vector<double>(80, std::numeric_limits<double>::quiet_NaN()));
    (void)judge.judge(80);
    EXPECT_EQ(judge.verdict(), "none of 80 points has a value");
}

TEST(Judge, NamesWhatHoldsItBackAndHowFarItIs) {
    const auto placed = place(80);
    auto rule = wanted(40, 1e-6);
    Judge shape(rule, placed, sequences, known(placed));
    (void)shape.judge(80);
    EXPECT_THAT(shape.verdict(), testing::MatchesRegex("kurtosis has no error yet: it rests on [0-9]+ of the 80 values "
                                                       "at 80 points, 50 are needed"));
    rule.gates = {"mean", "sd"};
    Judge strict(rule, placed, sequences, known(placed));
    (void)strict.judge(80);
    EXPECT_THAT(strict.verdict(), testing::MatchesRegex(".+ [0-9.]+ % > 0\\.0001 %, about [0-9]+ more points "
                                                        "\\(the design has 80\\)"));
    rule.rule = "any_change";
    Judge changes(rule, placed, sequences, known(placed));
    (void)changes.judge(40);
    EXPECT_EQ(changes.verdict(), "40 points, nothing to compare with yet");
    (void)changes.judge(80);
    EXPECT_THAT(changes.verdict(), StartsWith("change of "));
}

TEST(Judge, SkewnessIsNotJudgedWhileHalfOfTheValuesAreZero) {
    const auto placed = place(80);
    std::vector<double> values = known(placed);
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (i / sequences % 2 == 0) values[i] = 0;
    }
    auto rule = wanted(40);
    rule.gates = {"skewness"};
    Judge judge(rule, placed, sequences, values);
    const auto rows = judge.judge(80);
    EXPECT_EQ(rows.back().zero_share, 0.5);
    EXPECT_EQ(judge.verdict(), "skewness cannot be judged: 50 % of the values are zero, so the median jumps");
}

TEST(Judge, RefusesRulesTheDesignCannotCarry) {
    const auto placed = place(8);
    EXPECT_THROW(Judge(wanted(), placed, 1, known(placed)), std::invalid_argument);
    auto rule = wanted();
    rule.gates = {"variance"};
    EXPECT_THROW(Judge(rule, placed, sequences, known(placed)), std::invalid_argument);
    EXPECT_EQ(independent_sequences("halton", 8), 8U);
    EXPECT_EQ(independent_sequences("saltelli", 6), 1U);
    EXPECT_EQ(independent_sequences("morris", 5), 1U);
}

/// Two factors of a smooth response with a little scatter, in shifted lattice sequences.
struct Hill {
    explicit Hill(std::int64_t points) : placed(place(points)) {
        for (std::size_t p = 0; p < placed.size(); ++p) {
            const auto s = static_cast<double>(p % sequences), i = static_cast<double>(p / sequences);
            const double a = std::fmod(0.7548776662466927 * i + 0.137 * (s + 1) * (s + 1), 1.0);
            const double b = std::fmod(0.5698402909980532 * i + 0.311 * (s + 1) * (s + 1), 1.0);
            features.push_back({a, b});
            values.push_back(1 + std::sin(3 * a) * (0.5 + b) + 0.01 * std::sin(1000.0 * static_cast<double>(p)));
        }
    }
    [[nodiscard]] Judge judge(std::vector<double> there, bool stop = true) const {
        auto rule = wanted(8, 0.03);
        rule.rule = "assisted";
        rule.gates = {"mean", "sd"};
        rule.stop = stop;
        return {rule, placed, sequences, std::move(there), {}, view()};
    }
    [[nodiscard]] ModelView view() const {
        std::vector<double> integration;
        for (int k = 0; k < 2048; ++k) {
            integration.push_back(std::fmod(0.7548776662466927 * k + 0.5, 1.0));
            integration.push_back(std::fmod(0.5698402909980532 * k + 0.5, 1.0));
        }
        return {{.dimensions = 2, .low = {}, .high = {}, .integration = integration, .scramblings = 8},
                [all = features](std::size_t point) { return all[point]; }};
    }
    [[nodiscard]] std::vector<double> nothing() const { return std::vector<double>(placed.size(), none); }

    std::vector<campaign::PlacedCase> placed;
    std::vector<double> values;
    std::vector<std::vector<double>> features;
};

TEST(Judge, WithModelsItSaysTheSameWheneverAndInWhateverOrderItIsAsked) {
    const Hill hill(160);
    Judge calm = hill.judge(hill.values);
    const auto expected = calm.judge(hill.placed.size());
    ASSERT_TRUE(calm.converged_at());
    EXPECT_LT(*calm.converged_at(), 160);

    Judge judge = hill.judge(hill.nothing());
    EXPECT_EQ(judge.verdict(), "first check of y at 104 points");
    std::vector<bool> there(hill.placed.size());
    std::size_t prefix = 0;
    std::vector<store::ConvergenceRow> rows;
    const auto keep = [&](std::vector<store::ConvergenceRow> more) {
        rows.insert(rows.end(), more.begin(), more.end());
    };
    for (const auto i : stats::permutation(160, stats::Generator(3))) {
        judge.learn(hill.placed[i].question.id, answer(hill.values[i]));
        there[i] = true;
        while (prefix < there.size() && there[prefix]) ++prefix;
        keep(judge.judge(prefix, Judge::Models::beside));
    }
    keep(judge.judge(prefix));
    EXPECT_FALSE(judge.busy());
    EXPECT_EQ(judge.converged_at(), calm.converged_at());
    EXPECT_EQ(judge.verdict(), calm.verdict());
    ASSERT_EQ(rows.size(), expected.size());
    for (std::size_t k = 0; k < rows.size(); ++k) EXPECT_TRUE(same(rows[k], expected[k])) << k;
}

TEST(Judge, WithModelsAPartIsJudgedAsPartAndWhereItShallNotStopItGoesOn) {
    const Hill hill(160);
    Judge part = hill.judge(hill.values);
    const auto first = part.judge(104);
    ASSERT_EQ(first.size(), 1U);
    EXPECT_EQ(first.front().points, 104);
    EXPECT_FALSE(part.converged_at());
    EXPECT_THAT(part.judge(127), testing::IsEmpty());  // the next check is at 128
    Judge watching = hill.judge(hill.values, false);
    std::vector<std::int64_t> points;
    for (const auto& row : watching.judge(hill.placed.size())) points.push_back(row.points);
    EXPECT_THAT(points, testing::ElementsAre(104, 128, 160));
    EXPECT_THAT(watching.verdict(), HasSubstr("< 3 %"));
}

TEST(Judge, WithARefusedModelNothingIsDecidedAndItSaysWhy) {
    const Hill hill(128);
    Judge judge = hill.judge(std::vector<double>(hill.placed.size(), 2.0));
    for (const auto& row : judge.judge(hill.placed.size())) {
        EXPECT_FALSE(row.converged);
        EXPECT_TRUE(std::isnan(row.mean_error));
    }
    EXPECT_EQ(judge.verdict(), "nothing is decided at 128 points: no model-assisted moments: the response is constant");
    auto rule = wanted(8);
    rule.rule = "assisted";
    EXPECT_THROW(Judge(rule, hill.placed, sequences, hill.values), std::invalid_argument);  // no view
}

}  // namespace grainsweep::tests::schedule_judge_test
