// The spreading scene over its declared ranges: refused in a sentence, reported unstable, or answered in numbers.
#include "solver/scenes/scene.hpp"
#include "stats/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace grainsweep;

namespace {

const SceneInfo& spreading() {
    return *find_scene("powder_spreading");
}

/// Runs a case that is cheap enough and expects an answer or a fault. Returns the fault.
std::string verdict(const Inputs& inputs, std::uint64_t seed) {
    NoArtefacts none;
    const auto scene = spreading().make(inputs, seed, none);
    scene->advance(std::numeric_limits<double>::infinity());
    EXPECT_NE(scene->finished(), !scene->health().stable());
    Observations seen;
    scene->observe(seen);
    for (const auto& [name, value] : seen.scalars) EXPECT_TRUE(std::isfinite(value)) << name;
    const auto snapshot = scene->snapshot();
    for (const auto& x : snapshot.positions)
        for (const double c : x) EXPECT_TRUE(std::isfinite(c));
    return scene->health().reason;
}

Inputs small_case() {
    Inputs inputs = spreading().defaults();
    inputs["diameter"] = 0.003;
    inputs["width"] = 4.0;
    inputs["layer_area"] = 5e-5;
    inputs["settle_time"] = 0.05;
    inputs["travel"] = 0.03;
    return inputs;
}

}  // namespace

TEST(PowderSpreadingCorners, DefaultsLieWithinTheBoundsAndAreRelevantOnce) {
    for (const auto& p : spreading().parameters) {
        if (const auto* interval = std::get_if<Interval>(&p.bounds)) {
            EXPECT_TRUE(interval->contains(std::get<double>(p.default_value))) << p.name;
        }
        for (const auto& r : p.relevant_if) EXPECT_NE(spreading().find_parameter(r.other), nullptr) << p.name;
        EXPECT_FALSE(p.meaning.empty());
    }
    Inputs inputs = spreading().defaults();
    const double mixed = spreading().estimate_cost(inputs);
    inputs["precision"] = std::string("double");
    EXPECT_GT(spreading().estimate_cost(inputs), 1);
    EXPECT_LT(spreading().estimate_cost(inputs), 30);
    EXPECT_LT(mixed, spreading().estimate_cost(inputs));
}

// Every corner of (least, greatest) of each parameter, others at their defaults: made or refused, with a cost.
TEST(PowderSpreadingCorners, EveryBoundIsMadeOrRefused) {
    for (const auto& p : spreading().parameters) {
        const auto* interval = std::get_if<Interval>(&p.bounds);
        if (interval == nullptr) continue;
        for (const double end : {interval->low + (interval->low_open ? 1e-6 : 0.0), interval->high}) {
            Inputs inputs = spreading().defaults();
            inputs[p.name] = end;
            try {
                EXPECT_GT(spreading().estimate_cost(inputs), 0) << p.name << " " << end;
            } catch (const std::invalid_argument& sentence) {
                EXPECT_GT(std::string(sentence.what()).size(), 20U);
            }
        }
    }
}

// What a campaign asks: sound at the default time step.
TEST(PowderSpreadingCorners, ThePublishedRangesAreSound) {
    const stats::Stream random(3, 1);
    const auto between = [&](std::uint64_t k, std::uint64_t j, double low, double high) {
        return low + (high - low) * random.uniform(16 * k + j);
    };
    for (std::uint64_t k = 0; k < 24; ++k) {
        Inputs inputs = small_case();
        inputs["friction"] = between(k, 0, 0.0, 0.6);
        inputs["restitution"] = between(k, 1, 0.3, 0.9);
        inputs["gap"] = between(k, 2, 0.001, 0.008);
        inputs["speed"] = between(k, 3, 0.3, 1.6);
        inputs["cohesion"] = k % 3 == 0 ? 0.0 : between(k, 4, 0, 35000);
        inputs["cohesion_law"] = std::string(k % 2 == 0 ? "sjkr" : "sjkr2");
        inputs["blade_edge_radius"] = k % 4 == 0 ? 0.001 : 0.0;
        if (k % 2 == 1) {
            inputs["vibration_amplitude"] = between(k, 5, 1e-5, 2e-4);
            inputs["vibration_frequency"] = between(k, 6, 10, 300);
        }
        EXPECT_EQ(verdict(inputs, k), "") << "case " << k;
    }
}

// What is too much: soft particles, time steps near and beyond the limits, a violent blade.
TEST(PowderSpreadingCorners, TooMuchIsReported) {
    int faults = 0;
    for (const double modulus : {1e5, 1e7, 1e9})
        for (const double speed : {1.0, 4.0})
            for (const double time_step : {5e-6, 5e-5}) {  // the Rayleigh time is 2.3e-3, 2.3e-4 and 2.3e-5 s
                Inputs inputs = small_case();
                inputs["youngs_modulus"] = modulus;
                inputs["speed"] = speed;
                inputs["time_step"] = time_step;
                const auto fault = verdict(inputs, 5);
                SCOPED_TRACE(testing::Message() << modulus << " " << speed << " " << time_step << ": " << fault);
                if (modulus >= 1e7 && speed == 1.0 && time_step == 5e-6) {
                    EXPECT_EQ(fault, "");
                }
                if (modulus == 1e9 && time_step == 5e-5) {
                    EXPECT_NE(fault.find("time step"), std::string::npos);
                }
                faults += fault.empty() ? 0 : 1;
            }
    EXPECT_GE(faults, 2);
    Inputs jammed = small_case();  // soft spheres driven against a gap of a tenth of their diameter
    jammed["youngs_modulus"] = 1e5;
    jammed["layer_area"] = 4e-4;
    jammed["gap"] = 3e-4;
    jammed["speed"] = 10.0;
    jammed["time_step"] = 1e-5;
    EXPECT_NE(verdict(jammed, 5).find("overlap"), std::string::npos);
}
