// Accuracy settings of a program: pairs of cases with the same points and seeds, corrected means, and the error of each
// setting. Processes of a case count against the cores.
#include "tests/support/program_campaigns.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace grainsweep::tests::program_accuracy_test {

using nlohmann::json;
using testing::HasSubstr;

/// The mean of exp(x t) over t from 0 to 1, by the middles of so many cells.
const std::string midpoints =
    "awk -v x=\"$1\" -v n=\"$2\" 'BEGIN { for (i = 0; i < n; i++) s += exp(x * (i + 0.5) / n) / n; "
    "printf \"{\\\"y\\\": %.17g}\\n\", s }' > out.json\n";

json cells_campaign() {
    auto campaign =
        script_campaign(400, {{"command", {"sh", "script.sh", "{x}", "{cells}"}},
                              {"parameters", {{"x", {{"unit", "1"}}}, {"cells", {{"unit", "1"}, {"whole", true}}}}},
                              {"accuracy",
                               {{"coarse", {{"cells", 2}, {"cost_seconds", 0.01}}},
                                {"fine", {{"cells", 64}, {"cost_seconds", 1}}},
                                {"reference", "fine"}}}});
    campaign["factors"][0]["between"] = {0, 3};
    campaign["design"] = {{"kind", "halton"}, {"sequences", 8}, {"points", 400}};
    return campaign;
}

struct ProgramAccuracy : testing::Test {
    Folder folder;
    [[nodiscard]] json answer(std::vector<std::string> arguments) const {
        arguments.insert(arguments.end(), {"--format", "json"});
        const auto ended = run_program(arguments, folder.path());
        EXPECT_EQ(ended.code, 0) << ended.err;
        return json::parse(ended.out, nullptr, false);
    }
};

TEST_F(ProgramAccuracy, AGoalIsMetByPairsOfOnePoint) {
    auto campaign = cells_campaign();
    campaign["accuracy"] = {{"observable", "y"}, {"gates", {"mean"}}, {"tolerance", 0.02}};
    const auto ended = run_script(folder, midpoints, campaign, {"-j", "2", "--quiet", "--format", "json"});
    ASSERT_EQ(ended.code, 0) << ended.err;
    EXPECT_EQ(json::parse(ended.out)["converged"], true) << ended.out;
    const auto found = answer({"converge", "p.db", "--campaign", "p"}).at(0).at("corrected");
    EXPECT_EQ(found["setting"], "coarse");
    // The mean of (exp(x) - 1) / x over x from 0 to 3; twice the 95 % half-width, because the seed is one of many.
    constexpr double exact = 2.7527;
    const auto& mean = found["statistics"]["mean"];
    EXPECT_NEAR(mean["value"].get<double>(), exact, 2 * mean["error"].get<double>());
    EXPECT_LE(mean["error"].get<double>(), 0.02 * exact);
    const auto pairs = rows_of(folder,
                               "SELECT count(*) AS pairs, sum(r.seed = p.seed) AS common, sum(r.y > p.y) AS above FROM "
                               "p JOIN p_reference AS r USING (point)")[0];
    EXPECT_EQ(pairs["pairs"], found["pairs"]);
    EXPECT_EQ(pairs["common"], pairs["pairs"]) << "one seed for both";
    EXPECT_EQ(pairs["above"], pairs["pairs"]) << "middles of cells lie below";
}

TEST_F(ProgramAccuracy, ASettingIsChosenByItsName) {
    auto campaign = cells_campaign();
    campaign["design"] = {{"kind", "halton"}, {"points", 4}};
    ASSERT_EQ(run_script(folder, midpoints, campaign).code, 0);
    EXPECT_EQ(rows_of(folder, "SELECT DISTINCT value FROM inputs WHERE name = 'cells'")[0]["value"], 64)
        << "without a word the results are the standard";
    campaign["campaign"] = "q";
    campaign["accuracy"] = "coarse";
    ASSERT_EQ(run_script(folder, midpoints, campaign, {"-j", "2", "--db", "p.db"}).code, 0);
    EXPECT_EQ(rows_of(folder, "SELECT DISTINCT value FROM inputs WHERE name = 'cells' ORDER BY 1")[0]["value"], 2);

    const auto found = answer({"accuracy", "c.json", "--points", "4", "--quiet"});
    ASSERT_TRUE(found.contains("settings"));
    EXPECT_EQ(found["settings"][0]["setting"], "coarse");
    const double bias = found["settings"][0]["biases"][0]["bias"];
    EXPECT_LT(bias, -0.01);
    EXPECT_GT(bias, -0.5);
}

TEST_F(ProgramAccuracy, ProcessesCountAgainstTheCores) {
    auto campaign = script_campaign(3, {{"command", {"sh", "script.sh", "{x}", "{processes}", "{threads}"}},
                                        {"processes", 4096},
                                        {"cores", 2},
                                        {"environment", {{"ALONE", (folder / "alone").string()}}}});
    campaign["limits"]["attempts"] = 1;
    // A case fails beside another one. Without -j there is one worker, because no machine has cores for two such cases.
    const auto alone =
        "mkdir \"$ALONE\" || exit 1\nsleep 0.2\necho \"{\\\"y\\\": $(($2 * $3))}\" > out.json\n"
        "rmdir \"$ALONE\"\n";
    const auto ended = run_script(folder, alone, campaign, {"--quiet"});
    EXPECT_EQ(ended.code, 0) << ended.out;
    EXPECT_EQ(rows_of(folder, "SELECT DISTINCT y FROM p")[0]["y"], 8192);
}

}  // namespace grainsweep::tests::program_accuracy_test
