// Factors that move in groups: designs, and one index or effect a group.
#include "stats/sensitivity.hpp"
#include "sweep/report/figures.hpp"
#include "sweep/report/influence_tables.hpp"
#include "sweep/study/influence.hpp"
#include "tests/support/ask_design.hpp"
#include "tests/support/study.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <sstream>

namespace grainsweep::tests::report_groups_test {

using testing::Contains;
using testing::HasSubstr;

/// y = prod (|4 x_j - 2| + a_j)/(1 + a_j) has V_j = 1/(3 (1 + a_j)^2) and, of a set of factors, 1 + V = prod (1 + V_j).
constexpr std::array coefficients = {0.0, 1.0, 4.5, 9.0};

double g_function(const Inputs& inputs) {
    double y = 1;
    for (std::size_t j = 0; j < coefficients.size(); ++j)
        y *= (std::abs(4 * input(inputs, "x" + std::to_string(j + 1)) - 2) + coefficients[j]) / (1 + coefficients[j]);
    return y;
}

double variance_of(std::initializer_list<std::size_t> factors) {
    double product = 1;
    for (const auto j : factors) product *= 1 + 1 / (3 * std::pow(1 + coefficients[j], 2));
    return product - 1;
}

std::string grouped(const std::string& design) {
    return R"({"campaign": "g", "scene": "rehearsal", "fixed": {"response": "g_function"}, "factors": [
        {"name": "x1", "between": [0, 1], "group": "outer"}, {"name": "x2", "between": [0, 1]},
        {"name": "x3", "between": [0, 1]}, {"name": "x4", "between": [0, 1], "group": "outer"}], "design": )" +
           design + "}";
}

TEST_F(Study, SaltelliIndicesOfAGroupAreThoseOfTheClosedForm) {
    answer_by(store, grouped(R"({"kind": "saltelli", "base_points": 4096})"), g_function);
    const auto responses = ask("g");
    EXPECT_EQ(responses.rows(), 4096U * 5U);
    const auto influence = study::influence_of(responses, responses.observable("y"));
    ASSERT_EQ(influence.factors.size(), 3U);
    const double all = variance_of({0, 1, 2, 3});
    const auto& outer = influence.factors[0];
    EXPECT_EQ(outer.factor, "outer");
    EXPECT_EQ(outer.members, (std::vector<std::string>{"x1", "x4"}));
    EXPECT_NEAR(outer.first.value, variance_of({0, 3}) / all, 0.01);
    EXPECT_NEAR(outer.total.value, (all - variance_of({1, 2})) / all, 0.01);
    EXPECT_NEAR(influence.factors[1].first.value, variance_of({1}) / all, 0.01);
    EXPECT_NEAR(influence.factors[1].total.value, (all - variance_of({0, 2, 3})) / all, 0.01);
    EXPECT_NEAR(influence.factors[2].total.value, (all - variance_of({0, 1, 3})) / all, 0.01);
    EXPECT_LT(outer.total.half_width, 0.02);
    EXPECT_THAT(influence.notes, Contains(HasSubstr("x1, x4 are moved together, as 'outer'")));
}

TEST_F(Study, IshigamiIndicesOfAGroupAreThoseOfTheClosedForm) {
    // y = sin a + 7 sin^2 b + 0.1 c^4 sin a over (-pi, pi): V_1 = (1 + 0.1 pi^4/5)^2/2, V_2 = 49/8,
    // V_13 = 0.01 pi^8 (1/18 - 1/50). The group {a, c} has V_1 + V_13, and so has its total: b stands alone.
    const auto ishigami = [](const Inputs& inputs) {
        const auto z = [&](const char* name) { return std::numbers::pi * (2 * input(inputs, name) - 1); };
        return std::sin(z("x1")) + 7 * std::pow(std::sin(z("x2")), 2) + 0.1 * std::pow(z("x3"), 4) * std::sin(z("x1"));
    };
    answer_by(store, R"({"campaign": "i", "scene": "rehearsal", "fixed": {"response": "ishigami"}, "factors": [
        {"name": "x1", "between": [0, 1], "group": "odd"}, {"name": "x2", "between": [0, 1]},
        {"name": "x3", "between": [0, 1], "group": "odd"}], "design": {"kind": "saltelli", "base_points": 4096}})",
              ishigami);
    const auto responses = ask("i");
    const auto influence = study::influence_of(responses, responses.observable("y"));
    const double pi4 = std::pow(std::numbers::pi, 4);
    const double alone = std::pow(1 + 0.1 * pi4 / 5, 2) / 2, both = 0.01 * pi4 * pi4 * (1.0 / 18 - 1.0 / 50);
    const double all = alone + both + 49.0 / 8;
    ASSERT_EQ(influence.factors.size(), 2U);
    EXPECT_NEAR(influence.factors[0].first.value, (alone + both) / all, 0.02);
    EXPECT_NEAR(influence.factors[0].total.value, (alone + both) / all, 0.02);
    EXPECT_NEAR(influence.factors[1].total.value, 49.0 / 8 / all, 0.02);
}

TEST(Groups, OfMorrisMoveAtOnceAndHaveNoSign) {
    designs::DesignRequest request{.levels = {0, 0, 0, 0},
                                   .options = {{"trajectories", std::int64_t{20}}, {"grid", std::int64_t{4}}}};
    request.groups = {0, 1, 0, 2};
    const auto set = designs::design_named("morris").sample(request);
    ASSERT_EQ(set.size(), 20U * 4U);
    EXPECT_EQ(set.sequences, 4U);
    std::vector<double> values;
    for (std::size_t p = 0; p < set.size(); ++p) {
        const auto x = set.point(p);
        values.push_back(3 * x[0] - 2 * x[1] + 3 * x[2]);
    }
    const auto effects = stats::elementary_effects(set.coordinates, 4, values, request.groups);
    ASSERT_EQ(effects.size(), 3U);
    EXPECT_EQ(effects[0].count, 20);
    EXPECT_TRUE(std::isnan(effects[0].mu));
    EXPECT_TRUE(std::isnan(effects[0].sigma));
    EXPECT_LE(effects[0].mu_star, 6 + 1e-12);  // both up or both down: 6; one up, one down: 0
    EXPECT_GT(effects[0].mu_star, 1);
    EXPECT_NEAR(effects[1].mu, -2, 1e-12);
    EXPECT_NEAR(effects[1].sigma, 0, 1e-12);
    EXPECT_NEAR(effects[2].mu_star, 0, 1e-12);
    EXPECT_THROW((void)stats::elementary_effects(set.coordinates, 4, values), std::invalid_argument);
}

TEST_F(Study, EffectsOfGroupsStandInTablesAndJson) {
    answer_by(store, grouped(R"({"kind": "morris", "trajectories": 12})"), g_function);
    const auto responses = ask("g");
    const auto& y = responses.observable("y");
    const auto influence = study::influence_of(responses, y);
    ASSERT_EQ(influence.factors.size(), 3U);
    ASSERT_TRUE(influence.factors[0].effects);
    EXPECT_EQ(influence.factors[0].effects->count, 12);
    const auto json = report::to_json(responses, y, influence).text();
    EXPECT_THAT(json, HasSubstr(R"("name":"outer","members":["x1","x4"])"));
    std::ostringstream csv;
    report::write(csv, report::influence_document(responses, y, report::Format::csv), report::Format::csv);
    EXPECT_THAT(csv.str(), HasSubstr("g,y,morris,outer,"));
    EXPECT_THAT(csv.str(), testing::Not(HasSubstr("g,y,morris,x1,")));
}

TEST_F(Study, FiguresOfGroupsAreOverTheirFactors) {
    answer_by(store, grouped(R"({"kind": "saltelli", "base_points": 64})"), g_function);
    const auto responses = ask("g");
    const report::FigureSubject subject{store, responses, responses.observable("y")};
    const auto cases = report::figure_named(subject, "cases").panels.front();
    EXPECT_EQ(cases.x.title, "x1") << "the first factor of the group that explains most";
    EXPECT_EQ(report::figure_named(subject, "map").panels.front().y.title, "x4");
}

}  // namespace grainsweep::tests::report_groups_test
