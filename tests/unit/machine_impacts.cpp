// Energies of contacts: what the steps take out of the motion, contact by contact; closed forms of single impacts, the
// balance of a box, and machines that are cut into slices.
#include "solver/dem/engine.hpp"
#include "tests/support/granular_scenes.hpp"
#include "tests/support/machine_bed.hpp"
#include "tests/support/machines.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>

namespace grainsweep::tests::machine_impacts_test {

using namespace dem;
using geometry::dot;
using geometry::operator-;
using geometry::operator*;
using nlohmann::json;

// At the step that the program chooses, wherever in a step the impact begins.
TEST(MachineImpacts, HaveTheirRestitutionAtTheProgramsStep) {
    for (const bool linear : {false, true})
        for (const double restitution : {0.3, 0.6, 0.9})
            for (int k = 0; k < 6; ++k) {
                json machine = json::parse(R"({
                  "name": "two", "gravity": [0, 0, 0],
                  "materials": {"m": {"density": 2500, "youngs_modulus": 1e7}},
                  "species": {"p": {"diameter": 0.005}},
                  "domain": {"low": [-0.5, -0.5, -0.5], "high": [0.5, 0.5, 0.5]},
                  "phases": [{"name": "s", "for": 0.01}],
                  "measure": {"v": {"fastest": {"along": [1, 0, 0]}, "as": "last"}}
                })");
                machine["contacts"] = {{"restitution", restitution}};
                if (linear) machine["contacts"].update({{"normal_law", "linear"}, {"stiffness", 1000}});
                machine["fill"] = {{{"species", "p"},
                                    {"spheres",
                                     {{{"at", {0, 0, 0}}, {"velocity", {0.15, 0, 0}}},
                                      {{"at", {0.005 + 1.5e-5 * k, 0, 0}}, {"velocity", {-0.15, 0, 0}}}}}}};
                EXPECT_NEAR(answer_of(spec_of(machine)).scalars.at("v") / 0.15, restitution, 0.03)
                    << linear << " " << restitution << " " << k;
            }
}

class StepContacts : public testing::TestWithParam<Method::Precision> {
protected:
    [[nodiscard]] static bool mixed() { return GetParam() == Method::Precision::mixed; }
};
INSTANTIATE_TEST_SUITE_P(Both, StepContacts,
                         testing::Values(Method::Precision::mixed, Method::Precision::double_precision),
                         [](const auto& p) { return p.param == Method::Precision::mixed ? "mixed" : "double"; });

// A dissipative gas of unequal spheres that rub, roll and hit walls, thrown into a box without gravity. Over steps n
// the kinetic energy at half steps changes by exactly what the contacts of those steps take; at full steps it is that
// at half steps up to (f dt)^2/(8 m), which vanishes where nothing touches.
TEST_P(StepContacts, TakeWhatTheMotionLoses) {
    dem::Setup setup = boxed_gas(20, 0.4, 2, 5);
    setup.gravity = {};
    setup.material.friction = 0.6;
    setup.material.rolling_friction = 0.1;
    setup.material.restitution = 0.4;
    Method method;
    method.precision = GetParam();
    const auto engine = make_engine(setup, method);
    const double before = kinetic_energy(setup, state_of(*engine));
    double taken = 0, sliding = 0, sticking = 0;
    std::vector<ContactForce> contacts;
    const auto step = [&] {
        engine->run(1);
        engine->step_contacts(contacts);
        for (const auto& c : contacts) {
            taken += setup.time_step * (c.normal_power + c.tangential_power);
            (c.slides ? sliding : sticking) += 1;
        }
    };
    for (int k = 0; k < 6000; ++k) step();
    for (int k = 0; k < 20000 && !contacts.empty(); ++k) step();
    ASSERT_EQ(engine->fault(), "");
    ASSERT_TRUE(contacts.empty()) << "a moment at which nothing touches";
    const double after = kinetic_energy(setup, state_of(*engine));
    EXPECT_GT(sliding, 1000);
    EXPECT_GT(sticking, 1000);
    EXPECT_LT(after, 0.8 * before);
    EXPECT_NEAR(taken / (before - after), 1, mixed() ? 1e-3 : 1e-10);
}

/// Two spheres of mass m that meet head-on at the speed v: E = (1 - e^2) m v^2/4.
TEST_P(StepContacts, AnImpactDissipatesByItsRestitution) {
    const auto spectrum =
        machine::find_probe("impact_energy_spectrum")->make(with("from", 1e-9, "to", 1e-3, "bins", 6.0));
    const auto energy = machine::find_probe("impact_energy")->make({});
    const auto number = machine::find_probe("impact_number")->make({});
    const auto tangential = machine::find_probe("impact_energy")->make(with("part", word("tangential")));
    Bed bed;
    bed.add({0, 0, 0}, 0, {0.2, 0, 0}), bed.add({0.0021, 0, 0}, 0, {-0.2, 0, 0});
    bed.setup.material.density = 1000;
    bed.setup.material.restitution = 0.6;
    bed.setup.time_step = 1e-7;
    bed.setup.gravity = {};
    Method method;
    method.precision = GetParam();
    bed.engine = make_engine(bed.setup, method);
    machine::PartnerOrder order;
    for (int k = 0; k < 20000; ++k) {
        bed.engine->run(1);
        bed.engine->step_contacts(bed.contacts);
        machine::Frame frame{*bed.engine, bed.state, bed.contacts, bed.species, bed.density, bed.domain, {},
                             k * 1e-7,    0,         bed.radius,   1e-7};
        frame.by_partners = order.of(bed.contacts);
        for (auto* probe : {spectrum.get(), energy.get(), number.get(), tangential.get()}) probe->step(frame);
    }
    const double expected = (1 - 0.36) * 1000 * volume(0.002) * 0.4 * 0.4 / 4;
    EXPECT_NEAR(energy->look(bed.frame()) / expected, 1, 2e-3) << "the restitution of Hertz's damper is 0.6 to 1e-3";
    EXPECT_EQ(number->look(bed.frame()), 1);
    EXPECT_NEAR(tangential->look(bed.frame()) / expected, 0, 1e-12);
    std::vector<Sample> bins;
    spectrum->profile(bed.frame(), bins);
    ASSERT_EQ(bins.size(), 6U);
    const auto place = static_cast<std::size_t>(std::floor(std::log10(expected) + 9));
    EXPECT_NEAR(bins[place].bin, std::pow(10, -8.5 + static_cast<double>(place)), 1e-3 * bins[place].bin);
    for (std::size_t b = 0; b < bins.size(); ++b)
        EXPECT_EQ(bins[b].value, b == place ? energy->look(bed.frame()) : 0) << b;
}

TEST(PartnerOrder, IsByTheLargerIdThenBySmallerAndKeepsPlacesOnAWall) {
    std::vector<dem::ContactForce> contacts;
    for (const auto& [first, second] : {std::pair{2, 5}, {3, -1}, {3, -2}, {3, -1}, {0, 1}, {5, 0}, {3, 2}}) {
        contacts.emplace_back();
        contacts.back().first = first, contacts.back().second = second;
    }
    machine::PartnerOrder order;
    const auto places = order.of(contacts);
    EXPECT_EQ((std::vector<std::uint32_t>(places.begin(), places.end())),
              (std::vector<std::uint32_t>{4, 2, 1, 3, 6, 5, 0}));
    EXPECT_TRUE(order.of({}).empty());
}

/// A sphere that falls on a floor for half a second.
json bouncing() {
    return json::parse(R"({
      "name": "bounce",
      "domain": {"low": [-0.1, -0.1, -0.1], "high": [0.1, 0.1, 0.2]},
      "materials": {"glass": {"density": 2500, "youngs_modulus": "200 MPa"}},
      "contacts": {"restitution": 0.5, "friction": 0.3, "rolling_friction": 0.05},
      "species": {"a": {"diameter": "4 mm"}, "b": {"diameter": "3 mm"}},
      "walls": {"floor": {"rectangle": {"corner": [-0.05, -0.05, 0], "along": [0.1, 0, 0], "across": [0, 0.1, 0]}},
                "side": {"plane": {"point": [0.004, 0, 0], "normal": [-1, 0, 0]}}},
      "fill": [{"species": "a", "spheres": [{"at": [0, 0, 0.02]}]}],
      "phases": [{"name": "fall", "for": 0.4, "frames": 10}, {"name": "rest", "for": 0.1, "frames": 10}],
      "measure": {
        "all": {"impact_energy": {}, "as": "last"},
        "late": {"impact_energy": {}, "during": "rest", "as": "last"},
        "floor": {"impact_energy": {"wall": "floor"}, "as": "last"},
        "normal": {"impact_energy": {"part": "normal"}, "as": "last"},
        "sideways": {"impact_energy": {"part": "tangential"}, "as": "last"},
        "pairs": {"impact_energy": {"of": "b"}, "as": "last"},
        "number": {"impact_number_spectrum": {"from": 1e-10, "to": 1e-4, "bins": 60}, "as": "last_profile"},
        "hits": {"impact_number": {}, "as": "last"},
        "spectrum": {"impact_energy_spectrum": {"from": 1e-10, "to": 1e-4, "bins": 60}, "as": "last_profile"}}
    })");
}

// It comes to rest and has lost m g h; the k-th impact takes (1 - e^2) e^(2k) m g h, four bins of a tenth of a decade
// further down each time.
TEST(MachineImpacts, ABouncingSphereLosesWhatItFell) {
    for (const std::string precision : {"mixed", "double"}) {
        const auto answer = answer_of(spec_of(bouncing(), {{"precision", precision}}));
        const double fallen = 2500 * volume(0.004) * 9.81 * 0.018;
        EXPECT_NEAR(answer.scalars.at("all") / fallen, 1, 2e-3) << "and rests a little deeper than it touched";
        EXPECT_EQ(answer.scalars.at("all"), answer.scalars.at("floor"));
        EXPECT_NEAR(answer.scalars.at("normal") + answer.scalars.at("sideways"), answer.scalars.at("all"), 1e-12);
        EXPECT_NEAR(answer.scalars.at("sideways"), 0, 1e-3 * fallen);
        EXPECT_EQ(answer.scalars.at("pairs"), 0);
        EXPECT_LT(answer.scalars.at("late"), 1e-3 * fallen);
        const auto& number = answer.series.at("number");
        const auto& energy = answer.series.at("spectrum");
        ASSERT_EQ(energy.size(), 60U);
        double expected = 0.75 * fallen;
        for (int impact = 0; impact < 4; ++impact, expected /= 4) {
            const auto place = static_cast<std::size_t>(10 * (std::log10(expected) + 10));
            EXPECT_EQ(number[place].value, 1) << impact;
            EXPECT_NEAR(energy[place].value / expected, 1, 0.02 * (1 + impact)) << impact;
        }
        EXPECT_GE(answer.scalars.at("hits"), 4);
    }
}

/// The machine of the other tests, listened to.
machine::Spec listened(const Inputs& inputs = {}) {
    json document = small_machine();
    document["measure"]["dissipated"] =
        json::parse(R"({"impact_energy": {}, "during": ["fall", "turn"], "as": "last"})");
    document["measure"]["spectrum"] =
        json::parse(R"({"impact_number_spectrum": {"from": 1e-9, "to": 1e-5}, "during": "turn",
                                                "as": "last_profile"})");
    return spec_of(document, inputs);
}

Observations finished(machine::Run& run) {
    run.advance(1e9);
    Observations answer;
    run.observe(answer);
    return answer;
}

// Balance of a bed between a belt and a pressed lid. By `spring` the force of a contact jumps where its spring is cut,
// which half of the contacts do in many steps.
TEST(MachineImpacts, OfAShearedBedAreTheWorkOfItsWalls) {
    for (const char* limit : {"sum", "spring"})
        for (const bool linear : {false, true}) {
            json machine = json::parse(R"({
              "name": "shear",
              "materials": {"m": {"density": 2500, "youngs_modulus": 5e6}},
              "species": {"p": {"diameter": 0.003, "sizes": {"spread": "uniform", "half_width": 0.1}}},
              "domain": {"low": [0, 0, -0.005], "high": [0.015, 0.015, 0.04], "periodic": [1, 1, 0]},
              "walls": {
                "floor": {"plane": {"normal": [0, 0, 1]},
                          "motion": [{"convey": {"velocity": [0.2, 0, 0]}, "from": "shear"}]},
                "lid": {"plane": {"point": [0, 0, 0.03], "normal": [0, 0, -1]},
                        "motion": [{"press": {"along": [0, 0, -1], "mass": 0.01, "speed_at_most": 0.5},
                                    "from": "load"}]}
              },
              "fill": [{"species": "p", "count": 70,
                        "in": {"box": {"low": [0, 0, 0], "high": [0.015, 0.015, 0.028]}}}],
              "phases": [{"name": "settle", "for": 0.06, "frames": 2}, {"name": "load", "for": 0.1, "frames": 2},
                         {"name": "shear", "for": 0.03, "frames": 2}, {"name": "look", "for": 0.02, "frames": 2}],
              "measure": {
                "lost": {"impact_energy": {}, "during": "look", "as": "last"},
                "work": {"wall_work": {"wall": ["floor", "lid"]}, "during": "look", "as": "change"},
                "moves": {"kinetic_energy": {}, "during": "look", "as": "change"},
                "turns": {"rotational_energy": {}, "during": "look", "as": "change"},
                "rises": {"mean_height": {}, "during": "look", "as": "change"},
                "mass": {"mass": {}, "during": "look", "as": "last"}
              }
            })");
            machine["contacts"] = {{"restitution", linear ? 0.3 : 0.1}, {"tangential_limit", limit}};
            if (linear) machine["contacts"].update({{"normal_law", "linear"}, {"stiffness", 2250}});
            machine["walls"]["lid"]["motion"][0]["press"]["force"] = 1.125;
            const auto seen = answer_of(spec_of(machine)).scalars;
            const double gained = seen.at("moves") + seen.at("turns") + 9.81 * seen.at("mass") * seen.at("rises");
            EXPECT_GT(seen.at("work"), 1e-6) << limit << linear;
            EXPECT_NEAR((seen.at("lost") + gained) / seen.at("work"), 1, 5e-3) << limit << linear;
        }
}

TEST(MachineImpacts, ListeningChangesNoOtherAnswer) {
    for (const std::string precision : {"mixed", "double"}) {
        Observations plain = answer_of(spec_of(small_machine(), {{"precision", precision}}), 7);
        machine::Run run(listened({{"precision", precision}}), 7);
        Observations heard = finished(run);
        EXPECT_GT(heard.scalars.at("dissipated"), 0);
        EXPECT_EQ(heard.scalars.erase("dissipated") + heard.series.erase("spectrum"), 2U);
        EXPECT_EQ(text_of(heard), text_of(plain));
    }
}

TEST(MachineImpacts, SlicesThreadsAndContinuingChangeNoBit) {
    for (const std::string precision : {"mixed", "double"}) {
        const machine::Spec spec = listened({{"precision", precision}});
        machine::Run whole(spec, 7);
        const std::string expected = text_of(finished(whole));
        auto going = std::make_unique<machine::Run>(spec, 7);
        going->use_threads(2);
        for (int slice = 1; slice <= 11; ++slice) {
            going->advance(0.0111 * slice);
            Bytes bytes;
            going->save(bytes);
            going = std::make_unique<machine::Run>(spec, 7);
            going->restore(bytes);
        }
        EXPECT_EQ(text_of(finished(*going)), expected);
    }
}

TEST(MachineImpacts, RefuseBinsThatCannotBe) {
    const auto flaw = machine::find_probe("impact_energy_spectrum")->flaw;
    EXPECT_EQ(flaw(with("from", 1e-6, "to", 1e-3)), "");
    EXPECT_NE(flaw(with("from", 1e-3, "to", 1e-6)), "");
    EXPECT_NE(flaw(with("from", 1e-6, "to", 1e-3, "bins", 2.5)), "");
}

}  // namespace grainsweep::tests::machine_impacts_test
