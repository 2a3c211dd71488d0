// Walls that touch some species only: grains of others pass through as if the wall were not there.
#include "tests/support/machines.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace grainsweep::tests::machine_only_test {

using nlohmann::json;

/// Stones and sand of one material and size fall on a floor, above a second floor that stops all.
json two_floors(const char* upper) {
    json machine = json::parse(R"({
      "name": "floors",
      "materials": {"rock": {"density": 2500, "youngs_modulus": "5 MPa", "poisson_ratio": 0.25}},
      "contacts": {"restitution": 0.5, "friction": 0.4},
      "species": {"sand": {"diameter": "3 mm"}, "stone": {"diameter": "3 mm"}},
      "walls": {"box": {"box": {"low": [0, 0, -0.03], "high": [0.03, 0.03, 0.04], "open": ["+z"]}}},
      "fill": [{"species": "stone", "count": 40, "in": {"box": {"low": [0, 0, 0.001], "high": [0.03, 0.03, 0.04]}}},
               {"species": "sand", "count": 20, "in": {"box": {"low": [0, 0, -0.02], "high": [0.03, 0.03, -0.005]}}},
               {"species": "sand", "spheres": [{"at": [0.015, 0.015, 0.001]}, {"at": [0.005, 0.02, 0.0005]}]}],
      "phases": [{"name": "fall", "for": 0.3, "frames": 3}],
      "measure": {
        "sand_above": {"count": {"of": "sand", "in": {"half_space": {"point": [0, 0, 0], "normal": [0, 0, 1]}}}, "as": "last"},
        "stones_above": {"count": {"of": "stone", "in": {"half_space": {"point": [0, 0, 0], "normal": [0, 0, 1]}}}, "as": "last"},
        "load": {"wall_force": {"wall": "floor", "along": [0, 0, -1]}, "as": "last"}
      }
    })");
    machine["walls"]["floor"] = json::parse(upper);
    return machine;
}

constexpr const char* plane_floor = R"({"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}})";
constexpr const char* mesh_floor =
    R"({"rectangle": {"corner": [0, 0, 0], "along": [0.03, 0, 0], "across": [0, 0.03, 0]}})";

TEST(MachineOnly, AWallStopsTheSpeciesThatItTouches) {
    for (const char* floor : {plane_floor, mesh_floor})
        for (const char* precision : {"double", "mixed"}) {
            json machine = two_floors(floor);
            machine["walls"]["floor"]["only"] = {"stone"};
            const auto seen = answer_of(spec_of(machine, {{"precision", precision}})).scalars;
            EXPECT_EQ(seen.at("stones_above"), 40) << floor << precision;
            EXPECT_EQ(seen.at("sand_above"), 0) << floor << precision;
            EXPECT_EQ(seen.at("particles"), 62) << floor << precision;
            // The floor carries the stones alone.
            const double weight = 40 * 2500 * 3.14159265 / 6 * 0.003 * 0.003 * 0.003 * 9.81;
            EXPECT_NEAR(seen.at("load") / weight, 1, 0.05) << floor << precision;
        }
}

TEST(MachineOnly, SpeciesAreToldApartOnlyWhereAWallDoes) {
    json plain = two_floors(mesh_floor);
    plain["fill"].erase(2);  // sand within the floor
    EXPECT_EQ(spec_of(plain).densities.size(), 1u);
    json machine = plain;
    machine["walls"]["floor"]["only"] = "stone";
    const auto spec = spec_of(machine);
    EXPECT_EQ(spec.densities.size(), 2u);
    EXPECT_FALSE(spec.walls[1].touches(spec.species[0]));
    EXPECT_TRUE(spec.walls[1].touches(spec.species[1]));
    // A wall that lists all species is a wall like any other.
    machine["walls"]["floor"]["only"] = {"stone", "sand"};
    EXPECT_EQ(spec_of(machine).densities.size(), 1u);
    EXPECT_EQ(spec_of(machine).walls[1].passing, 0);
}

TEST(MachineOnly, BitsDoNotDependOnThreads) {
    json machine = two_floors(mesh_floor);
    machine["walls"]["floor"]["only"] = {"stone"};
    auto spec = spec_of(machine, {{"precision", "mixed"}});
    const auto one = text_of(answer_of(spec));
    spec.method.threads = 3;
    EXPECT_EQ(text_of(answer_of(spec)), one);
}

TEST(MachineOnly, ACheckpointKeepsWhatPasses) {
    json machine = two_floors(mesh_floor);
    machine["walls"]["floor"]["only"] = {"stone"};
    expect_same_resumed(machine, 0.05);
}

}  // namespace grainsweep::tests::machine_only_test
