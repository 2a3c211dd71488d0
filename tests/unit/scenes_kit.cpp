// The Bond number of a machine.
#include "solver/dem/material.hpp"
#include "solver/scenes/scene.hpp"
#include "sweep/campaign/installed_machines.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace grainsweep::tests::scenes_kit_test {

// The largest value of k A(d) - 4/3 E* sqrt(R*) d^(3/2), searched for.
TEST(Scenes, BondNumberIsTheLargestAttractionOverTheWeight) {
    const auto spreading = campaign::scene_named("powder_spreading");
    Inputs inputs = spreading->defaults();
    const double diameter = 2e-3, radius = diameter / 2, weight = dem::sphere_mass(radius, 7980) * 9.81;
    const auto bond_number = [&] {
        NoArtefacts none;
        Observations into;
        spreading->make(inputs, 1, none)->observe(into);
        return into.scalars.contains("bond_number") ? into.scalars.at("bond_number") : 0.0;
    };
    inputs["cohesion"] = 2e4;
    dem::Material material;
    material.youngs_modulus = 21e6, material.poisson_ratio = 0.3;
    const double stiffness = 4.0 / 3 * dem::effective_modulus(material) * std::sqrt(radius / 2);
    for (const auto& [word, factor] : {std::pair("sjkr", 1.0), std::pair("sjkr2", 2.0), std::pair("paper", 0.25)}) {
        inputs["cohesion_law"] = std::string(word);
        double largest = 0;
        for (int k = 0; k < 200'000; ++k) {
            const double d = 1e-13 * std::pow(1.0001, k);
            if (d > 0.01 * radius) break;
            largest = std::max(largest, 2e4 * factor * std::numbers::pi * radius * d - stiffness * std::pow(d, 1.5));
        }
        EXPECT_NEAR(bond_number() * weight / largest, 1, 1e-6) << word;
    }
    inputs["surface_energy"] = 2e-3;
    for (const auto& [word, factor] : {std::pair("jkr", 1.5), std::pair("dmt", 2.0)}) {
        inputs["cohesion_law"] = std::string(word);
        EXPECT_NEAR(bond_number() * weight / (factor * std::numbers::pi * 2e-3 * radius / 2), 1, 1e-12);
    }
    inputs["surface_energy"] = 0.0;
    EXPECT_EQ(bond_number(), 0) << "none without cohesion";
}

}  // namespace grainsweep::tests::scenes_kit_test
