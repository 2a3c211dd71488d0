// Clumps in machine files: filled, fed, placed, glued; probes count them as particles; runs continue with the same
// bits.
#include "tests/support/machines.hpp"

#include "sweep/campaign/input_error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

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
