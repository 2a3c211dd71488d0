// Factors that follow a distribution or a sample: what is read, what is asked of the scene, what an archive keeps.
#include "sweep/campaign/identity.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/reader.hpp"
#include "sweep/campaign/sections.hpp"
#include "sweep/campaign/stated_distribution.hpp"
#include "sweep/campaign/stored_identity.hpp"
#include "tests/support/process.hpp"
#include "tests/support/stored_both_ways.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace grainsweep::tests::campaign_distributions_test {

using namespace campaign;
using testing::HasSubstr;

std::string file_of(const std::string& factors, const std::string& design = R"({"kind": "halton", "points": 16})") {
    return R"({"campaign": "c", "scene": "rehearsal", "factors": [)" + factors + R"(], "design": )" + design + "}";
}

Campaign read(const std::string& factors, const std::filesystem::path& folder = ".",
              const std::string& design = R"({"kind": "halton", "points": 16})") {
    return parse_campaign(file_of(factors, design), folder);
}

std::string refusal(const std::function<void()>& ask) {
    try {
        ask();
    } catch (const InputError& wrong) {
        return wrong.what();
    }
    return "accepted";
}

const std::string five = R"({"name": "x1", "normal": {"mean": "50 %", "sd": 0.12}},
    {"name": "x2", "lognormal": {"median": 0.2, "sigma": 0.25}}, {"name": "x3", "triangular": {"low": 0.1, "mode": 0.2, "high": 0.9}},
    {"name": "x4", "beta": {"low": 0, "high": 0.5, "a": 2, "b": 5}}, {"name": "x5", "uniform": {"low": 0.25, "high": "75 %"}})";

// A standard deviation, a step or an error of 5 degC is one of 5 K.
TEST(Distributions, DifferencesOfTemperaturesHaveNoOffset) {
    const ParameterSpec kelvin{"t", "K", {}, 0.0, Interval{-1e9, 1e9}, {}},
        celsius{"t", "degC", {}, 0.0, Interval{-1e9, 1e9}, {}};
    const auto read_as = [](const char* text, const ParameterSpec& parameter, Reads reads) {
        const nlohmann::json json = text;
        return std::get<double>(read_value(Cursor(json, "$"), parameter, {}, reads));
    };
    EXPECT_NEAR(read_as("20 degC", kelvin, Reads::value), 293.15, 1e-9);
    EXPECT_NEAR(read_as("5 degC", kelvin, Reads::difference), 5, 1e-9);
    EXPECT_NEAR(read_as("5 K", celsius, Reads::difference), 5, 1e-9);
    EXPECT_EQ(read_as("5 K", kelvin, Reads::difference), 5);
    EXPECT_EQ(read_as("5", celsius, Reads::difference), 5);
}

TEST(Distributions, AreReadWithTheirUnits) {
    const auto factors = read(five).space.factors;
    ASSERT_EQ(factors.size(), 5U);
    EXPECT_EQ(factors[0].range, (decltype(Factor::range){stats::Distribution(stats::Normal{0.5, 0.12}, 0, 1)}));
    EXPECT_EQ(factors[1].range, (decltype(Factor::range){stats::Distribution(stats::Lognormal{0.2, 0.25}, 0, 1)}));
    EXPECT_EQ(factors[2].range, (decltype(Factor::range){stats::Distribution(stats::Triangular{0.1, 0.2, 0.9})}));
    EXPECT_EQ(factors[3].range, (decltype(Factor::range){stats::Distribution(stats::Beta{0, 0.5, 2, 5})}));
    EXPECT_EQ(factors[4].range, (decltype(Factor::range){Between{0.25, 0.75, Scale::linear}}));
    const auto ratio = read(R"({"name": "x1", "lognormal": {"median": 0.2, "ratio": 1.5}})").space.factors[0];
    EXPECT_EQ(ratio.range, (decltype(Factor::range){stats::Distribution(stats::Lognormal{0.2, std::log(1.5)}, 0, 1)}));
    for (const auto& [text, form] : {std::pair<const char*, stats::Distribution::Form>(
                                         R"({"weibull": {"scale": "20 %", "shape": 3}})", stats::Weibull{0.2, 3}),
                                     {R"({"gumbel": {"location": 0.5, "scale": 0.05}})", stats::Gumbel{0.5, 0.05}}}) {
        std::string factor = text;
        const auto read_back = read(factor.insert(1, R"("name": "x1", )")).space.factors[0];
        EXPECT_EQ(read_back.range, (decltype(Factor::range){stats::Distribution(form, 0, 1)})) << text;
        const auto stated = stated_text(std::get<stats::Distribution>(read_back.range));
        EXPECT_EQ(std::get<stats::Distribution>(distribution_in(stated)), stats::Distribution(form, 0, 1)) << stated;
    }
}

TEST(Distributions, AStatedLengthWithAUnitIsInMetres) {
    const auto campaign = parse_campaign(
        R"({"campaign": "c", "scene": "powder_spreading", "factors": [{"name": "diameter", "normal": {"mean": "34 um", "sd": "3 um"}}],
            "design": {"kind": "halton", "points": 8}})",
        ".");
    EXPECT_THAT(texts_of(identity_of(campaign)).factors, testing::StartsWith("diameter normal 3.4e-05 3e-06 within "));
}

TEST(Distributions, ComeBackFromTheArchiveAsTheyWereAsked) {
    const auto campaign = read(five);
    const auto identity = identity_of(campaign);
    const auto stored = stored_both_ways(identity);
    EXPECT_EQ(stored.factors, campaign.space.factors);
    const auto request = request_of(stored);
    for (std::size_t j = 0; j < 5; ++j) {
        EXPECT_EQ(request.factors[j].number(0.3), campaign.request.factors[j].number(0.3));
        EXPECT_EQ(request.factors[j].endless(), j < 2);
    }
}

TEST(Distributions, UniformIsTheSameCampaignAsBetween) {
    const auto between = read(R"({"name": "x1", "between": [0.25, 0.75]})");
    const auto uniform = read(R"({"name": "x1", "uniform": {"low": 0.25, "high": 0.75}})");
    EXPECT_EQ(texts_of(identity_of(uniform)).factors, "x1 between 0.25 0.75 linear\n");
    EXPECT_EQ(unfold(uniform, {})[3].question.id, unfold(between, {})[3].question.id);
}

TEST(Distributions, ADesignAsksTheirQuantiles) {
    const auto campaign = read(five);
    const auto cases = unfold(campaign, {});
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const auto set = designs::design_named("halton").sample(campaign.request);
        const auto question = cases[i].question;
        const auto& normal = std::get<stats::Distribution>(campaign.space.factors[0].range);
        EXPECT_EQ(std::get<double>(question.inputs.at("x1")), normal.quantile(set.point(i)[0]));
    }
}

TEST(Distributions, ALatticeHasTheirQuantilesForLevelsWhereNoneIsAnEnd) {
    const std::string normal = R"({"name": "x1", "normal": {"mean": 0.5, "sd": 0.1}})";
    const auto centred = read(normal, ".", R"({"kind": "lattice", "levels": 4, "placement": "centred"})");
    const auto cases = unfold(centred, {});
    const stats::Distribution distribution(stats::Normal{0.5, 0.1}, 0, 1);
    for (std::size_t i = 0; i < 4; ++i)
        EXPECT_EQ(std::get<double>(cases[i].question.inputs.at("x1")),
                  distribution.quantile((static_cast<double>(i) + 0.5) / 4));
    const auto ends = read(normal, ".", R"({"kind": "lattice", "levels": 4})");
    EXPECT_EQ(refusal([&] { (void)unfold(ends, {}); }),
              "$.design: got lattice; its point 0 stands at an end of factor 'x1', whose distribution has none: give "
              "\"placement\": \"centred\" to a lattice, \"scramble\": \"random\" to a sequence, or \"between\" to the "
              "factor.");
    const auto sobol = read(normal, ".", R"({"kind": "sobol", "points": 4, "scramble": "none"})");
    EXPECT_THAT(refusal([&] { (void)unfold(sobol, {}); }), HasSubstr("whose distribution has none"));
    const auto closed = read(R"({"name": "x1", "triangular": {"low": 0, "mode": 0.5, "high": 1}})", ".",
                             R"({"kind": "lattice", "levels": 3})");
    EXPECT_EQ(std::get<double>(unfold(closed, {})[2].question.inputs.at("x1")), 1);
}

TEST(Distributions, MorrisStepsFromQuantileToQuantile) {
    const auto campaign = read(
        R"({"name": "x1", "normal": {"mean": 0.5, "sd": 0.1}}, {"name": "x2", "triangular": {"low": 0, "mode": 0.5, "high": 1}})",
        ".", R"({"kind": "morris", "trajectories": 20})");
    std::set<double> normal, triangular;
    const auto set = designs::design_named("morris").sample(campaign.request);
    for (std::size_t p = 0; p < set.size(); ++p) {
        normal.insert(set.point(p)[0]);
        triangular.insert(set.point(p)[1]);
    }
    EXPECT_EQ(normal, (std::set{0.125, 0.375, 0.625, 0.875}));
    EXPECT_EQ(triangular, (std::set{0.0, 1.0 / 3, 2.0 / 3, 1.0}));
    (void)unfold(campaign, {});
}

TEST(Distributions, AnotherOneIsAnotherCampaign) {
    const auto identity = [](const std::string& range) {
        return identity_of(read(R"({"name": "x1", )" + range + "}"));
    };
    const auto normal = identity(R"("normal": {"mean": 0.5, "sd": 0.1})");
    EXPECT_EQ(
        refusal([&] { require_same(normal, identity(R"("normal": {"mean": 0.5, "sd": 0.11})"), "a.db"); }),
        "$.factors: got x1 normal 0.5 0.11 within 0 1; campaign 'c' stands in 'a.db' with factor x1 normal 0.5 0.1 "
        "within 0 1: another question needs another name.");
    EXPECT_THAT(refusal([&] { require_same(normal, identity(R"("between": [0, 1])"), "a.db"); }),
                HasSubstr("another question needs another name"));
    require_same(normal, normal, "a.db");
}

struct Samples : testing::Test {
    Folder folder;
    Samples() {
        folder.write("posterior.csv",
                     "x3,x1,weight,x2\n0.1,0.2,1,0.3\n0.4,0.5,1,0.6\n0.7,0.8,1,0.85\n0.75,0.9,1,0.95\n");
        folder.write("measured.csv", "friction\n0.31\n0.28\n30 %\n");
    }
};

TEST_F(Samples, FactorsOfOneFileTakeItsRows) {
    const auto campaign = read(R"({"name": "x1", "sample": "posterior.csv"}, {"name": "x5", "between": [0, 1]},
        {"name": "x2", "sample": {"file": "./posterior.csv"}})",
                               folder.path());
    const auto cases = unfold(campaign, {});
    const std::set<std::pair<double, double>> rows = {{0.2, 0.3}, {0.5, 0.6}, {0.8, 0.85}, {0.9, 0.95}};
    std::set<std::pair<double, double>> met;
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const auto inputs = cases[i].question.inputs;
        met.emplace(std::get<double>(inputs.at("x1")), std::get<double>(inputs.at("x2")));
    }
    EXPECT_EQ(met, rows);
}

TEST_F(Samples, AColumnAloneGivesItsQuantilesAndMayHaveAnotherName) {
    const auto campaign =
        read(R"({"name": "x1", "sample": {"file": "measured.csv", "column": "friction"}})", folder.path());
    EXPECT_EQ(campaign.request.factors[0].number(0), 0.28);
    EXPECT_EQ(campaign.request.factors[0].number(0.5), 0.3);
    EXPECT_EQ(campaign.request.factors[0].number(1), 0.31);
}

TEST_F(Samples, TheArchiveKeepsThem) {
    const auto campaign =
        read(R"({"name": "x2", "sample": "posterior.csv"}, {"name": "x1", "sample": "posterior.csv"})", folder.path());
    const auto identity = identity_of(campaign);
    const auto again = stored_both_ways(identity).factors;
    EXPECT_EQ(again, campaign.space.factors);
    const double u[] = {0.6, 0.2};
    for (std::size_t j = 0; j < 2; ++j) {
        EXPECT_EQ(value_at(again, j, u), value_at(campaign.space.factors, j, u));
    }
    folder.write("posterior.csv", "x1,x2\n0.2,0.3\n0.5,0.6\n0.8,0.85\n0.9,0.9500001\n");
    const auto changed =
        read(R"({"name": "x2", "sample": "posterior.csv"}, {"name": "x1", "sample": "posterior.csv"})", folder.path());
    EXPECT_THAT(
        refusal([&] { require_same(identity, identity_of(changed), "a.db"); }),
        testing::MatchesRegex(R"(\$\.factors: got x2 sample 2 of 2 in [0-9a-f]+; campaign 'c' stands in 'a.db' with )"
                              R"(factor x2 sample 2 of 2 in [0-9a-f]+: another question needs another name\.)"));
}

TEST_F(Samples, TheOrderOfTheFactorsSaysNothingAboutTheRows) {
    auto turned =
        read(R"({"name": "x2", "sample": "posterior.csv"}, {"name": "x1", "sample": "posterior.csv"})", folder.path());
    const auto straight =
        read(R"({"name": "x1", "sample": "posterior.csv"}, {"name": "x2", "sample": "posterior.csv"})", folder.path());
    const std::vector<std::string> order = {"x1", "x2"};
    ASSERT_TRUE(reorder_factors(turned, order));
    EXPECT_EQ(identity_of(turned).factors, identity_of(straight).factors);
    EXPECT_EQ(unfold(turned, {})[5].question.id, unfold(straight, {})[5].question.id);
}

TEST_F(Samples, ARowOfAListMayBeAnyValueBetweenTheEndsOfEachColumn) {
    const std::string factor = R"({"name": "x1", "sample": "posterior.csv"})";
    (void)read(factor, folder.path(), R"({"kind": "list", "rows": [[0.33]]})");
    EXPECT_EQ(refusal([&] { (void)read(factor, folder.path(), R"({"kind": "list", "rows": [[0.1]]})"); }),
              "$.design.rows[0][0]: got 0.1; factor 'x1' goes from 0.2 to 0.9.");
}

}  // namespace grainsweep::tests::campaign_distributions_test
