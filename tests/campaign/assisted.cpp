// Campaigns that stop by the rule `assisted`: earlier than by plain errors, with the truth within theirs, and at the
// same point however they were run.
#include "tests/support/progress.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <csignal>
#include <string>

namespace grainsweep::tests::assisted_test {

/// y = (6 + x1 + ... + x4) (1 + e), e even in [-0.005, 0.005].
std::string config(const std::string& rule, const std::string& more = "") {
    return R"({
      "campaign": "sum", "scene": "rehearsal",
      "factors": [{"name": "x1", "between": [0, 1]}, {"name": "x2", "between": [0, 1]},
                  {"name": "x3", "between": [0, 1]}, {"name": "x4", "between": [0, 1]}],
      "fixed": {"response": "sum", "noise": 0.005, "wait_seconds": 0.004},
      "design": {"kind": "halton", "sequences": 8, "points": 384}, )" +
           more + R"("convergence": {"observable": "y", "rule": ")" + rule + R"(", "tolerance": 0.03, "block": 32}})";
}

Ended run(const Folder& folder, const std::string& db, const std::string& workers, int code = 0) {
    const auto ended = run_program({"run", (folder / "c.json").string(), "--db", (folder / db).string(), "-j", workers},
                                   folder.path());
    EXPECT_EQ(ended.code, code) << ended.err;
    return ended;
}

std::string output(const Folder& folder, const std::vector<std::string>& arguments) {
    const auto ended = run_program(arguments, folder.path());
    EXPECT_EQ(ended.code, 0) << ended.err;
    return ended.out;
}

TEST(Assisted, StopsWherePlainErrorsAreFarFromItAndTheTruthIsWithinItsErrors) {
    const Folder folder;
    folder.write("c.json", config("assisted"));
    const auto ended = run(folder, "a.db", "2");
    const auto found = nlohmann::json::parse(output(folder, {"converge", "a.db", "--format", "json"}));
    const auto& judged = found.is_array() ? found.at(0) : found;
    EXPECT_EQ(judged.at("rule"), "assisted");
    ASSERT_TRUE(judged.at("converged").get<bool>()) << judged.dump(1);
    EXPECT_LT(judged.at("converged_at").get<int>(), 384);  // all that the plain rule has below
    const auto& at_the_stop = judged.at("checks").back();
    EXPECT_EQ(at_the_stop.at("converged"), 1);
    // Scatter of variance y^2 0.005^2/3 is in the truth.
    const std::array<std::pair<const char*, double>, 4> truth = {
        {{"mean", 8.0}, {"sd", 0.57781}, {"g1", 0.0007}, {"kurtosis", 2.7010}}};
    for (const auto& [name, value] : truth) {
        const double error = at_the_stop.at(std::string(name) + "_error").get<double>();
        // 1.5 half-widths: three standard errors, as it is one campaign.
        EXPECT_LE(std::abs(at_the_stop.at(name).get<double>() - value), 1.5 * error) << name;
        const auto& plain = judged.at("statistics").at(name).at("error");
        const bool spread = std::string(name) == "mean" || std::string(name) == "sd";
        EXPECT_TRUE(!spread || plain.is_number()) << name;  // g1 and kurtosis wait for more points
        if (plain.is_number()) {
            EXPECT_LT(error, plain.get<double>()) << name;
        }
    }
    EXPECT_NE(output(folder, {"converge", "a.db"}).find("converged at "), std::string::npos);
    EXPECT_NE(output(folder, {"report", "a.db", "-o", "a.html"}).find("a.html"), std::string::npos);

    folder.write("c.json", config("replicates"));
    (void)run(folder, "plain.db", "2", 0);
    const auto other = nlohmann::json::parse(output(folder, {"converge", "plain.db", "--format", "json"}));
    EXPECT_FALSE((other.is_array() ? other.at(0) : other).at("converged").get<bool>());
}

TEST(Assisted, StopsAtTheSamePointWithOneAndTwoWorkersAndAfterAKill) {
    const Folder folder;
    folder.write("c.json", config("assisted", R"("model": {"features": ["x1 + x2", "x3", "x4", "x1 - x2"]}, )"));
    (void)run(folder, "one.db", "1");
    (void)run(folder, "two.db", "2");
    const auto calm = output(folder, {"dump", "one.db"});
    EXPECT_NE(calm.find("stopped_at="), std::string::npos);
    EXPECT_EQ(calm, output(folder, {"dump", "two.db"}));
    for (const int after : {60, 135}) {
        const std::string db = "killed" + std::to_string(after) + ".db";
        {
            Process killed(
                program_command({"run", (folder / "c.json").string(), "--db", (folder / db).string(), "-j", "2"}),
                folder.path());
            await_settled(killed, folder / db, after);
            killed.signal(SIGKILL);
            killed.wait();
        }
        (void)run(folder, db, "2");
        EXPECT_EQ(calm, output(folder, {"dump", db})) << "killed after " << after;
    }
}

TEST(Assisted, WhatCannotBeJudgedIsRefusedInOneSentence) {
    const Folder folder;
    const auto refused = [&](const std::string& text) {
        folder.write("c.json", text);
        const auto ended = run_program({"run", "c.json", "--db", "x.db"}, folder.path());
        EXPECT_EQ(ended.code, 2);
        return ended.err;
    };
    const std::string undefined = R"x("model": {"features": ["log(x1 - 0.5)"]}, )x";
    EXPECT_NE(refused(config("assisted", undefined)).find("is undefined"), std::string::npos);
    auto skewness = config("assisted");
    skewness.replace(skewness.find("\"tolerance\""), 0, R"x("gates": ["mean", "skewness"], )x");
    EXPECT_NE(refused(skewness).find("has no model-assisted estimate: take g1"), std::string::npos);
    auto few = config("assisted");
    few.replace(few.find("\"sequences\": 8"), 14, "\"sequences\": 2");
    EXPECT_NE(refused(few).find("$.convergence.rule"), std::string::npos);
}

}  // namespace grainsweep::tests::assisted_test
