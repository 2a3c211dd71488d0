// Programs as scenes: each misfortune has one clear outcome, nothing is lost and nothing outlives a campaign.
#include "tests/support/program_campaigns.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <regex>
#include <thread>

namespace grainsweep::tests::programs_test {

using nlohmann::json;

constexpr const char* sound_script = "echo \"{\\\"y\\\": $1}\" > out.json\n";

/// Outcome and message of the only case.
std::string ending(const Folder& folder) {
    const auto rows = rows_of(folder,
                              "SELECT c.outcome || ': ' || coalesce(t.message, '') AS text FROM sim_case AS c JOIN "
                              "attempt AS t USING (case_key) ORDER BY t.number DESC LIMIT 1");
    return rows.is_array() && !rows.empty() ? rows[0]["text"].get<std::string>() : rows.dump();
}

/// How a campaign of one case ends.
std::string ending_of(const std::string& script, const json& more = {}, const json& limits = {{"attempts", 1}}) {
    const Folder folder;
    auto campaign = script_campaign(1, more);
    campaign["limits"] = limits;
    const auto ended = run_script(folder, script, campaign);
    EXPECT_LT(ended.most_memory, 300) << "MB";
    return ending(folder);
}

void expect_has(const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
}

/// Waits until no process has the text in its command line, for so long.
bool gone_within(const std::string& text, std::chrono::seconds time) {
    const auto until = std::chrono::steady_clock::now() + time;
    while (!processes_with(text).empty()) {
        if (std::chrono::steady_clock::now() > until) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return true;
}

bool there_within(const std::string& text, std::chrono::seconds time) {
    const auto until = std::chrono::steady_clock::now() + time;
    while (processes_with(text).empty()) {
        if (std::chrono::steady_clock::now() > until) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return true;
}

TEST(Programs, AnswersAndFactsOfEveryCaseAreStored) {
    const Folder folder;
    auto campaign =
        script_campaign(8, {{"version", {{"command", {"sh", "-c", "echo tool 3.4.5"}}, {"match", "tool (.*)"}}}});
    const auto ended = run_script(folder, sound_script, campaign);
    EXPECT_EQ(ended.code, 0) << ended.err;
    const auto rows = rows_of(folder, "SELECT x, y FROM p");
    ASSERT_EQ(rows.size(), 8U);
    for (const auto& row : rows) EXPECT_EQ(row["x"], row["y"]);
    const auto facts = rows_of(folder, "SELECT version, peak_memory, exit_status FROM attempt_program");
    ASSERT_EQ(facts.size(), 8U);
    EXPECT_EQ(facts[0]["version"], "3.4.5");
    EXPECT_GT(facts[0]["peak_memory"], 1e5);
    EXPECT_EQ(facts[0]["exit_status"], 0);
    EXPECT_FALSE(std::filesystem::exists(folder / "p.cases")) << "nothing failed, so nothing is kept";
    EXPECT_EQ(run_program({"verify", "p.db"}, folder.path()).code, 0);
}

TEST(Programs, ACaseIsReplayedFromTheArchiveAlone) {
    const Folder folder;
    ASSERT_EQ(run_script(folder, "echo \"{\\\"y\\\": {{ x }}}\" > out.json\n",
                         script_campaign(2, {{"files", json::array()}, {"templates", {"script.sh"}}}))
                  .code,
              0);
    std::filesystem::remove(folder / "script.sh");
    std::filesystem::remove(folder / "c.json");
    const auto id = rows_of(folder, "SELECT case_id FROM p LIMIT 1")[0]["case_id"].get<std::string>();
    const auto replayed = run_program({"replay", "p.db", id, "--keep", "kept"}, folder.path());
    EXPECT_EQ(replayed.code, 0) << replayed.out << replayed.err;
    expect_has(replayed.out, "equal to the last bit");
    EXPECT_TRUE(std::filesystem::exists(folder / "kept/out.json"));
    EXPECT_EQ(run_program({"replay", "p.db", id, "--keep", "kept"}, folder.path()).code, 2) << "never over a folder";
}

TEST(Programs, AReplayThatDiffersIsJudgedByItsTolerance) {
    const Folder folder;
    const std::string script = "echo \"{\\\"y\\\": 1.0$(date +%N | cut -c1-3)}\" > out.json\n";
    ASSERT_EQ(run_script(folder, script, script_campaign(1)).code, 0);
    const auto id = rows_of(folder, "SELECT case_id FROM p LIMIT 1")[0]["case_id"].get<std::string>();
    EXPECT_EQ(run_program({"replay", "p.db", id, "--tolerance", "0.2"}, folder.path()).code, 0);
    EXPECT_EQ(run_program({"replay", "p.db", id, "--tolerance", "2"}, folder.path()).code, 2);
}

TEST(Programs, EveryFailureIsOneClearOutcome) {
    const std::vector<std::pair<std::string, std::string>> cases = {
        {"echo '{\"y\": NaN}' > out.json\n", "rejected: out.json: /y is NaN, which is no number"},
        {"echo '{\"y\": -Infinity}' > out.json\n", "rejected: out.json: /y is Infinity, which is no number"},
        {"echo '{\"y\": 1e400}' > out.json\n", "rejected: out.json: /y is 1e400, which is no number"},
        {"echo '{\"y\": 1, \"z\": [0, -1e999]}' > out.json\n",
         "rejected: out.json: /z/1 is -1e999, which is no number"},
        {"echo '{\"y\": 1, \"y\": 2}' > out.json\n", "rejected: out.json: /y is there twice"},
        {"printf '{\"y\": \"\\377\"}' > out.json\n", "rejected: out.json is no JSON at byte"},
        {"head -c 200000 /dev/zero | tr '\\0' '[' > out.json\n", "rejected: out.json is nested deeper than 100 levels"},
        {"(head -c 99 /dev/zero | tr '\\0' '['; head -c 99 /dev/zero | tr '\\0' ']') > out.json\n",
         "rejected: out.json has no /y"},
        {"echo '{\"y\": null}' > out.json\n", "rejected: out.json: /y is null, which is no number"},
        {"echo '{\"z\": 1}' > out.json\n", "rejected: out.json has no /y"},
        {"exit 0\n", "rejected: out.json was not written"},
        {"ln -s /etc/passwd out.json\n", "rejected: out.json is a link"},
        {"mkfifo out.json\n", "rejected: out.json is no regular file"},
        {"echo about to fail >&2; exit 3\n", "crashed: the program ended with exit code 3; it wrote: about to fail"},
        {"kill -SEGV $$\n", "crashed: the program ended by signal 11 (Segmentation fault)"},
        {"echo ERROR: bad deck; exit 1\n", "crashed: the program ended with exit code 1; it wrote: ERROR: bad deck"},
        {"no_such_program\n", "crashed: the program ended with exit code 127; it wrote: script.sh: "},
        {"echo '{\"outcome\": \"unstable\", \"message\": \"blew up\"}' > out.json\n", "unstable: blew up"},
        {"echo '{\"outcome\": \"unstable\"}' > outcome.json\n", "unstable: the program says so"},
        {"echo '{\"outcome\": \"fine\"}' > outcome.json\n", "rejected: outcome.json: /outcome is \"fine\""},
    };
    for (const auto& [script, expected] : cases) expect_has(ending_of(script), expected);
    expect_has(ending_of(sound_script, {{"observables", {{"y", {{"bounds", {5, 6}}}}}}}),
               "rejected: y is 0.5, outside of its bounds 5 to 6");
}

TEST(Programs, APartOfANumberIsNoResult) {
    const auto found = [](const std::string& line, const std::string& pattern) {
        return ending_of(
            "echo '" + line + "'\n",
            {{"observables", {{"y", {{"from", {{"output", pattern}, {"json", nullptr}, {"path", nullptr}}}}}}}});
    };
    expect_has(found("y = 1,85 mm", "y = ([0-9.]+)"), "found '1', a part of the number '1,85'; numbers have decimal");
    expect_has(found("y = 1,234.5", "y = ([0-9.eE+-]+)"), "a part of the number '1,234'; numbers have decimal points");
    expect_has(found("y = 1.85 mm", "y = ([0-9]+)"), "found '1', a part of the number '1.85'");
    expect_has(found("y = -1.5 Pa", "([0-9.]+) Pa"), "found '1.5', a part of the number '-1.5'");
    expect_has(found("y = 1.5e-3 Pa", "([0-9]+) Pa"), "found '3', a part of the number '1.5e-3'");
    expect_has(found("y = 12.75", "([0-9]+)$"), "found '75', a part of the number '12.75'");
    for (const auto& [line, pattern] :
         std::vector<std::pair<std::string, std::string>>{{"y = 1,85", "y = ([0-9]+),"},
                                                          {"1.5, 2.5", "^([0-9.]+)"},
                                                          {"y = 5.", "y = ([0-9]+)"},
                                                          {"on 2026-11-30", "([0-9]+)$"},
                                                          {"y = -1.5 Pa", "(-[0-9.]+) Pa"},
                                                          {"10,5.25", "([0-9.]+)$"},
                                                          {"50 %\ry = 5\r", "^y = (.*)"},
                                                          {"7\r", "^(.*)$"},
                                                          {"y2 = 5", "= ([0-9]+)"},
                                                          {"1.5,2.5", "^([0-9.]+)"}})
        expect_has(found(line, pattern), "completed");
}

TEST(Programs, AValueBehindALongLineIsNotAnEarlierOne) {
    const auto found = [](const std::string& script, const std::string& pattern = "y = (.*)") {
        return ending_of(
            script,
            {{"observables",
              {{"y", {{"from", {{"output", pattern}, {"json", nullptr}, {"path", nullptr}}}, {"optional", true}}}}}});
    };
    const std::string behind = "printf '%5000s' .; echo y = 2\n";
    for (const std::string earlier : {"", "echo y = 1\n"})
        expect_has(found(earlier + behind),
                   "rejected: standard output: 'y = (.*)' may stand beyond the first 4096 bytes of a line");
    expect_has(found(behind + "echo y = 1\n"), "completed");
    expect_has(found("echo y = 1; printf '%5000s\\n' .\n"), "completed");
    expect_has(found("echo y = 1\n" + behind, "^y = (.*)"), "completed");
}

/// A hopper has no flow time where it jams.
TEST(Programs, AnOptionalObservableMayBeAbsent) {
    const json out = {{"y", {{"optional", true}, {"from", {{"json", "out.json"}, {"path", "/y"}}}}},
                      {"z", {{"from", {{"output", "z = (.*)"}}}}}};
    const auto absent = [&](const std::string& script, json observables) {
        const Folder folder;
        (void)run_script(folder, script + "echo z = 3\n", script_campaign(2, {{"observables", observables}}),
                         {"--quiet"});
        const auto rows =
            rows_of(folder, "SELECT count(*) AS n FROM p WHERE outcome = 'completed' AND y IS NULL AND z = 3");
        return rows.is_array() && rows[0]["n"] == 2 ? "absent" : ending(folder);
    };
    for (const char* script : {"\n", "echo '{}' > out.json\n", "echo '{\"y\": null}' > out.json\n"})
        EXPECT_EQ(absent(script, out), "absent") << script;
    expect_has(absent("echo '{\"y\": \"a\"}' > out.json\n", out), "rejected: out.json: /y is \"a\"");
    json table = out;
    table["y"]["from"] = {{"csv", "o.csv"}, {"column", "y"}, {"json", nullptr}, {"path", nullptr}};
    for (const char* script :
         {"\n", "echo t,y > o.csv\n", "printf 't,y\\n0,nan\\n' > o.csv\n", "printf 't,y\\n0,\\n' > o.csv\n"})
        EXPECT_EQ(absent(script, table), "absent") << script;
    expect_has(absent("printf 't,y\\n0,x\\n' > o.csv\n", table), "rejected: o.csv: 'y' in row 0 is 'x'");
    json line = out;
    line["y"]["from"] = {{"output", "y = (.*)"}, {"json", nullptr}, {"path", nullptr}};
    for (const char* script : {"\n", "echo y = NaN\n"}) EXPECT_EQ(absent(script, line), "absent") << script;
    line["y"]["optional"] = false;
    expect_has(absent("\n", line), "rejected: standard output has no line with 'y = (.*)'");
}

TEST(Programs, AFileThatWasCopiedIsNoResult) {
    const Folder folder;
    folder.write("out.json", "{\"y\": 1}");
    (void)run_script(folder, "exit 0\n", script_campaign(1, {{"files", {"script.sh", "out.json"}}}), {"--quiet"});
    expect_has(ending(folder), "rejected: out.json was not written: it is the file that was copied into the folder");
    const Folder other;
    other.write("out.json", "{\"y\": 1}");
    (void)run_script(other, "echo '{\"y\": 2}' > out.json\n",
                     script_campaign(1, {{"files", {"script.sh", "out.json"}}}), {"--quiet"});
    expect_has(ending(other), "completed");
}

TEST(Programs, OneThatWritesWithoutEndFillsNeitherDiskNorMemory) {
    expect_has(ending_of("dd if=/dev/zero of=big bs=1M count=4000 2>/dev/null; sleep 5\n", {{"disk", "30 MB"}}),
               "rejected: it wrote");
    expect_has(ending_of("yes 'a line of output' \n", {{"disk", "30 MB"}}), "rejected: it wrote");
    expect_has(
        ending_of("i=0; while true; do mkdir d$i; dd if=/dev/zero of=d$i/f bs=1M count=5 2>/dev/null; i=$((i+1)); "
                  "done\n",
                  {{"disk", "30 MB"}}),
        "rejected: it wrote");
}

TEST(Programs, FoldersWithinFoldersWithoutEndAreRefusedAndRemoved) {
    const Folder folder;
    auto campaign = script_campaign(1, {{"keep", "none"}});
    campaign["limits"] = {{"attempts", 1}};
    const std::string nests =
        "import os\n"
        "for k in range(3000):\n"
        "    os.mkdir('a' * 50); os.chdir('a' * 50)\n"
        "open('deep', 'w').write('x' * 1000)\n";
    (void)run_script(folder, "cat > nest.py <<'END'\n" + nests + "END\npython3 nest.py\n" + sound_script, campaign);
    expect_has(ending(folder), "rejected: it made folders within folders, more than 100 deep");
    std::vector<std::string> left;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
        if (entry.path().string().find("cases") != std::string::npos)
            for (const auto& one : std::filesystem::directory_iterator(entry)) left.push_back(one.path().string());
    EXPECT_TRUE(left.empty()) << left.front();
}

TEST(Programs, AMemoryLimitIsTheProgramsOwn) {
    const auto end = ending_of("python3 -c \"x = bytearray(2 * 10 ** 9)\"\n", {{"memory", "400 MB"}});
    expect_has(end, "crashed: the program ended with exit code");
    expect_has(end, "MemoryError");
}

TEST(Programs, ATimeLimitEndsItWithAllItsChildren) {
    const auto start = std::chrono::steady_clock::now();
    const std::string mark = "98761.25";
    const std::string stubborn =
        "trap '' TERM INT HUP; (setsid sleep " + mark + " &) ; while true; do sleep " + mark + "; done\n";
    expect_has(ending_of(stubborn, {}, {{"attempts", 1}, {"wall_seconds", 0.3}}), "timed_out: no answer within 0.3 s");
    EXPECT_TRUE(gone_within("sleep\0" + mark, std::chrono::seconds(1)));
    EXPECT_TRUE(gone_within(mark, std::chrono::seconds(1)));
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(12));
}

TEST(Programs, ChildrenDoNotSurviveAProgramThatEnds) {
    const std::string mark = "98762.25";
    const auto end = ending_of("(setsid sleep " + mark + " &)\nsleep " + mark + " &\n" + sound_script);
    expect_has(end, "completed");
    EXPECT_TRUE(gone_within(mark, std::chrono::seconds(2)));
}

TEST(Programs, NothingSurvivesWorkersOrMainProgramThatAreKilled) {
    for (const bool main_program : {true, false}) {
        const Folder folder;
        const std::string mark = main_program ? "98763.25" : "98764.25";
        folder.write("script.sh", "(setsid sh -c 'trap \"\" TERM; sleep " + mark + "; true' &)\nsleep " + mark + "\n");
        auto campaign = script_campaign(1);
        campaign["limits"] = {{"attempts", 1}};
        folder.write("c.json", campaign.dump());
        Process run(program_command({"run", "c.json", "-j", "1", "--quiet"}), folder.path());
        ASSERT_TRUE(there_within("sleep", std::chrono::seconds(10)));
        ASSERT_TRUE(there_within(mark, std::chrono::seconds(10)));
        if (main_program)
            run.signal(SIGKILL);
        else
            for (const auto worker : run.children()) ::kill(worker, SIGKILL);
        EXPECT_TRUE(gone_within(mark, std::chrono::seconds(8))) << main_program;
        run.wait();
    }
}

TEST(Programs, ACaseMayChangeItsFilesAndTheNextDoesNotSeeIt) {
    const Folder folder;
    const std::string script =
        "grep -q changed data.txt && echo '{\"y\": -1}' > out.json || echo \"{\\\"y\\\": $1}\" > out.json\n"
        "echo changed > data.txt; echo 'exit 1' > script.sh; rm -f inputs.json; chmod 000 .\n";
    folder.write("data.txt", "as it was\n");
    const auto ended =
        run_script(folder, script, script_campaign(6, {{"files", {"script.sh", "data.txt"}}}), {"-j", "1"});
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_EQ(rows_of(folder, "SELECT count(*) AS n FROM p WHERE x = y")[0]["n"], 6);
    std::ifstream stream(folder / "data.txt");
    std::string text;
    std::getline(stream, text);
    EXPECT_EQ(text, "as it was");
}

TEST(Programs, FailedCasesKeepTheirFoldersWhereAsked) {
    for (const std::string keep : {"failed", "all", "none"}) {
        const Folder folder;
        auto campaign = script_campaign(2, {{"keep", keep}});
        campaign["limits"] = {{"attempts", 1}};
        (void)run_script(folder, std::string(sound_script) + "[ $1 = 0.5 ] && exit 1; true\n", campaign);
        std::size_t kept = 0;
        if (std::filesystem::exists(folder / "p.cases"))
            for (const auto& entry : std::filesystem::directory_iterator(folder / "p.cases"))
                kept += std::filesystem::exists(entry.path() / "inputs.json") ? 1U : 0U;
        EXPECT_EQ(kept, keep == "all" ? 2U : keep == "failed" ? 1U : 0U) << keep;
        EXPECT_EQ(std::filesystem::exists(folder / "p.cases"), kept > 0) << keep;
    }
}

std::string dump_of(const Folder& folder) {
    return run_program({"dump", "p.db"}, folder.path()).out;
}

TEST(Programs, OneWorkerTwoWorkersAndAKilledRunGiveTheSameDump) {
    // Twice the time that the three kills leave to two workers, so that the third still meets a run.
    const std::string script = "sleep 0.1\n" + std::string(sound_script);
    const auto campaign = script_campaign(24, {{"observables", {{"e", {{"from", {{"output", "e=([0-9.]+)"}}}}}}}});
    const std::string with_output = script + "echo noise; echo e=1.5; echo e=2.5\n";
    const Folder one, two, killed;
    ASSERT_EQ(run_script(one, with_output, campaign, {"-j", "1"}).code, 0);
    ASSERT_EQ(run_script(two, with_output, campaign, {"-j", "2"}).code, 0);
    killed.write("script.sh", with_output);
    killed.write("c.json", campaign.dump());
    for (const int signal : {SIGKILL, SIGINT, SIGTERM}) {
        Process run(program_command({"run", "c.json", "-j", "2", "--quiet"}), killed.path());
        ASSERT_TRUE(there_within((killed / "p.cases").string(), std::chrono::seconds(10)));
        std::this_thread::sleep_for(std::chrono::milliseconds(150));
        run.signal(signal);
        run.wait();
        ASSERT_TRUE(gone_within((killed / "p.cases").string(), std::chrono::seconds(10)));
    }
    ASSERT_EQ(run_script(killed, with_output, campaign, {"-j", "2"}).code, 0);
    EXPECT_EQ(dump_of(one), dump_of(two));
    EXPECT_EQ(dump_of(one), dump_of(killed));
    expect_has(dump_of(one), "scalar e = 2.5");
    EXPECT_FALSE(std::filesystem::exists(killed / "p.cases"));
}

TEST(Programs, ContentsAreIdentityAndNamesOfFoldersAreNot) {
    const auto id_of = [](const std::string& script, const json& more) {
        const Folder folder;
        folder.write("script.sh", script);
        folder.write("c.json", script_campaign(1, more).dump());
        const auto planned = run_program({"plan", "c.json", "--format", "json"}, folder.path());
        EXPECT_EQ(planned.code, 0) << planned.err;
        EXPECT_FALSE(std::filesystem::exists(folder / "p.cases"));
        return json::parse(planned.out)["rows"][0]["case_id"].get<std::string>();
    };
    const auto same = id_of(sound_script, {});
    EXPECT_EQ(same, id_of(sound_script, {{"keep", "all"}, {"cost_seconds", 7}, {"cores", 2}}));
    EXPECT_EQ(same, id_of(sound_script, {{"parameters", {{"x", {{"unit", "m"}, {"bounds", {0, 2}}}}}}}));
    EXPECT_NE(same, id_of(std::string(sound_script) + "#\n", {}));
    EXPECT_NE(same, id_of(sound_script, {{"environment", {{"A", "1"}}}}));
    EXPECT_NE(same, id_of(sound_script, {{"version", {{"command", {"sh", "-c", "echo 1"}}, {"match", "(.)"}}}}));
}

TEST(Programs, ALibraryThatIsMissingIsACrashThatSaysSo) {
    const Folder folder;
    folder.write("main.cpp", "extern \"C\" int f(); int main() { return f(); }");
    folder.write("f.c", "int f(void) { return 0; }");
    const std::string build = "cd " + folder.path().string() +
                              " && c++ -x c -shared -fPIC -o libf.so f.c && c++ -o prog main.cpp -L. -lf && rm libf.so";
    ASSERT_EQ(std::system(build.c_str()), 0);
    const auto ended = run_script(folder, "", script_campaign(1, {{"command", {"./prog"}}, {"files", {"prog"}}}));
    EXPECT_EQ(ended.code, 1);
    expect_has(ending(folder), "crashed: the program ended with exit code 127; it wrote: ");
    expect_has(ending(folder), "libf.so");
}

TEST(Programs, OneThatIsGoneEndsTheRunAndNothingIsSpent) {
    const Folder folder;
    const auto tool =
        folder.write("tool", "#!/bin/sh\necho '{\"y\": 1}' > out.json\nrm -f " + (folder / "tool").string() + "\n");
    std::filesystem::permissions(tool, std::filesystem::perms::owner_all);
    const auto ended = run_script(folder, "", script_campaign(4, {{"command", {tool.string()}}}), {"-j", "1"});
    EXPECT_EQ(ended.code, 3) << ended.err;
    expect_has(ended.err, "cannot be executed: No such file or directory");
    EXPECT_EQ(rows_of(folder, "SELECT count(*) AS n FROM p WHERE outcome = 'completed'")[0]["n"], 1);
    EXPECT_EQ(rows_of(folder, "SELECT count(*) AS n FROM p WHERE outcome = 'crashed'")[0]["n"], 0);
    EXPECT_EQ(run_program({"run", "c.json"}, folder.path()).code, 2);  // it is not here
}

TEST(Programs, ARunWhoseCasesAllFailForOneReasonStops) {
    const Folder folder;
    auto campaign = script_campaign(30);
    const std::string fails = "echo run >> ../runs; echo started at $1 >&2; [ -e ../repaired ] || exit 9\n";
    const auto ended = run_script(folder, fails + sound_script, campaign, {"-j", "1"});
    EXPECT_EQ(ended.code, 1);
    std::string said = ended.out + ended.err;
    std::ranges::replace(said, '\n', ' ');
    // Eight, and what ended meanwhile.
    const std::regex words(
        "stopped, because the first (\\d+) cases all failed for one reason \\(crashed: the program ended with exit "
        "code "
        "9; it wrote: started at 0\\..*with (\\d+) cases left; run again to try all of them, --keep-going computes the "
        "others, too");
    std::smatch found;
    ASSERT_TRUE(std::regex_search(said, found, words)) << said;
    EXPECT_GE(std::stoi(found[1]), 8);
    EXPECT_LE(std::stoi(found[1]), 10);
    EXPECT_EQ(std::stoi(found[1]) + std::stoi(found[2]), 30);
    // Two attempts each, and those that the worker had already.
    const auto attempts = [&] { return rows_of(folder, "SELECT count(*) AS n FROM attempt")[0]["n"].get<int>(); };
    const int first = attempts();
    EXPECT_GE(first, 16);
    EXPECT_LE(first, 20);

    // The same run again tries them again.
    EXPECT_EQ(run_program({"run", "c.json", "-j", "1"}, folder.path()).code, 1);
    EXPECT_GE(attempts(), first + 16);
    EXPECT_LE(rows_of(folder, "SELECT count(DISTINCT case_key) AS n FROM attempt")[0]["n"], 12);

    // What was missing is there: all are computed.
    folder.write("p.cases/repaired", "");
    const auto resumed = run_program({"run", "c.json", "-j", "2"}, folder.path());
    EXPECT_EQ(resumed.code, 0) << resumed.err;
    expect_has(resumed.err, " failed cases of 'p' are tried again, because none has an answer yet");
    EXPECT_EQ(rows_of(folder, "SELECT count(*) AS n FROM p WHERE y = x")[0]["n"], 30);
    EXPECT_EQ(run_program({"verify", "p.db"}, folder.path()).code, 0);
}

TEST(Programs, FailuresThatDifferOrThatAreWantedDoNotStopARun) {
    const auto attempts_after = [](const std::string& script, std::vector<std::string> options) {
        const Folder folder;
        auto campaign = script_campaign(20);
        campaign["limits"] = {{"attempts", 1}};
        (void)run_script(folder, script, campaign, std::move(options));
        return rows_of(folder, "SELECT count(*) AS n FROM attempt")[0]["n"].get<int>();
    };
    EXPECT_LE(attempts_after("exit 3\n", {"-j", "1"}), 12) << "8, and those that the worker had already";
    EXPECT_EQ(attempts_after("exit 3\n", {"-j", "1", "--keep-going"}), 20);
    EXPECT_LE(attempts_after("true\n", {"-j", "1"}), 12) << "rejected: out.json was not written";
    EXPECT_EQ(attempts_after("case $1 in 0.5) exit 3;; *) exit 4;; esac\n", {"-j", "1"}), 20) << "two reasons";
    EXPECT_EQ(attempts_after("[ $1 = 0.75 ] || exit 3\n" + std::string(sound_script), {"-j", "1"}), 20)
        << "one has an answer";
}

TEST(Programs, AMissingVersionIsStatedOnce) {
    const Folder folder;
    const auto note = [](const Ended& ended) {
        return ended.err.find("note: without program.version, results of two versions of 'sh' are not told apart") !=
               std::string::npos;
    };
    EXPECT_TRUE(note(run_script(folder, sound_script, script_campaign(2))));
    EXPECT_FALSE(note(run_script(folder, sound_script, script_campaign(4))));
    const Folder other;
    EXPECT_FALSE(note(run_script(
        other, sound_script,
        script_campaign(2, {{"version", {{"command", {"sh", "-c", "echo tool 3"}}, {"match", "tool (.*)"}}}}))));
}

}  // namespace grainsweep::tests::programs_test
