// A refine design through the real program: rounds, interruption, any number of workers, refusals.
#include "tests/support/process.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>

namespace grainsweep::tests::refine_test {

using ::testing::HasSubstr;

std::string config(const std::string& options, const std::string& more = "") {
    return R"({"campaign": "cliff", "scene": "rehearsal",
  "factors": [{"name": "x2", "levels": [0.11, 0.37, 0.61]}, {"name": "x3", "between": [0, 1]}],
  "fixed": {"response": "spreading_b", "x1": 0.4, "x4": 0.6, "noise": 0.2, "wait_seconds": 0.002},
  "design": {"kind": "refine", "factor": "x3", "observable": "y", "threshold": 0.05, )" +
           options + "}" + more + "}";
}

std::string dump(const Folder& folder, const std::string& db) {
    const auto ended = run_program({"dump", db}, folder.path());
    EXPECT_EQ(ended.code, 0) << ended.err;
    return ended.out;
}

Ended refine(const Folder& folder, const std::string& db, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words = {"run", "c.json", "--db", db};
    words.insert(words.end(), more.begin(), more.end());
    return run_program(words, folder.path());
}

TEST(RefineCampaign, EveryCombinationFindsItsCliffAndSaysSo) {
    const Folder folder;
    folder.write("c.json", config(R"("width": 0.0078125, "replicates": 4)"));
    const auto ended = refine(folder, "a.db", {"-j", "2"});
    ASSERT_EQ(ended.code, 0) << ended.err;
    EXPECT_THAT(ended.out, HasSubstr("where y passes 0.05 along x3, to 0.007812: 3 found of 3"));
    const auto rows = run_program({"converge", "a.db", "--format", "csv"}, folder.path());
    EXPECT_THAT(rows.out, HasSubstr("campaign,observable,threshold,factor,x2,low,high"));
    // gap = 1.25 diameters: 1 + 4 x3 = 1.25 (1 + 2 x2)
    for (const double x2 : {0.11, 0.37, 0.61}) {
        const double at = (1.25 * (1 + 2 * x2) - 1) / 4;
        const auto sides = run_program(
            {"query", "a.db", "--format", "csv",
             "SELECT max(x3) FILTER (WHERE y < 0.05), min(x3) FILTER (WHERE y >= 0.05) FROM cliff WHERE x2 = " +
                 std::to_string(x2)},
            folder.path());
        double low = 0, high = 0;
        ASSERT_EQ(std::sscanf(sides.out.substr(sides.out.find('\n') + 1).c_str(), "%lf,%lf", &low, &high), 2)
            << sides.out;
        EXPECT_LE(low, at);
        EXPECT_GT(high, at);
        EXPECT_NEAR(high - low, 1.0 / 128, 1e-12);
    }
}

TEST(RefineCampaign, AnEndThatScattersAcrossTheThresholdIsNamed) {
    const Folder folder;
    folder.write("c.json", R"({"campaign": "cliff", "scene": "rehearsal",
        "factors": [{"name": "x1", "between": [0, 1]}], "fixed": {"response": "sum", "noise": 0.05},
        "design": {"kind": "refine", "factor": "x1", "observable": "y", "threshold": 8, "width": 0.01, "replicates": 2}})");
    EXPECT_THAT(refine(folder, "a.db", {"-j", "1", "--wide"}).out,
                HasSubstr("1 found of 1; 1 of them with an end whose 95 % interval contains the threshold"));
}

TEST(RefineCampaign, InterruptedAndWithOneWorkerItEndsInTheSameDump) {
    const Folder folder;
    folder.write("c.json", config(R"("width": 0.01, "replicates": 4)"));
    ASSERT_EQ(refine(folder, "calm.db", {"-j", "2", "--quiet"}).code, 0);
    ASSERT_EQ(refine(folder, "one.db", {"-j", "1", "--quiet"}).code, 0);
    int runs = 0;
    for (int code = 1; code != 0 && runs < 100; ++runs)
        code = refine(folder, "pieces.db", {"-j", "2", "--quiet", "--max-cases", "3"}).code;
    EXPECT_GT(runs, 8);
    EXPECT_EQ(dump(folder, "calm.db"), dump(folder, "one.db"));
    EXPECT_EQ(dump(folder, "calm.db"), dump(folder, "pieces.db"));
    const auto again = refine(folder, "calm.db", {"--quiet"});
    EXPECT_EQ(again.code, 0) << again.err;
}

TEST(RefineCampaign, WhatItCannotDoIsRefused) {
    const Folder folder;
    const auto refused = [&](const std::string& text) {
        folder.write("c.json", text);
        const auto ended = refine(folder, "no.db");
        EXPECT_EQ(ended.code, 2);
        EXPECT_FALSE(std::filesystem::exists(folder / "no.db"));
        return ended.err;
    };
    EXPECT_THAT(refused(config(R"("width": 2)")), HasSubstr("$.design: a width of 2"));
    EXPECT_THAT(refused(config(R"("width": 0)")), HasSubstr("$.design.width: got 0; must be a number above 0"));
    EXPECT_THAT(refused(config(R"("width": 0.1)", R"(, "replicates": 2)")), HasSubstr("$.replicates: got 2"));
    std::string wrong = config(R"("width": 0.1)");
    wrong.replace(wrong.find("\"factor\": \"x3\""), 14, "\"factor\": \"x2\"");
    EXPECT_THAT(refused(wrong), HasSubstr("$.design.factor"));
    wrong = config(R"("width": 0.1)");
    wrong.replace(wrong.find("\"observable\": \"y\""), 17, "\"observable\": \"z\"");
    EXPECT_THAT(refused(wrong), HasSubstr("$.design.observable"));
}

TEST(RefineCampaign, AnotherWidthUnderTheSameNameAndAskingAgainAreRefused) {
    const Folder folder;
    folder.write("c.json", config(R"("width": 0.1)"));
    ASSERT_EQ(refine(folder, "a.db", {"--quiet"}).code, 0);
    const auto again = refine(folder, "a.db", {"--again", "completed"});
    EXPECT_EQ(again.code, 2);
    EXPECT_THAT(again.err, HasSubstr("depend on the stored results"));
    folder.write("c.json", config(R"("width": 0.05)"));
    const auto narrower = refine(folder, "a.db");
    EXPECT_EQ(narrower.code, 2);
    EXPECT_THAT(narrower.err, HasSubstr("width = 0.1"));
}

}  // namespace grainsweep::tests::refine_test
