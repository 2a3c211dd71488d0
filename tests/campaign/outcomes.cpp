// Misfortune is recorded, retried as its kind deserves, and never spoils the rest of the campaign.
#include "tests/support/process.hpp"

#include <gtest/gtest.h>
#include <fstream>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>

namespace grainsweep::tests::outcomes_test {

std::string config(const std::string& fixed, const std::string& limits = R"({"attempts": 3})") {
    return R"({"campaign": "trouble", "scene": "rehearsal",
      "factors": [{"name": "x1", "between": [0, 1]}, {"name": "behaviour", "levels": ["normal", )" +
           fixed + R"(]}], "design": {"kind": "halton", "scramble": "none", "points": 8}, "limits": )" + limits + "}";
}

nlohmann::json query(const Folder& folder, const std::string& sql) {
    const auto ended = run_program({"query", "trouble.db", sql, "--format", "json"}, folder.path());
    EXPECT_EQ(ended.code, 0) << ended.err;
    return nlohmann::json::parse(ended.out);
}

TEST(Outcomes, OfNotesThatDifferInNumbersTwoArePrinted) {
    const Folder folder;
    folder.write("c.json", config("\"crash\""));
    const auto printed = run_program({"run", "c.json", "-j", "1", "--quiet"}, folder.path()).err;
    const auto count = [&](std::string_view word) {
        int found = 0;
        for (auto at = printed.find(word); at != std::string::npos; at = printed.find(word, at + 1)) ++found;
        return found;
    };
    EXPECT_EQ(count("trying again"), 2) << printed;
    EXPECT_EQ(count("giving up"), 2) << printed;
    // Each of the four crashing cases is tried three times.
    EXPECT_EQ(count("... and 8 more notes like these; the database has every attempt"), 1) << printed;
}

TEST(Outcomes, ACrashingCaseIsTriedThreeTimesAndTheRestIsComputed) {
    const Folder folder;
    folder.write("c.json", config("\"crash\""));
    const auto run = run_program({"run", "c.json", "-j", "2", "--quiet"}, folder.path());
    EXPECT_EQ(run.code, 1) << run.err;
    const auto rows = query(folder,
                            "SELECT outcome, count(*) AS n, max(attempts) AS tries FROM trouble GROUP BY outcome "
                            "ORDER BY outcome");
    ASSERT_EQ(rows.size(), 2U);
    EXPECT_EQ(rows[0]["outcome"], "completed");
    EXPECT_EQ(rows[0]["n"], 4);
    EXPECT_EQ(rows[1]["outcome"], "crashed");
    EXPECT_EQ(rows[1]["n"], 4);
    EXPECT_EQ(rows[1]["tries"], 3);
    // Running again does not try them again; --again does.
    EXPECT_EQ(run_program({"run", "c.json", "--quiet"}, folder.path()).code, 1);
    EXPECT_EQ(query(folder, "SELECT max(attempts) AS n FROM trouble")[0]["n"], 3);
    EXPECT_EQ(run_program({"run", "c.json", "--quiet", "--again", "crashed"}, folder.path()).code, 1);
    EXPECT_EQ(query(folder, "SELECT max(attempts) AS n FROM trouble")[0]["n"], 6);
}

TEST(Outcomes, ExplainTellsEveryAttempt) {
    const Folder folder;
    folder.write("c.json", config("\"crash\""));
    run_program({"run", "c.json", "--quiet"}, folder.path());
    const std::string id = query(folder, "SELECT case_id FROM trouble WHERE outcome = 'crashed' LIMIT 1")[0]["case_id"];
    const auto explained = run_program({"explain", "trouble.db", id}, folder.path());
    EXPECT_EQ(explained.code, 0) << explained.err;
    EXPECT_NE(explained.out.find("signal 9"), std::string::npos) << explained.out;
    EXPECT_NE(explained.out.find("crashed"), std::string::npos);
    EXPECT_NE(explained.out.find("3 of its attempts failed; limits.attempts is 3: it will not run again;"),
              std::string::npos)
        << explained.out;
    const auto replayed = run_program({"replay", "trouble.db", id}, folder.path());
    EXPECT_NE(replayed.err.find("this case crashed its worker"), std::string::npos) << replayed.err;
    // More attempts allowed, and none of them yet: the next run would.
    folder.write("c.json", config("\"crash\"", R"({"attempts": 5})"));
    run_program({"run", "c.json", "--quiet", "--max-cases", "1"}, folder.path());
    const std::string other =
        query(folder, "SELECT case_id FROM trouble WHERE outcome = 'crashed' AND attempts = 3 LIMIT 1")[0]["case_id"];
    const auto again = run_program({"explain", "trouble.db", other}, folder.path());
    EXPECT_NE(again.out.find("3 of its attempts failed; limits.attempts is 5: the next run tries it again"),
              std::string::npos)
        << again.out;
}

TEST(Outcomes, ExplainKnowsWhereACampaignStopped) {
    const Folder folder;
    folder.write("c.json",
                 R"({"campaign": "trouble", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]}],
      "design": {"kind": "halton", "sequences": 8, "points": 4000},
      "convergence": {"observable": "y", "rule": "replicates", "gates": ["mean"], "tolerance": 0.05, "block": 64}})");
    ASSERT_EQ(run_program({"run", "c.json", "--quiet"}, folder.path()).code, 0);
    const std::string id = query(folder, "SELECT case_id FROM trouble ORDER BY point DESC LIMIT 1")[0]["case_id"];
    const auto explained = run_program({"explain", "trouble.db", id}, folder.path());
    EXPECT_NE(explained.out.find("it has not started and will not: campaign 'trouble' converged and stopped at "),
              std::string::npos)
        << explained.out;
}

TEST(Outcomes, ACrashThatPassesIsForgiven) {
    const Folder folder;
    folder.write("c.json",
                 R"({"campaign": "trouble", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]}],
      "fixed": {"behaviour": "crash", "behave_attempts": 2}, "design": {"kind": "random", "points": 5}})");
    EXPECT_EQ(run_program({"run", "c.json", "-j", "2", "--quiet"}, folder.path()).code, 0);
    const auto rows = query(folder, "SELECT outcome, attempts, y FROM trouble");
    ASSERT_EQ(rows.size(), 5U);
    for (const auto& row : rows) {
        EXPECT_EQ(row["outcome"], "completed");
        EXPECT_EQ(row["attempts"], 3);
        EXPECT_TRUE(row["y"].is_number());
    }
}

TEST(Outcomes, AHangingCaseIsStoppedAtItsWallTime) {
    const Folder folder;
    folder.write("c.json", config("\"hang\"", R"({"attempts": 1, "wall_seconds": 0.5})"));
    const auto run = run_program({"run", "c.json", "-j", "4", "--quiet"}, folder.path());
    EXPECT_EQ(run.code, 1) << run.err;
    const auto rows = query(folder, "SELECT outcome, count(*) AS n FROM trouble GROUP BY outcome ORDER BY outcome");
    ASSERT_EQ(rows.size(), 2U);
    EXPECT_EQ(rows[1]["outcome"], "timed_out");
    EXPECT_EQ(rows[1]["n"], 4);
    // How long it took is known, what it cost is not.
    const auto cost =
        query(folder, "SELECT wall_seconds, cpu_seconds FROM attempt WHERE outcome = 'timed_out' ORDER BY 1")[0];
    EXPECT_GT(cost["wall_seconds"], 0.45);
    EXPECT_LT(cost["wall_seconds"], 10);
    EXPECT_TRUE(cost["cpu_seconds"].is_null());
}

// The time a launcher takes, a queue perhaps, is not the case's.
TEST(Outcomes, TheWallTimeBeginsWhenTheWorkerIsReady) {
    const Folder folder;
    folder.write("c.json",
                 R"({"campaign": "trouble", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]}],
      "design": {"kind": "random", "points": 3}, "limits": {"wall_seconds": 0.5, "attempts": 1},
      "execution": {"launcher": ["/bin/sh", "-c", "sleep 1.5; exec \"$@\"", "sh"]}})");
    const auto run = run_program({"run", "c.json", "-j", "1", "--quiet"}, folder.path());
    EXPECT_EQ(run.code, 0) << run.err;
}

// What launched a worker is not killed while it tidies up behind it.
TEST(Outcomes, ALauncherMayTidyUp) {
    const Folder folder;
    folder.write("c.json",
                 R"({"campaign": "trouble", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]}],
      "fixed": {"wait_seconds": 0.5}, "design": {"kind": "random", "points": 4},
      "execution": {"launcher": ["/bin/sh", "-c", "\"$@\"; sleep 0.3; echo tidy >> tidied", "sh"]}})");
    ASSERT_EQ(run_program({"run", "c.json", "-j", "2", "--quiet"}, folder.path()).code, 0);
    std::ifstream tidied(folder / "tidied");
    std::string first, second;
    EXPECT_TRUE(tidied >> first >> second) << "two workers were launched, and left to end";
}

TEST(Outcomes, AnUnstableCaseIsSettledWithItsReasonAndWithoutNumbers) {
    const Folder folder;
    folder.write("c.json", config("\"unstable\""));
    EXPECT_EQ(run_program({"run", "c.json", "--quiet"}, folder.path()).code, 1);
    const auto rows = query(folder, "SELECT attempts, y FROM trouble WHERE outcome = 'unstable'");
    ASSERT_EQ(rows.size(), 4U);
    for (const auto& row : rows) {
        EXPECT_EQ(row["attempts"], 1);
        EXPECT_TRUE(row["y"].is_null());
    }
}

// A plate appears beside a grain, or in it: these cases are unstable. The note blamed the measurement for their gaps.
TEST(Outcomes, ANoteOnGapsNamesTheOutcomes) {
    const auto machine = nlohmann::json::parse(R"json({
      "name": "m", "gravity": [0, 0, 0], "domain": {"low": [-0.01, -0.01, -0.01], "high": [0.01, 0.01, 0.01]},
      "parameters": {"place": {"unit": "mm", "default": 5, "bounds": [0, 10]}},
      "materials": {"rock": {"density": 2500, "youngs_modulus": "5 MPa", "poisson_ratio": 0.25}},
      "species": {"sand": {"diameter": "3 mm"}},
      "walls": {"plate": {"plane": {"point": [0, 0, "0 - place"], "normal": [0, 0, 1]}, "during": "late"}},
      "fill": [{"species": "sand", "spheres": [{"at": [0, 0, 0]}]}],
      "phases": [{"name": "early", "for": 1e-3, "frames": 1}, {"name": "late", "for": 1e-3, "frames": 1}],
      "measure": {"height": {"mean_height": {}, "as": "last"}}
    })json");
    const Folder folder;
    folder.write("c.json", nlohmann::json{{"campaign", "m"},
                                          {"scene", "machine"},
                                          {"machine", machine},
                                          {"factors", {{{"name", "place"}, {"levels", {0, 5}}}}},
                                          {"design", {{"kind", "lattice"}, {"levels", {2}}}}}
                               .dump());
    EXPECT_EQ(run_program({"run", "c.json", "--quiet"}, folder.path()).code, 1);
    const auto note = [&](const char* sql) { return run_program({"query", "m.db", sql}, folder.path()).err; };
    EXPECT_EQ(
        note("SELECT height FROM m"),
        "note: 1 of 2 rows have no height: cases of this database without results: 1 unstable; of a completed one "
        "it is undefined where there was nothing to measure\n");
    EXPECT_EQ(note("SELECT height, outcome FROM m"), "");
}

TEST(Outcomes, AHugeAnswerArrivesWhole) {
    const Folder folder;
    folder.write("c.json", config("\"huge\""));
    EXPECT_EQ(run_program({"run", "c.json", "--quiet"}, folder.path()).code, 0);
    EXPECT_EQ(query(folder, "SELECT count(*) AS n FROM series")[0]["n"], 4 * 20000);
}

// Inputs that are each within bounds and impossible together are one case's outcome, not the campaign's end.
TEST(Outcomes, AnImpossibleCaseIsRejectedAndTheRestIsComputed) {
    const Folder folder;
    folder.write("c.json", R"({"campaign": "trouble", "scene": "thermovibration",
      "factors": [{"name": "cells", "levels": [7, 8]}],
      "fixed": {"coupling": "one_way", "particles": 10, "symmetry": "mirror", "end_time": 1e-3},
      "design": {"kind": "lattice"}})");
    const auto plan = run_program({"plan", "c.json", "--format", "json"}, folder.path());
    EXPECT_EQ(plan.code, 0) << plan.err;
    EXPECT_EQ(nlohmann::json::parse(plan.out)["impossible"], 1);
    const auto told = run_program({"plan", "c.json"}, folder.path()).out;
    EXPECT_NE(told.find("cells = 7"), std::string::npos) << told;
    const auto run = run_program({"run", "c.json", "--quiet"}, folder.path());
    EXPECT_EQ(run.code, 1) << run.err;
    const auto rows = query(folder, "SELECT outcome, cells FROM trouble ORDER BY cells");
    EXPECT_EQ(rows[0]["outcome"], "rejected");
    EXPECT_EQ(rows[1]["outcome"], "completed");
}

TEST(Outcomes, FailuresCanEndTheRun) {
    const Folder folder;
    folder.write("c.json", config("\"unstable\""));
    EXPECT_EQ(run_program({"run", "c.json", "-j", "1", "-k", "1", "--quiet"}, folder.path()).code, 1);
    EXPECT_LT(query(folder, "SELECT count(outcome) AS n FROM trouble")[0]["n"].get<int>(), 8);
}

TEST(Outcomes, MaxCasesSettlesThatManyAndNoMore) {
    const Folder folder;
    folder.write("c.json", config("\"huge\""));
    EXPECT_EQ(run_program({"run", "c.json", "-j", "2", "--max-cases", "3", "--quiet"}, folder.path()).code, 1);
    EXPECT_EQ(query(folder, "SELECT count(outcome) AS n FROM trouble")[0]["n"], 3);
    EXPECT_EQ(run_program({"run", "c.json", "-j", "2", "--quiet"}, folder.path()).code, 0);
    EXPECT_EQ(query(folder, "SELECT max(attempts) AS n FROM trouble")[0]["n"], 1);
}

TEST(Outcomes, ALauncherThatCannotStartIsABrokenWorldNotAFailedCase) {
    const Folder folder;
    folder.write("c.json",
                 R"({"campaign": "trouble", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]}],
      "design": {"kind": "random", "points": 5}, "execution": {"launcher": ["/bin/false"]}})");
    const auto run = run_program({"run", "c.json", "--quiet"}, folder.path());
    EXPECT_EQ(run.code, 3) << run.err;
    EXPECT_NE(run.err.find("/bin/false"), std::string::npos) << run.err;
}

TEST(Outcomes, ALauncherThatDoesNotExistIsAWrongQuestion) {
    for (const char* launcher : {"nosuchprogram", "./nosuch", "/tmp"}) {
        const Folder folder;
        folder.write("c.json",
                     R"({"campaign": "trouble", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]}],
          "design": {"kind": "random", "points": 5}, "execution": {"launcher": [")" +
                         std::string(launcher) + R"("]}})");
        const auto run = run_program({"run", "c.json", "--quiet"}, folder.path());
        EXPECT_EQ(run.code, 2) << run.err;
        EXPECT_EQ(run.err, "grainsweep: c.json: $.execution.launcher[0]: got " + std::string(launcher) +
                               "; this launcher program does not exist.\n");
        EXPECT_FALSE(std::filesystem::exists(folder / "trouble.db"));
    }
    const Folder folder;
    folder.write("c.json", config("\"crash\""));
    const auto run = run_program({"run", "c.json", "--db", "missing/x.db"}, folder.path());
    EXPECT_EQ(run.code, 2);
    EXPECT_NE(run.err.find("--db: got missing/x.db; there is no folder"), std::string::npos) << run.err;
}

TEST(Outcomes, ALauncherPrefixCarriesTheWorker) {
    const Folder folder;
    folder.write("c.json",
                 R"({"campaign": "trouble", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]}],
      "design": {"kind": "random", "points": 20}, "execution": {"launcher": ["/usr/bin/env", "-u", "HOME"]}})");
    EXPECT_EQ(run_program({"run", "c.json", "--quiet"}, folder.path()).code, 0);
}

TEST(Outcomes, ReplayAgreesWithTheArchive) {
    const Folder folder;
    folder.write("c.json", config("\"huge\""));
    run_program({"run", "c.json", "--quiet"}, folder.path());
    const std::string id = query(folder, "SELECT case_id FROM trouble LIMIT 1")[0]["case_id"];
    const auto replay = run_program({"replay", "trouble.db", id.substr(0, 10)}, folder.path());
    EXPECT_EQ(replay.code, 0) << replay.err << replay.out;
}

}  // namespace grainsweep::tests::outcomes_test
