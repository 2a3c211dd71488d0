// A campaign is read once: what an archive keeps of it says the same when it is read back.
#include "sweep/campaign/identity.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/reader.hpp"
#include "sweep/campaign/stored_identity.hpp"
#include "sweep/campaign/stored_text.hpp"
#include "tests/support/stored_both_ways.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace grainsweep::tests::campaign_identity_test {

using namespace campaign;
using testing::ElementsAre;

Identity identity_in(const std::string& text) {
    return identity_of(parse_campaign(text, "."));
}

std::string lattice(const std::string& name, const std::string& design, const std::string& more = "") {
    return R"({"campaign": ")" + name + R"(", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0.1, 0.3]},
        {"name": "response", "levels": ["sum", "ishigami"]}], "design": {"kind": "lattice", )" +
           design + "}" + more + "}";
}

TEST(StoredIdentity, FactorsComeBackAsTheyWereAsked) {
    const auto identity = identity_in(R"({"campaign": "c", "scene": "rehearsal", "factors": [
        {"name": "x2", "between": [0.1, 0.30000000000000004]}, {"name": "x1", "between": [1e-7, 1], "scale": "log"},
        {"name": "response", "levels": ["g_function", "sum"]}, {"name": "x3", "levels": [0.25, 1e-5, 0]}],
        "design": {"kind": "halton", "points": 8}})");
    const auto factors = stored_both_ways(identity).factors;
    ASSERT_EQ(factors.size(), 4U);
    EXPECT_EQ(factors[0].range, (decltype(Factor::range){Between{0.1, 0.30000000000000004, Scale::linear}}));
    EXPECT_EQ(factors[1].range, (decltype(Factor::range){Between{1e-7, 1, Scale::log}}));
    EXPECT_EQ(factors[2].range, (decltype(Factor::range){Levels{{"g_function", "sum"}}}));
    EXPECT_EQ(factors[3].range, (decltype(Factor::range){Levels{{0.25, 1e-5, 0.0}}}));
    EXPECT_EQ(factors[0].unit, "1");
}

// Every option of every kind of design, and what the text of an older database says of it.
TEST(StoredIdentity, OptionsAndFixedValuesComeBack) {
    const auto identity = identity_in(R"({"campaign": "c", "scene": "rehearsal", "seed": 12345678901234567,
        "factors": [{"name": "x1", "between": [0.1, 0.9]}, {"name": "x2", "levels": [0.123456789, 0.1234567891]}],
        "fixed": {"x3": 0.1, "x4": "2*x1/3", "behaviour": "crash", "behave_attempts": 2}, "where": "x1 > x2",
        "common_random_numbers": ["x3", "noise"], "design": {"kind": "refine", "factor": "x1", "observable": "y",
        "threshold": 0.5, "width": 1e-3, "replicates": 4}})");
    const auto stored = stored_both_ways(identity);
    EXPECT_EQ(stored.seed, 12345678901234567U);
    EXPECT_EQ(stored.options, identity.options);
    EXPECT_EQ(stored.fixed.at("x4"), Value{"2*x1/3"});
    EXPECT_EQ(stored.fixed.at("behave_attempts"), Value{std::int64_t{2}});
    EXPECT_EQ(stored.common_random_numbers, (std::vector<std::string>{"noise", "x3"}));
    EXPECT_EQ(stored.condition, "x1 > x2");
    const auto text = resolved_text(identity);
    for (const char* part : {R"("levels":[0.123456789,0.1234567891])", R"("kind":"refine")", R"("threshold":0.5)"})
        EXPECT_THAT(text, testing::HasSubstr(part));
}

TEST(StoredIdentity, WhatIsNotAsWrittenIsRefused) {
    const auto text = resolved_text(identity_in(R"({"campaign": "c", "scene": "rehearsal", "factors": [
        {"name": "x1", "between": [0, 1]}, {"name": "x2", "between": [0, 1]}], "simplex": ["x1", "x2"],
        "design": {"kind": "halton", "points": 8}})"));
    EXPECT_NO_THROW((void)read_resolved(text));
    auto other = text;
    other.replace(other.find(R"("simplex":["x1")"), 15, R"("simplex":["no")");
    EXPECT_THROW((void)read_resolved(other), InputError);
    for (const char* wrong : {"", "3", "[]", "{}", R"({"campaign": "c"})"})
        EXPECT_THROW((void)read_resolved(wrong), InputError);
}

TEST(StoredIdentity, PointsAreThoseAskedFor) {
    EXPECT_EQ(points_of(identity_in(R"({"campaign": "c", "scene": "rehearsal", "factors": [{"name": "x1",
        "between": [0, 1]}], "design": {"kind": "halton", "points": 40}})")),
              40);
    EXPECT_EQ(points_of(identity_in(lattice("c", R"("levels": 3)"))), std::nullopt);
}

TEST(StoredIdentity, AFamilyDiffersInNameSeedAndExtentAlone) {
    const auto coarse = family_of(identity_in(lattice("coarse", R"("levels": 3)")));
    EXPECT_EQ(family_of(identity_in(lattice("fine", R"("levels": 9)", R"(, "seed": 7)"))), coarse);
    EXPECT_NE(family_of(identity_in(lattice("fine", R"("levels": 9, "placement": "centred")"))), coarse);
    EXPECT_NE(family_of(identity_in(lattice("fine", R"("levels": 9)", R"(, "fixed": {"x2": 0.5})"))), coarse);
    EXPECT_NE(family_of(identity_in(lattice("fine", R"("levels": 9)", R"(, "where": "x1 > 0.2")"))), coarse);
}

TEST(StoredIdentity, IsSaidInOneLine) {
    const auto identity = identity_in(lattice("c", R"("levels": 3)", R"(, "fixed": {"x2": 0.5, "noise": 0.25})"));
    EXPECT_EQ(design_line(identity), "lattice: placement = endpoints, levels = 3");
    EXPECT_EQ(fixed_line(identity), "noise = 0.25, x2 = 0.5");
}

TEST(StoredText, RemarksOfACampaignFile) {
    EXPECT_EQ(remarks_in(R"({"notes": "one"})").notes, "one");
    const auto both = remarks_in(R"({"notes": ["one", "two"], "limits": {"attempts": 5}})");
    EXPECT_EQ(both.notes, "one\ntwo");
    EXPECT_EQ(both.attempts, 5);
    for (const char* other : {"", "{", "[]", R"({"limits": 3})", R"({"limits": {"attempts": "many"}})", "\xff"}) {
        EXPECT_EQ(remarks_in(other).notes, "") << other;
        EXPECT_EQ(remarks_in(other).attempts, std::nullopt) << other;
    }
}

TEST(StoredText, PhasesComeBack) {
    const PhaseSeconds phases = {{"flow", 0.1}, {"particles", 1e-9}};
    EXPECT_EQ(phases_text(phases), R"({"flow":0.1,"particles":1e-09})");
    EXPECT_EQ(phases_in(*phases_text(phases)), phases);
    EXPECT_EQ(phases_text({}), std::nullopt);
    EXPECT_EQ(phases_text({{"flow", std::numeric_limits<double>::quiet_NaN()}}), "{}");
    for (const char* other : {"", "[]", R"({"flow": "long"})", R"({"flow":0.1)"})
        EXPECT_EQ(phases_in(other), std::nullopt) << other;
}

}  // namespace grainsweep::tests::campaign_identity_test
