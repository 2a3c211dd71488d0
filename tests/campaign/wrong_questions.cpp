// A wrong campaign file exits with 2, says one useful sentence, and leaves nothing behind.
#include "tests/support/process.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <vector>

namespace grainsweep::tests::wrong_questions_test {

struct Wrong {
    std::string what, text;
    std::vector<std::string> says;  ///< words the sentence must contain
};

void PrintTo(const Wrong& wrong, std::ostream* out) {
    *out << wrong.what;
}

std::string good_with(const std::string& from, const std::string& to) {
    std::string text = R"({"campaign": "c", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]}],
"fixed": {"response": "sum"}, "design": {"kind": "halton", "points": 10}})";
    const auto at = text.find(from);
    if (at == std::string::npos) throw std::invalid_argument("no such text: " + from);
    return text.replace(at, from.size(), to);
}

std::vector<Wrong> wrongs() {
    return {
        {"unknown_key", good_with("\"fixed\"", "\"fixd\""), {"$.fixd", "fixed"}},
        {"wrong_type", good_with("\"points\": 10", "\"points\": \"ten\""), {"$.design.points", "ten"}},
        {"low_not_below_high", good_with("[0, 1]", "[1, 0.5]"), {"$.factors[0].between"}},
        {"out_of_bounds", good_with("[0, 1]", "[0, 2]"), {"$.factors[0].between", "2"}},
        {"unknown_scene", good_with("rehearsal", "reharsal"), {"$.scene", "reharsal", "rehearsal"}},
        {"factor_not_in_scene", good_with("\"x1\"", "\"frction\""), {"$.factors[0].name", "frction"}},
        {"factor_also_fixed", good_with("\"response\": \"sum\"", "\"x1\": 0.5"), {"x1"}},
        {"empty_design", good_with("\"points\": 10", "\"points\": 0"), {"$.design.points", "0"}},
        {"unknown_design", good_with("halton", "haltn"), {"$.design.kind", "halton"}},
        {"unknown_word", good_with("\"sum\"", "\"som\""), {"$.fixed.response", "som", "sum"}},
        {"no_factors", good_with("[{\"name\": \"x1\", \"between\": [0, 1]}]", "[]"), {"$.factors"}},
        {"table_name", good_with("\"c\"", "\"series\""), {"$.campaign", "series"}},
        {"table_name_parameter", good_with("\"c\"", "\"Parameter\""), {"$.campaign", "Parameter"}},
        {"view_name_inputs", good_with("\"c\"", "\"inputs\""), {"$.campaign", "inputs"}},
        {"bad_where", good_with("\"fixed\"", "\"where\": \"x1 >\", \"fixed\""), {"$.where"}},
        {"where_leaves_nothing", good_with("\"fixed\"", "\"where\": \"x1 > 2\", \"fixed\""), {"where"}},
        {"duplicate_key", good_with("\"fixed\"", "\"scene\": \"rehearsal\", \"fixed\""), {"scene"}},
        {"not_json", "campaign: c\n", {"line 1"}},
        {"empty_file", "", {}},
        {"deep_nesting", std::string(100000, '['), {}},
        {"all_impossible",
         R"({"campaign": "c", "scene": "thermovibration", "factors": [{"name": "cells", "levels": [7, 9]}],
             "fixed": {"particles": 10, "symmetry": "mirror"}, "design": {"kind": "lattice"}})",
         {"cells = 7"}},
        {"without_effect", good_with("\"response\": \"sum\"", "\"behave_attempts\": 2"), {"behave_attempts"}},
    };
}

class WrongCampaign : public testing::TestWithParam<Wrong> {};

TEST_P(WrongCampaign, ExitsWithTwoAndOneSentenceAndWritesNothing) {
    const auto& wrong = GetParam();
    const Folder folder;
    folder.write("c.json", wrong.text);
    for (const char* command : {"run", "plan"}) {
        const auto ended = run_program({command, "c.json"}, folder.path());
        EXPECT_EQ(ended.code, 2) << ended.err;
        EXPECT_TRUE(ended.out.empty()) << ended.out;
        EXPECT_EQ(std::ranges::count(ended.err, '\n'), 1) << ended.err;
        EXPECT_LT(ended.err.size(), 400U) << ended.err;
        for (const auto& word : wrong.says) {
            EXPECT_NE(ended.err.find(word), std::string::npos) << "no '" << word << "' in: " << ended.err;
        }
    }
    for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
        const std::string name = entry.path().filename();
        EXPECT_TRUE(name == "c.json" || name.starts_with("out_") || name.starts_with("err_")) << name << " was written";
    }
}

INSTANTIATE_TEST_SUITE_P(EveryKind, WrongCampaign, testing::ValuesIn(wrongs()),
                         [](const auto& parameter) { return parameter.param.what; });

TEST(WrongArguments, ExitWithTwo) {
    const Folder folder;
    EXPECT_EQ(run_program({"rum"}, folder.path()).code, 2);
    EXPECT_EQ(run_program({"run"}, folder.path()).code, 2);
    EXPECT_EQ(run_program({"run", "nowhere.json"}, folder.path()).code, 2);
    EXPECT_EQ(run_program({"status", "nowhere.db"}, folder.path()).code, 2);
    EXPECT_EQ(run_program({"--version"}, folder.path()).code, 0);
}

TEST(WrongArguments, AreAlsoPrintedAsJsonWhereJsonIsRequested) {
    const Folder folder;
    folder.write("c.json", good_with("\"fixed\"", "\"fixd\""));
    for (const auto& arguments :
         std::vector<std::vector<std::string>>{{"plan", "c.json", "--format", "json"},
                                               {"status", "no.db", "--format=json"},
                                               {"plan", "c.json", "--format", "json", "--fo"}}) {
        const auto ended = run_program(arguments, folder.path());
        EXPECT_EQ(ended.code, 2);
        const auto printed = nlohmann::json::parse(ended.out);
        EXPECT_EQ(printed["error"]["code"], 2);
        EXPECT_EQ("grainsweep: " + printed["error"]["message"].get<std::string>() + "\n", ended.err);
    }
}

}  // namespace grainsweep::tests::wrong_questions_test
