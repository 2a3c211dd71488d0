// Programs that stay alive: one question a line, one reply a line.
#include "tests/support/program_campaigns.hpp"

#include <gtest/gtest.h>

#include <chrono>

namespace grainsweep::tests::program_lines_test {

using nlohmann::json;

/// A program in Python that replies to each question q by what `reply` evaluates to.
std::string replying(const std::string& before, const std::string& reply) {
    return "import json, os, sys, time\n" + before +
           "\nfor line in sys.stdin:\n    q = json.loads(line)\n    x = q['inputs']['x']\n" + reply +
           "\n    sys.stdout.flush()\n";
}

json lines_campaign(int points) {
    json campaign = script_campaign(points, {{"command", {"python3", "script.sh"}},
                                             {"protocol", "lines"},
                                             {"observables", {{"y", {{"unit", "1"}, {"from", nullptr}}}}}});
    return campaign;
}

const std::string sound = "    print(json.dumps({'case': q['case'], 'observables': {'y': 2 * x}}))";

std::string ending_of(const std::string& script, const json& limits = {{"attempts", 1}}) {
    const Folder folder;
    auto campaign = lines_campaign(1);
    campaign["limits"] = limits;
    const auto ended = run_script(folder, script, campaign);
    EXPECT_LT(ended.most_memory, 300) << "MB";
    const auto rows = rows_of(folder,
                              "SELECT c.outcome || ': ' || coalesce(t.message, '') AS text FROM sim_case AS c JOIN "
                              "attempt AS t USING (case_key) ORDER BY t.number DESC LIMIT 1");
    return rows.is_array() && !rows.empty() ? rows[0]["text"].get<std::string>() : ended.err;
}

void expect_has(const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
}

TEST(ProgramLines, OneProgramAnswersManyCases) {
    const Folder folder;
    auto campaign = lines_campaign(500);
    campaign["program"]["observables"]["started"] = {{"unit", "1"}};
    campaign["program"]["observables"]["p"] = {{"unit", "m"}, {"shape", "profile"}};
    const auto ended =
        run_script(folder,
                   replying("me = os.getpid()",
                            "    print(json.dumps({'observables': {'y': 2 * x, 'started': me, 'p': [[0, x], "
                            "[1, 2 * x]]}}))"),
                   campaign);
    EXPECT_EQ(ended.code, 0) << ended.err;
    const auto rows =
        rows_of(folder, "SELECT count(*) AS n, count(DISTINCT started) AS programs FROM p WHERE y = 2 * x");
    EXPECT_EQ(rows[0]["n"], 500);
    EXPECT_LE(rows[0]["programs"], 2);
    EXPECT_EQ(rows_of(folder, "SELECT count(*) AS n FROM series")[0]["n"], 1000);
    EXPECT_FALSE(std::filesystem::exists(folder / "p.cases"));
}

TEST(ProgramLines, EveryFailureIsOneClearOutcome) {
    expect_has(ending_of(replying("", "    print('{\"observables\": {\"y\": NaN}}')")),
               "rejected: its reply: /observables/y is NaN, which is no number");
    expect_has(ending_of(replying("", "    print('{\"observables\": {\"y\": 1e400}}')")),
               "rejected: its reply: /observables/y is 1e400, which is no number");
    expect_has(ending_of(replying("", "    print('{\"observables\": {\"y\": 1, \"y\": 2}}')")),
               "rejected: its reply: /observables/y is there twice");
    expect_has(ending_of(replying("", "    print('[' * 100000)")),
               "rejected: its reply is nested deeper than 100 levels");
    expect_has(ending_of(replying("", "    print('{\"observables\": {}}')")), "rejected: it replied without y");
    expect_has(ending_of(replying("", "    print('{\"observables\": {\"y\": 1, \"z\": 2}}')")),
               "rejected: it measured 'z', which is not declared");
    expect_has(ending_of(replying("", "    print('hello')")), "rejected: it replied what is no JSON object");
    expect_has(ending_of(replying("", "    print('{\"outcome\": \"unstable\", \"message\": \"blew up\"}')")),
               "unstable: blew up");
    expect_has(ending_of(replying("", "    sys.exit('no more')")),
               "crashed: the program ended with exit code 1; it wrote: no more");
    expect_has(ending_of(replying("print('a greeting'); sys.stdout.flush(); time.sleep(0.3)", sound)),
               "is no JSON object");
    expect_has(ending_of(replying("", "    while True: sys.stdout.write('a' * 100000)")),
               "rejected: it replied by a line of more than 16 MB");
    expect_has(ending_of(replying("", "    time.sleep(1000)"), {{"attempts", 1}, {"wall_seconds", 0.5}}),
               "timed_out: no answer within 0.5 s");
    expect_has(ending_of(replying("", "    print('{\"case\": \"other\", \"observables\": {\"y\": 1}}')")),
               "rejected: it replied to case \"other\", which was not asked");
}

/// A second line would be taken for the reply to the next question.
TEST(ProgramLines, TwoLinesForOneQuestionAreNoAnswers) {
    const std::string nameless = "    print(json.dumps({'observables': {'y': 2 * x}}))\n    sys.stdout.flush()\n";
    for (const std::string between : {"", "    time.sleep(0.01)\n"}) {
        const Folder folder;
        auto campaign = lines_campaign(6);
        campaign["limits"] = {{"attempts", 1}};
        (void)run_script(folder, replying("", nameless + between + nameless), campaign);
        EXPECT_EQ(rows_of(folder, "SELECT count(*) AS n FROM p WHERE outcome = 'completed'")[0]["n"], 0);
        expect_has(rows_of(folder, "SELECT message FROM attempt LIMIT 1")[0]["message"].get<std::string>(),
                   "the program wrote a line that was not asked for: {");
    }
    const Folder folder;
    auto campaign = lines_campaign(9);
    campaign["limits"] = {{"attempts", 1}};
    const std::string later =
        "    n = globals().get('n', 0) + 1\n"
        "    print(json.dumps({'observables': {'y': 2 * x}}) + ('\\n{}' if n == 3 else ''))\n    sys.stdout.flush()\n";
    (void)run_script(folder, replying("", later), campaign, {"-j", "1"});
    const auto said = rows_of(folder, "SELECT message FROM attempt WHERE outcome <> 'completed' LIMIT 1");
    expect_has(said.dump(), "its 3 replies before named no");
}

TEST(ProgramLines, AnOptionalObservableMayBeAbsent) {
    const Folder folder;
    auto campaign = lines_campaign(8);
    campaign["program"]["observables"]["y"]["optional"] = true;
    const std::string some =
        "    print(json.dumps({'observables': {'y': x} if x > 0.6 else {'y': None} if x > 0.3 else {}}))";
    EXPECT_EQ(run_script(folder, replying("", some), campaign).code, 0);
    EXPECT_EQ(rows_of(folder, "SELECT count(*) AS n FROM p WHERE (y IS NULL) = (x <= 0.6)")[0]["n"], 8);
    const auto id = rows_of(folder, "SELECT case_id FROM p WHERE y IS NULL LIMIT 1")[0]["case_id"].get<std::string>();
    EXPECT_EQ(run_program({"replay", "p.db", id}, folder.path()).code, 0);
}

TEST(ProgramLines, OneThatEndsNowAndThenIsStartedAnew) {
    const Folder folder;
    const auto script = replying("n = 0", sound + "\n    n += 1\n    if n == 7: sys.stdout.flush(); sys.exit(0)");
    const auto ended = run_script(folder, script, lines_campaign(40));
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_EQ(rows_of(folder, "SELECT count(*) AS n FROM p WHERE y = 2 * x AND attempts = 1")[0]["n"], 40);
}

TEST(ProgramLines, SolveAndReplayAskItToo) {
    const Folder folder;
    ASSERT_EQ(run_script(folder, replying("", sound), lines_campaign(3)).code, 0);
    const auto solved = run_program({"solve", "c.json", "--set", "x=0.25", "--format", "json"}, folder.path());
    EXPECT_EQ(solved.code, 0) << solved.err;
    EXPECT_EQ(json::parse(solved.out)["scalars"]["y"], 0.5);
    const auto id = rows_of(folder, "SELECT case_id FROM p LIMIT 1")[0]["case_id"].get<std::string>();
    EXPECT_EQ(run_program({"replay", "p.db", id}, folder.path()).code, 0);
}

}  // namespace grainsweep::tests::program_lines_test
