// Moments, indices, models and windows over distributions of the factors, against closed forms and fine integrals.
#include "sweep/campaign/reader.hpp"
#include "sweep/report/window_tables.hpp"
#include "sweep/study/estimators.hpp"
#include "sweep/study/influence.hpp"
#include "sweep/study/model_influence.hpp"
#include "sweep/study/process_window.hpp"
#include "tests/support/study.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

namespace grainsweep::tests::report_distributions_test {

using namespace study;
using testing::HasSubstr;

const std::string normal_and_triangular = R"({"name": "x1", "normal": {"mean": 0.5, "sd": 0.1}},
    {"name": "x2", "triangular": {"low": 0.2, "mode": 0.4, "high": 0.9}})";

std::string asked(const std::string& factors, const std::string& design) {
    return R"({"campaign": "c", "scene": "rehearsal", "factors": [)" + factors + R"(], "design": )" + design + "}";
}

/// 1 + 2 x1 + 3 x2 of these factors.
double plane(const Inputs& inputs) {
    return 1 + 2 * input(inputs, "x1") + 3 * input(inputs, "x2");
}
/// Of a triangular distribution (low + mode + high)/3 and (l^2 + m^2 + h^2 - lm - lh - mh)/18.
constexpr double mean_of_plane = 1 + 2 * 0.5 + 3 * 0.5;
constexpr double variance_x1 = 4 * 0.01;
constexpr double variance_x2 = 9 * (0.04 + 0.16 + 0.81 - 0.08 - 0.18 - 0.36) / 18;
constexpr double share_x1 = variance_x1 / (variance_x1 + variance_x2);

struct Sampled {
    const char* design;
    double tolerance;  ///< of mean and sd, relative
};

struct OverDistributions : Study, testing::WithParamInterface<Sampled> {};

TEST_P(OverDistributions, MomentsAndIndicesAreThoseOfTheClosedForm) {
    answer_by(store, asked(normal_and_triangular, GetParam().design), plane);
    const auto responses = ask("c");
    const auto all = figures_of(responses, responses.observable("y")).all;
    const double sd = std::sqrt(variance_x1 + variance_x2), tolerance = GetParam().tolerance;
    EXPECT_NEAR(all.of(stats::Statistic::mean).value, mean_of_plane, tolerance * sd);
    EXPECT_NEAR(all.of(stats::Statistic::sd).value, sd, tolerance * sd);
    const auto influence = influence_of(responses, responses.observable("y"));
    EXPECT_NEAR(influence.factors[0].first.value, share_x1, 0.12);
    EXPECT_NEAR(influence.factors[1].first.value, 1 - share_x1, 0.12);
}

INSTANTIATE_TEST_SUITE_P(Designs, OverDistributions,
                         testing::Values(Sampled{R"({"kind": "halton", "points": 512, "sequences": 8})", 0.02},
                                         Sampled{R"({"kind": "sobol", "points": 512, "scramble": "random"})", 0.02},
                                         // Its strata fix the margins, not the covariance of the factors, whose
                                         // standard error is 1.7 % of the sd here: three of them.
                                         Sampled{R"({"kind": "latin_hypercube", "points": 512})", 0.05},
                                         Sampled{R"({"kind": "random", "points": 2048})", 0.06},
                                         Sampled{R"({"kind": "saltelli", "base_points": 128})", 0.06},
                                         Sampled{R"({"kind": "lattice", "levels": 24, "placement": "centred"})",
                                                 0.04}));

/// The time x1, and none where it would be above 0.7: the process has jammed.
double time_of_flow(const Inputs& inputs) {
    const double time = input(inputs, "x1");
    return time > 0.7 ? std::numeric_limits<double>::quiet_NaN() : time;
}

TEST_F(Study, ACaseWithoutAValueMayCountAsBeyondAllOthers) {
    answer_by(store,
              asked(R"({"name": "x1", "between": [0, 1]}, {"name": "x2", "between": [0, 1]})",
                    R"({"kind": "halton", "points": 512, "sequences": 8})"),
              time_of_flow);
    const auto responses = ask("c");
    const auto& y = responses.observable("y");
    const std::array<stats::Level, 4> levels = {stats::Quantile{0.5}, stats::Quantile{0.9},
                                                stats::Exceedance{0.5, true}, stats::Exceedance{0.9, true}};
    const auto above = figures_of(responses, y, levels, WithoutValue::above);
    const auto below = figures_of(responses, y, levels, WithoutValue::below);
    const auto left_out = figures_of(responses, y, levels);
    const auto expect = [](const stats::Estimate& found, double truth) {
        EXPECT_NEAR(found.value, truth, found.error);
        EXPECT_LT(found.error, 0.03);
    };
    expect(above.all.levels[0].second, 0.5);
    EXPECT_TRUE(std::isnan(above.all.levels[1].second.value)) << "a time above all that were measured";
    expect(above.all.levels[2].second, 0.5);
    expect(above.all.levels[3].second, 0.3);
    expect(below.all.levels[0].second, 0.2);
    expect(below.all.levels[2].second, 0.2);
    EXPECT_EQ(below.all.levels[3].second.value, 0);
    expect(left_out.all.levels[0].second, 0.35);
    expect(left_out.all.levels[2].second, 0.2 / 0.7);
    EXPECT_EQ(above.beyond, above.all.excluded);
    EXPECT_EQ(left_out.beyond, 0);
    EXPECT_EQ(above.all.of(stats::Statistic::mean).value, left_out.all.of(stats::Statistic::mean).value);
}

TEST_F(Study, TotalIndicesOfSaltelliAreWithRespectToTheDistributions) {
    answer_by(store, asked(normal_and_triangular, R"({"kind": "saltelli", "base_points": 256})"), plane);
    const auto responses = ask("c");
    const auto influence = influence_of(responses, responses.observable("y"));
    EXPECT_NEAR(influence.factors[0].total.value, share_x1, influence.factors[0].total.half_width + 0.01);
    EXPECT_NEAR(influence.factors[1].total.value, 1 - share_x1, influence.factors[1].total.half_width + 0.01);
}

TEST_F(Study, ElementaryEffectsArePerUnitOfProbability) {
    answer_by(store, asked(normal_and_triangular, R"({"kind": "morris", "trajectories": 40})"), plane);
    const auto responses = ask("c");
    const auto influence = influence_of(responses, responses.observable("y"));
    ASSERT_TRUE(influence.factors[0].effects);
    const stats::Distribution x1(stats::Normal{0.5, 0.1}, 0, 1);
    const double steps[] = {2 * (x1.quantile(0.625) - x1.quantile(0.125)) / 0.5,
                            2 * (x1.quantile(0.875) - x1.quantile(0.375)) / 0.5};
    EXPECT_NEAR(steps[0], steps[1], 1e-9);
    EXPECT_NEAR(influence.factors[0].effects->mu_star, steps[0], 1e-9);
    EXPECT_NEAR(influence.factors[0].effects->sigma, 0, 1e-9);
}

/// sin z1 + 7 sin^2 z2 + 0.1 z3^4 sin z1 of normal z = pi (2 x - 1) with standard deviation s = 2 pi 0.12.
double ishigami(const Inputs& inputs) {
    const auto z = [&](const char* name) { return std::numbers::pi * (2 * input(inputs, name) - 1); };
    return std::sin(z("x1")) + 7 * std::pow(std::sin(z("x2")), 2) + 0.1 * std::pow(z("x3"), 4) * std::sin(z("x1"));
}

struct Truth {
    double mean = 0, sd = 0;
    std::array<double, 3> first{}, total{};
};

/// With E[sin^2 z] = (1 - exp(-2 s^2))/2 = p, E[sin^4 z] = (3 - 4 exp(-2 s^2) + exp(-8 s^2))/8, E[z^4] = 3 s^4 and
/// E[z^8] = 105 s^8: mean 7 p; parts of the variance V1 = p (1 + 0.3 s^4)^2, V2 = 49 (E[sin^4] - p^2),
/// V13 = p 0.01 (105 - 9) s^8.
Truth normal_ishigami() {
    const double s = 2 * std::numbers::pi * 0.12, q = s * s;
    const double p = (1 - std::exp(-2 * q)) / 2, fourth = (3 - 4 * std::exp(-2 * q) + std::exp(-8 * q)) / 8;
    const double v1 = p * std::pow(1 + 0.3 * q * q, 2), v2 = 49 * (fourth - p * p), v13 = p * 0.96 * q * q * q * q;
    const double all = v1 + v2 + v13;
    return {7 * p, std::sqrt(all), {v1 / all, v2 / all, 0}, {(v1 + v13) / all, v2 / all, v13 / all}};
}

TEST_F(Study, IshigamiUnderNormalFactorsHasTheMomentsAndIndicesOfItsClosedForm) {
    std::string factors;
    for (const char* name : {"x1", "x2", "x3"})
        factors += fmt::format("{}{{\"name\": \"{}\", \"normal\": {{\"mean\": 0.5, \"sd\": 0.12}}}}",
                               factors.empty() ? "" : ", ", name);
    answer_by(store, asked(factors, R"({"kind": "halton", "points": 512, "sequences": 8})"), ishigami);
    const auto responses = ask("c");
    const auto truth = normal_ishigami();
    const auto& y = responses.observable("y");
    const auto all = figures_of(responses, y).all;
    const auto mean = all.of(stats::Statistic::mean), sd = all.of(stats::Statistic::sd);
    EXPECT_NEAR(mean.value, truth.mean, 2 * mean.error);
    EXPECT_NEAR(sd.value, truth.sd, 2 * sd.error);

    const auto estimators = estimators_of(store, responses, y);
    ASSERT_TRUE(estimators.assisted) << estimators.refused;
    const auto model = model_influence_of(responses, y);
    ASSERT_TRUE(model.indices) << model.refused;
    for (std::size_t j = 0; j < 3; ++j) {
        EXPECT_NEAR(model.indices->first[j].value, truth.first[j], 0.02) << j;
        EXPECT_NEAR(model.indices->total[j].value, truth.total[j], 0.02) << j;
    }
}

TEST_F(Study, ASampleWithDependenceHasTheMomentsOfItsRows) {
    std::string rows = "x1,x2\n";
    std::vector<double> answers;
    const stats::Stream stream(5, 6);
    for (std::uint64_t i = 0; i < 3000; ++i) {  // a banana
        const double a = stream.uniform(2 * i), b = 4 * (a - 0.5) * (a - 0.5) * 0.9 + 0.1 * stream.uniform(2 * i + 1);
        rows += fmt::format("{},{}\n", a, b);
        answers.push_back(1 + 2 * a + 3 * b);
    }
    folder.write("banana.csv", rows);
    auto text = asked(R"({"name": "x1", "sample": "NAME"}, {"name": "x2", "sample": "NAME"})",
                      R"({"kind": "sobol", "points": 1024, "scramble": "random"})");
    const auto file = (folder / "banana.csv").string();
    for (auto at = text.find("NAME"); at != std::string::npos; at = text.find("NAME")) text.replace(at, 4, file);
    answer_by(store, text, plane);
    const auto responses = ask("c");
    const auto of_rows = stats::summarise(answers);
    const auto& y = responses.observable("y");
    const auto all = figures_of(responses, y).all;
    EXPECT_NEAR(all.of(stats::Statistic::mean).value, of_rows.mean, 0.02 * of_rows.sd);
    EXPECT_NEAR(all.of(stats::Statistic::sd).value, of_rows.sd, 0.02 * of_rows.sd);
    EXPECT_NEAR(all.of(stats::Statistic::g1).value, of_rows.g1, 0.05);
    for (std::size_t row = 0; row < responses.rows(); row += 50)
        for (const auto& factor : responses.factors) {
            EXPECT_GT(factor.coordinate(row), 0);
            EXPECT_LT(factor.coordinate(row), 1);
        }
    // Each index is that of its column alone, with what the other follows from it: together more than one.
    const auto influence = influence_of(responses, y);
    EXPECT_GT(influence.factors[0].first.value, 0.9);
    EXPECT_GT(influence.factors[1].first.value, 0.5);
}

TEST_F(Study, TheShareOfAWindowIsAProbability) {
    answer_by(store, asked(normal_and_triangular, R"({"kind": "halton", "points": 128, "sequences": 4})"),
              [](const Inputs& inputs) { return input(inputs, "x1"); });
    const auto cases = read_model_cases(store, "c");
    const WindowRequest request{.where = "y >= 0.6", .next = 0};
    const auto window = window_of(store, cases, request);
    EXPECT_NEAR(window.share_of_box, 0.158655, 0.005) << "beyond one standard deviation";
    const auto shown = report::window_document(cases, request, window).text;
    EXPECT_THAT(std::get<std::string>(shown.at(1)),
                HasSubstr("% of the distribution of the factors (4096 settings looked at)"));
    const auto [low, high] = stats::Distribution(stats::Normal{0.5, 0.1}, 0, 1).range();
    for (const auto& setting : window.searched) {
        EXPECT_GE(setting[0], low);
        EXPECT_LE(setting[0], high);
    }
    EXPECT_THAT(outside_text(cases.factors, {0.95, 0.5}), HasSubstr("x1 = 0.95 is outside of 0.19"));
    EXPECT_EQ(outside_text(cases.factors, {0.75, 0.5}), "");
}

}  // namespace grainsweep::tests::report_distributions_test
