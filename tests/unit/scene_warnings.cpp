// Inputs that make little sense together draw a warning of their kind; defaults and reasonable ones draw none.
#include "solver/scenes/scene.hpp"
#include "sweep/campaign/installed_machines.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

namespace grainsweep::tests::scene_warnings_test {

std::set<std::string> kinds(const std::string& scene, const Inputs& changed) {
    const auto info = campaign::scene_named(scene);
    Inputs inputs = info->defaults();
    for (const auto& [name, value] : changed) inputs.at(name) = value;
    std::set<std::string> found;
    for (const auto& warning : info->warnings(inputs, {})) {
        EXPECT_TRUE(found.insert(warning.kind).second) << warning.kind << " twice";
        EXPECT_GT(warning.sentence.size(), 20U);
        EXPECT_EQ(warning.sentence.find("nan"), std::string::npos) << warning.sentence;
    }
    return found;
}

using Kinds = std::set<std::string>;

TEST(SceneWarnings, DefaultsDrawNone) {
    for (const auto& scene : scene_catalogue()) {
        if (!scene.warnings) continue;
        for (const auto& warning : scene.warnings(scene.defaults(), {}))
            ADD_FAILURE() << scene.name << ": " << warning.kind;
    }
}

TEST(SceneWarnings, OfSpreading) {
    const auto of = [](const Inputs& changed) { return kinds("powder_spreading", changed); };
    EXPECT_EQ(of({{"gap", 0.0009}}), Kinds{"gap below half a diameter"});
    EXPECT_EQ(of({{"gap", 0.0011}}), Kinds{"gap below one diameter"});
    EXPECT_EQ(of({{"gap", 0.0019}}), Kinds{"gap below one diameter"});
    EXPECT_EQ(of({{"gap", 0.0021}}), Kinds{});
    EXPECT_EQ(of({{"gap", 0.04}}), Kinds{"gap above the layer"}) << "20 diameters";
    EXPECT_EQ(of({{"gap", 0.004}, {"diameter", 0.0002}}), Kinds{"gap above the width"});
    EXPECT_EQ(of({{"layer_area", 5e-5}, {"diameter", 0.004}}).count("layer below one diameter"), 1U);
    EXPECT_EQ(of({{"layer_area", 5e-5}, {"diameter", 0.004}}).count("few particles"), 1U);
    EXPECT_EQ(of({{"width", 4.0}}), Kinds{"narrow layer"});
    EXPECT_EQ(of({{"settle_time", 0.05}}), Kinds{"powder still falling"}) << "0.06 s";
    EXPECT_EQ(of({{"blade_thickness", 0.06}}), Kinds{"blade thicker than the measured travel"});
    EXPECT_EQ(of({{"travel", 0.015}}).count("short travel"), 1U);
    EXPECT_EQ(of({{"vibration_frequency", 50000.0}, {"vibration_amplitude", 1e-7}}),
              Kinds{"vibration faster than the time step"});
    EXPECT_EQ(of({{"youngs_modulus", 1e6}}),
              (Kinds{"particles too soft for the speed", "walls faster than the time step allows"}));
}

TEST(SceneWarnings, OfTheDrum) {
    const auto of = [](const Inputs& changed) { return kinds("rotating_drum", changed); };
    EXPECT_EQ(of({{"drum_diameter", 0.04}, {"length", 0.2}}), Kinds{"small drum"});
    EXPECT_EQ(of({{"length", 0.02}}), Kinds{"short drum"});
    EXPECT_EQ(of({{"length", 0.01}, {"ends", std::string("plates")}, {"particles", std::int64_t{150}}}),
              Kinds{"few particles"});
    EXPECT_EQ(of({{"rpm", 120.0}}), Kinds{"centrifuging drum"}) << "w^2 R/g = 1.2";
    EXPECT_EQ(of({{"turning_time", 0.2}}), Kinds{"measured before the bed flows steadily"});
    EXPECT_EQ(of({{"rpm", 5.0}}), Kinds{"measured before the bed flows steadily"}) << "a tenth of a turn";
    EXPECT_EQ(of({{"measured_time", 0.1}}), Kinds{"few frames"});
    EXPECT_EQ(of({{"youngs_modulus", 1e5}}), Kinds{"particles too soft for the fall"});
}

TEST(SceneWarnings, OfTheHopper) {
    const auto of = [](const Inputs& changed) { return kinds("hopper", changed); };
    EXPECT_EQ(of({{"opening_size", 0.004}}), Kinds{"opening below one diameter"});
    EXPECT_EQ(of({{"opening_size", 0.055}}), Kinds{"opening nearly as wide as the container"});
    EXPECT_EQ(of({{"particles", std::int64_t{300}}}), (Kinds{"few particles", "low filling"}));
    EXPECT_EQ(of({{"settle_time", 0.1}}), Kinds{"powder still falling"});
    EXPECT_EQ(of({{"youngs_modulus", 1e5}}), Kinds{"particles too soft for the fall"});
}

TEST(SceneWarnings, OfTheHeap) {
    const auto of = [](const Inputs& changed) { return kinds("heap", changed); };
    EXPECT_EQ(of({{"particles", std::int64_t{300}}}), Kinds{"few particles"});
    EXPECT_EQ(of({{"lift_speed", 2.0}}), Kinds{"tube lifted faster than the powder falls"});
    EXPECT_EQ(of({{"settle_time", 0.1}}), Kinds{"powder still falling"});
    EXPECT_EQ(of({{"end_time", 0.3}}), Kinds{"tube still in the heap"});
    EXPECT_EQ(of({{"youngs_modulus", 1e5}}), Kinds{"particles too soft for the fall"});
}

TEST(SceneWarnings, OfDischarge) {
    const auto of = [](const Inputs& changed) { return kinds("tpms_discharge", changed); };
    EXPECT_EQ(of({{"shell", 0.6}}), Kinds{"leaky shell"});
    EXPECT_EQ(of({{"edge", 10.0}, {"shell", 4.9}}).count("closed outlet"), 1U);
    EXPECT_EQ(of({{"packing_fraction", 0.4}}), Kinds{"packing looser than powder at rest"});
    EXPECT_EQ(of({{"end_time", 0.5}}), Kinds{"ends before anything has fallen out"});
    EXPECT_EQ(of({{"youngs_modulus", 1e5}, {"time_step", 1e-6}}), Kinds{"particles too soft for the cell"});
    EXPECT_EQ(of({{"time_step", 5e-6}}), Kinds{"coarse time step"});
    EXPECT_EQ(of({{"vibration_amplitude", 1e-8}, {"vibration_frequency", 100.0}}),
              Kinds{"vibration too weak to matter"});
    EXPECT_EQ(of({{"vibration_amplitude", 1e-3}, {"vibration_frequency", 200.0}}),
              Kinds{"vibration faster than free fall"});
}

TEST(SceneWarnings, OfThermovibration) {
    const auto of = [](const Inputs& changed) { return kinds("thermovibration", changed); };
    EXPECT_EQ(of({{"acceleration", 1e7}}), Kinds{"density changes beyond Boussinesq"});
    EXPECT_EQ(of({{"end_time", 0.001}}), Kinds{"few periods"});
    EXPECT_EQ(of({{"frequency", 9e6}}), Kinds{"vibration finer than the grid"});
    EXPECT_EQ(of({{"particles", std::int64_t{20}}}), Kinds{"sampled too finely"});
    EXPECT_EQ(of({{"particles", std::int64_t{1000000}}, {"stokes", 3e-6}}), Kinds{"too heavy for one way"});
    EXPECT_EQ(of({{"particles", std::int64_t{1000000}}, {"stokes", 1.2e-5}}), Kinds{"more particles than fit"});
    EXPECT_EQ(of({{"stokes", 1e-4}, {"particles", std::int64_t{200}}}), Kinds{"particles larger than cells"});
}

}  // namespace grainsweep::tests::scene_warnings_test
