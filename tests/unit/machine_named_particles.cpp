// Probes of single particles by name: force and torque of their contacts, place, energy of rotation.
#include "tests/support/machines.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

namespace grainsweep::tests::machine_named_particles_test {

using nlohmann::json;

constexpr double diameter = 0.004, radius = diameter / 2;
const double mass = 2500 * std::numbers::pi / 6 * std::pow(diameter, 3), weight = mass * 9.81;

json bench(const char* spheres, const char* measures) {
    json machine = json::parse(R"({
      "name": "bench",
      "domain": {"low": [-0.5, -0.5, -0.1], "high": [0.5, 0.5, 0.5]},
      "materials": {"rock": {"density": 2500, "youngs_modulus": "50 MPa", "poisson_ratio": 0.25}},
      "contacts": {"restitution": 0.2, "friction": 0.3},
      "species": {"sand": {"diameter": "4 mm"}},
      "walls": {"floor": {"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}}},
      "phases": [{"name": "run", "for": 0.2, "frames": 40}]
    })");
    machine["fill"] = {json{{"species", "sand"}, {"spheres", json::parse(spheres)}}};
    machine["measure"] = json::parse(measures);
    return machine;
}

TEST(MachineNamedParticles, AParticleAtRestBearsItsWeightAndItsLoad) {
    const auto seen =
        answer_of(
            spec_of(bench(
                R"([{"at": [0, 0, 0.002], "name": "lower"}, {"at": [0, 0, 0.006], "name": "upper"}, {"at": [0.1, 0, 0.002]}])",
                R"({"upper_force": {"particle_force": {"of": "upper", "along": [0, 0, 1]}, "as": "last"},
            "lower_force": {"particle_force": {"of": "lower", "along": [0, 0, 1]}, "as": "last"},
            "from_floor": {"particle_force": {"of": "lower", "along": [0, 0, 1], "from": "walls"}, "as": "last"},
            "from_above": {"particle_force": {"of": "lower", "along": [0, 0, 1], "from": "particles"}, "as": "last"},
            "pair": {"particle_force": {"of": ["lower", "upper"], "along": [0, 0, 1]}, "as": "last"},
            "height": {"centre": {"of": "upper", "along": [0, 0, 1]}, "as": "last"},
            "all": {"mass": {"of": "sand"}, "as": "last"},
            "one": {"mass": {"of": "upper"}, "as": "last"}})")))
            .scalars;
    EXPECT_NEAR(seen.at("upper_force") / weight, 1, 1e-3);
    EXPECT_NEAR(seen.at("lower_force") / weight, 1, 1e-3);
    EXPECT_NEAR(seen.at("from_floor") / weight, 2, 1e-3);
    EXPECT_NEAR(seen.at("from_above") / weight, -1, 1e-3);
    EXPECT_NEAR(seen.at("pair") / weight, 2, 1e-3);
    EXPECT_NEAR(seen.at("height"), 0.006, 1e-4);
    EXPECT_NEAR(seen.at("one") / mass, 1, 1e-9);
    EXPECT_NEAR(seen.at("all") / mass, 3, 1e-9);
}

TEST(MachineNamedParticles, FrictionTurnsASlidingParticle) {
    const auto seen = answer_of(
        spec_of(bench(R"([{"at": [0, 0, 0.002], "velocity": [1, 0, 0], "name": "slider"}, {"at": [0, 0.1, 0.002]}])",
                      R"({"drag": {"particle_force": {"of": "slider", "along": [1, 0, 0]}},
            "torque": {"particle_torque": {"of": "slider", "axis": [0, 1, 0]}, "as": "series"},
            "turning": {"rotational_energy": {"of": "slider"}, "as": "series"},
            "other": {"particle_torque": {"of": "sand", "axis": [0, 0, 1]}, "as": "last"}})")));
    // Sliding lasts 2 v/(7 mu g) = 0.097 s; torque mu m g R, speed of rotation w = torque t/(0.4 m R^2).
    const auto& torque = seen.series.at("torque");
    const auto& energy = seen.series.at("turning");
    std::size_t slid = 0;
    for (std::size_t k = 0; k < torque.size(); ++k) {
        const double t = torque[k].time;
        if (t < 0.02 || t > 0.08) continue;
        ++slid;
        EXPECT_NEAR(torque[k].value / (0.3 * weight * radius), 1, 0.02) << t;
        const double spin = 0.3 * weight * radius * t / (0.4 * mass * radius * radius);
        EXPECT_NEAR(energy[k].value / (0.2 * mass * radius * radius * spin * spin), 1, 0.05) << t;
    }
    EXPECT_GE(slid, 10u);
    EXPECT_NEAR(torque.back().value / (0.3 * weight * radius), 0, 0.01);
    EXPECT_NEAR(seen.scalars.at("other") / (weight * radius), 0, 1e-6);
}

TEST(MachineNamedParticles, AGluedParticleHasAForceAndNoPlaceInTheSpecies) {
    json machine = bench(R"([{"at": [0, 0, 0.05], "name": "post"}])",
                         R"({"on_post": {"particle_force": {"of": "post", "along": [0, 0, -1]}, "as": "last"},
                             "count": {"count": {"of": "sand"}, "as": "last"}})");
    machine["fill"][0]["glued"] = true;
    machine["fill"].push_back({{"species", "sand"}, {"spheres", json::parse(R"([{"at": [0, 0, 0.05399]}])")}});
    const auto seen = answer_of(spec_of(machine)).scalars;
    EXPECT_NEAR(seen.at("on_post") / weight, 1, 0.02);
    EXPECT_EQ(seen.at("count"), 1);
}

TEST(MachineNamedParticles, AClumpIsOneParticle) {
    json machine =
        bench(R"([{"at": [0, 0, 0.004], "name": "rod", "orientation": [1, 0, 0, 0]}, {"at": [0.1, 0, 0.004]}])",
              R"({"force": {"particle_force": {"of": "rod", "along": [0, 0, 1]}, "as": "last"},
                             "torque": {"particle_torque": {"of": "rod", "axis": [0, 1, 0]}, "as": "last"},
                             "mass": {"mass": {"of": "rod"}, "as": "last"}})");
    machine["species"]["sand"]["shape"] = {{"aspect_ratio", 2}};
    const auto seen = answer_of(spec_of(machine)).scalars;
    EXPECT_NEAR(seen.at("mass") / mass, 1, 1e-9);
    EXPECT_NEAR(seen.at("force") / weight, 1, 0.01);
    EXPECT_NEAR(seen.at("torque") / (weight * radius), 0, 0.01);
}

}  // namespace grainsweep::tests::machine_named_particles_test
