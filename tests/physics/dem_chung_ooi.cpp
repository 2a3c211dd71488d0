// Of the eight benchmark impacts of Chung & Ooi (2011), Granular Matter 13, 643, those whose force is compared, against
// closed forms, in both engines. The others are machine files: PeerSuites.
//
// Materials and speeds are like theirs. The contact of a step is resolved into 2000; what the formulas of a hard sphere
// leave out is of the order of d/R (up to 8e-3 here): the arm R - d/2 of the law and the turn of the normal; a duration
// is known to a step.
// Each test prints its worst error beside its tolerance: the table of solver/dem/README.md.
#include "solver/dem/engine.hpp"
#include "solver/dem/material.hpp"
#include "solver/geometry/vector.hpp"
#include "tests/support/spheres.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

namespace grainsweep::tests::dem_chung_ooi_test {

using dem::Method;
using dem::Vec3;
using Precision = dem::Method::Precision;
using geometry::operator+;

constexpr double steps_per_contact = 2000;

/// The bodies that meet: a second radius, or a plane.
struct Impact {
    dem::Material material;
    double radius = 0;
    double second_radius = 0;  ///< 0: the plane z = 0 with normal z
    double approach = 0;       ///< relative normal speed
    Vec3 velocity{};           ///< of the first besides the approach, along x

    [[nodiscard]] double mass() const { return dem::sphere_mass(radius, material.density); }
    [[nodiscard]] double second_mass() const { return dem::sphere_mass(second_radius, material.density); }
    [[nodiscard]] double reduced_mass() const {
        return second_radius > 0 ? 1 / (1 / mass() + 1 / second_mass()) : mass();
    }
    [[nodiscard]] double effective_radius() const {
        return second_radius > 0 ? 1 / (1 / radius + 1 / second_radius) : radius;
    }
    /// Hertz: duration and depth of an elastic impact.
    [[nodiscard]] double duration() const {
        const double modulus = dem::effective_modulus(material);
        return 2.8683 *
               std::pow(reduced_mass() * reduced_mass() / (effective_radius() * modulus * modulus * approach), 0.2);
    }
    [[nodiscard]] double depth() const {
        return std::pow(15 * reduced_mass() * approach * approach /
                            (16 * std::sqrt(effective_radius()) * dem::effective_modulus(material)),
                        0.4);
    }
    [[nodiscard]] double peak_force() const {
        return 4.0 / 3 * dem::effective_modulus(material) * std::sqrt(effective_radius()) * std::pow(depth(), 1.5);
    }
};

struct Outcome {
    dem::State state;
    double duration = 0, peak_force = 0;
};

/// The first sphere above, the second below or the plane; until they have parted.
Outcome collide(const Impact& impact, Precision precision) {
    const double largest = std::max(impact.radius, impact.second_radius);
    dem::Setup s;
    s.domain = {{-20 * largest, -20 * largest, -20 * largest}, {20 * largest, 20 * largest, 20 * largest}, {}};
    s.material = impact.material;
    s.gravity = {};
    s.time_step = impact.duration() / steps_per_contact;
    const double gap = 0.3 * impact.approach * s.time_step;
    if (impact.second_radius > 0) {
        // The centre of mass rests.
        const double share = impact.second_mass() / (impact.mass() + impact.second_mass());
        s.spheres = {{{0, 0, impact.radius + gap / 2},
                      impact.velocity + Vec3{0, 0, -impact.approach * share},
                      {},
                      impact.radius,
                      true},
                     {{0, 0, -impact.second_radius - gap / 2},
                      {0, 0, impact.approach * (1 - share)},
                      {},
                      impact.second_radius,
                      true}};
    } else {
        s.walls = {dem::Plane{}};
        s.spheres = {
            {{0, 0, impact.radius + gap}, impact.velocity + Vec3{0, 0, -impact.approach}, {}, impact.radius, true}};
    }
    Method method;
    method.precision = precision;
    const auto engine = dem::make_engine(s, method);
    Outcome out;
    std::vector<dem::ContactForce> contacts;
    for (int k = 0; k < 4 * steps_per_contact; ++k) {
        engine->run(1);
        engine->contacts(contacts);
        if (contacts.empty() && out.duration > 0) break;
        if (contacts.empty()) continue;
        out.duration += s.time_step;
        out.peak_force = std::max(out.peak_force, contacts[0].normal_force);
    }
    EXPECT_EQ(engine->fault(), "");
    out.state = tests::state_of(*engine);
    return out;
}

dem::Material material(double modulus, double ratio, double density, double restitution, double friction) {
    dem::Material m;
    m.youngs_modulus = modulus;
    m.poisson_ratio = ratio;
    m.density = density;
    m.restitution = restitution;
    m.friction = friction;
    return m;
}

/// Worst errors of one test in one engine.
class Score {
public:
    Score(std::string test, std::string what, Precision precision, double tolerance)
        : row_("| " + test + " | " + what + " | " + (precision == Precision::mixed ? "mixed" : "double")),
          tolerance_(tolerance) {}
    Score(const Score&) = delete;
    Score& operator=(const Score&) = delete;
    ~Score() {
        EXPECT_LT(worst_, tolerance_) << row_;
        EXPECT_GT(compared_, 0) << row_;
        std::printf("%s | %.1e | %.0e |\n", row_.c_str(), worst_, tolerance_);
    }
    void add(double measured, double expected, double scale) {
        worst_ = std::max(worst_, std::abs(measured - expected) / std::abs(scale));
        ++compared_;
    }
    void add(double measured, double expected) { add(measured, expected, expected); }

private:
    std::string row_;
    double tolerance_, worst_ = 0;
    int compared_ = 0;
};

class DemChungOoi : public testing::TestWithParam<Precision> {};

TEST_P(DemChungOoi, ElasticNormalImpactOfTwoSpheres) {
    Score time("1 two spheres, elastic", "duration, peak force", GetParam(), 6e-4);
    for (const double v : {2.0, 20.0}) {
        const Impact impact{material(4.8e10, 0.2, 2800, 1, 0.35), 0.01, 0.01, v, {}};
        const auto out = collide(impact, GetParam());
        time.add(out.duration, impact.duration());
        time.add(out.peak_force, impact.peak_force());
        time.add(out.state.velocity[0][2], v / 2);
    }
}

TEST_P(DemChungOoi, ElasticNormalImpactOnAPlane) {
    Score score("2 sphere on plane, elastic", "duration, peak force, rebound", GetParam(), 6e-4);
    for (const double v : {0.2, 2.0}) {
        const Impact impact{material(7e10, 0.3, 2699, 1, 0), 0.1, 0, v, {}};
        const auto out = collide(impact, GetParam());
        score.add(out.duration, impact.duration());
        score.add(out.peak_force, impact.peak_force());
        score.add(out.state.velocity[0][2], v);
    }
}

// Without sliding the slip u swings on the tangential spring: u' = s'', s'' = -7/2 (8 G* sqrt(R d)/m) s, and the sphere
// leaves with v_t' = v_t - 2/7 (u_0 - u_1). The oscillation is integrated here by itself.
TEST_P(DemChungOoi, StickingImpactsReboundByTheTangentialSpring) {
    Score score("4 oblique, sticking", "v_t', spin by the spring's oscillation", GetParam(), 4e-3);
    for (const double vt : {0.2, 1.0}) {
        const Impact impact{material(3.8e11, 0.23, 4000, 1, 50), 2.5e-3, 0, 3.9, {vt, 0, 0}};
        const auto state = collide(impact, GetParam()).state;
        const double normal =
            4.0 / 3 * dem::effective_modulus(impact.material) * std::sqrt(impact.radius) / impact.mass();
        const double tangential =
            3.5 * 8 * dem::effective_shear_modulus(impact.material) * std::sqrt(impact.radius) / impact.mass();
        double d = 0, rate = impact.approach, s = 0, u = vt;
        const double h = impact.duration() / 200000;
        while (d >= 0) {  // leapfrog
            d += h / 2 * rate;
            s += h / 2 * u;
            if (d < 0) break;
            rate -= h * normal * std::pow(d, 1.5);
            u -= h * tangential * std::sqrt(d) * s;
            d += h / 2 * rate;
            s += h / 2 * u;
        }
        const double change = 2.0 / 7 * (vt - u);
        score.add(vt - state.velocity[0][0], change, vt);
        score.add(state.angular_velocity[0][1] * impact.radius, 2.5 * change, vt);
    }
}

INSTANTIATE_TEST_SUITE_P(Engines, DemChungOoi, testing::Values(Precision::double_precision, Precision::mixed),
                         [](const auto& engine) {
                             return engine.param == Precision::mixed ? std::string("Mixed") : std::string("Double");
                         });

}  // namespace grainsweep::tests::dem_chung_ooi_test
