// Factors listed in another order are the same campaign: the stored order stays.
#include "tests/support/process.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

namespace grainsweep::tests::factor_order_test {

using nlohmann::json;

struct FactorOrder : testing::Test {
    Folder folder;

    std::string dump() const {
        const auto ended = run_program({"dump", "c.db"}, folder.path());
        EXPECT_EQ(ended.code, 0) << ended.err;
        return ended.out;
    }
    Ended run(const json& campaign) const {
        folder.write("c.json", campaign.dump());
        return run_program({"run", "c.json", "--quiet"}, folder.path());
    }
    std::string cases() const {
        return run_program({"query", "c.db", "SELECT count(*) FROM sim_case", "--format", "csv"}, folder.path()).out;
    }
    /// Runs the campaign, then the same with its factors (and what is listed by factor) the other way round.
    void expect_same(const json& campaign, const json& turned) const {
        ASSERT_EQ(run(campaign).code, 0);
        const auto before = dump();
        const auto again = run(turned);
        EXPECT_EQ(again.code, 0) << again.err;
        EXPECT_EQ(again.err, "note: the factors of 'c' keep their stored order: x1, response\n");
        EXPECT_EQ(dump(), before);
    }
};

json campaign_of(const json& design) {
    return {
        {"campaign", "c"},
        {"scene", "rehearsal"},
        {"factors", {{{"name", "x1"}, {"between", {0, 1}}}, {{"name", "response"}, {"levels", {"sum", "ishigami"}}}}},
        {"design", design}};
}

json turned_round(json campaign) {
    std::swap(campaign["factors"][0], campaign["factors"][1]);
    return campaign;
}

TEST_F(FactorOrder, OfAHaltonDesignIsTheStoredOne) {
    const json campaign = campaign_of({{"kind", "halton"}, {"points", 20}, {"sequences", 4}});
    expect_same(campaign, turned_round(campaign));
    json longer = turned_round(campaign);
    longer["design"]["points"] = 30;
    EXPECT_EQ(run(longer).code, 0);
    EXPECT_EQ(cases(), "count(*)\n30\n") << "an extension adds ten cases and asks none anew";
}

TEST_F(FactorOrder, MovesTheLevelsOfALatticeWithTheirFactors) {
    const json campaign = campaign_of({{"kind", "lattice"}, {"levels", {3, 2}}});
    json turned = turned_round(campaign);
    turned["design"]["levels"] = {2, 3};
    expect_same(campaign, turned);
}

TEST_F(FactorOrder, MovesTheColumnsOfAList) {
    const json campaign =
        campaign_of({{"kind", "list"}, {"rows", json::parse(R"([[0.25, "sum"], [0.5, "ishigami"]])")}});
    json turned = turned_round(campaign);
    turned["design"]["rows"] = json::parse(R"([["sum", 0.25], ["ishigami", 0.5]])");
    expect_same(campaign, turned);
}

TEST_F(FactorOrder, AnotherFactorIsAnotherCampaign) {
    const json campaign = campaign_of({{"kind", "halton"}, {"points", 8}});
    ASSERT_EQ(run(campaign).code, 0);
    json other = turned_round(campaign);
    other["factors"][1]["name"] = "x2";
    const auto refused = run(other);
    EXPECT_EQ(refused.code, 2);
    EXPECT_NE(refused.err.find("$.factors"), std::string::npos) << refused.err;
}

}  // namespace grainsweep::tests::factor_order_test
