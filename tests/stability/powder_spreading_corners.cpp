// The spreading scene over its declared ranges: refused in a sentence, reported unstable, or answered in numbers.
#include "solver/scenes/scene.hpp"
#include "stats/random.hpp"
#include "sweep/campaign/campaign.hpp"
#include "sweep/campaign/installed_machines.hpp"
#include "sweep/workers/compute.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace grainsweep::tests::powder_spreading_corners_test {

const SceneInfo& spreading() {
    return *campaign::scene_named("powder_spreading");
}

double as_number(const Value& value) {
    if (const auto* whole = std::get_if<std::int64_t>(&value)) return static_cast<double>(*whole);
    return std::get<double>(value);
}

/// Runs a case that is cheap enough and expects an answer or a fault. Returns the fault, or why it is refused.
std::string verdict(const Inputs& inputs, std::uint64_t seed) {
    NoArtefacts none;
    std::unique_ptr<Scene> scene;
    try {
        scene = spreading().make(inputs, seed, none);
    } catch (const std::invalid_argument& why) {
        return why.what();
    }
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

TEST(PowderSpreadingCorners, DefaultsLieWithinTheBoundsAndAreRelevantOnce) {
    for (const auto& p : spreading().parameters) {
        if (const auto* interval = std::get_if<Interval>(&p.bounds)) {
            EXPECT_TRUE(interval->contains(as_number(p.default_value))) << p.name;
        }
        for (const auto& r : p.relevant_if) EXPECT_NE(spreading().find_parameter(r.other), nullptr) << p.name;
        EXPECT_FALSE(p.meaning.empty());
    }
    Inputs inputs = spreading().defaults();
    const double mixed = spreading().estimate_cost(inputs, {}).seconds;
    inputs["precision"] = std::string("double");
    EXPECT_GT(spreading().estimate_cost(inputs, {}).seconds, 1);
    EXPECT_LT(spreading().estimate_cost(inputs, {}).seconds, 30);
    EXPECT_LT(mixed, spreading().estimate_cost(inputs, {}).seconds);
}

// Every corner of (least, greatest) of each parameter, others at their defaults: made or refused, with a cost.
TEST(PowderSpreadingCorners, EveryBoundIsMadeOrRefused) {
    for (const auto& p : spreading().parameters) {
        const auto* interval = std::get_if<Interval>(&p.bounds);
        if (interval == nullptr) continue;
        for (const double end : {interval->low + (interval->low_open ? 1e-6 : 0.0), interval->high}) {
            Inputs inputs = spreading().defaults();
            if (std::holds_alternative<double>(p.default_value))
                inputs[p.name] = end;
            else
                inputs[p.name] = static_cast<std::int64_t>(end);
            try {
                EXPECT_GT(spreading().estimate_cost(inputs, {}).seconds, 0) << p.name << " " << end;
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
                    EXPECT_NE(fault.find("time_step"), std::string::npos);
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

// The ends of every parameter and their worst meetings, through what `solve` and the workers call: an answer in finite
// and possible numbers, or unstable or rejected in a sentence.
TEST(PowderSpreadingCorners, EveryExtremeIsAnsweredOrReported) {
    using Changes = std::vector<std::pair<const char*, Value>>;
    const std::string lognormal = "lognormal", wide = "weibull_wide";
    const std::string roller = "roller", rough = "rough";
    const std::vector<Changes> table = {
        {{"diameter", 2e-4}, {"layer_area", 1e-6}, {"width", 3.0}},
        {{"diameter", 0.01}, {"layer_area", 4e-4}, {"gap", 0.01}},
        {{"youngs_modulus", 1e5}},
        {{"youngs_modulus", 1e11}},
        {{"speed", 10.0}},
        {{"speed", 0.01}, {"travel", 0.002}},
        {{"friction", 0.0}},
        {{"friction", 2.0}},
        {{"restitution", 0.01}},
        {{"restitution", 1.0}},
        {{"friction", 0.0}, {"restitution", 1.0}},
        {{"friction", 2.0}, {"restitution", 0.01}, {"speed", 10.0}},
        {{"cohesion", 1e6}},
        {{"cohesion", 1e6}, {"cohesion_law", std::string("sjkr2")}, {"youngs_modulus", 1e5}},
        {{"cohesion", 1e6}, {"cohesion_law", std::string("paper")}, {"youngs_modulus", 1e6}},
        {{"cohesion", 1e6}, {"friction", 0.0}, {"restitution", 1.0}, {"youngs_modulus", 1e7}},
        {{"gap", 1e-5}},
        {{"gap", 1e-5}, {"speed", 10.0}, {"youngs_modulus", 1e5}},
        {{"gap", 0.06}},
        {{"gap", 0.1}},
        {{"width", 3.0}},
        {{"width", 40.0}},
        {{"poisson_ratio", 0.0}},
        {{"poisson_ratio", 0.49}},
        {{"density", 100.0}},
        {{"density", 25000.0}},
        {{"gravity", 1e-3}},
        {{"gravity", 100.0}},
        {{"gravity", 1e-3}, {"speed", 10.0}, {"restitution", 1.0}},
        {{"vibration_amplitude", 0.0039}, {"vibration_frequency", 50.0}},
        {{"vibration_amplitude", 1e-5}, {"vibration_frequency", 1e5}},
        {{"vibration_amplitude", 0.003}, {"vibration_frequency", 1e4}},
        {{"blade_thickness", 1e-4}},
        {{"blade_thickness", 0.1}},
        {{"blade_edge_radius", 0.0025}},
        {{"time_step_fraction", 1.0}},
        {{"time_step", 1e-9}, {"travel", 0.001}, {"speed", 10.0}, {"settle_time", 0.0}},
        {{"time_step", 1e-3}},
        {{"settle_time", 0.0}},
        {{"settle_time", 0.0}, {"bed_seed", std::int64_t{1}}},
        {{"travel", 0.001}},
        {{"standard_error", 1.0}},
        {{"standard_error", 1e-9}, {"gap", 1e-4}},
        {{"size_distribution", lognormal}, {"size_spread", 0.5}, {"width", 10.0}, {"layer_area", 2e-5}},
        {{"size_distribution", lognormal}, {"size_spread", 0.5}, {"speed", 10.0}, {"width", 10.0}, {"cohesion", 1e6}},
        {{"size_distribution", lognormal}, {"size_spread", 0.5}, {"layer_area", 1e-6}, {"width", 7.0}},
        {{"size_distribution", wide}, {"gap", 1e-4}, {"youngs_modulus", 1e5}},
        {{"size_distribution", wide}, {"width", 3.0}, {"friction", 0.0}},
        {{"size_distribution", wide}, {"time_step_fraction", 1.0}},
        {{"tool", roller}, {"roller_diameter", 1e-5}},
        {{"tool", roller}, {"roller_diameter", 0.1}},
        {{"tool", roller}, {"roller_spin", -20.0}},
        {{"tool", roller}, {"roller_spin", 20.0}, {"speed", 10.0}},
        {{"tool", roller}, {"roller_spin", 20.0}, {"friction", 2.0}, {"gap", 1e-5}},
        {{"tool", roller}, {"roller_spin", 1.0}, {"vibration_amplitude", 0.0039}, {"vibration_frequency", 50.0}},
        {{"base", rough}},
        {{"base", rough}, {"gap", 1e-5}},
        {{"base", rough}, {"size_distribution", lognormal}, {"size_spread", 0.5}, {"width", 10.0}},
        {{"base", rough}, {"tool", roller}, {"cohesion", 1e6}},
        {{"layers", std::int64_t{2}}},
        {{"layers", std::int64_t{3}}, {"gap", 1e-5}},
        {{"layers", std::int64_t{2}}, {"gap", 0.1}},
        {{"layers", std::int64_t{2}}, {"travel", 1e-5}},
        {{"layers", std::int64_t{1000}}},
        {{"layers", std::int64_t{2}}, {"settle_time", 0.0}, {"travel", 0.04}},
        {{"layers", std::int64_t{2}}, {"travel", 0.05}, {"tool", roller}, {"roller_spin", 20.0}, {"base", rough}},
        {{"layers", std::int64_t{2}}, {"travel", 0.04}, {"friction", 0.0}, {"restitution", 1.0}},
        {{"layers", std::int64_t{2}}, {"travel", 0.04}, {"standard_error", 0.1}},
        {{"layer_beyond", 1e-5}},
        {{"layer_beyond", 1.0}},
        {{"layer_area", 1e-10}},
    };
    std::map<campaign::Outcome, int> outcomes;
    for (const char* precision : {"mixed", "double"})
        for (const auto& changes : table) {
            Inputs inputs = small_case();
            inputs["precision"] = std::string(precision);
            std::string what = precision;
            for (const auto& [name, value] : changes) {
                inputs[name] = value;
                what += std::string(" ") + name;
                if (const auto* x = std::get_if<double>(&value)) what += "=" + std::to_string(*x);
            }
            SCOPED_TRACE(what);
            NoArtefacts none;
            const auto result = workers::compute(campaign::make_case(spreading(), inputs, 9), 1, none, std::nullopt,
                                                 [](const Scene&) { return true; });
            ASSERT_TRUE(result.has_value());
            ++outcomes[result->outcome];
            if (result->outcome != campaign::Outcome::completed) {
                EXPECT_TRUE(result->outcome == campaign::Outcome::unstable ||
                            result->outcome == campaign::Outcome::rejected);
                EXPECT_GT(result->message.size(), 20U);
                EXPECT_EQ(result->message.find("nan"), std::string::npos) << result->message;
                continue;
            }
            const auto& scalars = result->observations.scalars;
            for (const auto& [name, value] : scalars) EXPECT_TRUE(std::isfinite(value)) << name;
            EXPECT_GT(scalars.at("particles"), 0);
            EXPECT_GE(scalars.at("max_overlap"), 0);
            EXPECT_LE(scalars.at("max_overlap"), 0.3);
            EXPECT_EQ(scalars.contains("mfr_window"), inputs.at("tool") == Value(std::string("blade")));
            if (scalars.contains("mfr_window")) {
                EXPECT_GE(scalars.at("mfr_window"), 0);
            }
            for (const auto& [name, samples] : result->observations.series)
                for (const auto& sample : samples) EXPECT_FALSE(std::isinf(sample.value)) << name;
        }
    EXPECT_GT(outcomes[campaign::Outcome::completed], 50);
    EXPECT_GT(outcomes[campaign::Outcome::unstable], 2);
    EXPECT_GT(outcomes[campaign::Outcome::rejected], 2);
}

}  // namespace grainsweep::tests::powder_spreading_corners_test
