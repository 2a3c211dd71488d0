// Every wrong distribution or sample gets one sentence: where, what value, which rule, the nearest right word.
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/reader.hpp"
#include "tests/support/process.hpp"

#include <gtest/gtest.h>

#include <string>

namespace grainsweep::tests::campaign_distribution_errors_test {

using namespace campaign;

struct Wrong {
    const char* factors;
    const char* sentence;
};

class WrongDistribution : public testing::TestWithParam<Wrong> {};

TEST_P(WrongDistribution, GetsItsSentence) {
    const Folder folder;
    folder.write("two.csv", "x1,x2\n0.1,0.2\n0.3,0.4\n");
    folder.write("words.csv", "x1\n0.1\nhigh\n");
    folder.write("outside.csv", "x1\n0.1\n1.5\n");
    folder.write("one.csv", "x1\n0.1\n");
    folder.write("same.csv", "x1\n0.1\n0.1\n0.1\n");
    folder.write("empty.csv", "");
    folder.write("bare.csv", "0.1,0.2\n0.3,0.4\n");
    folder.write("german.csv", "x1;x2\n0,1;0,2\n");
    folder.write("ragged.csv", "x1,x2\n0.1,0.2\n0.3\n");
    std::string long_list = "x1\n";
    for (int i = 0; i < 20'002; ++i) long_list += "0.5\n";
    folder.write("long.csv", long_list);
    std::string sentence = "no complaint";
    try {
        (void)parse_campaign(R"({"campaign": "c", "scene": "rehearsal", "factors": [)" +
                                 std::string(GetParam().factors) + R"(], "design": {"kind": "halton", "points": 8}})",
                             folder.path());
    } catch (const InputError& wrong) {
        sentence = wrong.what();
    }
    EXPECT_EQ(sentence, GetParam().sentence);
}

INSTANTIATE_TEST_SUITE_P(
    Figures, WrongDistribution,
    testing::Values(
        Wrong{R"({"name": "x1", "normal": [0.5, 0.1]})", "$.factors[0].normal: got [0.5,0.1]; must be an object."},
        Wrong{R"({"name": "x1", "normal": {"mean": 0.5}})",
              "$.factors[0].normal: key 'sd' is missing: standard deviation, above 0."},
        Wrong{R"({"name": "x1", "normal": {"mean": 0.5, "std": 0.1}})",
              "$.factors[0].normal.std: unknown key; $.factors[0].normal has 'mean', 'sd', 'low', 'high' or 'notes'. "
              "Did you mean "
              "'sd'?"},
        Wrong{R"({"name": "x1", "normal": {"mean": 0.5, "sd": 0}})",
              "$.factors[0].normal.sd: got 0; 'sd' must be a number above 0."},
        Wrong{R"({"name": "x1", "normal": {"mean": 0.5, "sd": -0.1}})",
              "$.factors[0].normal.sd: got -0.1; 'sd' must be a number above 0."},
        Wrong{R"({"name": "x1", "normal": {"mean": "half", "sd": 0.1}})",
              "$.factors[0].normal.mean: got \"half\"; 'mean' must be a number: it begins with no number."},
        Wrong{R"({"name": "x1", "normal": {"mean": null, "sd": 0.1}})",
              "$.factors[0].normal.mean: got null; 'mean' must be a number."},
        Wrong{R"({"name": "x1", "normal": {"mean": 0.5, "sd": 0.5}})",
              "$.factors[0].normal: got {\"mean\":0.5,\"sd\":0.5}; 31.7 % of the distribution lie where 'x1' has no "
              "value, which is a number from 0 to 1; at most 5 % may, unless \"low\" or \"high\" truncates the "
              "distribution there."},
        Wrong{
            R"({"name": "x1", "normal": {"mean": 7, "sd": 0.5}})",
            "$.factors[0].normal: got {\"mean\":7,\"sd\":0.5}; 100 % of the distribution lie where 'x1' has no value, "
            "which is a number from 0 to 1; at most 5 % may, unless \"low\" or \"high\" truncates the distribution "
            "there."},
        Wrong{R"({"name": "x1", "normal": {"mean": 0.5, "sd": 1e-18}})",
              "$.factors[0].normal: got {\"mean\":0.5,\"sd\":1e-18}; the width is lost in double precision."},
        Wrong{R"({"name": "x1", "lognormal": {"median": 0.2}})",
              "$.factors[0].lognormal: got neither; a lognormal distribution has either \"sigma\", the standard "
              "deviation of the natural logarithm, or \"ratio\", exp(sigma)."},
        Wrong{R"({"name": "x1", "lognormal": {"median": 0.2, "sigma": 0.1, "ratio": 1.1}})",
              "$.factors[0].lognormal: got both; a lognormal distribution has either \"sigma\", the standard deviation "
              "of the natural logarithm, or \"ratio\", exp(sigma)."},
        Wrong{R"({"name": "x1", "lognormal": {"median": 0, "sigma": 0.1}})",
              "$.factors[0].lognormal.median: got 0; 'median' must be a number above 0."},
        Wrong{R"({"name": "x1", "lognormal": {"median": 0.2, "ratio": 1}})",
              "$.factors[0].lognormal.ratio: got 1; must be a number above 1 and up to 20000."},
        Wrong{R"({"name": "x1", "lognormal": {"median": 0.2, "sigma": "10 %"}})",
              "$.factors[0].lognormal.sigma: got \"10 %\"; must be a number above 0 and up to 10."},
        Wrong{R"({"name": "x1", "lognormal": {"median": 0.8, "sigma": 1}})",
              "$.factors[0].lognormal: got {\"median\":0.8,\"sigma\":1}; 41.2 % of the distribution lie where 'x1' has "
              "no value, which is a number from 0 to 1; at most 5 % may, unless \"low\" or \"high\" truncates the "
              "distribution there."},
        Wrong{R"({"name": "x1", "triangular": {"low": 0.5, "mode": 0.5, "high": 0.5}})",
              "$.factors[0].triangular: got {\"high\":0.5,\"low\":0.5,\"mode\":0.5}; low must be below high."},
        Wrong{R"({"name": "x1", "triangular": {"low": 0.2, "mode": 0.1, "high": 0.5}})",
              "$.factors[0].triangular: got {\"high\":0.5,\"low\":0.2,\"mode\":0.1}; the mode must lie from low to "
              "high."},
        Wrong{R"({"name": "x1", "triangular": {"low": 0.2, "mode": 0.3, "high": 1.5}})",
              "$.factors[0].triangular.high: got 1.5; 'x1' must be a number from 0 to 1."},
        Wrong{R"({"name": "x1", "beta": {"low": 0, "high": 1, "a": 0, "b": 2}})",
              "$.factors[0].beta.a: got 0; must be a number from 0.05 to 10000."},
        Wrong{R"({"name": "x1", "beta": {"low": 1, "high": 0, "a": 1, "b": 2}})",
              "$.factors[0].beta: got {\"a\":1,\"b\":2,\"high\":0,\"low\":1}; low must be below high."},
        Wrong{R"({"name": "x1", "beta": {"a": 1, "b": 2}})",
              "$.factors[0].beta: key 'low' is missing: smallest value, a number or a text with a unit."},
        Wrong{R"({"name": "x1", "uniform": {"low": 0.5, "high": 0.5}})",
              "$.factors[0].uniform: got {\"high\":0.5,\"low\":0.5}; low must be below high."},
        Wrong{R"({"name": "x1", "uniform": [0, 1]})", "$.factors[0].uniform: got [0,1]; must be an object."},
        Wrong{R"({"name": "x1", "normal": {"mean": 0.5, "sd": 0.1}, "scale": "log"})",
              "$.factors[0].scale: got \"log\"; a distribution has no scale; it belongs to \"between\"."},
        Wrong{R"({"name": "x1", "normal": {"mean": 0.5, "sd": 0.1}, "between": [0, 1]})",
              "$.factors[0]: got between and normal; a factor has one of 'between', 'levels', 'uniform', 'normal', "
              "'lognormal', 'weibull', 'gumbel', 'triangular', 'beta' or 'sample'."},
        Wrong{R"({"name": "x1", "gaussian": {"mean": 0.5, "sd": 0.1}})",
              "$.factors[0].gaussian: unknown key; $.factors[0] has 'name', 'between', 'levels', 'scale', 'uniform', "
              "'normal', 'lognormal', 'weibull', 'gumbel', 'triangular', 'beta', 'sample', 'step', 'whole', 'group', "
              "'when', "
              "'role' or 'notes'. Did you mean 'normal'?"},
        Wrong{R"({"name": "behave_attempts", "normal": {"mean": 5, "sd": 1}})",
              "$.factors[0].normal: got {\"mean\":5,\"sd\":1}; 'behave_attempts' is a whole number; vary it by "
              "\"levels\"."},
        Wrong{R"({"name": "behaviour", "normal": {"mean": 5, "sd": 1}})",
              "$.factors[0].normal: got {\"mean\":5,\"sd\":1}; the values of 'behaviour' are words; vary it by "
              "\"levels\"."}));

INSTANTIATE_TEST_SUITE_P(
    Samples, WrongDistribution,
    testing::Values(
        Wrong{R"({"name": "x1", "sample": 3})",
              "$.factors[0].sample: got 3; must be the name of a CSV file, or {\"file\": ... or \"powder\": ..., "
              "\"column\": "
              "...}."},
        Wrong{
            R"({"name": "x1", "sample": [0.1, 0.2]})",
            "$.factors[0].sample: got [0.1,0.2]; must be the name of a CSV file, or {\"file\": ... or \"powder\": ..., "
            "\"column\": ...}."},
        Wrong{R"({"name": "x1", "sample": {"column": "x2"}})",
              "$.factors[0].sample: got {\"column\":\"x2\"}; needs \"file\" or \"powder\", one of the two."},
        Wrong{R"({"name": "x1", "sample": "none.csv"})",
              "$.factors[0].sample: got \"none.csv\"; there is no such file beside the campaign file."},
        Wrong{R"({"name": "x3", "sample": "two.csv"})",
              "$.factors[0].sample: got \"two.csv\"; its header has no column 'x3': name it by {\"file\": ..., "
              "\"column\": ...}. Did you mean 'x1'?"},
        Wrong{
            R"({"name": "x3", "sample": {"file": "two.csv", "column": "x4"}})",
            "$.factors[0].sample: got {\"column\":\"x4\",\"file\":\"two.csv\"}; its header has no column 'x4'. Did you "
            "mean 'x1'?"},
        Wrong{
            R"({"name": "x1", "sample": "two.csv"}, {"name": "x3", "sample": {"file": "two.csv", "column": "x1"}})",
            "$.factors[1].sample: got {\"column\":\"x1\",\"file\":\"two.csv\"}; another factor samples the column 'x1' "
            "already."},
        Wrong{R"({"name": "x1", "sample": "words.csv"})",
              "$.factors[0].sample: words.csv, record 3, column 'x1': got \"high\"; 'x1' must be a number from 0 to 1: "
              "it begins with no number."},
        Wrong{R"({"name": "x1", "sample": "outside.csv"})",
              "$.factors[0].sample: outside.csv, record 3, column 'x1': got 1.5; 'x1' must be a number from 0 to 1."},
        Wrong{R"({"name": "x1", "sample": "one.csv"})",
              "$.factors[0].sample: got \"one.csv\"; a sample has at least 2 rows below its header."},
        Wrong{R"({"name": "x1", "sample": "same.csv"})",
              "$.factors[0].sample: got \"same.csv\"; all 3 values of the column 'x1' are the same; what does not vary "
              "goes into \"fixed\"."},
        Wrong{R"({"name": "x1", "sample": "long.csv"})",
              "$.factors[0].sample: got \"long.csv\"; a sample has at most 20000 rows; take every n-th of them."},
        Wrong{R"({"name": "x1", "sample": "empty.csv"})",
              "$.factors[0].sample: got \"empty.csv\"; the file is empty; a header and records are expected."},
        Wrong{R"({"name": "x1", "sample": "bare.csv"})",
              "$.factors[0].sample: got \"bare.csv\"; its first line has the number \"0.1\"; a header that names the "
              "columns is expected."},
        Wrong{R"({"name": "x1", "sample": "german.csv"})",
              "$.factors[0].sample: got \"german.csv\"; its header has semicolons between the columns; commas are "
              "expected, and points in numbers."},
        Wrong{R"({"name": "x1", "sample": "ragged.csv"})",
              "$.factors[0].sample: got \"ragged.csv\"; record 3 has 1 cells and the header 2."},
        Wrong{R"({"name": "behaviour", "sample": "two.csv"})",
              "$.factors[0].sample: got \"two.csv\"; the values of 'behaviour' are words; vary it by \"levels\"."}));

TEST(WrongDistributions, ACalibrationBeginsFromIndependentFactors) {
    const Folder folder;
    folder.write("two.csv", "x1,x2\n0.1,0.2\n0.3,0.4\n");
    std::string sentence = "no complaint";
    try {
        (void)parse_campaign(R"({"campaign": "c", "scene": "rehearsal", "factors": [{"name": "x1", "sample": "two.csv"},
            {"name": "x2", "sample": "two.csv"}], "calibration": {"targets": [{"observable": "y", "value": 1, "error": 0.1}],
            "discrepancy": {"y": 0.1}}})",
                             folder.path());
    } catch (const InputError& wrong) {
        sentence = wrong.what();
    }
    EXPECT_EQ(sentence,
              "$.factors: got x1; a calibration begins from factors that are independent; give each a distribution of "
              "its own, not a column of one file with another.");
}

}  // namespace grainsweep::tests::campaign_distribution_errors_test
