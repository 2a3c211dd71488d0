// Clumps of spheres: closed forms of free bodies and impacts, conservation, restarts.
#include "solver/dem/engine.hpp"
#include "solver/dem/fast/mixed_engine.hpp"
#include "tests/support/clump_cases.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace grainsweep::tests::clumps_test {

using namespace geometry;

constexpr double density = clump_density;

dem::BodyState body_of(const dem::Engine& engine, std::size_t number = 0) {
    dem::State state;
    engine.state(state);
    return state.bodies.at(number);
}

/// Returns the turn about a unit axis by an angle, rad, right hand.
Quaternion turn_about(const Vec3& axis, double angle) {
    const double s = std::sin(angle / 2);
    return {std::cos(angle / 2), s * axis[0], s * axis[1], s * axis[2]};
}

double energy_of(const dem::BodyState& b) {
    return 0.5 * (b.mass * dot(b.velocity, b.velocity) + dot(b.angular_momentum, b.angular_velocity));
}

// The axis of a symmetric top goes round L at |L|/I_perp; L stays exactly, the energy to second order.
TEST(Clumps, ATopPrecesses) {
    double before = 0;
    for (const double step : {4e-5, 2e-5}) {
        dem::Setup setup = clump_room();
        setup.shapes = {clump_shape("dumbbell_1_5", density)};
        setup.time_step = step;
        add_body(setup, {.angular_velocity = {150, 80, 200}});
        const auto engine = dem::make_engine(setup, {});
        const dem::BodyState start = body_of(*engine);
        const double rate = norm(start.angular_momentum) / start.inertia[1];
        const Vec3 along = (1 / norm(start.angular_momentum)) * start.angular_momentum;
        const double time = 0.1;
        engine->run(std::llround(time / step));
        const dem::BodyState end = body_of(*engine);
        EXPECT_EQ(end.angular_momentum, start.angular_momentum);
        const Vec3 axis = dem::axes_of(start.orientation)[0], now = dem::axes_of(end.orientation)[0];
        const Vec3 across = axis - dot(axis, along) * along, side = cross(along, across);
        const double angle = rate * time;
        const Vec3 expected = dot(axis, along) * along + std::cos(angle) * across + std::sin(angle) * side;
        const double error = norm(now - expected);
        EXPECT_LT(error, 2e-4 * step / 2e-5);
        if (before > 0) {
            EXPECT_NEAR(before / error, 4, 0.4);
        }
        before = error;
    }
}

// An asymmetric top that spins about its middle axis turns over every 2 K(k)/w_p (Jacobi).
TEST(Clumps, AnAsymmetricTopTurnsOver) {
    dem::Setup setup = clump_room();
    setup.shapes = {clump_shape("asym3", density)};
    setup.time_step = 1e-5;
    const Vec3 inertia = setup.shapes[0].inertia;
    const double tip = 0.01, speed = 300;
    add_body(setup, {.angular_velocity = {tip * speed, speed, 0}});
    const auto engine = dem::make_engine(setup, {});
    const auto about_middle = [&] {
        const auto body = body_of(*engine);
        return dot(dem::axes_of(body.orientation)[1], body.angular_velocity);
    };
    std::vector<double> reversals;
    double last = about_middle();
    for (int k = 1; k <= 60000; ++k) {
        engine->run(1);
        const double now = about_middle();
        if ((now > 0) != (last > 0)) reversals.push_back((k - now / (now - last)) * setup.time_step);
        last = now;
    }
    ASSERT_GE(reversals.size(), 3U);
    // Energy and momentum of the start: L^2 between 2 E I_2 and 2 E I_3, or I_1 and I_2.
    const double w1 = tip * speed, w2 = speed;
    const double e2 = inertia[0] * w1 * w1 + inertia[1] * w2 * w2;
    const double l2 = std::pow(inertia[0] * w1, 2) + std::pow(inertia[1] * w2, 2);
    double a = inertia[0], c = inertia[2];
    const double b = inertia[1];
    if (l2 < e2 * b) std::swap(a, c);
    const double rate = std::sqrt((c - b) * (l2 - e2 * a) / (a * b * c));
    const double k2 = (b - a) * (e2 * c - l2) / ((c - b) * (l2 - e2 * a));
    double x = 1, y = std::sqrt(1 - k2);  // K by the arithmetic-geometric mean
    for (int k = 0; k < 40; ++k) {
        const double mean = (x + y) / 2;
        y = std::sqrt(x * y);
        x = mean;
    }
    const double half = 2 * (std::numbers::pi / (2 * x)) / std::abs(rate);
    for (std::size_t k = 1; k < reversals.size(); ++k) EXPECT_NEAR((reversals[k] - reversals[k - 1]) / half, 1, 1e-3);
}

struct Rebound {
    double vz = 0, wy = 0;
};

/// A dumbbell falls on a plane at 0.5 m/s, its axis at an angle above the plane.
Rebound rebound(double angle, double stiffness, double restitution, dem::DampingMass damping,
                const dem::Method& method = {}) {
    dem::Setup setup = clump_room();
    setup.material.youngs_modulus *= stiffness;
    setup.material.restitution = restitution;
    setup.material.friction = 0;
    setup.time_step = 2e-7 / std::pow(stiffness, 0.4);
    setup.shapes = {clump_shape("dumbbell_1_5", density, damping)};
    setup.walls.emplace_back(Plane{{0, 0, 0}, {0, 0, 1}});
    const double h = norm(setup.shapes[0].members[0].place), r = setup.shapes[0].members[0].radius;
    add_body(setup, {.position = {0, 0, h * std::sin(angle) + r + 1e-6},
                     .orientation = turn_about({0, 1, 0}, angle),
                     .velocity = {0, 0, -0.5}});
    const auto engine = dem::make_engine(setup, method);
    bool touched = false;
    std::vector<dem::ContactForce> contacts;
    for (int k = 0; k < 20000; ++k) {
        engine->run(20);
        engine->contacts(contacts);
        if (touched && contacts.empty()) break;
        touched = touched || !contacts.empty();
    }
    const auto body = body_of(*engine);
    return {body.velocity[2], body.angular_velocity[1]};
}

// Without friction and damping the impulse is 2 v/(1/m + x_c^2/I); softness errs as E^-0.4.
TEST(Clumps, ReboundAsRigidBodiesDo) {
    const auto shape = clump_shape("dumbbell_1_5", density);
    for (const double degrees : {30.0, 60.0}) {
        const double angle = degrees * std::numbers::pi / 180;
        const double arm = norm(shape.members[0].place) * std::cos(angle);
        const double impulse = 2 * 0.5 / (1 / shape.mass + arm * arm / shape.inertia[1]);
        double before = 0;
        for (const double stiffness : {1.0, 10.0, 100.0}) {
            const auto found = rebound(angle, stiffness, 1, dem::DampingMass::contact);
            const double error = std::abs(found.vz / (impulse / shape.mass - 0.5) - 1);
            EXPECT_LT(error, 2e-2 * std::pow(stiffness, -0.4));
            EXPECT_NEAR(std::abs(found.wy) / (impulse * arm / shape.inertia[1]), 1, 2e-2 * std::pow(stiffness, -0.4));
            if (before > 0) {
                EXPECT_NEAR(std::log10(before / error), 0.4, 0.06) << degrees;
            }
            before = error;
        }
    }
}

// Restitution is that of the contact point, at any angle, if the damping has the mass that an impact feels; with the
// mass of the body only where it goes through the centre.
TEST(Clumps, DampBySelectedMass) {
    const auto shape = clump_shape("dumbbell_1_5", density);
    const double h = norm(shape.members[0].place);
    const auto of_contact = [&](double degrees, dem::DampingMass damping, const dem::Method& method = {}) {
        const double angle = degrees * std::numbers::pi / 180;
        const auto found = rebound(angle, 100, 0.5, damping, method);
        // Velocity of the contact point along the normal, after divided by before.
        return (found.vz - std::abs(found.wy) * (degrees == 90 ? 0 : -1) * h * std::cos(angle)) / 0.5;
    };
    constexpr dem::Method single{.precision = dem::Method::Precision::mixed};
    for (const double degrees : {30.0, 60.0, 90.0})
        for (const dem::Method& method : {dem::Method{}, single})
            EXPECT_NEAR(of_contact(degrees, dem::DampingMass::contact, method), 0.5, 3e-3) << degrees;
    EXPECT_NEAR(of_contact(30, dem::DampingMass::body, single), of_contact(30, dem::DampingMass::body), 1e-4);
    EXPECT_NEAR(of_contact(30, dem::DampingMass::body), 0.454, 5e-3);
    EXPECT_NEAR(of_contact(60, dem::DampingMass::body), 0.482, 5e-3);
    EXPECT_NEAR(of_contact(90, dem::DampingMass::body), 0.5, 3e-3);
}

/// Clumps and single spheres, thrown together in a periodic box with a floor.
dem::Setup crowd(bool floor) {
    dem::Setup setup = clump_room();
    setup.domain = {{0, 0, floor ? 0 : -1.0}, {0.03, 0.03, floor ? 0.06 : 1.0}, {true, true, false}};
    setup.material.youngs_modulus = 5e6;
    setup.time_step = 1e-5;
    setup.gravity = floor ? Vec3{0, 0, -9.81} : Vec3{};
    setup.shapes = {clump_shape("dumbbell_1_5", density), clump_shape("tetra_1_5", density)};
    if (floor) setup.walls.emplace_back(Plane{{0, 0, 0}, {0, 0, 1}});
    std::size_t n = 0;
    for (int z = 0; z < 4; ++z)
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 4; ++x, ++n) {
                const double u = std::fmod(0.618 * static_cast<double>(n), 1),
                             v = std::fmod(0.755 * static_cast<double>(n), 1),
                             w = std::fmod(0.57 * static_cast<double>(n), 1);
                const Vec3 at = {0.00375 + 0.0075 * x, 0.00375 + 0.0075 * y, 0.004 + 0.0075 * z};
                const Vec3 velocity = {0.3 * (u - 0.5), 0.3 * (v - 0.5), 0.3 * (w - 0.5)};
                if (n % 3 == 2)
                    setup.spheres.push_back({.position = at, .velocity = velocity, .radius = 0.002});
                else
                    add_body(setup, {.shape = n % 3,
                                     .scale = 0.9 + 0.1 * u,
                                     .position = at,
                                     .orientation = orientation_at(u, v, w),
                                     .velocity = velocity,
                                     .angular_velocity = {20 * u, -10 * v, 15 * w}});
            }
    return setup;
}

constexpr dem::Method mixed{.precision = dem::Method::Precision::mixed};

void keep_momentum_and_lose_energy(const dem::Method& method, double rounding) {
    dem::Setup setup = crowd(false);
    setup.domain.periodic = {true, true, false};
    const auto engine = dem::make_engine(setup, method);
    const auto momentum_and_energy = [&] {
        dem::State state;
        engine->state(state);
        Vec3 p{};
        double e = 0;
        std::vector<char> member(setup.spheres.size(), 0);
        for (const auto& b : state.bodies) {
            p += b.mass * b.velocity;
            e += energy_of(b);
            for (std::uint32_t k = 0; k < b.members; ++k) member[static_cast<std::size_t>(b.first) + k] = 1;
        }
        for (std::size_t i = 0; i < state.id.size(); ++i) {
            if (member[static_cast<std::size_t>(state.id[i])] != 0) continue;
            const double m = dem::sphere_mass(state.radius[i], density);
            p += m * state.velocity[i];
            e += 0.5 * m * dot(state.velocity[i], state.velocity[i]);
        }
        return std::pair(p, e);
    };
    const auto [p0, e0] = momentum_and_energy();
    engine->run(20000);
    EXPECT_EQ(engine->fault(), "");
    const auto [p1, e1] = momentum_and_energy();
    EXPECT_LT(norm(p1 - p0), rounding * std::sqrt(e0));
    EXPECT_LT(e1, 0.8 * e0);
    EXPECT_GT(e1, 0);
}

TEST(Clumps, KeepMomentumAndLoseEnergy) {
    keep_momentum_and_lose_energy({}, 1e-12);
    keep_momentum_and_lose_energy(mixed, 1e-5);
}

// A case continues from a checkpoint with the same bits, and clumps leave as a whole.
void continue_from_a_checkpoint(const dem::Method& method) {
    dem::Setup setup = crowd(true);
    setup.material.friction = 0.4;
    const auto whole = dem::make_engine(setup, method), first = dem::make_engine(setup, method);
    whole->run(3000), first->run(1700);
    std::vector<std::byte> saved;
    first->save(saved);
    const auto second = dem::make_engine(setup, method);
    second->restore(saved);
    second->run(1300);
    dem::State a, b;
    const auto same = [&] {
        whole->state(a), second->state(b);
        ASSERT_EQ(a.id, b.id);
        EXPECT_EQ(a.position, b.position);
        EXPECT_EQ(a.velocity, b.velocity);
        ASSERT_EQ(a.bodies.size(), b.bodies.size());
        for (std::size_t k = 0; k < a.bodies.size(); ++k) EXPECT_EQ(a.bodies[k].orientation, b.bodies[k].orientation);
    };
    same();
    const std::int32_t member = a.bodies[3].first + 1;
    const std::size_t spheres = a.id.size(), bodies = a.bodies.size(), gone = a.bodies[3].members;
    for (auto* engine : {whole.get(), second.get()}) {
        engine->remove(std::vector<std::int32_t>{member});
        engine->run(500);
        EXPECT_EQ(engine->fault(), "");
    }
    same();
    EXPECT_EQ(a.id.size(), spheres - gone);
    EXPECT_EQ(a.bodies.size(), bodies - 1);
    for (std::size_t cut = 0; cut < saved.size(); cut += 997) {
        const auto broken = dem::make_engine(setup, method);
        EXPECT_THROW(broken->restore(std::span(saved).first(cut)), std::invalid_argument);
    }
}

TEST(Clumps, ContinueFromACheckpoint) {
    continue_from_a_checkpoint({});
    continue_from_a_checkpoint(mixed);
}

// Threads change no bit: of 64 particles each thread has a few.
TEST(Clumps, HaveTheSameBitsOnManyThreads) {
    dem::Setup setup = crowd(true);
    setup.material.friction = 0.4;
    const auto one = dem::make_engine(setup, mixed);
    one->run(2500);
    dem::State a, b;
    one->state(a);
    for (const int threads : {2, 3}) {
        const auto engine =
            dem::fast::make_mixed_engine(setup, dem::Method::Path::best, 0, 0, {.most = threads, .least_particles = 1});
        engine->run(1000);
        engine->run(1500);
        engine->state(b);
        EXPECT_EQ(engine->fault(), "");
        EXPECT_EQ(a.position, b.position) << threads;
        EXPECT_EQ(a.velocity, b.velocity) << threads;
        for (std::size_t k = 0; k < a.bodies.size(); ++k) EXPECT_EQ(a.bodies[k].orientation, b.bodies[k].orientation);
    }
}

// Both precisions compute the same bed, by every law.
TEST(Clumps, SettleAlikeInBothPrecisions) {
    const auto settle = [](const char* law, auto&& change) {
        dem::Setup setup = crowd(true);
        setup.material.friction = 0.4;
        setup.material.restitution = 0.3;
        change(setup.material);
        std::array<double, 2> height{}, energy{};
        for (const std::size_t k : {0U, 1U}) {
            const auto engine = dem::make_engine(setup, k == 0 ? dem::Method{} : mixed);
            engine->run(40000);
            EXPECT_EQ(engine->fault(), "") << law;
            dem::State state;
            engine->state(state);
            ASSERT_EQ(state.bodies.size(), setup.bodies.size()) << law;
            double weight = 0;
            std::size_t members = 0;
            for (const auto& body : state.bodies) {
                height[k] += body.position[2] / static_cast<double>(state.bodies.size());
                energy[k] += energy_of(body);
                weight += 9.81 * body.mass;
                members += body.members;
            }
            weight += 9.81 * static_cast<double>(state.id.size() - members) * dem::sphere_mass(0.002, density);
            EXPECT_NEAR(-engine->wall_load(0, {}).force[2] / weight, 1, 0.02) << law;
        }
        EXPECT_NEAR(height[1] / height[0], 1, 0.08) << law;
        EXPECT_LT(energy[0], 1e-5) << law;
        EXPECT_LT(energy[1], 1e-5) << law;
    };
    settle("hertz", [](dem::Material&) {});
    settle("linear", [](dem::Material& m) {
        m.normal_law = dem::NormalLaw::linear;
        m.stiffness = 2000;
    });
    settle("jkr", [](dem::Material& m) {
        m.cohesion_law = dem::CohesionLaw::jkr;
        m.surface_energy = 0.05;
    });
    settle("capillary", [](dem::Material& m) {
        m.cohesion_law = dem::CohesionLaw::capillary;
        m.surface_tension = 0.07;
    });
    settle("sjkr", [](dem::Material& m) { m.cohesion = 1000; });
}

void add_while_it_runs(const dem::Method& method) {
    dem::Setup setup = crowd(true);
    for (const auto& shape : setup.shapes)
        setup.to_come.push_back({shape.members[0].radius * 0.9, shape.members[0].radius, 0});
    const auto engine = dem::make_engine(setup, method);
    engine->run(500);
    const auto& shape = setup.shapes[0];
    const dem::Body body{.shape = 0, .position = {0.0299, 0.015, 0.05}, .velocity = {0, 0, -1}};
    engine->add(dem::members_of(shape, body), std::span(&body, 1));
    engine->run(3000);
    EXPECT_EQ(engine->fault(), "");
    dem::State state;
    engine->state(state);
    EXPECT_EQ(state.bodies.size(), setup.bodies.size() + 1);
    EXPECT_EQ(state.bodies.back().first, static_cast<std::int32_t>(setup.spheres.size()));
    EXPECT_LT(state.bodies.back().position[2], 0.05);
    dem::Body beyond = body;
    beyond.shape = 7;
    EXPECT_THROW(engine->add(dem::members_of(shape, body), std::span(&beyond, 1)), std::invalid_argument);
}

TEST(Clumps, AreAddedWhileACaseRuns) {
    add_while_it_runs({});
    add_while_it_runs(mixed);
}

TEST(Clumps, ImpossibleOnesGetASentence) {
    const auto refused = [](auto&& change) {
        dem::Setup setup = crowd(true);
        change(setup);
        EXPECT_THROW((void)dem::make_engine(setup, {}), std::invalid_argument);
    };
    refused([](dem::Setup& s) { s.material.rolling_friction = 0.1; });
    refused([](dem::Setup& s) { s.bodies[0].shape = 9; });
    refused([](dem::Setup& s) { s.bodies[1].first = s.bodies[0].first; });
    refused([](dem::Setup& s) { s.bodies[0].scale = -1; });
    refused([](dem::Setup& s) { s.bodies[0].orientation = {0, 0, 0, 0}; });
    refused([](dem::Setup& s) { s.spheres[s.bodies[0].first].radius *= 2; });
    refused([](dem::Setup& s) { s.spheres[s.bodies[0].first].mobile = false; });
    refused([](dem::Setup& s) { s.shapes[0].inertia = {1, 1, 3}; });
    refused([](dem::Setup& s) { s.shapes[0].mass = 0; });
    refused([](dem::Setup& s) { s.domain.high[0] = 0.012; });
}

}  // namespace grainsweep::tests::clumps_test
