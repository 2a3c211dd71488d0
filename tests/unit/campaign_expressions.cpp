// Numbers with units and expressions in campaign files: the cases are those of plain numbers, and what is wrong gets
// its sentence.
#include "sweep/campaign/expressions.hpp"
#include "sweep/campaign/installed_machines.hpp"

#include "sweep/campaign/identity.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/reader.hpp"
#include "sweep/campaign/relevance.hpp"
#include "tests/support/stored_both_ways.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace grainsweep::tests::campaign_expressions_test {

using namespace campaign;
using nlohmann::json;
using testing::HasSubstr;

json spreading() {
    return json::parse(R"({"campaign": "c", "scene": "powder_spreading",
        "factors": [{"name": "diameter", "between": [6e-5, 1.2e-4]}, {"name": "cohesion", "levels": [0, 10000, 35000]}],
        "fixed": {"speed": 0.15, "gap": 2e-4},
        "design": {"kind": "list", "rows": [[6e-5, 0], [7.5e-5, 35000], [1.2e-4, 10000]]}})");
}

json with(json file, const std::string& patch) {
    return file.patch(json::parse(patch));
}

std::string sentence_of(const json& file) {
    try {
        (void)unfold(parse_campaign(file.dump(), "."), {});
    } catch (const InputError& wrong) {
        return wrong.what();
    }
    return "";
}

std::vector<Case> cases_of(const json& file, const std::filesystem::path& folder = ".") {
    std::vector<Case> cases;
    const auto unfolded = unfold(parse_campaign(file.dump(), folder), {});
    for (std::size_t k = 0; k < unfolded.size(); ++k) cases.push_back(unfolded[k].question);
    return cases;
}

TEST(QuantitiesInCampaigns, GiveTheCasesOfPlainNumbers) {
    const json plain = spreading();
    const json united = with(plain, R"([
        {"op": "replace", "path": "/factors/0/between", "value": ["60 um", "0.12 mm"]},
        {"op": "replace", "path": "/factors/1/levels", "value": [0, "10 kJ/m3", "0.035 J/cm3"]},
        {"op": "replace", "path": "/fixed", "value": {"speed": "150 mm/s", "gap": "200 µm"}},
        {"op": "replace", "path": "/design/rows", "value": [["60 um", 0], ["75 um", "35 kJ/m3"], [1.2e-4, "10 kPa"]]}])");
    EXPECT_EQ(cases_of(united), cases_of(plain));
    const auto one = identity_of(parse_campaign(plain.dump(), "."));
    const auto other = identity_of(parse_campaign(united.dump(), "."));
    EXPECT_EQ(one.fixed, other.fixed);
    EXPECT_EQ(one.factors, other.factors);
}

TEST(QuantitiesInCampaigns, StandInFilesOfRowsAndOnCommandLines) {
    const std::filesystem::path folder = testing::TempDir();
    std::ofstream(folder / "quantity_rows.csv") << "cohesion,diameter\n0,60 um\n35 kJ/m3,75 um\n1e4,0.12 mm\n";
    json file = spreading();
    file["design"] = {{"kind", "list"}, {"file", "quantity_rows.csv"}};
    EXPECT_EQ(cases_of(file, folder), cases_of(spreading()));
    std::filesystem::remove(folder / "quantity_rows.csv");

    const auto& scene = *campaign::scene_named("powder_spreading");
    const auto value = [&](const char* name, const char* text) {
        return parse_value(*scene.find_parameter(name), text, ".", "--set");
    };
    EXPECT_EQ(value("gap", "200 um"), Value{2e-4});
    EXPECT_EQ(value("gap", "2e-4"), Value{2e-4});
    EXPECT_EQ(value("cohesion_law", "sjkr2"), Value{std::string("sjkr2")});
    const auto& drum = *campaign::scene_named("rotating_drum");
    EXPECT_EQ(parse_value(*drum.find_parameter("rpm"), "0.5 Hz", ".", ""), Value{30.0});
    EXPECT_EQ(parse_value(*drum.find_parameter("particles"), "1e3", ".", ""), Value{std::int64_t{1000}});
}

TEST(QuantitiesInCampaigns, StandInConditionsOfTargets) {
    const auto file = [](const json& first, const json& second) {
        json text = json::parse(R"({"campaign": "c", "scene": "rotating_drum",
            "factors": [{"name": "friction", "between": [0.1, 0.9]}],
            "calibration": {"targets": [{"observable": "angle_cm", "value": 34, "error": 0.5, "inputs": {"rpm": 15}},
                                        {"observable": "angle_cm", "value": 39, "error": 0.5, "inputs": {"rpm": 30}}],
                            "discrepancy": {"angle_cm": 0.5}}})");
        text["calibration"]["targets"][0]["inputs"]["rpm"] = first;
        text["calibration"]["targets"][1]["inputs"]["rpm"] = second;
        return text;
    };
    EXPECT_EQ(cases_of(file("15 rpm", "0.5 Hz")), cases_of(file(15, 30)));
    EXPECT_EQ(cases_of(file("15", "30 1/min")), cases_of(file(15, 30)));
}

TEST(Expressions, GiveEachCaseItsNumber) {
    const json file = with(spreading(), R"~([
        {"op": "replace", "path": "/fixed/gap", "value": "3*diameter"},
        {"op": "add", "path": "/fixed/friction", "value": "if(cohesion > 2e4, 0.4, gap/diameter/10)"},
        {"op": "add", "path": "/fixed/width", "value": "2*5"}])~");
    const auto cases = cases_of(file);
    ASSERT_EQ(cases.size(), 3U);
    for (const auto& one : cases) {
        const double diameter = std::get<double>(one.inputs.at("diameter"));
        const bool sticky = std::get<double>(one.inputs.at("cohesion")) > 2e4;
        EXPECT_EQ(one.inputs.at("gap"), Value{3 * diameter});
        EXPECT_EQ(one.inputs.at("friction"), Value{sticky ? 0.4 : 3 * diameter / diameter / 10});
        EXPECT_EQ(std::get<double>(coerced(one.inputs.at("width"), Value{0.0})), 10);
    }
    // A list that gives the numbers instead asks the same.
    json plain = with(spreading(),
                      R"([{"op": "add", "path": "/fixed/width", "value": 10}, {"op": "remove", "path": "/fixed/gap"},
        {"op": "add", "path": "/factors/-", "value": {"name": "gap", "between": [1e-4, 1e-3]}},
        {"op": "add", "path": "/factors/-", "value": {"name": "friction", "between": [0.1, 0.5]}}])");
    for (std::size_t k = 0; k < cases.size(); ++k) {
        plain["design"]["rows"][k].push_back(std::get<double>(cases[k].inputs.at("gap")));
        plain["design"]["rows"][k].push_back(std::get<double>(cases[k].inputs.at("friction")));
    }
    EXPECT_EQ(cases_of(plain), cases);
}

TEST(Expressions, AreTheSameInAListInAGridAndAtAPoint) {
    json file = with(spreading(), R"([{"op": "replace", "path": "/fixed/gap", "value": "3*diameter"},
        {"op": "replace", "path": "/design", "value": {"kind": "halton", "points": 12}}])");
    const auto campaign = parse_campaign(file.dump(), ".");
    const auto unfolded = unfold(campaign, [](const Inputs& inputs) {
        return std::get<double>(inputs.at("gap")) == 3 * std::get<double>(inputs.at("diameter"));
    });
    EXPECT_EQ(unfolded.size(), 12U) << "a condition sees the numbers";
    for (std::size_t k = 0; k < unfolded.size(); ++k) {
        const auto placed = unfolded[k];
        EXPECT_EQ(make_case(campaign.scene(), placed.question.inputs, placed.question.seed), placed.question);
        EXPECT_EQ(case_seed(campaign, placed.question.inputs, 0), placed.question.seed);
    }
    const std::vector<double> middle(2, 0.5);
    const Inputs inputs = campaign.space.at(std::span<const double>(middle));
    EXPECT_EQ(inputs.at("gap"), Value{3 * std::get<double>(inputs.at("diameter"))});
}

TEST(Expressions, DoNotDependOnTheirOrderOrBlanks) {
    const auto identity = [](const char* first, const char* second) {
        const json file = {{"campaign", "c"},
                           {"scene", "rehearsal"},
                           {"factors", {{{"name", "x1"}, {"between", {0, 1}}}}},
                           {"fixed", {{"x2", first}, {"x3", second}}},
                           {"design", {{"kind", "halton"}, {"points", 3}}}};
        return texts_of(identity_of(parse_campaign(file.dump(), "."))).fixed;
    };
    EXPECT_EQ(identity("x1/2", "x2/2"), identity(" x1 / 2", "+x2/ 2 "));
    EXPECT_EQ(identity("x3/2", "x1/2"), "x2 = x3/2\nx3 = x1/2\n");
}

TEST(Expressions, AreReadBackFromTheArchive) {
    const json file = with(spreading(), R"~([{"op": "replace", "path": "/fixed/gap", "value": "max(width, 4)*diameter"},
        {"op": "add", "path": "/fixed/width", "value": "floor(3.5 + (cohesion == 0)*2)"}])~");
    const auto campaign = parse_campaign(file.dump(), ".");
    const auto stored = expressions_of(stored_both_ways(identity_of(campaign)), campaign.scene());
    ASSERT_EQ(stored.size(), 2U);
    EXPECT_EQ(stored[0].name, "width") << "gap needs it";
    const auto cases = cases_of(file);
    EXPECT_EQ(cases[0].inputs.at("gap"), Value{5 * 6e-5});
    EXPECT_EQ(cases[1].inputs.at("gap"), Value{4 * 7.5e-5});
    for (const auto& one : cases) {
        Inputs inputs = one.inputs;
        inputs["gap"] = inputs["width"] = Value{0.0};
        evaluate_expressions(stored, inputs);
        EXPECT_EQ(inputs, one.inputs);
    }
}

TEST(Expressions, GiveWayToWhatIsSet) {
    auto campaign = parse_campaign(
        with(spreading(), R"([{"op": "replace", "path": "/fixed/gap", "value": "3*diameter"}])").dump(), ".");
    ASSERT_EQ(campaign.space.expressions.size(), 1U);
    EXPECT_EQ(fixed_as_stated(campaign.space).at("gap"), Value{std::string("3*diameter")});
    hold(campaign.space, "diameter", Value{1e-4}, "");
    const std::vector<double> first(1, 0.0);
    EXPECT_EQ(campaign.space.at(std::span<const double>(first)).at("gap"), Value{3 * 1e-4});
    hold(campaign.space, "gap", Value{5e-4}, "");
    EXPECT_EQ(campaign.space.at(std::span<const double>(first)).at("gap"), Value{5e-4});
}

TEST(Expressions, OutOfBoundsMatterOnlyWhereAPointIsAsked) {
    const json file =
        with(spreading(), R"~([{"op": "replace", "path": "/fixed/gap", "value": "if(cohesion > 2e4, 1/0, 2e-4)"}])~");
    EXPECT_THAT(sentence_of(file), HasSubstr("$.fixed.gap: got \"if(cohesion>2e4,1/0,2e-4)\"; 'gap' must be a number"));
    EXPECT_THAT(sentence_of(file), HasSubstr("and it is inf where cohesion = 35000."));
    const auto filter = [](const Inputs& inputs) { return std::get<double>(inputs.at("cohesion")) < 2e4; };
    EXPECT_EQ(unfold(parse_campaign(file.dump(), "."), filter).size(), 2U);
}

struct Wrong {
    const char* patch;
    const char* sentence;
};

class WrongQuantity : public testing::TestWithParam<Wrong> {};

TEST_P(WrongQuantity, GetsItsSentence) {
    const auto said = sentence_of(with(spreading(), GetParam().patch));
    EXPECT_THAT(said, HasSubstr(GetParam().sentence)) << GetParam().patch;
    EXPECT_LT(said.size(), 400U);
}

#define GAP(text) R"([{"op": "replace", "path": "/fixed/gap", "value": ")" text R"("}])"
#define BETWEEN(low, high) R"([{"op": "replace", "path": "/factors/0/between", "value": [)" low ", " high "]}]"
#define LEVELS(values) R"([{"op": "replace", "path": "/factors/1/levels", "value": [)" values "]}]"
#define FIXED(name, text) R"([{"op": "add", "path": "/fixed/)" name R"(", "value": ")" text R"("}])"

INSTANTIATE_TEST_SUITE_P(
    InFactorsAndRows, WrongQuantity,
    testing::Values(
        Wrong{BETWEEN(R"("60 s")", R"("120 um")"),
              "$.factors[0].between[0]: got \"60 s\"; 'diameter' must be a number"},
        Wrong{BETWEEN(R"("60 s")", R"("120 um")"), "'s' does not fit 'm', these fit: um, mm, m, nm."},
        Wrong{BETWEEN(R"("60 umm")", "1e-4"), "'umm' is no unit, the nearest that fits is 'um'."},
        Wrong{BETWEEN(R"("60 microns2")", "1e-4"), "'microns2' does not fit 'm'"},
        Wrong{BETWEEN(R"("120 um")", R"("60 um")"),
              "$.factors[0].between: got [\"120 um\",\"60 um\"]; low must be below high."},
        Wrong{BETWEEN(R"("60 um")", R"("60e-3 mm")"), "low must be below high."},
        Wrong{BETWEEN(R"("60 um")", R"("12 km")"), "and this is 12000 m."},
        Wrong{BETWEEN(R"("um")", "1e-4"), "it begins with no number."},
        Wrong{BETWEEN(R"("")", "1e-4"), "it begins with no number."},
        Wrong{BETWEEN(R"("1,5 um")", "1e-4"), "the decimal sign is a point."},
        Wrong{BETWEEN(R"("1e999 um")", "1e-4"), "the number is beyond double precision."},
        Wrong{BETWEEN(R"("2*30 um")", "1e-4"), "'*30 um' is no unit"},
        Wrong{BETWEEN(R"("gap/2")", "1e-4"), "it begins with no number."},
        Wrong{LEVELS(R"("35 kJ/m2")"), "$.factors[1].levels[0]: got \"35 kJ/m2\"; 'cohesion' must be a number"},
        Wrong{LEVELS(R"("35 kJ/m2")"), "'kJ/m2' does not fit 'J/m3', the nearest that fits is 'kJ/m3'."},
        Wrong{LEVELS(R"("35 kj/m3")"), "'kj/m3' is no unit, the nearest that fits is 'kJ/m3'."},
        Wrong{LEVELS(R"(35000, "35 kJ/m3")"), "$.factors[1].levels[1]: got \"35 kJ/m3\"; this level is there twice."},
        Wrong{LEVELS(R"("-1 kJ/m3")"), "and this is -1000 J/m3."},
        Wrong{R"([{"op": "replace", "path": "/design/rows/1/0", "value": "75 mm"}])",
              "$.design.rows[1][0]: got \"75 mm\"; 'diameter' must be a number"},
        Wrong{R"([{"op": "replace", "path": "/design/rows/1/0", "value": "50 um"}])",
              "$.design.rows[1][0]: got \"50 um\"; factor 'diameter' goes from 6e-05 to 0.00012."},
        Wrong{R"([{"op": "replace", "path": "/design/rows/1/1", "value": "34 kJ/m3"}])",
              "got \"34 kJ/m3\"; is none of the levels of factor 'cohesion'."}));

INSTANTIATE_TEST_SUITE_P(
    InFixedValues, WrongQuantity,
    testing::Values(Wrong{GAP("30,5 um"), "$.fixed.gap: got \"30,5 um\"; the decimal sign is a point: '30.5 um'."},
                    Wrong{GAP("60 Pa"), "$.fixed.gap: got \"60 Pa\"; 'gap' must be a number"},
                    Wrong{GAP("60 Pa"), "'Pa' does not fit 'm'"},
                    Wrong{GAP("60 parsnips"), "'parsnips' is no unit, these fit: um, mm, m, nm."},
                    Wrong{GAP("60 mm um"), "'mm um' does not fit 'm'"}, Wrong{GAP("30 deg"), "'deg' does not fit 'm'"},
                    Wrong{GAP("10 %"), "'%' does not fit 'm'"},
                    Wrong{FIXED("friction", "30 deg"), "'deg' does not fit '1'"},
                    Wrong{FIXED("vibration_frequency", "30 m"), "'m' does not fit 'Hz', these fit: Hz, kHz, 1/s, rpm."},
                    Wrong{FIXED("cohesion_law", "35 kJ/m3"), "$.fixed.cohesion_law: got \"35 kJ/m3\"; must be 'sjkr'"},
                    Wrong{GAP("3*diametre"),
                          "or an expression of other parameters: 'diametre' is no name here (the nearest is "
                          "'diameter'), at position 3."},
                    Wrong{GAP("thick"), "or an expression of other parameters: 'thick' is no name here"},
                    Wrong{GAP("3*diameter um"), "an operator must stand before 'um' at position 12."},
                    Wrong{GAP("3*(diameter"), "')' is missing at position 12."},
                    Wrong{GAP("3*cohesion_law"), "'cohesion_law' is no name here"},
                    Wrong{GAP("max(diameter; 1)"), "an operator must stand before ';' at position 13."},
                    Wrong{GAP("gap*2"), "$.fixed.gap: got \"gap*2\"; an expression cannot need itself: gap needs gap."},
                    Wrong{R"([{"op": "replace", "path": "/fixed/gap", "value": "speed/1000"},
                  {"op": "replace", "path": "/fixed/speed", "value": "1000*gap"}])",
                          "an expression cannot need itself: gap needs speed needs gap."},
                    Wrong{FIXED("diameter", "3*gap"), "'diameter' is also a factor; it is either varied or fixed."},
                    Wrong{GAP("diameter - 1"), "'gap' must be a number"},
                    Wrong{GAP("diameter - 1"), "and it is -0.99994 where diameter = 6e-05."},
                    Wrong{GAP("log(0*diameter)"), "and it is -inf where diameter = 6e-05."},
                    Wrong{GAP("sqrt(-diameter)"), "and it is not a number where diameter = 6e-05."},
                    Wrong{GAP(""), "a number or a name is missing at position 1."}));

}  // namespace grainsweep::tests::campaign_expressions_test
