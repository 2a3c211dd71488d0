// Factors that follow a distribution or a sample, through the real program: plan, run, statistics, window, prediction,
// and a database that needs the file of the sample no more.
#include "tests/support/commands.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace grainsweep::tests::distributions_test {

using nlohmann::json;
using testing::HasSubstr;

using Distributions = CommandsInAFolder;

json campaign_of(const json& factors) {
    return {{"campaign", "c"},
            {"scene", "rehearsal"},
            {"factors", factors},
            {"design", {{"kind", "halton"}, {"points", 64}, {"sequences", 4}}}};
}

const json two = {{{"name", "x1"}, {"normal", {{"mean", 0.5}, {"sd", 0.25}}}},
                  {{"name", "x2"}, {"triangular", {{"low", 0}, {"mode", 0.25}, {"high", "50 %"}}}}};

TEST_F(Distributions, PlanDrawsThemAndStatesWhatTheBoundsCutOff) {
    folder.write("c.json", campaign_of(two).dump());
    const auto text = out({"plan", "c.json"});
    EXPECT_THAT(text, HasSubstr("normal, mean 0.5, sd 0.25"));
    EXPECT_THAT(text, HasSubstr("triangular, low 0, mode 0.25, high 0.5"));
    const auto plan = json::parse(out({"plan", "c.json", "--format", "json"}));
    const auto& normal = plan["distributions"][0];
    EXPECT_NEAR(normal["cut %"], 4.550026389635842, 1e-9);
    EXPECT_NEAR(normal["50 %"], 0.5, 1e-12);
    EXPECT_EQ(plan["distributions"][1]["cut %"], 0);
    EXPECT_NEAR(plan["distributions"][1]["5 %"], std::sqrt(0.05 * 0.5 * 0.25), 1e-12);
}

TEST_F(Distributions, StatisticsWindowAndPredictionAreOverThem) {
    folder.write("c.json", campaign_of(two).dump());
    out({"run", "c.json", "--quiet"});
    const auto moments = json::parse(out({"converge", "c.db", "--format", "json"}));
    EXPECT_THAT(moments.dump(), HasSubstr("\"mean\""));
    const auto window = out({"window", "c.db", "--where", "x1 >= 0.5", "--maximize", "y"});
    EXPECT_THAT(window, HasSubstr("in 50.0 +- 1.5 % of the distribution of the factors"));
    EXPECT_EQ(ask({"predict", "c.db", "--at", "x1=0.5", "--at", "x2=0.2"}).code, 0);
    const auto beyond = ask({"predict", "c.db", "--at", "x1=0.5", "--at", "x2=0.6"});
    EXPECT_EQ(beyond.code, 2);
    EXPECT_THAT(beyond.err, HasSubstr("x2 = 0.6 is outside of 0 to 0.5"));
    out({"report", "c.db", "-o", "c.html"});
    out({"sensitivity", "c.db"});
    auto wider = campaign_of(two);
    wider["factors"][0]["normal"]["sd"] = 0.2;
    folder.write("c.json", wider.dump());
    const auto refused = ask({"run", "c.json", "--quiet"});
    EXPECT_EQ(refused.code, 2);
    EXPECT_THAT(refused.err, HasSubstr("got x1 normal 0.5 0.2 within 0 1; campaign 'c' stands in 'c.db' with factor x1 "
                                       "normal 0.5 0.25 within 0 1: another question needs another name."));
}

TEST_F(Distributions, ASampleIsKeptInTheDatabase) {
    std::string rows = "x2,x1\n";
    for (int i = 0; i < 200; ++i) {
        const double a = (i + 0.5) / 200;
        rows += std::to_string(a * a) + "," + std::to_string(a) + "\n";
    }
    folder.write("posterior.csv", rows);
    folder.write("c.json", campaign_of({{{"name", "x1"}, {"sample", "posterior.csv"}},
                                        {{"name", "x2"}, {"sample", "posterior.csv"}}})
                               .dump());
    EXPECT_THAT(out({"plan", "c.json"}), HasSubstr("column 1 of 2 of a sample of 200 rows"));
    out({"run", "c.json", "--quiet"});
    EXPECT_EQ(out({"query", "c.db", "SELECT max(abs(x2 - x1*x1)) < 1e-5 AS on_the_curve FROM c", "--format", "csv"}),
              "on_the_curve\n1\n");
    const auto before = out({"sensitivity", "c.db", "--format", "json"});
    std::filesystem::remove(folder / "posterior.csv");
    EXPECT_EQ(out({"sensitivity", "c.db", "--format", "json"}), before);
    out({"report", "c.db", "-o", "c.html"});
    const auto again = ask({"run", "c.json", "--quiet"});
    EXPECT_EQ(again.code, 2);
    EXPECT_THAT(again.err, HasSubstr("there is no such file beside the campaign file"));
    folder.write("posterior.csv", rows + "0.5,0.7\n");
    const auto changed = ask({"run", "c.json", "--quiet"});
    EXPECT_EQ(changed.code, 2);
    EXPECT_THAT(changed.err, HasSubstr("another question needs another name"));
}

TEST_F(Distributions, WrongOnesAreRefusedAndNothingIsWritten) {
    auto wrong = campaign_of(two);
    wrong["factors"][0]["normal"]["sd"] = 2;
    folder.write("c.json", wrong.dump());
    const auto ended = ask({"run", "c.json"});
    EXPECT_EQ(ended.code, 2);
    EXPECT_THAT(ended.err, HasSubstr("at most 5 % may, unless \"low\" or \"high\" truncates the distribution there."));
    wrong["factors"][0]["normal"].update({{"low", 0.9}, {"high", 0.1}});
    folder.write("c.json", wrong.dump());
    EXPECT_THAT(ask({"run", "c.json"}).err, HasSubstr("low must be below high"));
    EXPECT_FALSE(std::filesystem::exists(folder / "c.db"));
}

TEST_F(Distributions, MayBeTruncatedAsFarAsTheUserStates) {
    auto wide = campaign_of(two);
    wide["factors"][0]["normal"] = {{"mean", 0.5}, {"sd", 2}, {"low", 0.4}, {"high", 0.6}};
    folder.write("c.json", wide.dump());
    const auto plan = json::parse(out({"plan", "c.json", "--format", "json"}));
    // 1 - (Phi(0.05) - Phi(-0.05))
    EXPECT_NEAR(plan["distributions"][0]["cut %"].get<double>(), 96.01223886, 1e-6);
    out({"run", "c.json", "--quiet"});
    EXPECT_EQ(out({"query", "c.db", "SELECT min(x1) >= 0.4 AND max(x1) <= 0.6 AS within FROM c", "--format", "csv"}),
              "within\n1\n");
    EXPECT_EQ(ask({"run", "c.json", "--quiet"}).code, 0);
}

TEST_F(Distributions, ACalibrationTakesThemForItsPrior) {
    folder.write("c.json", json{{"campaign", "c"},
                                {"scene", "rehearsal"},
                                {"factors", {{{"name", "x1"}, {"normal", {{"mean", 0.5}, {"sd", 0.1}}}}}},
                                {"calibration",
                                 {{"targets", {{{"observable", "y"}, {"value", 8.1}, {"error", 0.1}}}},
                                  {"discrepancy", {{"y", 0.001}}},
                                  {"points_per_wave", 12},
                                  {"waves", 2},
                                  {"checks", 4}}}}
                               .dump());
    out({"calibrate", "c.json", "--quiet"});
    const auto found = json::parse(out({"converge", "c.db", "--format", "json"}))[0];
    // y = x1 + 7.5: the prior N(0.5, 0.1^2) and the measurement 0.6 with error 0.1 meet in the middle.
    EXPECT_NEAR(found["posterior"][0]["mean"].get<double>(), 0.55, 0.01);
    EXPECT_NEAR(found["posterior"][0]["sd"].get<double>(), 0.1 / std::sqrt(2.0), 0.007);
}

}  // namespace grainsweep::tests::distributions_test
