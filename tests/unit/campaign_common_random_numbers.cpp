// Parameters that change no seed: cases that differ in these alone draw the same random numbers.
#include "sweep/campaign/campaign.hpp"
#include "sweep/campaign/reader.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace grainsweep::tests::campaign_common_random_numbers_test {

using namespace campaign;

TEST(CommonRandomNumbers, LeaveTheirInputsOutOfTheSeedAlone) {
    const auto cases_of = [](const std::string& noise, const std::string& more) {
        const auto campaign = parse_campaign(R"({"campaign": "t", "scene": "rehearsal", "seed": 5,
            "factors": [{"name": "x1", "between": [0, 1]}], "fixed": {"noise": )" +
                                                 noise + R"(}, "design": {"kind": "halton", "points": 3})" + more + "}",
                                             ".");
        std::vector<Case> cases;
        const auto all = unfold(campaign, {});
        for (std::size_t i = 0; i < all.size(); ++i) {
            cases.push_back(all.question(i));
            EXPECT_EQ(cases.back().seed, case_seed(campaign, cases.back().inputs, 0));
        }
        return cases;
    };
    const std::string common = R"(, "common_random_numbers": ["noise"])";
    const auto plain = cases_of("0.1", ""), little = cases_of("0.1", common), much = cases_of("0.2", common);
    const auto other = cases_of("0.2", "");
    for (std::size_t i = 0; i < plain.size(); ++i) {
        EXPECT_EQ(little[i].seed, much[i].seed);
        EXPECT_NE(little[i].id, much[i].id) << "another question all the same";
        EXPECT_NE(plain[i].seed, other[i].seed);
    }
}

}  // namespace grainsweep::tests::campaign_common_random_numbers_test
