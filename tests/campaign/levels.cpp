// Quantiles and probabilities through the real program: converge, JSON, SQL, gates of a rule, failures, wrong words.
#include "tests/support/commands.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

namespace grainsweep::tests::levels_test {

using nlohmann::json;
using testing::HasSubstr;

using Levels = CommandsInAFolder;

/// y = 7.5 + x1.
json campaign_of(int points, const json& gates) {
    return {{"campaign", "c"},
            {"scene", "rehearsal"},
            {"factors", {{{"name", "x1"}, {"between", {0, 1}}}}},
            {"design", {{"kind", "sobol"}, {"points", points}, {"sequences", 8}, {"scramble", "random"}}},
            {"convergence", {{"observable", "y"}, {"gates", gates}, {"tolerance", 0.05}, {"block", 64}}}};
}

TEST_F(Levels, AreShownWithTheirErrorsInEveryForm) {
    auto config = campaign_of(256, {"mean", "quantile:0.9", "above:8"});
    config["convergence"]["stop"] = false;
    folder.write("c.json", config.dump());
    out({"run", "c.json", "--quiet"});
    const auto text = out({"converge", "c.db"});
    EXPECT_THAT(text, HasSubstr("90 % quantile"));
    EXPECT_THAT(text, HasSubstr("P(y > 8)"));
    EXPECT_THAT(text, HasSubstr("5 % quantile"));
    const auto found = json::parse(
        out({"converge", "c.db", "--statistic", "below:7.6", "--statistic", "quantile:0.25", "--format", "json"}));
    const auto& levels = found.at(0).at("distribution");
    ASSERT_EQ(levels.size(), 4U);  // the gates, and those that were wanted
    const auto near = [&](std::size_t k, const std::string& name, double truth) {
        EXPECT_EQ(levels[k]["statistic"], name);
        const double error = levels[k]["error"].get<double>();
        EXPECT_GT(error, 0);
        EXPECT_NEAR(levels[k]["value"].get<double>(), truth, error) << name;
        EXPECT_NEAR(levels[k]["model_assisted"]["value"].get<double>(), truth, 0.02) << name;
        EXPECT_TRUE(levels[k]["of_all_cases"].is_null());
    };
    near(0, "quantile:0.9", 8.4);
    near(1, "above:8", 0.5);
    near(2, "below:7.6", 0.1);
    near(3, "quantile:0.25", 7.75);
    const auto row = json::parse(out({"query", "c.db",
                                      "SELECT quantile(y, 0.9) AS q, quantile_error(y, 0.9, sequence) AS e, "
                                      "above(y, 8) AS p, above_error(y, 8, sequence) AS pe FROM c",
                                      "--format", "json"}))
                         .at(0);
    EXPECT_DOUBLE_EQ(row["q"].get<double>(), levels[0]["value"].get<double>());
    EXPECT_DOUBLE_EQ(row["e"].get<double>(), levels[0]["error"].get<double>());
    EXPECT_DOUBLE_EQ(row["p"].get<double>(), levels[1]["value"].get<double>());
    EXPECT_DOUBLE_EQ(row["pe"].get<double>(), levels[1]["error"].get<double>());
    out({"report", "c.db", "-o", "c.html"});
}

TEST_F(Levels, StopACampaign) {
    folder.write("c.json", campaign_of(1024, {"quantile:0.9", "above:8"}).dump());
    const auto ended = ask({"run", "c.json"});
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_THAT(out({"converge", "c.db"}), HasSubstr("above:8"));
    EXPECT_THAT(out({"query", "c.db", "SELECT count(*) < 1024 AS stopped FROM c WHERE outcome = 'completed'",
                     "--format", "csv"}),
                HasSubstr("stopped\n1"));
    EXPECT_EQ(ask({"run", "c.json", "--quiet"}).code, 0);
}

TEST_F(Levels, WrongOnesAreRefused) {
    const auto refusal = [&](const json& gates, const std::string& rule = "replicates") {
        auto config = campaign_of(256, gates);
        config["convergence"]["rule"] = rule;
        folder.write("c.json", config.dump());
        const auto ended = ask({"run", "c.json"});
        EXPECT_EQ(ended.code, 2);
        return ended.err;
    };
    EXPECT_THAT(refusal({"quantile:90"}), HasSubstr("must be a quantile with a probability between 0 and 1"));
    EXPECT_THAT(refusal({"quantil:0.9"}), HasSubstr("'quantile:'"));
    EXPECT_THAT(refusal({"above:8", "above:8.0"}), HasSubstr("this statistic is there twice"));
    EXPECT_THAT(refusal({"above:8"}, "assisted"), HasSubstr("judges moments"));
    folder.write("c.json", campaign_of(64, {"mean"}).dump());
    out({"run", "c.json", "--quiet"});
    const auto ended = ask({"converge", "c.db", "--statistic", "q90"});
    EXPECT_EQ(ended.code, 2);
    EXPECT_THAT(ended.err, HasSubstr("quantile:P"));
}

}  // namespace grainsweep::tests::levels_test
