// Clumps in machine files: filled, fed, placed, glued; probes count them as particles; runs continue with the same
// bits.
#include "tests/support/machines.hpp"

#include "sweep/campaign/input_error.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>

namespace grainsweep::tests::machine_clumps_test {

using nlohmann::json;

json pour(const json& shape) {
    return json::parse(R"({
      "name": "pour",
      "materials": {"grain": {"density": 2500, "youngs_modulus": 5e6}},
      "contacts": {"friction": 0.4},
      "species": {"rice": {"material": "grain", "diameter": "5 mm", "shape": )" +
                       shape.dump() + R"(}},
      "domain": {"low": [0, 0, -0.01], "high": [0.04, 0.04, 0.1], "sides": ["periodic", "periodic", "open"]},
      "walls": {"floor": {"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}}},
      "fill": [{"species": "rice", "count": 30, "in": {"box": {"low": [0, 0, 0.001], "high": [0.04, 0.04, 0.09]}}}],
      "phases": [{"name": "settle", "for": "0.02 s", "frames": 1}],
      "measure": {
        "count": {"count": {}, "as": "last"}, "mass": {"mass": {}, "as": "last"},
        "translation": {"kinetic_energy": {}, "as": "last"}, "rotation": {"rotational_energy": {}, "as": "last"},
        "orientation": {"orientation": {"along": [0, 0, 1]}, "as": "last"},
        "order": {"nematic_order": {}, "as": "last"}, "top": {"height": {"share": 1}, "as": "last"},
        "centres": {"height": {"share": 1, "of_sphere": "centre"}, "as": "last"},
        "partners": {"coordination": {}, "as": "last"}, "contacts": {"contacts": {}, "as": "last"},
        "solid": {"point_fraction": {"in": {"box": {"low": [0, 0, 0], "high": [0.04, 0.04, 0.1]}}, "points": 200000},
                  "as": "first"},
        "pressed": {"stress": {"in": {"box": {"low": [0, 0, 0], "high": [0.04, 0.04, 0.02]}}}, "as": "last"},
        "gone": {"discharged_number": {}, "as": "last"}}
    })");
}

constexpr double volume_of_one = std::numbers::pi / 6 * 125e-9;

TEST(MachineClumps, AreCountedAsParticles) {
    for (const json& shape :
         {json{{"aspect_ratio", 2}}, json{{"spheres", {{0, 0, 0, 2}, {1, 0, 0, 2}, {0, 1, 0, 1.5}}}}}) {
        for (const char* as : {"lattice", "random", "rain", "packed"}) {
            json machine = pour(shape);
            machine["fill"][0]["as"] = as;
            if (std::string(as) != "lattice") machine["fill"][0]["count"] = 15;
            const double count = machine["fill"][0]["count"];
            const auto answer = answer_of(spec_of(machine)).scalars;
            EXPECT_EQ(answer.at("count"), count) << as;
            EXPECT_EQ(answer.at("particles"), count);
            EXPECT_EQ(answer.at("lost"), 0);
            EXPECT_EQ(answer.at("gone"), 0);
            EXPECT_NEAR(answer.at("mass"), count * 2500 * volume_of_one, 1e-12);
            // Overlapping spheres of a clump count once.
            EXPECT_NEAR(answer.at("solid"), count * volume_of_one / (0.04 * 0.04 * 0.1), 6e-4) << as;
            EXPECT_GT(answer.at("top"), answer.at("centres") + 1.5e-3);
        }
    }
}

TEST(MachineClumps, HaveTheFillingOfSpheresAtRatioOne) {
    json spheres = pour({{"aspect_ratio", 1}}), plain = spheres;
    plain["species"]["rice"].erase("shape");
    for (json* machine : {&spheres, &plain})
        for (const char* name : {"orientation", "order"}) (*machine)["measure"].erase(name);
    EXPECT_EQ(text_of(answer_of(spec_of(spheres))), text_of(answer_of(spec_of(plain))));
}

TEST(MachineClumps, StartAtRandomOrientations) {
    json machine = pour({{"aspect_ratio", 2}});
    machine["domain"]["high"] = {0.2, 0.2, 0.3};
    machine["fill"][0] = {
        {"species", "rice"}, {"count", 3000}, {"in", {{"box", {{"low", {0, 0, 0.001}}, {"high", {0.2, 0.2, 0.29}}}}}}};
    machine["phases"][0]["for"] = 0;
    const auto answer = answer_of(spec_of(machine)).scalars;
    EXPECT_NEAR(answer.at("orientation"), 1.0 / 3, 3 * std::sqrt(4.0 / 45 / 3000));
    EXPECT_LT(answer.at("order"), 0.05);
}

TEST(MachineClumps, ContinueWithTheSameBits) {
    json machine = pour({{"aspect_ratio", 1.7}});
    machine["feed"] = json::array({{{"species", "rice"},
                                    {"rate", 0.2},
                                    {"velocity", {0, 0, -0.5}},
                                    {"through", {{"box", {{"low", {0, 0, 0.09}}, {"high", {0.04, 0.04, 0.1}}}}}}}});
    machine["fill"][0]["in"]["box"]["high"][2] = 0.08;
    machine["fill"].push_back({{"species", "rice"},
                               {"glued", true},
                               {"spheres", {{{"at", {0.02, 0.02, 0.085}}, {"orientation", {0.5, 0.5, 0.5, 0.5}}}}}});
    machine["phases"][0]["for"] = 0.05;
    const auto spec = spec_of(machine);
    machine::Run whole(spec, 1), first(spec, 1), second(spec, 1);
    whole.advance(1e9);
    first.advance(0.023);
    Bytes saved;
    first.save(saved);
    second.restore(saved);
    second.advance(1e9);
    Observations a, b;
    whole.observe(a), second.observe(b);
    EXPECT_EQ(text_of(a), text_of(b));
    EXPECT_TRUE(whole.health().stable());
    EXPECT_GT(a.scalars.at("feed_fed"), 5 * 2500 * volume_of_one);
    EXPECT_EQ(a.scalars.at("particles"), a.scalars.at("count"));
    EXPECT_EQ(a.scalars.at("particles"), 30 + std::round(a.scalars.at("feed_fed") / (2500 * volume_of_one)));
    const Snapshot picture = whole.snapshot();
    EXPECT_EQ(picture.scalars.at("body").size(), picture.positions.size());
    EXPECT_EQ(picture.vectors.at("long_axis").size(), picture.positions.size());
    EXPECT_EQ(picture.scalars.at("orientation_w").size(), picture.positions.size());
}

TEST(MachineClumps, ArePlacedWithAnOrientation) {
    json machine = pour({{"aspect_ratio", 2}});
    machine["fill"] = json::array(
        {{{"species", "rice"},
          {"spheres", {{{"at", {0.02, 0.02, 0.05}}, {"orientation", {1, 0, 1, 0}}, {"spin", {0, 0, 0}}}}}}});
    machine["phases"][0]["for"] = "1 ms";
    auto answer = answer_of(spec_of(machine)).scalars;
    EXPECT_NEAR(answer.at("orientation"), 1, 1e-12) << "a turn by 90 degrees about y: the long axis is upright";
    EXPECT_NEAR(answer.at("order"), 1, 1e-12);
    const FileTexts files = {{"grains.csv", "x,y,z,qw,qx,qy,qz\n0.02,0.02,0.05,1,0,0,0\n0.02,0.03,0.05,1,0,0,1\n"}};
    machine["fill"][0]["spheres"] = "grains.csv";
    answer = answer_of(spec_of(machine, {}, files)).scalars;
    EXPECT_EQ(answer.at("count"), 2);
    EXPECT_NEAR(answer.at("orientation"), 0, 1e-12);
}

// At rest on the floor: the sum of force times way from the floor to the centre of mass is weight times height, and
// compression is positive; also of spheres in a machine that has a clump somewhere.
TEST(MachineClumps, CarryTheirWeightByStress) {
    const json inside = {{"box", {{"low", {0, 0, -0.01}}, {"high", {0.02, 0.04, 0.02}}}}};
    const double volume = 0.02 * 0.04 * 0.03;
    for (const bool sphere : {false, true}) {
        json machine = pour({{"aspect_ratio", 1.5}});
        machine["species"]["ball"] = {{"material", "grain"}, {"diameter", "5 mm"}};
        machine["fill"] = {{{"species", sphere ? "ball" : "rice"}, {"spheres", {{{"at", {0.01, 0.02, 0.0026}}}}}},
                           {{"species", "rice"}, {"glued", true}, {"spheres", {{{"at", {0.03, 0.02, 0.05}}}}}}};
        machine["phases"][0]["for"] = 0.5;
        json component = {{"in", inside}, {"quantity", "component"}, {"force", {0, 0, 1}}, {"face", {0, 0, 1}}};
        machine["measure"] = {{"zz", {{"stress", component}, {"as", "last"}}},
                              {"pressure", {{"stress", {{"in", inside}}}, {"as", "last"}}},
                              {"height", {{"centre", {{"along", {0, 0, 1}}, {"in", inside}}}, {"as", "last"}}}};
        for (const char* precision : {"mixed", "double"}) {
            const auto seen = answer_of(spec_of(machine, {{"precision", precision}})).scalars;
            const double expected = 2500 * volume_of_one * 9.81 * seen.at("height") / volume;
            EXPECT_NEAR(seen.at("zz") / expected, 1, 2e-3) << sphere << precision;
            EXPECT_NEAR(seen.at("pressure") / (expected / 3), 1, 2e-2) << sphere << precision;
        }
    }
}

TEST(MachineClumps, SpinsHaveEnergy) {
    json machine = pour({{"spheres", {{-1, 0, 0, 2}, {1, 0, 0, 2}}}});
    machine["fill"] =
        json::array({{{"species", "rice"}, {"spheres", {{{"at", {0.02, 0.02, 0.05}}, {"spin", {100, 0, 50}}}}}}});
    machine["gravity"] = {0, 0, 0};
    machine["phases"][0]["for"] = 0;
    const auto answer = answer_of(spec_of(machine)).scalars;
    // Touching spheres of radius r: I = 0.4 m r^2 along the axis, 1.4 m r^2 across.
    const double r = 2.5e-3 / std::cbrt(2), m = 2500 * volume_of_one;
    EXPECT_NEAR(answer.at("rotation") / (0.5 * m * r * r * (0.4 * 100 * 100 + 1.4 * 50 * 50)), 1, 1e-9);
    EXPECT_EQ(answer.at("translation"), 0);
}

TEST(MachineClumps, LeaveTheDomainAsAWhole) {
    json machine = pour({{"aspect_ratio", 2}});
    machine["walls"] = json::object();
    machine["fill"] = json::array(
        {{{"species", "rice"},
          {"spheres", {{{"at", {0.02, 0.02, 0.0}}, {"velocity", {0, 0, -2}}}, {{"at", {0.02, 0.02, 0.05}}}}}}});
    const auto answer = answer_of(spec_of(machine)).scalars;
    EXPECT_EQ(answer.at("lost"), 1);
    EXPECT_EQ(answer.at("gone"), 1);
    EXPECT_EQ(answer.at("particles"), 1);
}

std::string why_refused(const json& machine, const FileTexts& files = {}) {
    try {
        (void)spec_of(machine, {}, files);
    } catch (const campaign::InputError& why) {
        return why.what();
    } catch (const std::exception& why) {
        return why.what();
    }
    return "";
}

/// A box of 12 x 8 x 6 mm as an STL file, in mm.
std::string box_stl() {
    constexpr std::array<std::array<double, 3>, 8> corner = {
        {{-6, -4, -3}, {6, -4, -3}, {6, 4, -3}, {-6, 4, -3}, {-6, -4, 3}, {6, -4, 3}, {6, 4, 3}, {-6, 4, 3}}};
    constexpr std::array<std::array<std::size_t, 4>, 6> sides = {
        {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};
    std::string text = "solid box\n";
    for (const auto& side : sides)
        for (const auto& triangle : {std::array{0, 1, 2}, std::array{0, 2, 3}}) {
            text += "facet normal 0 0 0\nouter loop\n";
            for (const int k : triangle) {
                const auto& [x, y, z] = corner[side[static_cast<std::size_t>(k)]];
                text += fmt::format("vertex {} {} {}\n", x, y, z);
            }
            text += "endloop\nendfacet\n";
        }
    return text + "endsolid box\n";
}

// It comes to rest on them, is carried by them alone, and every joule of it is booked.
TEST(MachineClumps, CarryAFreeBody) {
    const double mass = 8.64e-4, weight = 9.81 * mass;
    for (const char* precision : {"mixed", "double"}) {
        json machine = pour({{"aspect_ratio", 1.5}});
        machine["domain"] = {{"low", {-0.02, -0.02, -0.01}}, {"high", {0.02, 0.02, 0.08}}};
        machine["walls"]["tube"] = {{"cylinder", {{"axis", {0, 0, 1}}, {"radius", "15 mm"}}}};
        machine["walls"]["box"] = {{"stl", "box.stl"},
                                   {"scale", "1 mm"},
                                   {"at", {0, 0, 0.03}},
                                   {"motion", {{{"free", {{"mass", mass}, {"speed_at_most", 2}}}, {"from", "fall"}}}}};
        machine["species"]["rice"]["diameter"] = "3 mm";
        machine["fill"] = {{{"species", "rice"},
                            {"count", 250},
                            {"as", "random"},
                            {"in", {{"cylinder", {{"base", {0, 0, 0.001}}, {"radius", "15 mm"}, {"length", 0.05}}}}}}};
        machine["phases"] = {
            {{"name", "settle"}, {"for", 0.15}}, {{"name", "fall"}, {"for", 0.35}}, {{"name", "lie"}, {"for", 0.05}}};
        machine["measure"] = {
            {"carried", {{"wall_force", {{"wall", "box"}, {"along", {0, 0, 1}}}}, {"during", "lie"}, {"as", "mean"}}},
            {"kinetic", {{"wall_energy", {{"wall", "box"}}}, {"as", "last"}}},
            {"residual", {{"wall_energy", {{"wall", "box"}, {"part", "residual"}}}, {"as", "last"}}},
            {"fallen",
             {{"wall_position", {{"wall", "box"}, {"along", {0, 0, -1}}, {"of", {0, 0, 0.03}}}}, {"as", "last"}}}};
        std::string one;
        for (const int threads : {1, 2}) {
            auto spec = spec_of(machine, {{"precision", precision}}, {{"box.stl", box_stl()}});
            machine::Run run(spec, 1);
            run.use_threads(threads);
            run.advance(1e9);
            Observations seen;
            run.observe(seen);
            EXPECT_NEAR(seen.scalars.at("carried"), weight, 1e-3 * weight) << precision;
            EXPECT_LT(seen.scalars.at("kinetic"), 1e-4 * weight * 0.02) << precision;
            EXPECT_NEAR(seen.scalars.at("residual"), 0, 1e-12 * weight) << precision;
            // on a bed some 9 mm high, on one of its sides
            EXPECT_GT(seen.scalars.at("fallen"), 0.03 - 0.02) << precision;
            EXPECT_LT(seen.scalars.at("fallen"), 0.03 - 0.006) << precision;
            const auto text = text_of(seen);
            if (one.empty()) one = text;
            EXPECT_EQ(text, one) << precision << " " << threads;
        }
    }
}

TEST(MachineClumps, EveryMachineGivesItsPowderAnAspectRatio) {
    json machine = pour({{"aspect_ratio", 1.7}}), plain = machine;
    plain["species"]["rice"].erase("shape");
    for (json* one : {&machine, &plain}) (*one)["fill"][0]["in"]["box"]["high"] = {0.04, 0.04, "rice_largest + 0.08"};
    EXPECT_EQ(text_of(answer_of(spec_of(plain, {{"aspect_ratio", 1.7}}))), text_of(answer_of(spec_of(machine))));
    // Shapes resist rolling, and what is left out is said.
    json rolls = plain;
    rolls["contacts"]["rolling_friction"] = 0.1;
    const auto long_grains = spec_of(rolls, {{"aspect_ratio", 1.7}});
    EXPECT_EQ(text_of(answer_of(long_grains)), text_of(answer_of(spec_of(machine))));
    ASSERT_EQ(long_grains.warnings.size(), 1u);
    EXPECT_EQ(long_grains.warnings[0].sentence,
              "at an aspect ratio of 1.7 the shape resists rolling, so the rolling friction of 0.1 is left out");
    EXPECT_TRUE(spec_of(rolls).warnings.empty());
    // Single and glued particles, and species with a shape, stay as they are.
    plain["species"]["ball"] = {{"material", "grain"}, {"diameter", "5 mm"}};
    plain["species"]["rod"] = {{"material", "grain"}, {"diameter", "5 mm"}, {"shape", {{"aspect_ratio", 3}}}};
    plain["fill"].push_back({{"species", "ball"}, {"spheres", {{{"at", {0.02, 0.02, 0.095}}}}}});
    plain["fill"].push_back({{"species", "rod"}, {"glued", true}, {"spheres", {{{"at", {0.02, 0.02, -0.005}}}}}});
    const auto spec = spec_of(plain, {{"aspect_ratio", 1.5}});
    const auto members = [&](std::string_view name) {
        const auto found = std::ranges::find(spec.species, name, &machine::Species::name);
        return found->shape ? found->shape->balls.size() : 1;
    };
    EXPECT_EQ(members("rice"), 2u);
    EXPECT_EQ(members("ball"), 1u);
    EXPECT_EQ(members("rod"), 5u);
}

// A lattice is as wide as grains are long, and machines whose spheres fit were refused.
TEST(MachineClumps, LieAtRandomWhereALatticeHasTooFewPlaces) {
    json machine = pour({{"aspect_ratio", 2}});
    machine["fill"][0]["count"] = 250;  // of 144 places
    machine["phases"][0]["for"] = 0;
    machine["measure"]["overlap"] = {{"overlap", json::object()}};
    const auto answer = answer_of(spec_of(machine)).scalars;
    EXPECT_EQ(answer.at("count"), 250);
    EXPECT_EQ(answer.at("max_overlap"), 0);
    EXPECT_NEAR(answer.at("orientation"), 1. / 3, 0.06);
}

// Spheres around grains leave no room in any way of filling, and where random places do not suffice either, grains
// start from the bottom up, at orientations by chance.
TEST(MachineClumps, StartFromTheBottomWhereRandomPlacesDoNotSuffice) {
    constexpr double side = 0.04, high = 0.03, solid = 0.36;
    const auto filled = [&](const char* as, double count) {
        json machine = pour({{"aspect_ratio", 2}});
        machine["fill"][0]["as"] = as;
        machine["fill"][0]["count"] = count;
        machine["fill"][0]["in"]["box"]["high"][2] = 0.001 + high;
        machine["phases"][0]["for"] = 0;
        machine["measure"].erase("solid");
        machine["measure"]["overlap"] = {{"overlap", json::object()}};
        return answer_of(spec_of(machine));
    };
    const double count = std::floor(solid * side * side * high / volume_of_one);
    for (const char* as : {"lattice", "random", "rain", "packed"}) {
        const auto all = filled(as, count);
        const auto& answer = all.scalars;
        EXPECT_EQ(answer.at("count"), count) << as;
        EXPECT_EQ(answer.at("max_overlap"), 0) << as;
        EXPECT_EQ(answer.at("max_wall_overlap"), 0) << as;
        EXPECT_NEAR(answer.at("orientation"), 1. / 3, 3 * std::sqrt(4. / 45 / count)) << as;
        EXPECT_EQ(text_of(filled(as, count)), text_of(all)) << as;
    }
    EXPECT_LT(filled("packed", std::floor(count / 2)).scalars.at("top"), 0.7 * high);
    try {
        (void)filled("packed", 2 * count);
        ADD_FAILURE();
    } catch (const std::invalid_argument& why) {
        EXPECT_NE(std::string(why.what()).find("particles find a place without overlap"), std::string::npos)
            << why.what();
    }
}

TEST(MachineClumps, AMachineMayHaveAnAspectRatioOfItsOwn) {
    json machine = pour({{"aspect_ratio", 1}});
    machine["species"]["rice"].erase("shape");
    machine["parameters"] = {{"aspect_ratio", {{"default", 7}, {"meaning", "of the box"}}}};
    EXPECT_FALSE(spec_of(machine).species[0].shape);
}

TEST(MachineClumps, AnAspectRatioWithoutEffectIsRefused) {
    const json machine = pour({{"aspect_ratio", 1.5}});
    EXPECT_NO_THROW((void)spec_of(machine));
    try {
        (void)spec_of(machine, {{"aspect_ratio", 2.0}});
        FAIL();
    } catch (const campaign::InputError& wrong) {
        EXPECT_NE(std::string(wrong.what()).find("aspect_ratio: got 2; must be 1"), std::string::npos) << wrong.what();
    }
}

TEST(MachineClumps, WrongOnesGetASentence) {
    const auto says = [](const json& shape, const std::string& part, const FileTexts& files = {}) {
        const std::string why = why_refused(pour(shape), files);
        EXPECT_NE(why.find(part), std::string::npos) << shape << ": " << why;
        EXPECT_NE(why.find("$.species.rice.shape"), std::string::npos) << why;
    };
    const json two = {{-0.5, 0, 0, 2}, {0.5, 0, 0, 2}};
    says(json::object(), "has one of");
    says({{"aspect_ratio", 2}, {"spheres", two}}, "has one of");
    says({{"aspect_ratoi", 2}}, "Did you mean 'aspect_ratio'?");
    says({{"aspect_ratio", 0.5}}, "from 1 to 20");
    says({{"spheres", {{0, 0, 0, 1}}}}, "leave \"shape\" out");
    says({{"spheres", {{0, 0, 0, 1}, {5, 0, 0, 1}}}}, "fall into pieces");
    says({{"spheres", {{0, 0, 0, 2}, {0.1, 0, 0, 1}}}}, "lies within");
    says({{"spheres", {{0, 0, 0, 1}, {0.5, 0, 0, 0}}}}, "above 0");
    says({{"spheres", {{0, 0, 1}, {0.5, 0, 1}}}}, "[x, y, z, diameter]");
    says({{"spheres", 5}}, "belongs to \"stl\"");
    says({{"spheres", "none.csv"}}, "none.csv");
    says({{"spheres", "a.csv"}}, "header", {{"a.csv", "x,y,z\n1,2,3\n"}});
    says({{"spheres", "a.csv"}}, "line 3: 'c' is no number", {{"a.csv", "x,y,z,r\n1,2,3,1\n1,2,c,1\n"}});
    says({{"stl", "a.stl"}}, "STL", {{"a.stl", "hello"}});
    says({{"stl", "a.stl"}, {"spheres", 1}}, "from 2 to 200", {{"a.stl", "hello"}});
    says({{"aspect_ratio", 1.5}, {"error", 0.1}}, "belongs to \"stl\"");
    says({{"aspect_ratio", 1.5}, {"mass", 0.16}}, "check the units");
    says({{"aspect_ratio", 1.5}, {"mass", -1}}, "above 0");
    says({{"aspect_ratio", 1.5}, {"inertia", {1, 2, 3}}}, "six numbers");
    says({{"aspect_ratio", 1.5}, {"inertia", {1e-10, 0, 0, 1e-10, 0, 9e-10}}}, "no body has this inertia");
    says({{"aspect_ratio", 1.5}, {"centre", {5, 0, 0}}}, "outside of it");
    says({{"aspect_ratio", 1.5}, {"damping_mass", "bodi"}}, "Did you mean 'body'?");
    json machine = pour({{"aspect_ratio", 1.5}});
    machine["contacts"]["rolling_friction"] = 0.1;
    EXPECT_NE(why_refused(machine).find("rice has a shape, which resists rolling"), std::string::npos);
    machine = pour({{"aspect_ratio", 1.5}});
    machine["fill"][0]["count"] = 100000;
    EXPECT_THROW((void)answer_of(spec_of(machine)), std::invalid_argument);
}

}  // namespace grainsweep::tests::machine_clumps_test
