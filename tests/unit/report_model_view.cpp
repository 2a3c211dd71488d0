// What the models of the rule `assisted` see of a campaign's points.
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/reader.hpp"
#include "sweep/store/expression.hpp"
#include "sweep/study/model_view.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace grainsweep::tests::report_model_view_test {

using namespace study;

using testing::ElementsAre;
using testing::HasSubstr;

campaign::Campaign read(const std::string& more) {
    return campaign::parse_campaign(
        R"({"campaign": "seen", "scene": "rehearsal",
            "factors": [{"name": "x1", "between": [0, 1]}, {"name": "x2", "between": [0.1, 1], "scale": "log"},
                        {"name": "response", "levels": ["sum", "ishigami"]}],)" +
            more + R"("design": {"kind": "halton", "sequences": 8, "points": 200},
            "convergence": {"observable": "y", "rule": "assisted", "block": 32}})",
        ".");
}

schedule::ModelView view_of(const campaign::Campaign& campaign) {
    return model_view(campaign, 0, store::make_filter(campaign.where, campaign::filter_names(campaign)));
}

double number(const Inputs& inputs, const char* name) {
    return std::get<double>(inputs.at(name));
}

std::string refusal(const std::string& more) {
    try {
        (void)view_of(read(more));
    } catch (const campaign::InputError& wrong) {
        return wrong.what();
    }
    return "accepted";
}

TEST(ModelView, FeaturesOfAPointAreThoseOfItsCase) {
    const auto campaign = read("");
    const auto view = view_of(campaign);
    EXPECT_EQ(view.space.dimensions, 3U);
    for (const auto& one : campaign::unfold(campaign, {})) {
        const auto& inputs = one.question.inputs;
        const double ishigami = std::get<std::string>(inputs.at("response")) == "ishigami" ? 1 : 0;
        EXPECT_THAT(view.features(static_cast<std::size_t>(one.point)),
                    ElementsAre(number(inputs, "x1"), std::log(number(inputs, "x2")), ishigami));
    }
}

TEST(ModelView, IntegratesOverTheRangesAsTheDesignFillsThem) {
    const auto view = view_of(read(""));
    const auto& points = view.space.integration;
    EXPECT_EQ(points.size(), 3U * 8 * 4096);
    std::array<double, 3> mean{};
    for (std::size_t i = 0; i < points.size(); ++i) mean[i % 3] += points[i] / (8 * 4096);
    EXPECT_NEAR(mean[0], 0.5, 1e-4);
    EXPECT_NEAR(mean[1], 0.5 * std::log(0.1), 1e-3);
    EXPECT_NEAR(mean[2], 0.5, 1e-3);
    EXPECT_NEAR(view.space.low[1], std::log(0.1), 1e-2);
    EXPECT_NEAR(view.space.high[1], 0, 1e-2);
}

TEST(ModelView, WhereAndWrittenFeaturesHold) {
    const auto view = view_of(
        read(R"x("where": "x1 + x2 < 1", "model": {"features": ["x1 + x2", "x2 / (x1 + 1)", "response = 'sum'"]},)x"));
    const auto& points = view.space.integration;
    ASSERT_EQ(points.size() % (3 * 8), 0U);
    EXPECT_LT(points.size(), 3U * 8 * 4096);
    for (std::size_t i = 0; i < points.size(); i += 3) ASSERT_LT(points[i], 1);
}

TEST(ModelView, RefusesWhatCannotBeIntegrated) {
    EXPECT_THAT(refusal(R"x("model": {"features": ["x1", "log(x1 - 0.5)"]},)x"),
                HasSubstr("$.model.features[1]: got log(x1 - 0.5); is undefined somewhere in the ranges"));
    EXPECT_THAT(refusal(R"x("model": {"features": ["x1", "0 * x2"]},)x"),
                HasSubstr("is the same everywhere in the ranges"));
    EXPECT_THAT(refusal(R"x("where": "x1 + x2 < 0.105",)x"), HasSubstr("$.where: got "));
}

}  // namespace grainsweep::tests::report_model_view_test
