// Both engines under stress: every outcome is either sound (finite, energy bounded by what was put in, overlaps
// within the law's range) or a fault that says what, where and when. Never a silent wrong answer, never a hang: every
// run has a fixed number of steps.
#include "solver/dem/engine.hpp"
#include "solver/dem/limits.hpp"
#include "solver/dem/material.hpp"
#include "solver/dem/time_step.hpp"
#include "solver/particles/packing.hpp"
#include "tests/support/blade.hpp"
#include "tests/support/spheres.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

namespace grainsweep::tests::dem_stress_test {

using dem::Method;

enum class Expected { sound, fault, either };

struct Stress {
    std::string name;
    dem::Setup setup;
    std::int64_t steps = 0;
    Expected expected = Expected::either;
    double stored = 0;        ///< J, elastic energy of the contacts at the start, an upper bound
    std::string reason = {};  ///< a word the fault must contain
};

double potential_range(const dem::Setup& setup) {
    double energy = 0;
    for (const auto& s : setup.spheres)
        for (std::size_t k = 0; k < 3; ++k)
            energy += tests::mass(setup, s.radius) * std::abs(setup.gravity[k]) *
                      (setup.domain.high[k] - setup.domain.low[k]);
    return energy;
}

/// Work cohesion can do on the way from touching to the deepest sound overlap, every particle with twelve neighbours.
double cohesive_energy(const dem::Setup& setup) {
    double energy = 0;
    for (const auto& s : setup.spheres) {
        const double depth = dem::largest_sound_overlap * 2 * s.radius;
        energy += 6 * setup.material.cohesion * 2 * std::numbers::pi * s.radius * depth * depth;
    }
    return energy;
}

class DemStress : public testing::TestWithParam<Method::Precision> {
protected:
    void judge(const Stress& stress) const {
        SCOPED_TRACE(stress.name);
        Method method;
        method.precision = GetParam();
        const auto engine = dem::make_engine(stress.setup, method);
        const double start = tests::kinetic_energy(stress.setup, state_of(*engine));
        engine->run(stress.steps);
        const auto state = state_of(*engine);
        EXPECT_TRUE(tests::finite(state)) << engine->fault();
        if (engine->fault().empty()) {
            EXPECT_NE(stress.expected, Expected::fault);
            const double given = start + stress.stored + potential_range(stress.setup) + cohesive_energy(stress.setup);
            EXPECT_LE(tests::kinetic_energy(stress.setup, state), 1.2 * given);
            EXPECT_LE(engine->largest_overlap(), dem::largest_sound_overlap);
            EXPECT_EQ(engine->work().steps, stress.steps);
        } else {
            EXPECT_NE(stress.expected, Expected::sound) << engine->fault();
            EXPECT_NE(engine->fault().find(" at ("), std::string::npos) << engine->fault();
            EXPECT_NE(engine->fault().find(" steps, "), std::string::npos) << engine->fault();
            EXPECT_NE(engine->fault().find(stress.reason), std::string::npos) << engine->fault();
        }
        std::printf("%-44s %s\n", stress.name.c_str(),
                    engine->fault().empty() ? "sound" : ("unstable: " + engine->fault()).c_str());
    }
};

double limit_of(const dem::Setup& setup, double radius, double speed) {
    return std::min(dem::rayleigh_time(setup.material, radius), dem::hertz_contact_time(setup.material, radius, speed));
}

std::string with(const char* what, double value) {
    char text[80];
    std::snprintf(text, sizeof text, "%s %g", what, value);
    return text;
}

/// A random close packing, scaled to spheres of 2 mm, in a periodic box with a floor it rests on.
dem::Setup packed(double fraction) {
    constexpr double edge = 6, d = 2e-3;
    const auto packing = particles::random_close_packing({edge, fraction, 3, 2e-5});
    dem::Setup setup = tests::empty_space();
    setup.domain = {{0, 0, 0}, {edge * d, edge * d, edge * d}, {true, true, true}};
    for (const auto& x : packing.positions)
        setup.spheres.push_back({{x[0] * d, x[1] * d, x[2] * d}, {}, {}, d / 2, true});
    setup.time_step = 0.2 * limit_of(setup, d / 2, 0.5);
    return setup;
}

TEST_P(DemStress, TimeStepsFromHalfToTenTimesTheLimit) {
    for (const double share : {0.1, 0.2, 0.5, 1.0, 1.5, 2.0, 3.0, 10.0}) {
        auto setup = tests::boxed_gas(125, 0.3, 1, 2);
        setup.gravity = {0, 0, -9.81};
        setup.time_step = share * limit_of(setup, 1e-3, 1.0);
        judge({with("time step over the limit", share), setup, static_cast<std::int64_t>(0.05 / setup.time_step),
               share <= 0.2   ? Expected::sound
               : share >= 3.0 ? Expected::fault
                              : Expected::either});
    }
}

TEST_P(DemStress, StiffnessOverSixDecades) {
    for (const double modulus : {1e5, 1e6, 1e7, 1e9, 1e11}) {
        auto setup = tests::boxed_gas(64, 0.3, 1, 4);
        setup.gravity = {0, 0, -9.81};
        setup.material.youngs_modulus = modulus;
        setup.time_step = 0.2 * limit_of(setup, 1e-3, 1.0);
        const auto steps = static_cast<std::int64_t>(std::min(2e4, 0.1 / setup.time_step));
        judge({with("Young's modulus", modulus), setup, steps, Expected::sound});
    }
}

TEST_P(DemStress, RestitutionHoldsAtEveryStiffness) {
    for (const double modulus : {1e6, 1e7, 1e9, 1e11}) {
        auto setup = tests::empty_space();
        setup.material.youngs_modulus = modulus;
        setup.time_step = 0.01 * limit_of(setup, 1e-3, 0.2);
        setup.spheres = {{{0, 0, 0}, {0.1, 0, 0}, {}, 1e-3, true}, {{2.00001e-3, 0, 0}, {-0.1, 0, 0}, {}, 1e-3, true}};
        Method method;
        method.precision = GetParam();
        const auto engine = dem::make_engine(setup, method);
        engine->run(
            static_cast<std::int64_t>(3 * dem::hertz_contact_time(setup.material, 1e-3, 0.2) / setup.time_step));
        ASSERT_EQ(engine->fault(), "");
        const auto state = state_of(*engine);
        // Unclipped, the law's restitution is e but for the end of the contact, where it ends at zero overlap: 1 %.
        EXPECT_NEAR((state.velocity[1][0] - state.velocity[0][0]) / 0.2, setup.material.restitution, 0.01) << modulus;
    }
}

TEST_P(DemStress, ImpactsAtAHundredMetresPerSecond) {
    for (const double speed : {10.0, 100.0})
        for (const double share : {0.05, 0.2, 1.0}) {
            auto setup = tests::boxed_gas(64, speed, 1, 5);
            setup.material.youngs_modulus = 1e9;
            setup.time_step = share * limit_of(setup, 1e-3, 2 * speed);
            judge({with("speed", speed) + with(", time step over the limit", share), setup, 3000,
                   speed < 50 && share <= 0.2 ? Expected::sound : Expected::either});
        }
}

TEST_P(DemStress, DiametersOneToTwenty) {
    auto setup = tests::boxed_gas(216, 0.3, 20, 6);
    setup.gravity = {0, 0, -9.81};
    setup.time_step = 0.2 * limit_of(setup, 1e-3 / 20, 2.0);
    judge({"diameters 1:20", setup, 20000, Expected::sound});
}

TEST_P(DemStress, CohesionFarBeyondTheEquilibrium) {
    for (const double cohesion : {1e3, 1e5, 1e6, 1e7, 1e9})
        for (const auto area : {dem::CohesionLaw::sjkr, dem::CohesionLaw::sjkr2, dem::CohesionLaw::paper}) {
            auto setup = tests::boxed_gas(64, 0.3, 1, 7);
            setup.gravity = {0, 0, -9.81};
            setup.material.cohesion = cohesion;
            setup.material.cohesion_law = area;
            setup.time_step = 0.2 * limit_of(setup, 1e-3, 1.0);
            judge({with("cohesion", cohesion) + with(", area", static_cast<int>(area)), setup, 4000,
                   cohesion <= 1e5   ? Expected::sound
                   : cohesion >= 1e9 ? Expected::fault
                                     : Expected::either});
        }
}

TEST_P(DemStress, OverlappingInsertion) {
    for (const double distance : {0.0, 1e-9, 5e-4, 1.3e-3, 1.5e-3, 1.9e-3, 1.99999e-3}) {
        auto setup = tests::empty_space();
        setup.spheres = {{{0, 0, 0}, {}, {}, 1e-3, true}, {{distance, 0, 0}, {}, {}, 1e-3, true}};
        const double overlap = 2e-3 - distance;
        const double stored =
            8.0 / 15 * dem::effective_modulus(setup.material) * std::sqrt(5e-4) * std::pow(overlap, 2.5);
        const bool deep = overlap / 2e-3 > dem::largest_sound_overlap;
        judge({with("distance over the diameter", distance / 2e-3), setup, 2000,
               deep ? Expected::fault : Expected::sound, stored, "overlap"});
    }
}

TEST_P(DemStress, NobodyOneAndTwo) {
    for (std::size_t n = 0; n <= 2; ++n)
        for (const double friction : {0.0, 0.2}) {
            auto setup = tests::boxed_gas(n, 0.1, 1, 3);
            setup.domain = {{-0.01, -0.01, -0.01}, {0.01, 0.01, 0.01}, {false, true, false}};
            setup.walls = {dem::Plane{{0, 0, 0}, {0, 0, 1}}};
            setup.gravity = {0, 0, -9.81};
            setup.material.friction = friction;
            judge({with("particles", static_cast<double>(n)), setup, 3000, Expected::sound});
        }
}

TEST_P(DemStress, AtWallsEdgesAndFaces) {
    const Blade blade{0, 5e-3, 4e-3, 0.02, 0, 0, 0, 0};
    const double r = 1e-3;
    const std::vector<std::pair<const char*, dem::Vec3>> places = {
        {"just touching the plane", {0.01, 0, r}},
        {"just touching the blade's face", {r, 0, 0.01}},
        {"just touching the blade's edge", {r * std::sqrt(0.5), 0, 4e-3 - r * std::sqrt(0.5)}},
        {"under the blade's middle, touching", {-2.5e-3, 0, 4e-3 - r}},
        {"centre on the blade's edge", {0, 0, 4e-3}},
        {"centre inside the blade", {-2.5e-3, 0, 0.01}},
        {"centre on the periodic face", {0.01, -0.01, 0.01}},
        {"centre on the other periodic face", {0.01, 0.01, 0.01}},
        {"centre on an open face", {0.02, 0, 0.01}},
        {"wedged between plane and blade", {-2.5e-3, 0, 1e-3}},
    };
    for (const auto& [name, place] : places) {
        auto setup = tests::empty_space();
        setup.domain = {{-0.02, -0.01, -0.005}, {0.02, 0.01, 0.03}, {false, true, false}};
        setup.gravity = {0, 0, -9.81};
        setup.walls = {dem::Plane{{0, 0, 0}, {0, 0, 1}}, blade};
        setup.spheres = {{place, {0.1, 0.2, 0}, {50, 20, 10}, r, true}};
        const bool inside = std::string(name).find("centre on the blade") != std::string::npos ||
                            std::string(name).find("inside") != std::string::npos;
        judge({name, setup, 5000, inside ? Expected::fault : Expected::sound, 0, "wall 1"});
    }
}

TEST_P(DemStress, ABoxFullTo64Percent) {
    auto setup = packed(0.62);
    constexpr double touching = 1e-10;  // J: overlaps of up to 2e-5 diameters are left in the packing
    judge({"packed to 0.62, no gravity", setup, 3000, Expected::sound, touching});
    setup.material.cohesion = 5e4;
    judge({"packed to 0.62, cohesive", setup, 3000, Expected::sound, touching});
    setup.material.cohesion = 0;
    for (auto& s : setup.spheres) s.radius *= 1.011;  // 0.64
    judge({"packed to 0.64 under compression", setup, 3000, Expected::sound, 1e-3});
    for (auto& s : setup.spheres) s.velocity = {s.position[1] > 6e-3 ? 10.0 : -10.0, 0, 0};
    judge({"packed to 0.64 sheared at 20 m/s", setup, 3000, Expected::either, 1e-3});
}

INSTANTIATE_TEST_SUITE_P(Precision, DemStress,
                         testing::Values(Method::Precision::double_precision, Method::Precision::mixed),
                         [](const auto& method) {
                             return method.param == Method::Precision::mixed ? std::string("mixed")
                                                                             : std::string("double");
                         });

}  // namespace grainsweep::tests::dem_stress_test
