// Boxes of factors with corners where cases fail, answered by a program whose law is known: does a window keep its
// word?
//
// Box k has 2 to 4 factors in [0, 1] and fails where
//
//   even k: a slanted plane is passed,          odd k: two factors lie in a corner,
//   k mod 4 < 2: surely,                        else: with a probability that falls over a tenth of the range.
//
// y grows towards the failures, so that the largest y lies beside them, and scatters by 0.05.
#pragma once

#include "tests/support/program_campaigns.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <string>

namespace grainsweep::tests {

inline std::string failing_script(int box) {
    return "import json, math, random, sys\nk = " + std::to_string(box) + R"(
d = 2 + k % 3
law = random.Random(1000 + k)
slopes = [law.uniform(0.3, 1) for j in range(d)]
offset = law.uniform(0.15, 0.35)
corner = [law.uniform(0.45, 0.65) for j in range(2)]
def depth(x):
    if k % 2 == 0:
        return sum(s * u for s, u in zip(slopes, x)) / sum(slopes) - 0.5 - offset / 2
    return min(x[0] - corner[0], x[1] - corner[1])
def fails(x, r):
    z = depth(x)
    return z > 0 if k % 4 < 2 else r.random() < 0.5 * math.erfc(-z / 0.05 / math.sqrt(2))
for line in sys.stdin:
    q = json.loads(line)
    x = [q['inputs']['x%d' % (j + 1)] for j in range(d)]
    r = random.Random(q['seed'])
    if fails(x, r):
        print('{"outcome": "unstable", "message": "it fails here"}')
    else:
        y = 1 + sum(s * u for s, u in zip(slopes, x)) / sum(slopes) + 0.2 * math.sin(3 * x[0]) + r.gauss(0, 0.05)
        print(json.dumps({'observables': {'y': y}}))
    sys.stdout.flush()
)";
}

inline nlohmann::json failing_campaign(int box, const std::string& name, const nlohmann::json& design) {
    nlohmann::json factors = nlohmann::json::array();
    for (int j = 0; j < 2 + box % 3; ++j)
        factors.push_back({{"name", "x" + std::to_string(j + 1)}, {"between", {0, 1}}});
    return {{"campaign", name},
            {"scene", "program"},
            {"program",
             {{"command", {"python3", "script.py"}},
              {"files", {"script.py"}},
              {"protocol", "lines"},
              {"observables", {{"y", {{"unit", "1"}}}}}}},
            {"factors", factors},
            {"design", design},
            {"limits", {{"attempts", 1}}}};
}

/// What a window promised of the setting it chose, and what fresh runs there gave.
struct Kept {
    double promised = 0, answers = 0;  ///< probability that a run answers and holds, and that it answers
    int runs = 0, answered = 0, held = 0;
    double y = 0;  ///< mean of the answered runs
    int failed = 0, cases = 0;
};

inline Kept kept_promise(int box, int cases, int runs) {
    const Folder folder;
    const auto program = [&](std::vector<std::string> arguments, int code) {
        const auto ended = run_program(arguments, folder.path());
        EXPECT_EQ(ended.code, code) << ended.err;
        return ended.out;
    };
    const auto parsed_rows = [&](const std::string& database, const std::string& sql) {
        return nlohmann::json::parse(program({"query", database, sql, "--format", "json"}, 0));
    };
    folder.write("script.py", failing_script(box));
    folder.write("c.json", failing_campaign(box, "c", {{"kind", "halton"}, {"points", cases}}).dump());
    program({"run", "c.json", "-j", "1", "--quiet"}, 1);
    const auto found = nlohmann::json::parse(
        program({"window", "c.db", "--where", "y >= 1.4", "--maximize", "y", "--single", "--format", "json"}, 0));
    Kept kept;
    const auto& best = found["best"].is_null() ? found["surest"] : found["best"];
    kept.promised = best["probability"];
    kept.answers = best["answers"];
    nlohmann::json row = nlohmann::json::array();
    for (const auto& [name, value] : best["inputs"].items()) row.push_back(value);
    auto fresh = failing_campaign(box, "f", {{"kind", "list"}, {"rows", nlohmann::json::array({row})}});
    fresh["replicates"] = runs;
    fresh["seed"] = 7;
    folder.write("f.json", fresh.dump());
    (void)run_program({"run", "f.json", "-j", "1", "--quiet"}, folder.path());
    const auto counts = parsed_rows("f.db",
                                    "SELECT count(*) AS n, sum(outcome = 'completed') AS answered, "
                                    "sum(coalesce(y >= 1.4, 0)) AS held, avg(y) AS y FROM f")[0];
    kept.runs = counts["n"];
    kept.answered = counts["answered"];
    kept.held = counts["held"];
    kept.y = counts["y"].is_null() ? 0 : counts["y"].get<double>();
    const auto all = parsed_rows("c.db", "SELECT count(*) AS n, sum(outcome <> 'completed') AS failed FROM c")[0];
    kept.cases = all["n"];
    kept.failed = all["failed"];
    return kept;
}

}  // namespace grainsweep::tests
