// Probes of contacts: stress, wear of walls, forces and fabric; contacts written by hand, and beds at rest.
#include "tests/support/machine_bed.hpp"
#include "tests/support/machines.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace grainsweep::tests::machine_contact_probes_test {

using namespace geometry;
using machine::Options;
using machine::Region;
using nlohmann::json;

constexpr Vec3 ex{1, 0, 0}, ey{0, 1, 0}, ez{0, 0, 1};

dem::ContactForce contact(std::int32_t first, std::int32_t second, const Vec3& normal, double force,
                          const Vec3& tangential = {}, double overlap = 0) {
    return {.first = first,
            .second = second,
            .overlap = overlap,
            .normal = normal,
            .normal_force = force,
            .tangential_force = tangential};
}

std::vector<Sample> profile_of(const char* name, const Options& options, const machine::Frame& frame) {
    const auto probe = machine::find_probe(name)->make(options);
    (void)probe->look(frame);
    std::vector<Sample> bins;
    probe->profile(frame, bins);
    return bins;
}

/// Two spheres of 2 mm that touch along x, seen with contacts of the test's own.
struct Pair : Bed {
    explicit Pair(std::vector<dem::ContactForce> given) {
        add({0, 0, 0}, 0), add({0.002, 0, 0}, 0);
        (void)frame();
        contacts = std::move(given);
    }
};

// One contact along x with the force (3, 1, 0) N over a branch of 2 mm: V s = f l.
TEST(MachineStress, IsForceTimesBranch) {
    Pair pair({contact(1, 0, ex, 3, {0, 1, 0})});
    const auto all = box({-0.005, -0.005, -0.005}, {0.005, 0.005, 0.005});
    const double volume = 1e-6;
    const auto component = [&](const Vec3& force, const Vec3& face) {
        return pair.look("stress", with("in", all, "quantity", word("component"), "force", force, "face", face));
    };
    EXPECT_DOUBLE_EQ(component(ex, ex), 3 * 0.002 / volume);
    EXPECT_DOUBLE_EQ(component(ey, ex), 1 * 0.002 / volume);
    EXPECT_EQ(component(ex, ey), 0) << "no force on that face";
    EXPECT_DOUBLE_EQ(pair.look("stress", with("in", all)), 0.002 / volume);
    // s = (3, 1/2; 1/2, 0): s' = diag(2, -1, -1) and shears of 1/2, 3/2 (4 + 1 + 1 + 1/4 + 1/4)
    EXPECT_DOUBLE_EQ(pair.look("stress", with("in", all, "quantity", word("deviator"))),
                     std::sqrt(1.5 * 6.5) * 0.002 / volume);
    // A region to x = 0.5 mm has a quarter of the branch.
    const auto quarter = box({-0.005, -0.005, -0.005}, {0.0005, 0.005, 0.005});
    EXPECT_DOUBLE_EQ(pair.look("stress", with("in", quarter)), 0.25 * 0.002 / 0.55e-6);
    const auto slabs = profile_of(
        "stress_profile", with("along", ex, "from", -0.001, "to", 0.003, "bins", 4.0, "section", 1e-4), pair.frame());
    ASSERT_EQ(slabs.size(), 4U);
    EXPECT_EQ(slabs[0].value, 0);
    EXPECT_DOUBLE_EQ(slabs[1].value, 0.001 / (1e-4 * 0.001));
    EXPECT_DOUBLE_EQ(slabs[2].value, 0.001 / (1e-4 * 0.001));
    EXPECT_DOUBLE_EQ(slabs[1].bin, 0.0005);
}

// At a wall the branch ends at its surface, at a glued sphere in the middle of the overlap.
TEST(MachineStress, BranchesEndAtWhatIsNoPowder) {
    Pair wall({contact(1, -1, ex, 3, {}, 1e-4)});
    const auto all = box({-0.005, -0.005, -0.005}, {0.005, 0.005, 0.005});
    EXPECT_NEAR(wall.look("stress", with("in", all)), 3 * 0.0009 / 3 / 1e-6, 1e-9);
    for (const int glued : {0, 1})
        for (const auto& [first, second] : {std::pair{1, 0}, {0, 1}}) {
            Pair pair({contact(first, second, first == 1 ? ex : Vec3{-1, 0, 0}, 3, {}, 1e-4)});
            pair.state.mobile[static_cast<std::size_t>(glued)] = 0;
            EXPECT_NEAR(pair.look("stress", with("in", all)), 3 * 0.00095 / 3 / 1e-6, 1e-9) << first << glued;
        }
}

// Two masses m at +-v: m v v each, whatever their mean motion.
TEST(MachineStress, HasAKineticPartAboutTheMean) {
    Pair pair({contact(1, 0, ex, 3)});
    const double m = 1000 * volume(0.002);
    pair.state.velocity = {{7 + 0.2, 0, 0}, {7 - 0.2, 0, 0}};
    const auto all = box({-0.005, -0.005, -0.005}, {0.005, 0.005, 0.005});
    const auto part = [&](const char* which) {
        return pair.look("stress",
                         with("in", all, "part", word(which), "quantity", word("component"), "force", ex, "face", ex));
    };
    EXPECT_NEAR(part("kinetic"), 2 * m * 0.04 / 1e-6, 1e-9);
    EXPECT_DOUBLE_EQ(part("contact"), 3 * 0.002 / 1e-6);
    EXPECT_NEAR(part("all"), part("kinetic") + part("contact"), 1e-9);
    const auto one = profile_of(
        "stress_profile",
        with("along", ex, "from", -0.001, "to", 0.003, "bins", 2.0, "section", 1e-4, "part", word("kinetic")),
        pair.frame());
    EXPECT_NEAR(one[0].value, 0, 1e-12) << "a slab with one sphere has no motion about its mean";
}

TEST(MachineStress, RefusesWhatCannotBe) {
    const auto flaw = machine::find_probe("stress")->flaw, of_slabs = machine::find_probe("stress_profile")->flaw;
    const auto all = box({0, 0, 0}, {1, 1, 1});
    EXPECT_EQ(flaw(with("in", all)), "");
    EXPECT_NE(flaw(with("in", Region{Region::Half{}})), "");
    EXPECT_NE(flaw(with("in", all, "quantity", word("component"))), "");
    EXPECT_NE(flaw(with("in", all, "quantity", word("component"), "force", ex)), "");
    EXPECT_NE(flaw(with("in", all, "force", ex, "face", ex)), "");
    EXPECT_NE(of_slabs(with("along", ex, "from", 1.0, "to", 0.0, "section", 1.0)), "");
}

/// A column of spheres at rest between smooth walls on a floor at z = 0, 10 mm by 10 mm.
json column() {
    return json::parse(R"({
      "name": "column",
      "domain": {"low": [0, 0, -0.01], "high": [0.01, 0.01, 0.1], "sides": ["periodic", "periodic", "open"]},
      "materials": {"glass": {"density": 2500, "youngs_modulus": "5 MPa"}},
      "contacts": {"restitution": 0.2, "friction": 0.3},
      "species": {"a": {"diameter": "2 mm", "sizes": {"spread": "uniform", "half_width": 0.1}}},
      "walls": {"floor": {"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}}},
      "fill": [{"species": "a", "count": 250, "shaken": 0.05,
                "in": {"box": {"low": [0, 0, 0.001], "high": [0.01, 0.01, 0.045]}}}],
      "phases": [{"name": "settle", "for": 0.35, "frames": 1}, {"name": "look", "for": 0.001, "frames": 1}],
      "measure": {
        "mean": {"stress": {"in": {"box": {"low": [-1, -1, -0.005], "high": [1, 1, 0.095]}}, "quantity": "component",
                            "force": [0, 0, 1], "face": [0, 0, 1]}, "during": "look", "as": "last"},
        "slabs": {"stress_profile": {"along": [0, 0, 1], "from": 0, "to": 0.024, "bins": 4, "section": 1e-4,
                                     "quantity": "component", "force": [0, 0, 1], "face": [0, 0, 1]},
                  "during": "look", "as": "last_profile"},
        "moving": {"stress": {"in": {"box": {"low": [-1, -1, -1], "high": [1, 1, 1]}}, "part": "kinetic"},
                   "during": "look", "as": "last"},
        "centre": {"centre": {"along": [0, 0, 1]}, "during": "look", "as": "last"},
        "mass": {"mass": {}, "as": "last"},
        "above": {"mass": {"in": {"half_space": {"point": [0, 0, 0.009], "normal": [0, 0, 1]}}}, "as": "last"},
        "floor": {"wall_force": {"wall": "floor", "along": [0, 0, -1]}, "during": "look", "as": "last"},
        "fabric": {"fabric": {}, "during": "look", "as": "last"},
        "force": {"contact_force": {}, "during": "look", "as": "last"}}
    })");
}

// At rest the virial of all forces along z is that of the weights: V s_zz = sum m g z. The slab about the height z
// carries the weight above it, to what a slab of three diameters blurs.
TEST(MachineStress, OfABedIsItsWeight) {
    const auto answer = answer_of(spec_of(column()));
    const double weight = 9.81 * answer.scalars.at("mass");
    ASSERT_NEAR(answer.scalars.at("floor"), weight, 2e-3 * weight);
    const double virial = answer.scalars.at("mean") * 0.1 * 1e-4;  // the region ends at the periodic faces
    EXPECT_NEAR(virial, weight * answer.scalars.at("centre"), 5e-3 * virial);
    const auto& slabs = answer.series.at("slabs");
    ASSERT_EQ(slabs.size(), 4U);
    EXPECT_NEAR(slabs[1].bin, 0.009, 1e-12);
    const double above = 9.81 * answer.scalars.at("above") / 1e-4;
    EXPECT_NEAR(slabs[1].value, above, 0.05 * above);
    EXPECT_LT(answer.scalars.at("moving") * 2e-4, 1e-3 * virial);
    EXPECT_GT(answer.scalars.at("fabric"), 0);
    EXPECT_LT(answer.scalars.at("fabric"), 0.3);
    EXPECT_GT(answer.scalars.at("force"), 0);
}

TEST(MachineWear, IsForceTimesSlidingDistance) {
    Pair pair({contact(0, -1, ez, 2), contact(1, -1, ez, 5), contact(1, -2, ez, 7), contact(1, 0, ez, 11)});
    for (auto& c : pair.contacts) c.slip = {3, 4, 0}, c.slides = true;
    pair.contacts.push_back(contact(1, -1, ez, 100));
    pair.contacts.back().slip = {3, 4, 0};  // sticks
    pair.contacts.push_back(contact(1, -1, ez, -100));
    pair.contacts.back().slip = {3, 4, 0}, pair.contacts.back().slides = true;  // attracts
    machine::Frame frame = pair.frame();
    frame.time_step = 0.1;
    const auto wear = [&](const char* probe, const Options& options) {
        const auto made = machine::find_probe(probe)->make(options);
        made->step(frame);
        std::vector<Sample> bins;
        made->profile(frame, bins);
        const double sum = made->look(frame);
        return std::pair{sum, bins};
    };
    EXPECT_DOUBLE_EQ(wear("wall_wear", with("wall", of({0}))).first, (2 + 5) * 5 * 0.1);
    EXPECT_DOUBLE_EQ(wear("wall_wear", with("wall", of({0, 1}))).first, (2 + 5 + 7) * 5 * 0.1);
    EXPECT_EQ(wear("wall_wear", with("wall", of({0}), "of", of({1}))).first, 0);
    EXPECT_DOUBLE_EQ(wear("wall_wear", with("wall", of({0}), "in", box({0.001, -1, -1}, {1, 1, 1}))).first, 2.5);
    EXPECT_DOUBLE_EQ(wear("wall_wear", with("wall", of({0}), "in", box({-1, -1, -0.0011}, {1, 1, -0.0009}))).first, 3.5)
        << "where they touch";
    EXPECT_TRUE(std::isnan(wear("wall_wear", with("wall", of({}))).first));
    const auto bins =
        wear("wall_wear_profile", with("wall", of({0}), "along", ex, "from", -0.001, "to", 0.003, "bins", 2.0)).second;
    ASSERT_EQ(bins.size(), 2U);
    EXPECT_DOUBLE_EQ(bins[0].value, 1);
    EXPECT_DOUBLE_EQ(bins[1].value, 2.5);
}

// A sphere thrown along a floor slides until it rolls with 5/7 of its speed: friction does m v^2/7 of work on the way,
// and normal force times distance is that divided by mu.
TEST(MachineWear, OfAThrownSphereIsTheWorkOfFriction) {
    for (const std::string precision : {"mixed", "double"}) {
        const auto answer = answer_of(spec_of(json::parse(R"({
          "name": "thrown",
          "domain": {"low": [-0.1, -0.1, -0.1], "high": [1, 0.1, 0.2]},
          "materials": {"glass": {"density": 2500, "youngs_modulus": "5 MPa"}},
          "contacts": {"restitution": 0.8, "friction": 0.4},
          "species": {"a": {"diameter": "4 mm"}},
          "walls": {"floor": {"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}}},
          "fill": [{"species": "a", "spheres": [{"at": [0, 0, 0.00201], "velocity": [0.5, 0, 0]}]}],
          "phases": [{"name": "slide", "for": 0.1, "frames": 5}],
          "measure": {
            "wear": {"wall_wear": {"wall": "floor"}, "as": "last"},
            "along": {"wall_wear_profile": {"wall": "floor", "along": [1, 0, 0], "from": 0, "to": 0.1, "bins": 10},
                      "as": "last_profile"},
            "lost": {"impact_energy": {"part": "tangential"}, "as": "last"},
            "speed": {"velocity": {"along": [1, 0, 0]}, "as": "last"}}
        })"),
                                              {{"precision", precision}}));
        const double work = 2500 * volume(0.004) * 0.25 / 7;
        EXPECT_NEAR(answer.scalars.at("speed"), 0.5 * 5 / 7, 1e-3);
        EXPECT_NEAR(answer.scalars.at("lost") / work, 1, 5e-3);
        EXPECT_NEAR(answer.scalars.at("wear") * 0.4 / work, 1, 5e-3);
        double sum = 0;
        for (const auto& bin : answer.series.at("along")) sum += bin.value;
        EXPECT_NEAR(sum / answer.scalars.at("wear"), 1, 1e-9);
    }
}

TEST(MachineContactForces, HaveADensityAboutTheirMean) {
    Pair pair({contact(0, 1, ex, 1), contact(0, 1, ex, 1), contact(0, 1, ex, -1), contact(0, 1, ex, 5),
               contact(0, -1, ex, 100)});
    EXPECT_DOUBLE_EQ(pair.look("contact_force"), 2);
    EXPECT_TRUE(std::isnan(pair.look("contact_force", with("of", of({1})))));
    const auto bins = profile_of("contact_force_density", with("to", 3.0, "bins", 3.0), pair.frame());
    ASSERT_EQ(bins.size(), 3U);
    EXPECT_DOUBLE_EQ(bins[0].value, 0.75);
    EXPECT_DOUBLE_EQ(bins[1].value, 0);
    EXPECT_DOUBLE_EQ(bins[2].value, 0.25);
}

TEST(MachineContactForces, HaveAFabric) {
    Pair pair({contact(0, 1, ex, 1), contact(0, -1, ez, 1)});
    EXPECT_NEAR(pair.look("fabric"), 1, 1e-12) << "all parallel";
    EXPECT_NEAR(pair.look("fabric", with("along", ex)), 1, 1e-12);
    pair.contacts = {contact(0, 1, ex, 1), contact(0, 1, ey, 1)};
    EXPECT_NEAR(pair.look("fabric"), 0.5, 1e-12) << "in a plane";
    pair.contacts.push_back(contact(0, 1, ez, 1));
    EXPECT_NEAR(pair.look("fabric"), 0, 1e-12) << "isotropic";
    EXPECT_NEAR(pair.look("fabric", with("along", ez)), 1.0 / 3, 1e-12);
    EXPECT_TRUE(std::isnan(pair.look("fabric", with("in", box({1, 1, 1}, {2, 2, 2})))));
}

// A blade stirs a bed at a given speed: its work, booked in every step, is its torque times the angle it turns. The
// blade braked by the powder has a negative torque. Frames see the torque a hundred times in the phase.
TEST(MachineFlowEnergy, IsTheWorkOfTheBlade) {
    json document = column();
    document["walls"]["blade"] = json::parse(R"({
        "rectangle": {"corner": [0.001, 0.005, 0.002], "along": [0.008, 0, 0], "across": [0, 0, 0.008]},
        "motion": [{"rotate": {"axis": [0, 0, 1], "through": [0.005, 0.005, 0], "speed": 20}, "from": "look"}]})");
    document["domain"] = json::parse(R"({"low": [-0.001, -0.001, -0.01], "high": [0.011, 0.011, 0.1]})");
    document["walls"]["box"] = json::parse(R"({"box": {"low": [0, 0, 0], "high": [0.01, 0.01, 0.1], "open": ["+z"]}})");
    document["fill"][0]["in"]["box"]["low"][2] = 0.012;
    document["fill"][0]["count"] = 150;
    document["phases"] = json::parse(R"([{"name": "settle", "for": 0.1, "frames": 1},
                                         {"name": "look", "for": 0.1, "frames": 2000}])");
    document["measure"] = json::parse(R"({
        "flow_energy": {"wall_work": {"wall": "blade"}, "during": "look", "as": "change"},
        "torque": {"wall_torque": {"wall": "blade", "axis": [0, 0, 1], "about": [0.005, 0.005, 0]}, "during": "look",
                   "as": "integral"}})");
    const auto answer = answer_of(spec_of(document));
    EXPECT_GT(answer.scalars.at("flow_energy"), 0);
    EXPECT_NEAR(-20 * answer.scalars.at("torque") / answer.scalars.at("flow_energy"), 1, 0.03);
}

// A wet sphere of 1 mm thrown against a ceiling hangs from it: the force at touch is 35 times its weight. Dry, or where
// the pair has no tension, it falls back. The bridge keeps what its work is: (m v^2/2 - m g h) is dissipated.
TEST(MachineCapillary, AWetSphereHangsFromACeiling) {
    json document = json::parse(R"({
      "name": "ceiling",
      "domain": {"low": [-0.01, -0.01, -1], "high": [0.01, 0.01, 0.02]},
      "materials": {"glass": {"density": 2500, "youngs_modulus": "5 MPa"}, "steel": {"youngs_modulus": "5 MPa"}},
      "contacts": {"restitution": 0.2, "cohesion_law": "capillary", "surface_tension": "72 mN/m", "contact_angle": "20 deg",
                   "bridge_volume": 0.002},
      "species": {"a": {"diameter": "1 mm"}},
      "walls": {"ceiling": {"plane": {"point": [0, 0, 0.01], "normal": [0, 0, -1]}, "material": "steel"}},
      "fill": [{"species": "a", "spheres": [{"at": [0, 0, 0.008], "velocity": [0, 0, 0.3]}]}],
      "phases": [{"name": "throw", "for": 0.1}],
      "measure": {"height": {"centre": {"along": [0, 0, 1]}, "as": "last"},
                  "lost": {"impact_energy": {}, "as": "last"}}
    })");
    for (const std::string precision : {"mixed", "double"}) {
        const auto height = [&](const json& machine) {
            return answer_of(spec_of(machine, {{"precision", precision}})).scalars.at("height");
        };
        EXPECT_NEAR(height(document), 0.0095, 2e-5) << "it hangs";
        json dry = document;
        dry["contacts"]["surface_tension"] = 0;
        EXPECT_LT(height(dry), 0);
        json no_bridge = document;
        no_bridge["contacts"]["pairs"] = {{"glass steel", {{"surface_tension", 0}}}};
        EXPECT_LT(height(no_bridge), 0);
    }
    const auto answer = answer_of(spec_of(document));
    const double mass = 2500 * volume(0.001);
    // At rest the contact holds the energy of its bridge, which is negative: more than the motion is taken out of it.
    EXPECT_NEAR(answer.scalars.at("lost"), mass * (0.3 * 0.3 / 2 - 9.81 * 0.0015), 2e-3 * mass * 0.045);
}

}  // namespace grainsweep::tests::machine_contact_probes_test
