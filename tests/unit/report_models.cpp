// What response models see of a case, conditions of a process window, and what both refuse.
#include "stats/confidence.hpp"
#include "stats/random.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/reader.hpp"
#include "sweep/campaign/stored_text.hpp"
#include "sweep/report/model_tables.hpp"
#include "sweep/study/box_search.hpp"
#include "sweep/study/condition.hpp"
#include "sweep/study/process_window.hpp"
#include "sweep/study/response_models.hpp"
#include "tests/support/answered.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace grainsweep::tests::report_models_test {

using namespace report;
using namespace study;

using store::Store;
using testing::AllOf;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr double none = std::numeric_limits<double>::quiet_NaN();
const std::vector<std::string> names = {"mfr", "rough", "gap"};

bool holds(std::string_view text, std::vector<double> values) {
    return Condition::read(text, names).holds(values);
}

template <class Ask>
std::string refusal(const Ask& ask) {
    try {
        (void)ask();
    } catch (const campaign::InputError& wrong) {
        return wrong.what();
    }
    return "accepted";
}

const std::vector<std::string> units = {"kg/s", "1", "m"};

TEST(Conditions, TakeUnitsAndRatios) {
    const auto united = [](std::string_view text, std::vector<double> values) {
        return Condition::read(text, names, units).holds(values);
    };
    EXPECT_TRUE(united("mfr >= 0.4 g/s and gap < 3 mm", {0.0004, 0, 0.0029}));
    EXPECT_FALSE(united("mfr >= 0.4 g/s and gap < 3 mm", {0.00039, 0, 0.0029}));
    EXPECT_TRUE(united("(0.4 g/s <= mfr) or gap between 30 um and 2 mm", {0.0004, 0, 0}));
    EXPECT_TRUE(united("not rough < 5 %", {0, 0.06, 0}));
    EXPECT_TRUE(united("mfr/gap > 2 and rough < 1", {3, 0.5, 1}));
    EXPECT_FALSE(united("mfr/gap > 2", {3, 0.5, none}));
    EXPECT_FALSE(united("mfr / gap > 2", {0, 0.5, 0}));
    const auto ratio = Condition::read("mfr/gap > 2", names, units);
    EXPECT_THAT(ratio.compared(), ElementsAre(0U, 2U));
    EXPECT_EQ(ratio.direction(0), 1);
    EXPECT_EQ(ratio.direction(2), 0);
    const auto refused = [](std::string_view text) {
        try {
            (void)Condition::read(text, names, units);
        } catch (const campaign::InputError& wrong) {
            return std::string(wrong.what());
        }
        return std::string("accepted");
    };
    EXPECT_THAT(refused("mfr > 3 mm"), HasSubstr("'mfr' is in kg/s, and 'mm' does not fit 'kg/s'"));
    EXPECT_THAT(refused("mfr/gap > 3 mm"), HasSubstr("a number without the unit 'mm' is expected"));
}

std::string refused_condition(std::string_view text) {
    return refusal([&] { return Condition::read(text, names); });
}

ModelFactor range(std::string name, std::string unit, double low, double high) {
    ModelFactor factor{{.name = std::move(name), .range = campaign::Between{low, high}, .unit = std::move(unit)}};
    return factor;
}

std::vector<ModelFactor> factors() {
    auto law = range("law", "", 0, 0);
    law.words = {"sjkr", "sjkr2", "paper"};
    law.range = campaign::Levels{{law.words.begin(), law.words.end()}};
    auto cohesion = range("cohesion", "J/m3", 0, 35000);
    cohesion.numbers = {0, 10000, 35000};
    cohesion.range = campaign::Levels{{0.0, 10000.0, 35000.0}};
    return {range("friction", "1", 0.2, 0.3), range("diameter", "m", 0.001, 0.003), range("gap", "m", 0.001, 0.005),
            cohesion, law};
}

TEST(WindowCondition, DecidesAsSqlDoes) {
    EXPECT_TRUE(holds("mfr >= 0.35 and rough <= 0.1", {0.35, 0.1, 0}));
    EXPECT_FALSE(holds("mfr > 0.35 and rough <= 0.1", {0.35, 0.1, 0}));
    EXPECT_TRUE(holds("mfr > 1 or rough < 1 and gap > 2", {2, 5, 0})) << "and binds closer than or";
    EXPECT_FALSE(holds("(mfr > 1 or rough < 1) and gap > 2", {2, 5, 0}));
    EXPECT_TRUE(holds("NOT mfr > 1 AND 3e-3 < gap", {0.5, 0, 0.004}));
    EXPECT_TRUE(holds("gap between -1 and 1", {0, 0, -1}));
    EXPECT_FALSE(holds("not (gap between -1 and 1)", {0, 0, 1}));
    EXPECT_TRUE(holds("mfr > 1 or rough < 1", {2, none, 0})) << "one side is enough";
    EXPECT_FALSE(holds("rough < 1", {2, none, 0}));
    EXPECT_FALSE(holds("not rough < 1", {2, none, 0})) << "undefined is neither";
    EXPECT_FALSE(holds("mfr > 3 or not rough < 1", {2, none, 0}));
}

TEST(WindowCondition, KnowsWhatItComparesAndWhichWay) {
    const auto condition = Condition::read("0.1 >= rough and not (gap < 2 or mfr > 3) and gap < 9", names);
    EXPECT_THAT(condition.compared(), ElementsAre(1, 2, 0));
    EXPECT_EQ(condition.direction(1), -1);
    EXPECT_EQ(condition.direction(0), -1) << "not > is a bound from above";
    EXPECT_EQ(condition.direction(2), 0);
}

TEST(WindowCondition, RefusesTheRestInOneSentence) {
    EXPECT_THAT(refused_condition("roughh < 1"),
                testing::AllOf(HasSubstr("--where"), HasSubstr("Did you mean 'rough'")));
    EXPECT_THAT(refused_condition("mfr * gap > 1"), HasSubstr("<, <=, > or >= is expected at '* gap > 1'"));
    EXPECT_THAT(refused_condition("mfr = 1"), HasSubstr("<, <=, > or >= is expected"));
    EXPECT_THAT(refused_condition("mfr > gap"), HasSubstr("a number is expected at 'gap'"));
    EXPECT_THAT(refused_condition("(mfr > 1"), HasSubstr("a closing bracket is expected at its end"));
    EXPECT_THAT(refused_condition("mfr > 1 gap > 1"), HasSubstr("and, or, or the end is expected"));
    EXPECT_THAT(refused_condition("mfr > inf"), HasSubstr("a number is expected"));
    for (const auto* chain : {"0.1 < mfr < 0.5", "mfr < 0.5 < 1", "1 >= mfr >= gap", "mfr > 1 = 1"})
        EXPECT_THAT(refused_condition(chain),
                    HasSubstr("and with another comparison (0.2 < x and x < 0.5) is expected"))
            << chain;
    EXPECT_THAT(refused_condition(std::string(5000, '(')), HasSubstr("fewer brackets"));
    EXPECT_THAT(refused_condition(""), HasSubstr("the name of an observable or a factor is expected"));
}

TEST(ModelFeatures, ByDefaultLogarithmsWhereTheRangeIsWide) {
    const auto features = default_features(factors());
    EXPECT_THAT(features.names,
                ElementsAre("friction", "log(diameter)", "log(gap)", "cohesion", "law = 'sjkr2'", "law = 'paper'"));
    EXPECT_THAT(features.of(Setting{0.25, 0.002, 0.004, 10000, 2}),
                ElementsAre(0.25, std::log(0.002), std::log(0.004), 10000, 0, 1));
}

TEST(ModelFeatures, RatiosAreOfOneUnitAndTakeThePlaceOfAFactor) {
    const auto ratios = candidate_ratios(factors());
    ASSERT_EQ(ratios.size(), 2U);  // diameter/gap, gap/diameter
    const auto features = default_features(factors(), std::span(&ratios[1], 1));
    EXPECT_EQ(features.names[2], "log(gap/diameter)");
    EXPECT_DOUBLE_EQ(features.of(Setting{0.25, 0.002, 0.004, 0, 0})[2], std::log(0.004 / 0.002));
}

TEST(ModelFeatures, WrittenOnesAreExpressionsOfFactors) {
    const std::vector<std::string> expressions = {"gap / diameter", "ln(cohesion)", "law = 'paper'", "law"};
    const auto features = written_features(factors(), expressions);
    const auto values = features.of(Setting{0.25, 0.002, 0.004, 0, 2});
    EXPECT_EQ(values[0], 2);
    EXPECT_TRUE(std::isnan(values[1])) << "the logarithm of nothing";
    EXPECT_EQ(values[2], 1);
    EXPECT_TRUE(std::isnan(values[3])) << "a word is no number";
    EXPECT_EQ(features.of(Setting{0.25, 0.001, 0.004, 1, 0})[0], 4);
}

const std::string with_poles = R"json({"campaign": "c", "scene": "rehearsal",
    "model": {"features": ["1/(x1 - 0.5)", "log(x2)"]},
    "factors": [{"name": "x1", "between": [0, 0.5]}, {"name": "x2", "between": [0, 1]}],
    "design": {"kind": "halton", "points": 60}})json";

TEST(ModelFeatures, WithoutANumberThereIsNoPredictionAndNoRecommendation) {
    Folder folder;
    Store store(folder / "a.db", Store::Mode::create);
    answer_by(store, with_poles, [](const Inputs& i) { return 1 / (input(i, "x1") - 0.5) + std::log(input(i, "x2")); });
    const auto cases = read_model_cases(store, "c");
    const auto model = learn_or_refuse(cases, cases.observable("y"));
    const auto said = [&](double x1, double x2) {
        return refusal([&] { return study::predict(cases, model, {{0.1, 0.5}, {x1, x2}}, true); });
    };
    EXPECT_EQ(said(0.2, 0.5), "accepted");
    EXPECT_THAT(said(0.5, 0.5), HasSubstr("x1 = 0.5, x2 = 0.5; the feature '1/(x1 - 0.5)' of the model has no number"));
    EXPECT_THAT(said(0.2, 0), HasSubstr("the feature 'log(x2)' of the model has no number there"));
    // The first point searched is the corner x1 = x2 = 0, where log(x2) is undefined.
    const auto window = window_of(store, cases, {.where = "y >= 100", .objectives = {{"y"}}, .next = 3});
    ASSERT_TRUE(window.surest);
    EXPECT_GT(window.surest->setting[1], 0);
    EXPECT_TRUE(window.surest->believed);
    for (const auto& one : window.next) EXPECT_GT(one.setting[1], 0);
}

TEST(ModelFeatures, RefusesWhatCannotBeEvaluated) {
    const auto refused = [](std::string expression) {
        const std::vector<std::string> expressions = {"gap", std::move(expression)};
        return refusal([&] { return written_features(factors(), expressions); });
    };
    EXPECT_THAT(refused("log(diametr)"), testing::AllOf(HasSubstr("$.model.features[1]"), HasSubstr("'diameter'")));
    EXPECT_THAT(refused("random() * gap"), HasSubstr("'random' is not among the deterministic functions"));
    EXPECT_THAT(refused("1 + 1"), HasSubstr("depends on no factor"));
    EXPECT_THAT(refused("gap, diameter"), HasSubstr("one expression is expected"));
    EXPECT_THAT(refused("(select gap)"), HasSubstr("no SELECT inside"));
}

const std::string with_model = R"({"campaign": "c", "scene": "rehearsal", "model": {"features": ["x1 / x2", "x2"]},
    "factors": [{"name": "x1", "between": [0.1, 1]}, {"name": "x2", "between": [0.1, 1]}],
    "design": {"kind": "halton", "points": 60}})";

TEST(ModelFeatures, OfACampaignFileAreReadAndNoPartOfWhatItIs) {
    const auto campaign = campaign::parse_campaign(with_model, ".");
    EXPECT_THAT(campaign.features, ElementsAre("x1 / x2", "x2"));
    EXPECT_THAT(campaign::remarks_in(with_model).features, ElementsAre("x1 / x2", "x2"));
    std::string other = with_model;
    other.replace(other.find("x1 / x2"), 7, "x1 * x2");
    EXPECT_EQ(campaign::family_of(campaign::identity_of(campaign)),
              campaign::family_of(campaign::identity_of(campaign::parse_campaign(other, "."))));
    const auto refused = [](const std::string& from, const std::string& to) {
        std::string text = with_model;
        text.replace(text.find(from), from.size(), to);
        return refusal([&] { return campaign::parse_campaign(text, "."); });
    };
    EXPECT_THAT(refused("[\"x1 / x2\", \"x2\"]", "[]"), HasSubstr("$.model.features"));
    EXPECT_THAT(refused("\"x1 / x2\", \"x2\"", "\"x2\", \"x2\""), HasSubstr("this feature is there twice"));
    EXPECT_THAT(refused("features", "featurs"), HasSubstr("features"));
}

TEST(FurtherPoints, AreAListOfTheSameCampaign) {
    const std::vector<std::vector<Value>> rows = {{0.5, 0.25}, {1.0, 0.1}};
    const auto text = campaign::further_points(with_model, "c_next", "why", rows, 2);
    const auto further = campaign::parse_campaign(text, ".");
    const auto first = campaign::parse_campaign(with_model, ".");
    EXPECT_EQ(further.name, "c_next");
    EXPECT_EQ(further.design, "list");
    EXPECT_EQ(further.seed, first.seed + 2) << "the same setting again is a new run";
    EXPECT_EQ(further.space.factors, first.space.factors);
    EXPECT_EQ(further.features, first.features);
    EXPECT_EQ(campaign::candidates_of(further), 2);
}

TEST(FurtherPoints, OfACalibrationHaveItsConditionsAsFactors) {
    const std::string calibration = R"({"campaign": "c", "scene": "rehearsal",
      "factors": [{"name": "x1", "between": [0, 1]}, {"name": "x2", "between": [0, 1]}],
      "calibration": {"discrepancy": {"y": 0.01}, "targets": [
        {"observable": "y", "value": 1, "error": 0.1, "inputs": {"x4": 0.9, "x3": 0.5}},
        {"observable": "y", "value": 2, "error": 0.1, "inputs": {"x3": 0.25, "x4": 0.9}}]}})";
    const std::vector<std::vector<Value>> rows = {{0.5, 0.25, 0.25, 0.9}};
    const auto further = campaign::parse_campaign(campaign::further_points(calibration, "n", "why", rows, 2), ".");
    EXPECT_EQ(further.space.factors, campaign::parse_campaign(calibration, ".").space.factors);
    EXPECT_EQ(campaign::candidates_of(further), 1);
}

TEST(BoxSearch, SettingsAreRoundedAndStayInside) {
    const auto box = factors();
    for (const auto& point : spread_points(box, {}, 64)) {
        EXPECT_EQ(outside_text(box, point.setting), "");
        EXPECT_DOUBLE_EQ(point.setting[1] * 1e6, std::round(point.setting[1] * 1e6)) << "a thousandth of 1 mm";
    }
    const auto near = points_about({{1, 1, 1, 0.5, 0.5}, rounded_setting(box, std::vector<double>{1, 1, 1, 0.5, 0.5})},
                                   0.1, box, {}, 32);
    for (const auto& point : near) {
        EXPECT_EQ(outside_text(box, point.setting), "");
        EXPECT_EQ(point.setting[3], 10000);
        EXPECT_GE(point.setting[2], 0.0045);
    }
    EXPECT_EQ(outside_text(box, {0.25, 0.002, 0.006, 0, 0}), "gap = 0.006 is outside of 0.001 to 0.005");
}

struct Learned : testing::Test {
    Folder folder;
    Store store{folder / "a.db", Store::Mode::create};

    static std::string campaign_of(const std::string& name, const std::string& more = "") {
        return R"({"campaign": ")" + name + R"(", "scene": "rehearsal",
            "factors": [{"name": "x1", "between": [0, 1]}, {"name": "x2", "between": [0, 1]}],
            "design": {"kind": "halton", "points": 120})" +
               more + "}";
    }
    /// y = x1 + x2 + noise of 0.02; undefined for x1 < 0.3; a few cases fail.
    static std::optional<double> response(const Inputs& inputs) {
        const double x1 = input(inputs, "x1"), x2 = input(inputs, "x2");
        if (x2 > 0.99) return std::nullopt;
        if (x1 < 0.3) return none;
        const double u = stats::Stream(7, 0).uniform(static_cast<std::uint64_t>(1e9 * x1 + 1e3 * x2));
        return x1 + x2 + 0.02 * std::sqrt(3) * (2 * u - 1);
    }
};

TEST_F(Learned, LeavesOutWhatIsUndefinedAndKnowsWhere) {
    answer_by(store, campaign_of("c"), response);
    const auto cases = read_model_cases(store, "");
    const auto model = learn_or_refuse(cases, cases.observable(""));
    EXPECT_GT(cases.failed.size(), 0U);
    EXPECT_GT(model.undefined, 25U);
    EXPECT_EQ(model.undefined + model.cases(), cases.settings.size());
    const std::vector<Setting> asked = {{0.6, 0.5}, {0.05, 0.5}};
    EXPECT_NEAR(model.predict(asked)[0].mean, 1.1, 0.03);
    EXPECT_GT(model.defined(asked)[0], 0.99);
    EXPECT_LT(model.defined(asked)[1], 0.01);
}

TEST_F(Learned, WindowKeepsAwayFromWhereTheObservableIsUndefined) {
    answer_by(store, campaign_of("c"), response);
    const auto cases = read_model_cases(store, "c");
    // y is smallest where x1 is: just above 0.3, where it begins to be defined.
    const auto window = window_of(store, cases, {.where = "y >= 0", .objectives = {{"y", false}}});
    ASSERT_TRUE(window.best);
    EXPECT_GE(window.best->probability, 0.95);
    EXPECT_GT(window.best->setting[0], 0.28);
    EXPECT_LT(window.best->setting[0], 0.5);
    EXPECT_NEAR(window.share_of_box, 0.7, 0.06);
    const auto again = window_of(store, cases, {.where = "y >= 0", .objectives = {{"y", false}}});
    EXPECT_EQ(again.best->setting, window.best->setting);
}

TEST_F(Learned, AWindowOfAResponseThatOnlyScattersIsAllOrNothing) {
    answer_by(store, campaign_of("c"), [number = 0](const Inputs&) mutable {
        return stats::normal_quantile(stats::Stream(5, 0).uniform(static_cast<std::uint64_t>(++number)));
    });
    const auto cases = read_model_cases(store, "c");
    EXPECT_THAT(refusal([&] { return learn_or_refuse(cases, cases.observable("y")); }), HasSubstr("no response model"));
    EXPECT_EQ(window_of(store, cases, {.where = "y >= -0.7"}).share_of_box, 1);
    EXPECT_EQ(window_of(store, cases, {.where = "y >= 0.7"}).share_of_box, 0);
    // A single run: y >= -1.28 with probability 0.9, so the box is the window at a risk of 0.2, not of 0.05.
    const auto runs = [&](double risk) {
        return window_of(store, cases, {.where = "y >= -1.28", .risk = risk, .judged = stats::Judged::single_run});
    };
    EXPECT_LT(runs(0.05).share_of_box, 0.2);
    const auto window = runs(0.2);
    EXPECT_EQ(window.share_of_box, 1);
    ASSERT_EQ(window.models.size(), 1U);
    EXPECT_THAT(window.models.front().notes, testing::Contains(HasSubstr("the factors explain nothing of 'y' (120 "
                                                                         "cases, left-out ones predicted with an")));
}

TEST_F(Learned, FewValuesOfAFactorAreNoted) {
    const auto lattice = [](int levels) {
        return R"("scene": "rehearsal", "design": {"kind": "lattice", "levels": [)" + std::to_string(levels) +
               R"(, 12]}, "factors": [)";
    };
    const std::string x2 = R"({"name": "x2", "between": [0, 1]}]})";
    const auto sum = [](const Inputs& inputs) { return input(inputs, "x1") + input(inputs, "x2"); };
    answer_by(store, R"({"campaign": "few", )" + lattice(5) + R"({"name": "x1", "between": [0, 1]}, )" + x2, sum);
    answer_by(store,
              R"({"campaign": "levels", )" + lattice(4) + R"({"name": "x1", "levels": [0, 0.25, 0.5, 1]}, )" + x2, sum);
    const auto of = [&](const char* name) {
        const auto cases = read_model_cases(store, name);
        return std::pair(cases, learn_or_refuse(cases, cases.observable("y")));
    };
    const auto [few, model] = of("few");
    EXPECT_THAT(model.notes, testing::Contains(HasSubstr("few values of x1 (5): between them")));
    const auto [levels, of_levels] = of("levels");
    EXPECT_THAT(of_levels.notes, Not(testing::Contains(HasSubstr("few values"))))
        << "a campaign's levels are all it asks";
    const std::vector<Setting> asked = {{0.5, 0.3}, {0.3, 0.3}};
    EXPECT_THAT(between_levels_text(levels.factors, asked), HasSubstr("x1 = 0.3 is no level of the campaign"));
    EXPECT_EQ(between_levels_text(levels.factors, std::span(asked).first(1)), "");
    EXPECT_EQ(between_levels_text(few.factors, asked), "");
}

TEST_F(Learned, RefusesWhatNoSumOfSquaresHolds) {
    answer_by(store, campaign_of("c"), [](const Inputs& inputs) { return 1e160 * (1 + input(inputs, "x1")); });
    const auto cases = read_model_cases(store, "c");
    EXPECT_THAT(refusal([&] { return learn_or_refuse(cases, cases.observable("y")); }),
                AllOf(HasSubstr("leave the range of double precision: choose another unit"), Not(HasSubstr("nan"))));
}

TEST_F(Learned, ConditionsOverFactorsAloneNeedNoModel) {
    answer_by(store, campaign_of("c"), [](const Inputs& inputs) { return response(inputs).value_or(none); });
    const auto window = window_of(store, read_model_cases(store, "c"), {.where = "x1 < 0.25 or x2 >= 0.5"});
    EXPECT_TRUE(window.models.empty());
    EXPECT_NEAR(window.share_of_box, 1 - 0.75 * 0.5, 0.002);
}

TEST_F(Learned, CasesOfFurtherCampaignsComeIntoTheSameModel) {
    answer_by(store, campaign_of("c"), response);
    const auto before = read_model_cases(store, "c");
    answer_by(store, campaign_of("d", R"(, "seed": 2)"), response);
    const auto cases = read_model_cases(store, "c");
    EXPECT_THAT(cases.further, ElementsAre("d"));
    EXPECT_GT(cases.settings.size(), 2 * before.settings.size() - 10);
    answer_by(store, campaign_of("e", R"(, "fixed": {"x3": 0.25})"), response);
    EXPECT_THAT(refusal([&] { return read_model_cases(store, ""); }), HasSubstr("which of c, e?"));
    EXPECT_TRUE(read_model_cases(store, "e").further.empty());
}

TEST_F(Learned, RefusesByItsReason) {
    answer_by(store, campaign_of("flat"), [](const Inputs&) { return 3.0; });
    answer_by(store, campaign_of("few", R"(, "fixed": {"x3": 0.25})"), response, 9);
    const auto refused = [&](const std::string& name) {
        const auto cases = read_model_cases(store, name);
        return refusal([&] { return learn_or_refuse(cases, cases.observable("y")); });
    };
    EXPECT_THAT(refused("flat"), HasSubstr("campaign flat, observable 'y': no response model: "));
    EXPECT_THAT(refused("few"), HasSubstr("no response model: "));
    const auto cases = read_model_cases(store, "flat");
    EXPECT_THAT(refusal([&] { return window_of(store, cases, {}); }), HasSubstr("give a condition"));
    EXPECT_THAT(refusal([&] { return window_of(store, cases, {.where = "z > 1"}); }), HasSubstr("'z' is neither"));
    EXPECT_THAT(refusal([&] { return window_of(store, cases, {.where = "x1 > 1", .risk = 1.5}); }),
                HasSubstr("--risk"));
    EXPECT_THAT(refusal([&] { return cases.observable("yy"); }), HasSubstr("Did you mean 'y'"));
}

}  // namespace grainsweep::tests::report_models_test
