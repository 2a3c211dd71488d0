// Perforated plates: spheres smaller than a hole pass, larger ones stay; a sphere on the edge of a hole rests on it.
#include "tests/support/machines.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

namespace grainsweep::tests::perforated_plates_test {

using nlohmann::json;

constexpr double hole = 0.01, pitch = 0.014;
constexpr int across = 4;

/// A plate of 4 x 4 holes with a sphere above the middle of each, `share` of the hole wide.
json plate(double share, const char* pattern) {
    json machine = json::parse(R"json({
      "name": "plate",
      "materials": {"rock": {"density": 2500, "youngs_modulus": "50 MPa", "poisson_ratio": 0.25}},
      "contacts": {"restitution": 0.3, "friction": 0.3},
      "species": {"ball": {"diameter": 0.01}},
      "phases": [{"name": "fall", "for": 0.25, "frames": 5}],
      "measure": {
        "above": {"count": {"in": {"half_space": {"point": [0, 0, 0], "normal": [0, 0, 1]}}}, "as": "last"},
        "speed": {"rms_speed": {}, "as": "last"},
        "load": {"wall_force": {"wall": "plate", "along": [0, 0, -1]}, "as": "last"},
        "height": {"centre": {"along": [0, 0, 1]}, "as": "last"}
      }
    })json");
    const double row = pattern == std::string("square") ? pitch : pitch * std::sqrt(0.75);
    machine["domain"] = {{"low", {-0.01, -0.01, -0.5}}, {"high", {0.1, 0.1, 0.1}}};
    machine["walls"]["plate"] = {{"perforated",
                                  {{"corner", {0, 0, 0}},
                                   {"along", {across * pitch, 0, 0}},
                                   {"across", {0, across * row, 0}},
                                   {"hole", hole},
                                   {"pitch", pitch},
                                   {"pattern", pattern}}}};
    json balls = json::array();
    for (int j = 0; j < across; ++j)
        for (int i = 0; i < across - (row < pitch ? j % 2 : 0); ++i)
            balls.push_back(
                {{"at", {(i + 0.5 + (row < pitch && j % 2 == 1 ? 0.5 : 0)) * pitch, (j + 0.5) * row, 0.008}},
                 {"diameter", share * hole}});
    machine["fill"] = {json{{"species", "ball"}, {"spheres", balls}}};
    return machine;
}

TEST(PerforatedPlates, SmallerSpheresPassAndLargerOnesStay) {
    for (const char* pattern : {"square", "triangular"})
        for (const char* precision : {"double", "mixed"}) {
            const auto small = answer_of(spec_of(plate(0.99, pattern), {{"precision", precision}})).scalars;
            EXPECT_EQ(small.at("above"), 0) << pattern << precision;
            EXPECT_NEAR(small.at("speed") / (9.81 * 0.25), 1, 0.01) << "nothing has braked them";
            const auto large = answer_of(spec_of(plate(1.03, pattern), {{"precision", precision}})).scalars;
            EXPECT_EQ(large.at("above"), large.at("particles")) << pattern << precision;
            EXPECT_GE(large.at("particles"), 14);
        }
}

TEST(PerforatedPlates, ASphereRestsOnTheEdgeOfAHole) {
    // Its centre is at sqrt(R^2 - a^2), a the radius of the hole.
    for (const char* precision : {"double", "mixed"}) {
        json machine = plate(1.4, "square");
        machine["fill"][0]["spheres"] = {machine["fill"][0]["spheres"][5]};
        machine["phases"][0]["for"] = 0.6;
        const auto seen = answer_of(spec_of(machine, {{"precision", precision}})).scalars;
        const double radius = 0.7 * hole;
        EXPECT_NEAR(seen.at("height"), std::sqrt(radius * radius - hole * hole / 4), 0.01 * radius) << precision;
        const double weight = 2500 * 4 * std::numbers::pi / 3 * std::pow(radius, 3) * 9.81;
        EXPECT_NEAR(seen.at("load") / weight, 1, 0.01) << precision;
        EXPECT_LT(seen.at("speed"), 1e-3) << precision;
    }
}

}  // namespace grainsweep::tests::perforated_plates_test
