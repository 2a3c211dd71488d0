// One sphere at planes, cylinders and cones, at rest and in motion, against LIGGGHTS 3.8 and the exact evaluation
// beside it (tests/reference/walls): the same law and time step give the same numbers up to rounding.
#include "solver/dem/engine.hpp"
#include "tests/support/against_plain.hpp"
#include "tests/support/wall_case.hpp"

#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <set>

namespace grainsweep::tests::wall_trajectories_test {

using dem::Method;
using nlohmann::json;

/// The cases without meshes that name the velocity of the surface itself.
std::vector<std::pair<std::string, json>> cases() {
    std::vector<std::pair<std::string, json>> chosen;
    for (const char* file : {"cases.json", "cases_exact.json"}) {
        const json all = tests::wall_cases(file);
        for (const auto& [name, c] : all.items()) {
            if (!c["meshes"].empty()) continue;
            const json& wall = c["primitives"][0];
            const bool slides =
                wall.contains("shear") && wall["shear"][0].get<std::string>()[0] == wall["kind"].get<std::string>()[0];
            if (wall.contains("shear") && !slides && !wall.contains("surface")) continue;  // of the centre: see README
            chosen.emplace_back(name, c);
        }
    }
    return chosen;
}

// Rounding alone: an independent evaluation differs by up to 1e-12 of the largest speed from the reference.
TEST(WallTrajectories, EqualTheReferenceToRounding) {
    std::set<std::string> seen;
    for (const auto& [name, c] : cases()) {
        const auto d = tests::deviation(name, tests::setup_of_wall_case(c), {});
        EXPECT_EQ(d.fault, "") << name;
        EXPECT_LT(d.largest(), 1e-11) << name;
        seen.insert(name);
    }
    EXPECT_EQ(seen.size(), 17U);
}

// Mixed precision: 3e-6 of the largest speed, as of two spheres. Where impacts follow one another each multiplies what
// the one before left: 3e-5, and over the bounces down a slope 1e-4.
TEST(WallTrajectories, MixedPrecisionEqualsTheReference) {
    const std::map<std::string, double> beyond = {{"p_cyl_release60_slip", 3e-5},
                                                  {"p_zcyl_helix", 3e-5},
                                                  {"x_zcyl_spin_helix_surface", 3e-5},
                                                  {"p_plane_tilt30_bounce", 1e-4}};
    for (const auto& [name, c] : cases())
        for (const auto path : tests::paths()) {
            const auto d = tests::deviation(name, tests::setup_of_wall_case(c), {Method::Precision::mixed, path});
            EXPECT_EQ(d.fault, "") << name << " " << tests::path_name(path);
            const double tolerance = beyond.contains(name) ? beyond.at(name) : 3e-6;
            EXPECT_LT(d.largest(), tolerance) << name << " " << tests::path_name(path);
        }
}

}  // namespace grainsweep::tests::wall_trajectories_test
