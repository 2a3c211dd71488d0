// What steps, groups, shares and conditions of factors may not be: one sentence each.
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/reader.hpp"
#include "sweep/store/expression.hpp"
#include "sweep/store/when_clauses.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

namespace grainsweep::tests::campaign_factor_errors_test {

using namespace campaign;
using nlohmann::json;

std::string sentence_of(const json& patch) {
    auto text = json::parse(R"({"campaign": "trial", "scene": "rehearsal",
        "factors": [{"name": "x1", "between": [0, 1]}, {"name": "x2", "between": [0, 1]},
                    {"name": "x3", "between": [0, 1]}, {"name": "x4", "levels": [0, 0.5, 1]}],
        "design": {"kind": "halton", "points": 64, "sequences": 8}})");
    text = text.patch(patch);
    try {
        auto campaign = parse_campaign(text.dump(), ".");
        campaign.space.when = store::when_clauses(campaign.space);
        (void)unfold(campaign, store::make_filter(campaign.where, filter_names(campaign)));
    } catch (const InputError& wrong) {
        return wrong.what();
    }
    return "no complaint";
}

struct Wrong {
    const char* patch;
    const char* sentence;  ///< a part of it
};

class WrongFactorRule : public testing::TestWithParam<Wrong> {};

TEST_P(WrongFactorRule, GetsItsSentence) {
    EXPECT_THAT(sentence_of(json::parse(GetParam().patch)), testing::HasSubstr(GetParam().sentence));
}

#define ADD(path, value) R"([{"op": "add", "path": ")" path R"(", "value": )" value "}]"
#define ADD2(path, value, path2, value2)                                                             \
    R"([{"op": "add", "path": ")" path R"(", "value": )" value R"(}, {"op": "add", "path": ")" path2 \
    R"(", "value": )" value2 "}]"

INSTANTIATE_TEST_SUITE_P(
    Steps, WrongFactorRule,
    testing::Values(Wrong{ADD("/factors/0/step", "0"), "$.factors[0].step: got 0; 'step' must be a number above 0"},
                    Wrong{ADD("/factors/0/step", "-0.1"), "'step' must be a number above 0"},
                    Wrong{ADD("/factors/0/step", "\"1 mm\""), "'step' must be a number above 0: 'mm' does not fit"},
                    Wrong{ADD("/factors/0/step", "true"), "'step' must be a number above 0"},
                    Wrong{ADD("/factors/0/step", "2"), "only one multiple of it, counted from 0, lies between 0 and 1"},
                    Wrong{ADD2("/factors/0/step", "0.5", "/factors/0/between", "[0.1, 0.4]"),
                          "no multiple of it, counted from 0, lies between 0.1 and 0.4"},
                    Wrong{ADD("/factors/0/step", "1e-12"),
                          "the values end more than 1000000000 steps from 0: give a larger step"},
                    Wrong{ADD("/factors/3/step", "0.5"), "a factor with \"levels\" are taken as they are"},
                    Wrong{ADD("/factors/3/whole", "true"), "a factor with \"levels\" are taken as they are"},
                    Wrong{ADD("/factors/0", R"({"name": "x1", "normal": {"mean": 0.5, "sd": 0.1}, "step": 2})"),
                          "no multiple of it, counted from 0, lies between 0.19"},
                    Wrong{ADD("/factors/0", R"({"name": "x1", "normal": {"mean": 0.5, "sd": 0.1}, "step": 1e-12})"),
                          "the values end more than 1000000000 steps from 0"},
                    Wrong{ADD("/factors/0/whole", "false"), "only true has a meaning"},
                    Wrong{ADD("/factors/0/whole", "1"), "$.factors[0].whole: got 1; must be true or false"},
                    Wrong{ADD2("/factors/0/whole", "true", "/factors/0/step", "0.5"),
                          "'whole' is a step of 1: give one of the two"},
                    Wrong{ADD("/factors/0/stepp", "0.5"), "step"},
                    Wrong{ADD2("/factors/0/step", "0.25", "/design", R"({"kind": "list", "rows": [[0.3, 0, 0, 0]]})"),
                          "factor 'x1' takes multiples of 0.25"},
                    Wrong{R"([{"op": "add", "path": "/factors/0/step", "value": 0.25},
                  {"op": "replace", "path": "/factors", "value": [{"name": "x1", "between": [0, 1], "step": 0.25}]},
                  {"op": "replace", "path": "/design", "value": {"kind": "refine", "factor": "x1", "observable": "y",
                   "threshold": 1, "width": 0.1}}])",
                          "a refine chooses its points between real numbers itself: leave out 'step'"}));

INSTANTIATE_TEST_SUITE_P(
    Wholes, WrongFactorRule,
    testing::Values(
        Wrong{R"([{"op": "replace", "path": "/scene", "value": "rotating_drum"}, {"op": "replace", "path": "/factors",
                  "value": [{"name": "particles", "between": [100, 200]}]}])",
              "'particles' is a whole number: add \"whole\": true, or vary it by \"levels\""},
        Wrong{R"([{"op": "replace", "path": "/scene", "value": "rotating_drum"}, {"op": "replace", "path": "/factors",
                  "value": [{"name": "particles", "between": [100, 200], "step": 2.5}]}])",
              "'step' must be a whole number above 0"}));

INSTANTIATE_TEST_SUITE_P(
    Groups, WrongFactorRule,
    testing::Values(
        Wrong{ADD2("/factors/0/group", "\"a\"", "/factors/1/group", "\"a\""),
              "factors move in groups in the designs saltelli and morris, not in halton"},
        Wrong{R"([{"op": "add", "path": "/factors/0/group", "value": "a"}, {"op": "remove", "path": "/factors/3"},
                  {"op": "remove", "path": "/design"}, {"op": "add", "path": "/calibration", "value": {
                   "targets": [{"observable": "y", "value": 1, "error": 0.1}], "discrepancy": {"y": 0.1}}}])",
              "factors move in groups in the designs saltelli and morris, not in calibration"},
        Wrong{ADD2("/factors/0/group", "\"a\"", "/design", R"({"kind": "morris", "trajectories": 4})"),
              "this group has one factor"},
        Wrong{ADD2("/factors/0/group", "\"x2\"", "/design", R"({"kind": "morris", "trajectories": 4})"),
              "a factor has this name; take another for the group"},
        Wrong{ADD("/factors/0/group", "\"two words\""), "the name of a group is letters, digits and _"},
        Wrong{ADD("/factors/0/group", "3"), "$.factors[0].group: got 3; must be a non-empty text"},
        Wrong{ADD("/factors/0/group", "\"simplex\""), "the shares that add to one have this group"},
        Wrong{R"([{"op": "replace", "path": "/factors", "value": [{"name": "x1", "between": [0, 1], "group": "a"},
                  {"name": "x2", "between": [0, 1], "group": "a"}]},
                  {"op": "replace", "path": "/design", "value": {"kind": "morris", "trajectories": 4}}])",
              "all factors are in one group: nothing is left to compare"}));

INSTANTIATE_TEST_SUITE_P(
    Shares, WrongFactorRule,
    testing::Values(
        Wrong{ADD("/simplex", "[\"x1\"]"), "$.simplex: got [\"x1\"]; at least two shares add to one"},
        Wrong{ADD("/simplex", "\"x1\""), "$.simplex: got \"x1\"; must be a list"},
        Wrong{ADD("/simplex", "[\"x1\", \"x9\"]"), "must be a factor of the campaign, with its smallest share"},
        Wrong{ADD("/simplex", "[\"x1\", \"x1\"]"), "this share is there twice"},
        Wrong{ADD("/simplex", "[\"x1\", \"x4\"]"), "a share varies between two values, and this factor has levels"},
        Wrong{R"([{"op": "replace", "path": "/factors/0", "value": {"name": "x1", "normal": {"mean": 0.5, "sd": 0.1}}},
                  {"op": "add", "path": "/simplex", "value": ["x1", "x2"]}])",
              "shares are uniform, and this factor has a distribution: give \"between\""},
        Wrong{ADD2("/factors/0/between", "[0.6, 1]", "/simplex", "[\"x1\", \"x2\"]"), "no complaint"},
        Wrong{R"([{"op": "replace", "path": "/factors/0/between", "value": [0.6, 1]},
                  {"op": "replace", "path": "/factors/1/between", "value": [0.4, 1]},
                  {"op": "add", "path": "/simplex", "value": ["x1", "x2"]}])",
              "the smallest shares add to 1: less than 1 is needed"},
        Wrong{ADD2("/factors/0/between", "[0, 0.5]", "/simplex", "[\"x1\", \"x2\"]"),
              "'x1' ends at 0.5, and the others leave up to 1: shares have a lower end only; end it at 1 and give "
              "\"where\": \"x1 <= 0.5\""},
        Wrong{ADD2("/factors/0/step", "0.5", "/simplex", "[\"x1\", \"x2\"]"),
              "steps of several shares do not add to one"},
        Wrong{ADD2("/factors/0/when", "\"x4 = 1\"", "/simplex", "[\"x1\", \"x2\"]"), "all shares count at every point"},
        Wrong{ADD2("/factors/0/group", "\"a\"", "/simplex", "[\"x1\", \"x2\"]"), "the shares move together anyway"},
        Wrong{R"([{"op": "replace", "path": "/factors/0", "value": {"name": "x1", "between": [0.1, 1], "scale": "log"}},
                  {"op": "add", "path": "/simplex", "value": ["x1", "x2"]}])",
              "shares are uniform: a logarithmic scale has no meaning"},
        Wrong{ADD2("/design", R"({"kind": "lattice", "levels": 3})", "/simplex", "[\"x1\", \"x2\"]"),
              "a lattice divides every factor by itself, and its shares do not add to one"},
        Wrong{ADD2("/design", R"({"kind": "list", "rows": [[0.5, 0.5, 0, 0], [0.5, 0.4, 0, 0]]})", "/simplex",
                   "[\"x1\", \"x2\"]"),
              "$.design: got row 2; its shares add to 0.9, not to 1"},
        Wrong{ADD2("/convergence", R"({"observable": "y", "rule": "assisted"})", "/simplex", "[\"x1\", \"x2\"]"),
              "the rule 'assisted' integrates a model over independent factors: leave out 'simplex'"}));

INSTANTIATE_TEST_SUITE_P(
    Conditions, WrongFactorRule,
    testing::Values(Wrong{ADD("/factors/0/when", "\"x1 > 0.5\""),
                          "$.factors[0].when: got x1 > 0.5; 'x1' cannot decide by itself whether it counts"},
                    Wrong{ADD2("/factors/0/when", "\"x2 > 0.5\"", "/factors/1/when", "\"x1 > 0.5\""),
                          "conditions cannot need one another: x1 needs x2 needs x1"},
                    Wrong{ADD("/factors/0/when", "\"x9 > 0.5\""),
                          "it reads no other factor: 'x1' would count everywhere or nowhere"},
                    Wrong{ADD("/factors/0/when", "\"y9 > 0.5\""), "no such column: y9"},
                    Wrong{ADD("/factors/0/when", "\"x2 >\""), "$.factors[0].when: got x2 >; "},
                    Wrong{ADD("/factors/0/when", "\"random() > 0\""),
                          "'random' is not among the deterministic functions of SQLite"},
                    Wrong{ADD("/factors/0/when", "\"0.1 < x2 < 0.3\""), "compares the outcome of a comparison"},
                    Wrong{ADD("/factors/0/when", "\"  \""), "a condition is expected"},
                    Wrong{ADD("/factors/0/when", "1"), "must be a non-empty text"},
                    Wrong{ADD("/factors/0/when", "\"x4 = 7\""),
                          "it is true at none of the 64 points of the design: 'x1' never counts"},
                    Wrong{ADD2("/factors/0/when", "\"x5 > 0.5\"", "/fixed", R"({"x5": "2*x2"})"),
                          "'x5' follows from an expression, which is evaluated later: write what it needs"},
                    Wrong{ADD2("/factors/0/when", "\"x4 = 1\"", "/convergence",
                               R"({"observable": "y", "rule": "assisted"})"),
                          "the rule 'assisted' integrates a model over independent factors: leave out 'when'"}));

#undef ADD
#undef ADD2

}  // namespace grainsweep::tests::campaign_factor_errors_test
