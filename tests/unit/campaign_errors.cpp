// Every wrong campaign file gets one sentence: where, what value, which rule, the nearest right word.
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

namespace grainsweep::tests::campaign_errors_test {

using namespace campaign;
using nlohmann::json;

constexpr const char* sound = R"({
  "campaign": "trial", "scene": "rehearsal",
  "factors": [{"name": "x1", "between": [0.1, 0.3]}, {"name": "x2", "levels": [0, 0.5, 1]}],
  "fixed": {"response": "ishigami"},
  "design": {"kind": "halton", "points": 80, "sequences": 8},
  "convergence": {"observable": "y", "block": 40}
})";

std::string sentence_of(std::string_view text, const std::filesystem::path& folder = ".") {
    try {
        (void)parse_campaign(text, folder);
    } catch (const InputError& wrong) {
        return wrong.what();
    }
    return "no complaint";
}

/// The sound campaign after a JSON patch.
std::string patched(const char* patch) {
    return json::parse(sound).patch(json::parse(patch)).dump();
}

struct Wrong {
    const char* patch;
    const char* sentence;
};

class WrongCampaign : public testing::TestWithParam<Wrong> {};

TEST_P(WrongCampaign, GetsItsSentence) {
    EXPECT_EQ(sentence_of(patched(GetParam().patch)), GetParam().sentence);
}

INSTANTIATE_TEST_SUITE_P(
    Names, WrongCampaign,
    testing::Values(
        Wrong{R"([{"op": "remove", "path": "/campaign"}])",
              "$: key 'campaign' is missing: name of the campaign and of its view in the database."},
        Wrong{R"([{"op": "replace", "path": "/campaign", "value": "1st"}])",
              "$.campaign: got \"1st\"; a name is letters, digits and _, not a digit first, at most 128: it names a "
              "view in SQL."},
        Wrong{R"([{"op": "replace", "path": "/campaign", "value": ""}])",
              "$.campaign: got \"\"; must be a non-empty text."},
        Wrong{R"([{"op": "replace", "path": "/campaign", "value": "Series"}])",
              "$.campaign: got \"Series\"; the database has a table or view of this name; take another. Did you mean "
              "'Series_1'?"},
        Wrong{R"([{"op": "replace", "path": "/campaign", "value": "sqlite_x"}])",
              "$.campaign: got \"sqlite_x\"; the database has a table or view of this name; take another. Did you mean "
              "'my_sqlite_x'?"},
        Wrong{R"([{"op": "move", "from": "/design", "path": "/desing"}])",
              "$.desing: unknown key; $ has 'campaign', 'scene', 'factors', 'fixed', 'simplex', 'where', 'design', "
              "'calibration', "
              "'replicates', "
              "'seed', 'common_random_numbers', 'convergence', 'accuracy', 'model', 'program', 'machine', 'powder', "
              "'limits', 'execution' or 'notes'. Did "
              "you mean "
              "'design'?"},
        Wrong{R"([{"op": "add", "path": "/notes", "value": 3}])",
              "$.notes: got 3; notes are a text or a list of texts."}));

INSTANTIATE_TEST_SUITE_P(
    Factors, WrongCampaign,
    testing::Values(
        Wrong{R"([{"op": "replace", "path": "/factors", "value": []}])",
              "$.factors: got []; a campaign varies at least one factor."},
        Wrong{R"([{"op": "replace", "path": "/factors", "value": {}}])", "$.factors: got {}; must be a list."},
        Wrong{R"([{"op": "replace", "path": "/factors/0", "value": 7}])", "$.factors[0]: got 7; must be an object."},
        Wrong{R"([{"op": "replace", "path": "/factors/0/name", "value": "nois"}])",
              "$.factors[0].name: got \"nois\"; scene 'rehearsal' has no parameter of this name (grainsweep scenes "
              "rehearsal lists them). Did you mean 'noise'?"},
        Wrong{R"([{"op": "replace", "path": "/factors/0/name", "value": null}])",
              "$.factors[0].name: got null; scene 'rehearsal' has no parameter of this name (grainsweep scenes "
              "rehearsal lists them)."},
        Wrong{R"([{"op": "replace", "path": "/factors/1/name", "value": "x1"}])",
              "$.factors[1].name: got \"x1\"; this factor is there twice."},
        Wrong{R"([{"op": "add", "path": "/factors/0/levels", "value": [1]}])",
              "$.factors[0]: got between and levels; a factor has one of 'between', 'levels', 'uniform', 'normal', "
              "'lognormal', 'weibull', 'gumbel', 'triangular', 'beta' or 'sample'."},
        Wrong{R"([{"op": "remove", "path": "/factors/0/between"}])",
              "$.factors[0]: got none; a factor has one of 'between', 'levels', 'uniform', 'normal', "
              "'lognormal', 'weibull', 'gumbel', 'triangular', 'beta' or 'sample'."},
        Wrong{R"([{"op": "replace", "path": "/factors/0/between", "value": [0.3, 0.1]}])",
              "$.factors[0].between: got [0.3,0.1]; low must be below high."},
        Wrong{R"([{"op": "replace", "path": "/factors/0/between", "value": [0.1, 0.1]}])",
              "$.factors[0].between: got [0.1,0.1]; low must be below high."},
        Wrong{R"([{"op": "replace", "path": "/factors/0/between", "value": [0.1]}])",
              "$.factors[0].between: got [0.1]; must be [low, high]."},
        Wrong{R"([{"op": "replace", "path": "/factors/0/between", "value": "0.1"}])",
              "$.factors[0].between: got \"0.1\"; must be [low, high]; what is the same in every case goes into "
              "\"fixed\"."},
        Wrong{R"([{"op": "replace", "path": "/factors/0/between", "value": [0, 1.5]}])",
              "$.factors[0].between[1]: got 1.5; 'x1' must be a number from 0 to 1."},
        Wrong{R"([{"op": "replace", "path": "/factors/0/between", "value": ["low", 1]}])",
              "$.factors[0].between[0]: got \"low\"; 'x1' must be a number from 0 to 1: it begins with no number."},
        Wrong{
            R"([{"op": "replace", "path": "/factors/0", "value": {"name": "x1", "between": [0, 1], "scale": "log"}}])",
            "$.factors[0].between: got [0,1]; a logarithmic range must lie above 0."},
        Wrong{R"([{"op": "add", "path": "/factors/0/scale", "value": "logarithmic"}])",
              "$.factors[0].scale: got \"logarithmic\"; must be 'linear' or 'log'."},
        Wrong{R"([{"op": "add", "path": "/factors/1/scale", "value": "log"}])",
              "$.factors[1].scale: got \"log\"; levels have no scale; it belongs to \"between\"."},
        Wrong{R"([{"op": "replace", "path": "/factors/0", "value": {"name": "behave_attempts", "between": [0, 3]}}])",
              "$.factors[0].between: got [0,3]; 'behave_attempts' is a whole number: add \"whole\": true, or vary it "
              "by \"levels\"."},
        Wrong{R"([{"op": "replace", "path": "/factors/0", "value": {"name": "behaviour", "between": [0, 3]}}])",
              "$.factors[0].between: got [0,3]; the values of 'behaviour' are words; vary it by \"levels\"."},
        Wrong{
            R"([{"op": "replace", "path": "/factors/0", "value": {"name": "behaviour", "levels": ["normal", "crahs"]}}])",
            "$.factors[0].levels[1]: got \"crahs\"; must be 'normal', 'crash', 'hang', 'unstable' or 'huge'. Did you "
            "mean 'crash'?"},
        Wrong{R"([{"op": "replace", "path": "/factors/1/levels", "value": []}])",
              "$.factors[1].levels: got []; a factor needs at least one level."},
        Wrong{R"([{"op": "replace", "path": "/factors/1/levels", "value": [0, 0.5, -0.0]}])",
              "$.factors[1].levels[2]: got -0.0; this level is there twice."},
        Wrong{R"([{"op": "replace", "path": "/factors/1", "value": {"name": "behave_attempts", "levels": [1, 1.5]}}])",
              "$.factors[1].levels[1]: got 1.5; 'behave_attempts' must be a whole number from 0 to 1000."},
        Wrong{R"([{"op": "add", "path": "/factors/0/level", "value": [1]}])",
              "$.factors[0].level: unknown key; $.factors[0] has 'name', 'between', 'levels', 'scale', 'uniform', "
              "'normal', 'lognormal', 'weibull', 'gumbel', 'triangular', 'beta', 'sample', 'step', 'whole', 'group', "
              "'when', "
              "'role' or 'notes'. Did you mean 'levels'?"}));

INSTANTIATE_TEST_SUITE_P(
    Fixed, WrongCampaign,
    testing::Values(
        Wrong{R"([{"op": "replace", "path": "/fixed", "value": [1]}])",
              "$.fixed: got [1]; must be an object of parameter names and values."},
        Wrong{R"([{"op": "add", "path": "/fixed/frictoin", "value": 1}])",
              "$.fixed.frictoin: scene 'rehearsal' has no parameter of this name (grainsweep scenes rehearsal lists "
              "them)."},
        Wrong{R"([{"op": "add", "path": "/fixed/x1", "value": 1}])",
              "$.fixed.x1: got 1; 'x1' is also a factor; it is either varied or fixed."},
        Wrong{R"([{"op": "replace", "path": "/fixed/response", "value": 3}])",
              "$.fixed.response: got 3; must be 'sum', 'ishigami', 'g_function', 'spreading_a' or 'spreading_b'."},
        Wrong{R"([{"op": "add", "path": "/fixed/wait_seconds", "value": -1}])",
              "$.fixed.wait_seconds: got -1; 'wait_seconds' must be a number from 0 to 86400 s."},
        Wrong{R"([{"op": "add", "path": "/accuracy", "value": "fast"}])",
              "$.accuracy: got \"fast\"; scene 'rehearsal' offers no accuracy settings; leave it out."}));

INSTANTIATE_TEST_SUITE_P(
    Design, WrongCampaign,
    testing::Values(
        Wrong{R"([{"op": "replace", "path": "/design", "value": "halton"}])",
              "$.design: got \"halton\"; must be an object with a \"kind\"."},
        Wrong{R"([{"op": "replace", "path": "/design/points", "value": 0}])",
              "$.design.points: got 0; must be a whole number from 1 to 100000000."},
        Wrong{R"([{"op": "replace", "path": "/design/points", "value": 80.5}])",
              "$.design.points: got 80.5; must be a whole number from 1 to 100000000."},
        Wrong{R"([{"op": "replace", "path": "/design/points", "value": 50000000}])",
              "$.design.points: got 50000000; a campaign has at most 1000000 cases."},
        Wrong{R"([{"op": "remove", "path": "/design/points"}])",
              "$.design: key 'points' is missing: number of points, all sequences together."},
        Wrong{
            R"([{"op": "add", "path": "/design/scramble", "value": "randm"}])",
            "$.design.scramble: got \"randm\"; must be 'none', 'braaten_weller', 'braaten_weller_vc2006' or 'random'. "
            "Did you mean 'random'?"},
        Wrong{R"([{"op": "add", "path": "/design/squences", "value": 8}])",
              "$.design.squences: unknown key; $.design has 'kind', 'points', 'scramble', 'sequences', 'first' or "
              "'notes'. Did you mean 'sequences'?"},
        Wrong{R"([{"op": "replace", "path": "/design", "value": {"kind": "lattice", "levels": [3]}},
                  {"op": "remove", "path": "/convergence"}])",
              "$.design.levels: got [3]; must be one whole number or one per factor, and there are 2 factors."},
        Wrong{R"([{"op": "replace", "path": "/design", "value": {"kind": "lattice", "levels": [3, 4]}},
                  {"op": "remove", "path": "/convergence"}])",
              "$.design.levels[1]: got 4; this factor is given by its 3 levels."},
        Wrong{R"([{"op": "replace", "path": "/design", "value": {"kind": "lattice", "levels": 1000000000}},
                  {"op": "remove", "path": "/convergence"}])",
              "$.design.levels: got 1000000000; must be a whole number from 1 to 1000000."},
        Wrong{R"([{"op": "replace", "path": "/design", "value": {"kind": "list"}},
                  {"op": "remove", "path": "/convergence"}])",
              "$.design: got neither; give either \"rows\": [[...], ...] or \"file\": a CSV file."},
        Wrong{R"([{"op": "replace", "path": "/design", "value": {"kind": "list", "rows": []}},
                  {"op": "remove", "path": "/convergence"}])",
              "$.design.rows: got []; a design needs at least one row."},
        Wrong{R"([{"op": "replace", "path": "/design", "value": {"kind": "list", "rows": [[0.2]]}},
                  {"op": "remove", "path": "/convergence"}])",
              "$.design.rows[0]: got [0.2]; a row has one value per factor, and there are 2 factors."},
        Wrong{R"([{"op": "replace", "path": "/design", "value": {"kind": "list", "rows": [[0.2, 0], [0.9, 0]]}},
                  {"op": "remove", "path": "/convergence"}])",
              "$.design.rows[1][0]: got 0.9; factor 'x1' goes from 0.1 to 0.3."},
        Wrong{R"([{"op": "replace", "path": "/design", "value": {"kind": "list", "rows": [[0.2, 0.7]]}},
                  {"op": "remove", "path": "/convergence"}])",
              "$.design.rows[0][1]: got 0.7; is none of the levels of factor 'x2'."},
        Wrong{R"([{"op": "replace", "path": "/design", "value": {"kind": "list", "file": "no.csv"}},
                  {"op": "remove", "path": "/convergence"}])",
              "$.design.file: got \"no.csv\"; there is no such file beside the campaign file."}));

INSTANTIATE_TEST_SUITE_P(
    Sections, WrongCampaign,
    testing::Values(
        Wrong{R"([{"op": "add", "path": "/replicates", "value": 0}])",
              "$.replicates: got 0; must be a whole number from 1 to 1000000."},
        Wrong{R"([{"op": "add", "path": "/seed", "value": -1}])",
              "$.seed: got -1; must be a whole number from 0 to 9223372036854774784."},
        Wrong{R"([{"op": "add", "path": "/seed", "value": 18446744073709551615}])",
              "$.seed: got 18446744073709551615; must be a whole number from 0 to 9223372036854774784."},
        Wrong{R"([{"op": "add", "path": "/seed", "value": "1"}])",
              "$.seed: got \"1\"; must be a whole number from 0 to 9223372036854774784."},
        Wrong{R"([{"op": "add", "path": "/where", "value": ""}])", "$.where: got \"\"; must be a non-empty text."},
        Wrong{R"([{"op": "replace", "path": "/convergence/observable", "value": "z"}])",
              "$.convergence.observable: got \"z\"; must be 'y'. Did you mean 'y'?"},
        Wrong{R"([{"op": "replace", "path": "/convergence/observable", "value": "y_series"}])",
              "$.convergence.observable: got \"y_series\"; is a series; statistics need a scalar observable: 'y'."},
        Wrong{R"([{"op": "add", "path": "/convergence/rule", "value": "replicate"}])",
              "$.convergence.rule: got \"replicate\"; must be 'replicates', 'assisted', 'any_change' or 'all_change'. "
              "Did you mean "
              "'replicates'?"},
        Wrong{R"([{"op": "add", "path": "/convergence/gates", "value": ["mean", "sdd"]}])",
              "$.convergence.gates[1]: got \"sdd\"; must be 'mean', 'sd', 'skewness', 'g1', 'kurtosis', 'quantile:', "
              "'above:' or 'below:'. Did you mean "
              "'sd'?"},
        Wrong{R"([{"op": "add", "path": "/convergence/gates", "value": []}])",
              "$.convergence.gates: got []; at least one statistic must be judged."},
        Wrong{R"([{"op": "add", "path": "/convergence/gates", "value": ["sd", "sd"]}])",
              "$.convergence.gates[1]: got \"sd\"; this statistic is there twice."},
        Wrong{R"([{"op": "add", "path": "/convergence/tolerance", "value": 1}])",
              "$.convergence.tolerance: got 1; must be a number above 0 and below 1."},
        Wrong{R"([{"op": "add", "path": "/convergence/stop", "value": 1}])",
              "$.convergence.stop: got 1; must be true or false."},
        Wrong{R"([{"op": "replace", "path": "/convergence/block", "value": 31}])",
              "$.convergence.block: got 31; must give each of the 8 sequences at least 4 points."},
        Wrong{R"([{"op": "replace", "path": "/design/sequences", "value": 3}])",
              "$.convergence.rule: got \"replicates\" by default; this rule needs a halton or sobol design with "
              "\"scramble\": \"random\" and \"sequences\" of at least 4 (8 is good); any_change and all_change need "
              "none."},
        Wrong{R"([{"op": "replace", "path": "/design", "value": {"kind": "lattice", "levels": 3}},
                  {"op": "add", "path": "/convergence/rule", "value": "any_change"}])",
              "$.convergence.rule: got \"any_change\"; the points of a lattice come in no useful order, so blocks of "
              "them mean nothing; compare campaigns of that design or take a halton design."},
        Wrong{R"([{"op": "add", "path": "/limits", "value": {"attempts": 0}}])",
              "$.limits.attempts: got 0; must be a whole number from 1 to 1000."},
        Wrong{R"([{"op": "add", "path": "/limits", "value": {"wall_seconds": -1}}])",
              "$.limits.wall_seconds: got -1; must be a number from 0."},
        Wrong{R"([{"op": "add", "path": "/limits", "value": {"wall_seconds": 1e-9}}])",
              "$.limits.wall_seconds: got 1e-09; must be at least 0.1 s, or 0 for no limit."},
        Wrong{R"([{"op": "add", "path": "/execution", "value": {"silence_seconds": 1}}])",
              "$.execution.silence_seconds: got 1; must be at least 3 s, or 0 for no limit."},
        Wrong{R"([{"op": "add", "path": "/execution", "value": {"start_seconds": 0.01}}])",
              "$.execution.start_seconds: got 0.01; must be at least 0.1 s, or 0 for no limit."},
        Wrong{R"([{"op": "add", "path": "/execution", "value": {"workers": 1.5}}])",
              "$.execution.workers: got 1.5; must be a whole number from 0 to 100000."},
        Wrong{R"([{"op": "add", "path": "/execution", "value": {"threads": 0}}])",
              "$.execution.threads: got 0; must be 'auto' or a whole number from 1 to 1024."},
        Wrong{R"([{"op": "add", "path": "/execution", "value": {"threads": 1.5}}])",
              "$.execution.threads: got 1.5; must be 'auto' or a whole number from 1 to 1024."},
        Wrong{R"([{"op": "add", "path": "/execution", "value": {"threads": true}}])",
              "$.execution.threads: got true; must be 'auto' or a whole number from 1 to 1024."},
        Wrong{R"([{"op": "add", "path": "/execution", "value": {"threads": "atuo"}}])",
              "$.execution.threads: got \"atuo\"; must be 'auto' or a whole number from 1 to 1024. Did you mean "
              "'auto'?"},
        Wrong{R"([{"op": "add", "path": "/execution", "value": {"launcher": "srun"}}])",
              "$.execution.launcher: got \"srun\"; must be a list."},
        Wrong{R"([{"op": "add", "path": "/execution", "value": {"launcher": [""]}}])",
              "$.execution.launcher[0]: got \"\"; must be a non-empty text."}));

TEST(InputError, ShowsTheBeginningOfALongValueOnOneLineThatMovesNoCursor) {
    const std::string words = input_error("$.where", "a\x1b[2J\nb" + std::string(100000, 'x'), "is wrong").what();
    EXPECT_THAT(words, ::testing::HasSubstr("got a\\u001b[2J bxxx"));
    EXPECT_THAT(words, ::testing::EndsWith(" ...; is wrong."));
    EXPECT_LT(words.size(), 500u);
    std::string umlauts;
    for (int k = 0; k < 400; ++k) umlauts += "\xC3\xA4";
    const std::string cut = input_error("", "a" + umlauts, "is wrong").what();
    EXPECT_THAT(cut, ::testing::HasSubstr("\xC3\xA4 ...")) << "cut between two characters";
}

TEST(CampaignText, TheNearestSceneAndDesignAreNamed) {
    EXPECT_THAT(sentence_of(patched(R"([{"op": "replace", "path": "/scene", "value": "rehersal"}])")),
                testing::AllOf(testing::StartsWith("$.scene: got \"rehersal\"; must be "),
                               testing::EndsWith(". Did you mean 'rehearsal'?")));
    EXPECT_THAT(sentence_of(patched(R"([{"op": "replace", "path": "/design/kind", "value": "haltn"}])")),
                testing::AllOf(testing::StartsWith("$.design.kind: got \"haltn\"; must be '"),
                               testing::EndsWith(". Did you mean 'halton'?")));
    EXPECT_THAT(sentence_of(patched(R"([{"op": "remove", "path": "/design/kind"}])")),
                testing::StartsWith("$.design: key 'kind' is missing: '"));
}

TEST(CampaignText, WhatIsNoJsonIsRefusedWithItsPlace) {
    EXPECT_EQ(sentence_of(""), "line 1, column 1: got nothing; a campaign file is one JSON object.");
    EXPECT_EQ(sentence_of(" \n\t"), "line 1, column 1: got nothing; a campaign file is one JSON object.");
    EXPECT_EQ(sentence_of("[1, 2]"), "$: got [1,2]; must be an object.");
    EXPECT_EQ(sentence_of("{\"a\": 1,\n  \"b\" 2}"),
              "line 2, column 7: got \"2\"; not JSON: unexpected number literal; expected ':'.");
    EXPECT_EQ(sentence_of("{\"seed\": 1"), "line 1, column 11: not JSON: unexpected end of input; expected '}'.");
    EXPECT_EQ(sentence_of("{\"seed\": 1} x"),
              "line 1, column 13: got \"x\"; not JSON: invalid literal; expected end of input.");
    EXPECT_EQ(sentence_of("{\"seed\": NaN}"), "line 1, column 10: got \"NaN\"; JSON has no NaN and no Infinity.");
    EXPECT_EQ(sentence_of("{\"seed\": -Infinity}"),
              "line 1, column 10: got \"-Infinity\"; JSON has no NaN and no Infinity.");
    EXPECT_EQ(sentence_of("{\"seed\": 1e999}"),
              "line 1, column 10: got \"1e999\"; a number must be finite in double precision.");
    const std::string no_comments = "JSON has no comments; write \"notes\": \"...\", in any object.";
    EXPECT_EQ(sentence_of("// no\n{}"), "line 1, column 1: got \"//\"; " + no_comments);
    EXPECT_EQ(sentence_of("{\"seed\": 1, // no\n}"), "line 1, column 13: got \"//\"; " + no_comments);
    EXPECT_EQ(sentence_of("{\"seed\": 1\n  # no\n}"), "line 2, column 3: got \"#\"; " + no_comments);
    EXPECT_EQ(sentence_of("{/* no */\"seed\": 1}"), "line 1, column 2: got \"/*\"; " + no_comments);
    EXPECT_EQ(sentence_of("{'seed': 1}"), "line 1, column 2: got \"'\"; JSON has its texts and keys in double quotes.");
    EXPECT_EQ(sentence_of("\xFF\xFE{\0}"),
              "line 1, column 1: got a UTF-16 byte-order mark; the file must be UTF-8 text.");
    EXPECT_EQ(sentence_of("{\"notes\": \"\xC3\x28\"}"),
              "line 1, column 13: got \"\\\"\\ufffd(\"; not JSON: invalid string: ill-formed UTF-8 byte.");
    EXPECT_EQ(sentence_of("{\"notes\": \"\\u0000\"}"),
              "$.notes: got \"\\u0000\"; a text must not contain the NUL character.");
}

TEST(CampaignText, ATrailingCommaIsCalledSo) {
    EXPECT_EQ(sentence_of("{\"seed\": 1,}"),
              "line 1, column 11: got \",\"; a trailing comma: JSON has none before '}'; take it out.");
    EXPECT_EQ(sentence_of("{\"a\": [1, 2,\n\n ]}"),
              "line 1, column 12: got \",\"; a trailing comma: JSON has none before ']'; take it out.");
}

TEST(CampaignText, AKeyThatIsThereTwiceIsRefusedWithItsPath) {
    EXPECT_EQ(sentence_of(R"({"factors": [{"name": "x1"}, {"name": "x2", "name": "x3"}]})"),
              "$.factors[1].name: this key is there twice; keep one.");
    EXPECT_EQ(sentence_of(R"({"a b": 1, "a b": 1})"), "$[\"a b\"]: this key is there twice; keep one.");
}

TEST(CampaignText, DeepNestingIsRefusedWithoutRecursion) {
    const std::string deep = "{\"notes\": " + std::string(1'000'000, '[');
    EXPECT_THAT(sentence_of(deep), testing::EndsWith("nested deeper than 32 levels; a campaign needs 6."));
}

TEST(CampaignText, AByteOrderMarkIsSkipped) {
    EXPECT_EQ(sentence_of(std::string("\xEF\xBB\xBF") + sound), "no complaint");
}

TEST(CampaignText, AMissingFileIsRefusedWithTheNearestName) {
    const auto folder = std::filesystem::temp_directory_path() / "grainsweep_reader_names";
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "quickstart.json") << sound;
    try {
        (void)read_campaign(folder / "quikstart.json");
        FAIL() << "it was read";
    } catch (const InputError& wrong) {
        EXPECT_EQ(std::string(wrong.what()), (folder / "quikstart.json").string() +
                                                 ": there is no such campaign file. Did you mean 'quickstart.json'?");
    }
    EXPECT_THROW((void)read_campaign(folder), InputError);
    std::filesystem::remove_all(folder);
}

/// Each byte dropped, doubled or replaced: a sentence or a campaign, never anything else.
TEST(CampaignText, CorruptedTextNeverCrashes) {
    const std::string text = sound;
    const std::string replacements = "{}[]\",:0-e.\\ x\n\xFF";
    std::size_t refused = 0;
    for (std::size_t k = 0; k < text.size(); ++k) {
        std::vector<std::string> corrupted = {text.substr(0, k), text.substr(k), text.substr(0, k) + text.substr(k + 1),
                                              text.substr(0, k + 1) + text.substr(k)};
        for (const char c : replacements) {
            corrupted.push_back(text);
            corrupted.back()[k] = c;
        }
        for (const auto& one : corrupted) refused += sentence_of(one) != "no complaint" ? 1 : 0;
    }
    EXPECT_GT(refused, text.size() * 10);
}

/// Every value of the file in turn replaced by values of every type.
TEST(CampaignText, WrongTypesNeverCrash) {
    const json document = json::parse(sound);
    const auto flat = document.flatten();
    const json values =
        json::parse(R"([null, true, -1, 1e300, 1e-300, "", "x1", [], [[]], {}, {"kind": 1}, [null, {}]])");
    std::vector<std::string> paths = {"/factors", "/factors/0", "/factors/1/levels",
                                      "/fixed",   "/design",    "/convergence"};
    for (const auto& [path, value] : flat.items()) paths.push_back(path);
    for (const auto& path : paths) {
        for (const auto& value : values) {
            json changed = document;
            changed[json::json_pointer(path)] = value;
            EXPECT_THAT(sentence_of(changed.dump()), testing::Not(testing::HasSubstr("json.exception")));
        }
    }
}

TEST(WrongFile, OfAMachineIsCalledSo) {
    EXPECT_EQ(
        sentence_of(R"({"name": "mixer", "phases": [], "measure": {}})"),
        "$: this is a machine file; a campaign file names it, with \"scene\": \"machine\" and \"machine\": the name "
        "of this file.");
}

}  // namespace grainsweep::tests::campaign_errors_test
