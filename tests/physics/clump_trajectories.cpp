// Clumps of spheres against LIGGGHTS 3.8, step by step: the same formulas, the same order of operations and the same
// time step must give the same numbers up to rounding.
#include "solver/dem/engine.hpp"
#include "tests/support/clump_cases.hpp"
#include "tests/support/reference.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace grainsweep::tests::clump_trajectories_test {

using namespace geometry;
using nlohmann::json;

/// Largest differences over all rows: positions divided by the diameter of the bounding sphere, velocities and R w by
/// the largest speed, the angle in rad.
struct ClumpDeviation {
    double position = 0, velocity = 0, spin = 0, angle = 0;
    [[nodiscard]] double worst() const { return std::max({position, velocity, spin, angle}); }
};

Vec3 in_row(const Table& table, std::size_t row, const std::string& of) {
    return {table.at(of + "x", row), table.at(of + "y", row), table.at(of + "z", row)};
}

ClumpDeviation clump_deviation(const std::string& name, const json& c, const Vec3& moved = {},
                               const std::array<bool, 3>& periodic = {}, const dem::Method& method = {}) {
    const auto table = tests::read_table(tests::reference("clumps/trajectories/" + name + ".csv"));
    ClumpCase made = clump_case(c);
    auto& setup = made.setup;
    const std::size_t bodies = setup.bodies.size();
    double fastest = 0;
    for (std::size_t r = 0; r < table.rows; ++r) {
        const double reach = made.reach[r % bodies];
        fastest = std::max({fastest, norm(in_row(table, r, "v")), reach * norm(in_row(table, r, "w"))});
    }
    // From row 0: inserted centres differ from the case by up to 2e-11 m.
    for (std::size_t b = 0; b < bodies; ++b) {
        dem::Body& body = setup.bodies[b];
        const Quaternion q{table.at("qw", b), table.at("qx", b), table.at("qy", b), table.at("qz", b)};
        body.position = Vec3{table.at("x", b), table.at("y", b), table.at("z", b)} + moved;
        body.velocity = in_row(table, b, "v");
        body.angular_velocity = in_row(table, b, "w");
        body.orientation = normalised(product(q, made.turns[b]));
        const auto members = dem::members_of(setup.shapes[body.shape], body, setup.spheres[body.first].kind);
        std::ranges::copy(members, setup.spheres.begin() + static_cast<std::ptrdiff_t>(body.first));
    }
    setup.domain.periodic = periodic;
    const auto engine = dem::make_engine(setup, method);
    ClumpDeviation d;
    dem::State state;
    const Domain& domain = setup.domain;
    for (std::size_t r = 0; r < table.rows; ++r) {
        engine->run(static_cast<std::int64_t>(table.at("step", r)) - engine->work().steps);
        EXPECT_EQ(engine->fault(), "") << name;
        engine->state(state);
        const auto b = static_cast<std::size_t>(table.at("body", r)) - 1;
        const dem::BodyState& body = state.bodies.at(b);
        const double reach = made.reach[b];
        const Vec3 x = Vec3{table.at("x", r), table.at("y", r), table.at("z", r)} + moved;
        d.position = std::max(d.position, norm(domain.separation(body.position, x)) / (2 * reach));
        d.velocity = std::max(d.velocity, norm(body.velocity - in_row(table, r, "v")) / fastest);
        d.spin = std::max(d.spin, reach * norm(body.angular_velocity - in_row(table, r, "w")) / fastest);
        const Quaternion theirs{table.at("qw", r), table.at("qx", r), table.at("qy", r), table.at("qz", r)};
        const Quaternion ours = product(body.orientation, conjugate(made.turns[b]));
        const Quaternion between = product(conjugate(normalised(theirs)), ours);
        d.angle = std::max(d.angle, 2 * norm(Vec3{between[1], between[2], between[3]}));
    }
    return d;
}

double clump_tolerance(const std::string& name) {
    const bool impact = name.starts_with("fall") || name == "collide" || name == "free_dumbbell";
    return impact ? 1e-11 : 1e-8;
}

void expect_within(double tolerance, const ClumpDeviation& d, const std::string& name) {
    EXPECT_LT(d.position, tolerance) << name;
    EXPECT_LT(d.velocity, tolerance) << name;
    EXPECT_LT(d.spin, tolerance) << name;
    EXPECT_LT(d.angle, tolerance) << name;
    std::ostringstream worst;
    worst << d.worst();
    testing::Test::RecordProperty(name, worst.str());
}

TEST(ClumpTrajectories, EqualLiggghts) {
    const json all = clump_cases();
    int seen = 0;
    for (const auto& [name, c] : all.items()) {
        const auto d = clump_deviation(name, c);
        const double tolerance = clump_tolerance(name);
        expect_within(tolerance, d, name);
        ++seen;
    }
    EXPECT_EQ(seen, 14);
}

// The mixed engine: to single precision where contacts are few, and as impacts in a row amplify it.
TEST(ClumpTrajectories, EqualLiggghtsInMixedPrecision) {
    const json all = clump_cases();
    const dem::Method mixed{.precision = dem::Method::Precision::mixed};
    for (const auto& [name, c] : all.items()) {
        const auto d = clump_deviation(name, c, {}, {}, mixed);
        const double tolerance = clump_tolerance(name) < 1e-10 ? 1e-5 : 1e-3;
        expect_within(tolerance, d, name);
    }
    for (const std::string name : {"collide", "fall_damped_30"})
        EXPECT_LT(clump_deviation(name, all[name], {0.0305, 0.0295, 0}, {true, true, false}, mixed).worst(), 1e-5);
}

// Across a periodic side the same.
TEST(ClumpTrajectories, CrossPeriodicSides) {
    const json all = clump_cases();
    for (const std::string name : {"collide", "fall_damped_30"}) {
        const auto d = clump_deviation(name, all[name], {0.0305, 0.0295, 0}, {true, true, false});
        EXPECT_LT(d.worst(), 1e-11) << name;
    }
}

}  // namespace grainsweep::tests::clump_trajectories_test
