// A campaign is read once: what an archive keeps of it says the same when it is read back.
#include "sweep/campaign/identity.hpp"
#include "sweep/campaign/reader.hpp"
#include "sweep/campaign/stored_text.hpp"

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
    const auto factors = factors_of(identity_in(R"({"campaign": "c", "scene": "rehearsal", "factors": [
        {"name": "x2", "between": [0.1, 0.30000000000000004]}, {"name": "x1", "between": [1e-7, 1], "scale": "log"},
        {"name": "response", "levels": ["g_function", "sum"]}, {"name": "x3", "levels": [0.25, 1e-5, 0]}],
        "design": {"kind": "halton", "points": 8}})"));
    ASSERT_EQ(factors.size(), 4U);
    EXPECT_EQ(factors[0], (StatedFactor{"x2", Between{0.1, 0.30000000000000004, Scale::linear}, {}}));
    EXPECT_EQ(factors[1], (StatedFactor{"x1", Between{1e-7, 1, Scale::log}, {}}));
    EXPECT_EQ(factors[2], (StatedFactor{"response", {}, {"g_function", "sum"}}));
    EXPECT_EQ(factors[3], (StatedFactor{"x3", {}, {"0.25", "1e-05", "0"}}));
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
