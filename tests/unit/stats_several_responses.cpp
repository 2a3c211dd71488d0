// Models of several responses, fitted side by side, are those fitted one after another.
#include "stats/several_responses.hpp"
#include "tests/support/ask_design.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <variant>
#include <vector>

namespace grainsweep::tests::stats_several_responses_test {

using namespace stats;

TEST(SeveralResponses, TheFitsOfEachAloneInTheirOrder) {
    const auto set = ask_design("halton", 2, {{"points", 40}}, 3);
    std::vector<std::vector<double>> values(7);
    for (std::size_t i = 0; i < set.size(); ++i) {
        const double x = set.point(i)[0], y = set.point(i)[1];
        for (std::size_t k = 0; k < 6; ++k)
            values[k].push_back(std::sin(2.0 * x + static_cast<double>(k)) + y * y * static_cast<double>(k));
        values[6].push_back(0.5);
    }
    values[2][5] = std::numeric_limits<double>::quiet_NaN();
    allow_fits_at_once(3);
    const auto fits = fit_responses({set.coordinates, 2}, values);
    ASSERT_EQ(fits.size(), values.size());
    const auto asked = ask_design("random", 2, {{"points", 20}}, 4);
    for (std::size_t k = 0; k < 6; ++k) {
        const auto alone = fit_response({set.coordinates, 2}, values[k]);
        ASSERT_TRUE(std::holds_alternative<ResponseModel>(alone)) << k;
        ASSERT_TRUE(std::holds_alternative<ResponseModel>(fits[k])) << k;
        const auto& one = std::get<ResponseModel>(alone);
        const auto& same = std::get<ResponseModel>(fits[k]);
        EXPECT_EQ(one.means({asked.coordinates, 2}), same.means({asked.coordinates, 2})) << k;
        EXPECT_EQ(one.quality().leave_one_out_error, same.quality().leave_one_out_error) << k;
    }
    EXPECT_EQ(std::get<Refusal>(fits[6]).sentence, "no response model: the response is constant (0.5 in all 40 cases)");
    EXPECT_TRUE(fit_responses({set.coordinates, 2}, {}).empty());
}

TEST(SeveralResponses, WhatOneFitThrowsIsThrown) {
    const auto set = ask_design("halton", 2, {{"points", 40}}, 3);
    std::vector<std::vector<double>> values(4, std::vector<double>(set.size(), 1.0));
    values[3].pop_back();
    EXPECT_THROW((void)fit_responses({set.coordinates, 2}, values), std::invalid_argument);
}

}  // namespace grainsweep::tests::stats_several_responses_test
