// Particles added while a machine runs: what is fed and what waits add up to rate times time, none overlaps, and a
// blocked feed waits.
#include "solver/machine/feeding.hpp"
#include "tests/support/machines.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace grainsweep::tests::machine_feeding_test {

using namespace geometry;
using nlohmann::json;

/// Nothing but a feed into an empty box.
json feeder() {
    return json::parse(R"({
      "name": "feeder",
      "domain": {"low": [0, 0, 0], "high": [0.03, 0.03, 0.05], "sides": ["periodic", "periodic", "open"]},
      "materials": {"glass": {"density": 2500, "youngs_modulus": "5 MPa"}},
      "species": {"a": {"diameter": "3 mm"}, "b": {"diameter": "2 mm"}},
      "walls": {"floor": {"plane": {"normal": [0, 0, 1]}}},
      "feed": [{"mix": {"a": 0.6, "b": 0.4}, "rate": "20 g/s", "velocity": [0, 0, -1], "every": "5 ms",
                "during": ["feed"],
                "through": {"box": {"low": [0.005, 0.005, 0.03], "high": [0.025, 0.025, 0.045]}}}],
      "phases": [{"name": "wait", "for": 0.01, "frames": 1}, {"name": "feed", "for": 0.032, "frames": 4},
                 {"name": "end", "for": 0.005, "frames": 1}],
      "measure": {"mass": {"mass": {}, "as": "last"}, "heavy": {"count": {"of": "a"}, "as": "last"}}
    })");
}

constexpr double grain = 2500 * 3.14159265358979 / 6 * 2.7e-8;  // mass of an a, kg

TEST(MachineFeeding, WhatIsFedAndWhatWaitsIsRateTimesTime) {
    const auto answer = answer_of(spec_of(feeder(), {{"precision", std::string("double")}}));
    const double fed = answer.scalars.at("feed_fed"), due = 0.02 * 0.032;
    EXPECT_NEAR(fed, answer.scalars.at("mass"), 1e-12);
    EXPECT_GE(fed, due - 1e-6 * due);
    EXPECT_LT(fed, 1.001 * due + grain) << "up to one particle more";
    EXPECT_EQ(answer.scalars.at("feed_waiting"), 0);
    EXPECT_EQ(answer.scalars.at("lost"), 0);
}

// The last interval is cut short by the end of the phase, whatever the interval is.
TEST(MachineFeeding, TheIntervalOfBatchesDoesNotChangeTheMass) {
    for (const char* every : {"0.2 ms", "4 ms", "7 ms", "16 ms", "1 s"}) {
        json document = feeder();
        document["feed"][0]["every"] = every;
        const auto answer = answer_of(spec_of(document));
        const double fed = answer.scalars.at("feed_fed") + answer.scalars.at("feed_waiting");
        EXPECT_GE(fed, 0.02 * 0.032 * (1 - 1e-3)) << every;
        EXPECT_LT(fed, 0.02 * 0.032 * (1 + 1e-3) + grain) << every;
    }
}

TEST(MachineFeeding, APhaseThatEndsEarlyTakesBackWhatIsNotDue) {
    json document = feeder();
    document["phases"][1] = {
        {"name", "feed"}, {"until", {{"measure", "seen"}, {"above", 0.0001}}}, {"at_most", 0.1}, {"frames", 4}};
    document["measure"]["seen"] = json::parse(R"({"mass": {}, "as": "series"})");
    document["feed"][0]["every"] = "20 ms";
    const auto answer = answer_of(spec_of(document));
    const double due = 0.02 * answer.scalars.at("feed_time"), fed = answer.scalars.at("feed_fed");
    EXPECT_EQ(answer.scalars.at("feed_ended"), 1);
    EXPECT_LT(answer.scalars.at("feed_time"), 0.02);
    EXPECT_GT(fed, due) << "a whole batch was in advance";
    EXPECT_EQ(answer.scalars.at("feed_waiting"), 0);
}

// More frames than time steps: each moment is seen once, and each batch is fed once.
TEST(MachineFeeding, FramesWithinATimeStepFeedNothingTwice) {
    json document = feeder();
    document["phases"][1]["frames"] = 20000;
    const auto answer = answer_of(spec_of(document));
    EXPECT_LT(answer.scalars.at("feed_fed"), 0.02 * 0.032 + grain);
    document["phases"] = json::parse(R"([{"name": "feed", "for": 1e-12, "frames": 100}])");
    EXPECT_LT(answer_of(spec_of(document)).scalars.at("feed_fed"), 2 * grain);
}

TEST(MachineFeeding, ABlockedFeedWaits) {
    json document = feeder();
    document["feed"][0]["rate"] = "2 kg/s";
    document["feed"][0]["velocity"] = {0, 0, 0};
    document["gravity"] = {0, 0, 0};
    const auto answer = answer_of(spec_of(document, {{"precision", std::string("double")}}));
    const double fed = answer.scalars.at("feed_fed"), waiting = answer.scalars.at("feed_waiting");
    EXPECT_NEAR(fed + waiting, 2 * 0.032, 1e-4);
    EXPECT_GT(waiting, 0.8 * 2 * 0.032);
    EXPECT_NEAR(fed, answer.scalars.at("mass"), 1e-12);
    EXPECT_LT(answer.scalars.at("max_overlap"), 1e-9) << "nothing moves and nothing overlaps";
    EXPECT_GT(answer.scalars.at("heavy"), 5) << "in the shares of the mix";
}

/// What a batch adds to a state.
machine::Filled batch_in(const machine::Spec& spec, double seconds, const dem::State& state = {}) {
    machine::Feeder feeder(spec, 0, 3);
    feeder.owe(seconds);
    return feeder.batch(state, machine::walls_in(spec, 0, {{0.0}, {}}), 0);
}

TEST(MachineFeeding, ABatchIsInItsRegionAndTouchesNothing) {
    json document = feeder();
    document["walls"]["pin"] = json::parse(R"({"cylinder": {"point": [0.015, 0.015, 0.04], "radius": 0.004,
                                                            "length": 0.02, "side": "outside"}})");
    document["domain"]["sides"] = {"periodic", "open", "open"};
    document["feed"][0]["through"]["box"] = json::parse(R"({"low": [-1, 0.005, 0.03], "high": [1, 0.025, 0.06]})");
    const auto spec = spec_of(document);
    dem::State there;
    there.id = {0};
    there.position = {{0.0, 0.01, 0.04}};
    there.radius = {0.006};
    const auto batch = batch_in(spec, 0.05, there);
    ASSERT_GT(batch.spheres.size(), 20U);
    const auto apart = [&](Vec3 a, const Vec3& b) {
        a[0] -= 0.03 * std::round((a[0] - b[0]) / 0.03);
        return norm(a - b);
    };
    for (std::size_t i = 0; i < batch.spheres.size(); ++i) {
        const dem::Sphere& s = batch.spheres[i];
        EXPECT_GE(spec.feeds[0].through.depth(s.position), s.radius);
        EXPECT_LE(s.position[2], 0.05) << "within the domain";
        EXPECT_GE(apart(s.position, there.position[0]), s.radius + 0.006);
        EXPECT_GE(std::hypot(s.position[0] - 0.015, s.position[1] - 0.015), 0.004 + s.radius) << "off the pin";
        EXPECT_EQ(s.velocity, (Vec3{0, 0, -1}));
        for (std::size_t j = 0; j < i; ++j)
            EXPECT_GE(apart(s.position, batch.spheres[j].position), s.radius + batch.spheres[j].radius);
    }
}

TEST(MachineFeeding, AWallThatHasComeIsInTheWay) {
    json document = feeder();
    document["walls"]["shelf"] = json::parse(R"({"plane": {"point": [0, 0, 0.038], "normal": [0, 0, 1]},
                                                 "during": ["feed"]})");
    const auto spec = spec_of(document);
    machine::Feeder feeder(spec, 0, 3);
    feeder.owe(0.02);
    for (const auto& s : feeder.batch({}, machine::walls_in(spec, 1, {{0.0, 0.01}, {0.01}}), 0.01).spheres)
        EXPECT_GE(s.position[2], 0.038 + s.radius);
}

TEST(MachineFeeding, IsGivenBySeedAndNumber) {
    const auto spec = spec_of(feeder());
    machine::Feeder whole(spec, 0, 3), parts(spec, 0, 3);
    whole.owe(0.02);
    const auto all = whole.batch({}, {}, 0);
    parts.owe(0.01);
    auto first = parts.batch({}, {}, 0);
    Bytes bytes;
    ByteWriter out(bytes);
    parts.save(out);
    machine::Feeder restored(spec, 0, 3);
    ByteReader in(bytes);
    restored.restore(in);
    EXPECT_EQ(restored.fed(), parts.fed());
    dem::State state;
    for (const auto& s : first.spheres) {
        state.id.push_back(static_cast<std::int32_t>(state.id.size()));
        state.position.push_back(s.position);
        state.radius.push_back(s.radius);
    }
    restored.owe(0.01);
    const auto second = restored.batch(state, {}, 0);
    ASSERT_EQ(first.spheres.size() + second.spheres.size(), all.spheres.size());
    for (std::size_t i = 0; i < all.spheres.size(); ++i) {
        const auto& s = i < first.spheres.size() ? first.spheres[i] : second.spheres[i - first.spheres.size()];
        EXPECT_EQ(s.position, all.spheres[i].position);
    }
}

TEST(MachineFeeding, RefusesARegionWithoutRoom) {
    const auto refusal = [](const json& patch) {
        json document = feeder();
        document.merge_patch(patch);
        try {
            machine::Run run(spec_of(document), 1);
        } catch (const std::invalid_argument& why) {
            return std::string(why.what());
        }
        return std::string("no complaint");
    };
    EXPECT_EQ(refusal(json::object()), "no complaint");
    json thin = feeder();
    thin["feed"][0]["through"]["box"]["high"] = {0.025, 0.025, 0.0325};
    EXPECT_NE(refusal(thin).find("feed: a particle of 0.003 m finds no place in its region"), std::string::npos);
    const json blocked =
        json::parse(R"({"walls": {"floor": {"plane": {"point": [0, 0, 0.045], "normal": [0, 0, 1]}}}})");
    EXPECT_NE(refusal(blocked).find("finds no place"), std::string::npos) << "behind a wall";
    EXPECT_NE(refusal(json::parse(R"({"domain": {"high": [0.03, 0.03, 0.03]}})")).find("finds no place"),
              std::string::npos)
        << "outside of the domain";
}

}  // namespace grainsweep::tests::machine_feeding_test
