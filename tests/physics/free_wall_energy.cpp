// Energy of walls that the powder moves: every joule booked, to rounding, in closed balances of wall and powder.
//
// Wall:    kinetic = start + work of contacts + own work + bounds + turning, at any step.
// Powder:  its kinetic energy at half steps changes by gravity, by the work of all walls, and by what contacts take.
// Both:    what contacts take from powder and wall is stored or dissipated. Without damping and friction it is stored,
//          but for the error of the time step, which is of second order.
#include "solver/dem/engine.hpp"
#include "solver/dem/material.hpp"
#include "solver/geometry/solid.hpp"
#include "solver/machine/shapes.hpp"
#include "sweep/campaign/installed_machines.hpp"
#include "tests/support/machines.hpp"
#include "tests/support/places.hpp"
#include "tests/support/spheres.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>
#include <vector>

namespace grainsweep::tests::free_wall_energy_test {

using dem::Vec3;
using namespace geometry;

using Precision = dem::Method::Precision;
constexpr std::array both = {Precision::double_precision, Precision::mixed};

/// Residual of the balance of a wall.
double residual(const dem::Engine& engine, std::size_t wall) {
    return kinetic_energy(engine.wall(wall).motions) - engine.wall_energy(wall).sum();
}

/// What was turned over so far: the scale of rounding.
double turned_over(const BodyEnergy& energy) {
    return std::abs(energy.start) + std::abs(energy.contacts) + std::abs(energy.own) + std::abs(energy.bounds);
}

/// Books the contacts of a calculation step by step.
class Ledger {
public:
    Ledger(const dem::Setup& setup, dem::Engine& engine) : setup_(setup), engine_(engine) {
        step();
        start_ = kinetic_;
        taken_before_ -= taken_;
        height_ = taken_ = 0;
        works_at_start_ = works();
        loss_at_start_ = loss();
        stored_at_start_ = stored_;
    }

    void step() {
        taken_before_ = taken_;
        bodies_before_ = works_of_bodies();
        engine_.run(1);
        engine_.step_contacts(contacts_);
        const dem::State state = state_of(engine_);
        const std::size_t n = state.id.size();
        std::vector<Vec3> force(n), torque(n);
        stored_ = 0;
        for (const auto& c : contacts_) {
            taken_ += setup_.time_step * (c.normal_power + c.tangential_power);
            stored_ += c.stored;
            const Vec3 f = c.normal_force * c.normal + c.tangential_force;
            const auto act = [&](std::int32_t id, double sign) {
                const auto i = static_cast<std::size_t>(id);
                force[i] += sign * f;
                torque[i] += (state.radius[i] - c.overlap / 2) * cross(c.tangential_force, c.normal);
                torque[i] += sign * c.rolling_moment;
            };
            act(c.first, 1);
            if (c.second >= 0) act(c.second, -1);
        }
        double kinetic = 0;
        for (std::size_t i = 0; i < n; ++i) {
            const double m = mass(setup_, state.radius[i]), inertia = 0.4 * m * state.radius[i] * state.radius[i];
            const double half = setup_.time_step / 2;
            const Vec3 v = state.velocity[i] + half * ((1 / m) * force[i] + setup_.gravity);
            const Vec3 w = state.angular_velocity[i] + (half / inertia) * torque[i];
            kinetic += m / 2 * dot(v, v) + inertia / 2 * dot(w, w);
            height_ += setup_.time_step * m * dot(setup_.gravity, state.velocity[i]);
        }
        kinetic_ = kinetic;  // half a step from now
    }

    /// Of the powder.
    [[nodiscard]] double residual_of_powder() const {
        return kinetic_ - start_ - height_ + taken_ - (works() - works_at_start_);
    }
    /// What contacts have taken from powder and free walls together, at the full step of double precision: of the last
    /// step half.
    [[nodiscard]] double loss() const {
        double on_bodies = 0;
        for (std::size_t w = 0; w < setup_.walls.size(); ++w) on_bodies += engine_.wall_energy(w).contacts;
        return (taken_before_ + taken_) / 2 - (bodies_before_ + works_of_bodies()) / 2 - on_bodies - loss_at_start_;
    }
    [[nodiscard]] double scale() const { return start_ + std::abs(height_) + taken_ + std::abs(works()); }
    [[nodiscard]] double stored() const { return stored_ - stored_at_start_; }

private:
    [[nodiscard]] double works() const {
        return sum_of_works([](const dem::Wall&) { return true; });
    }
    [[nodiscard]] double works_of_bodies() const {
        return sum_of_works([](const dem::Wall& wall) { return std::ranges::any_of(wall.motions, is_free); });
    }
    [[nodiscard]] double sum_of_works(auto&& counts) const {
        double sum = 0;
        for (std::size_t w = 0; w < setup_.walls.size(); ++w)
            if (counts(setup_.walls[w])) sum += engine_.wall_load(w, {}).work;
        return sum;
    }

    const dem::Setup& setup_;
    dem::Engine& engine_;
    std::vector<dem::ContactForce> contacts_;
    double kinetic_ = 0, start_ = 0, taken_ = 0, height_ = 0, stored_ = 0;
    double taken_before_ = 0, bodies_before_ = 0;  // before the last step
    double works_at_start_ = 0, loss_at_start_ = 0, stored_at_start_ = 0;
};

/// Spheres on the floor, between four walls or in a period.
dem::Setup bed(int layers, bool periodic) {
    dem::Setup setup = bed_on_floor(layers);
    setup.domain = {{0, 0, -0.01}, {0.02, 0.02, 0.08}, {periodic, periodic, false}};
    setup.material.rolling_friction = 0.05;
    for (std::size_t k = 0; k < 2 && !periodic; ++k)
        for (const double sign : {1.0, -1.0}) {
            Vec3 point{}, inwards{};
            point[k] = sign > 0 ? 0 : 0.02, inwards[k] = sign;
            setup.walls.emplace_back(dem::Plane{point, inwards});
        }
    return setup;
}

/// A lid of 5 g pressed by 2 N.
dem::Setup pressed_bed() {
    dem::Setup setup = bed(5, true);
    setup.walls.emplace_back(dem::Plane{{0, 0, 0.018}, {0, 0, -1}},
                             std::vector<Motion>{Press{.along = {0, 0, -1}, .force = 2, .mass = 0.005, .fastest = 5}});
    return setup;
}

/// Two crossed blades of 12 mm by 10 mm, driven in the powder.
dem::Setup driven_vane() {
    dem::Setup setup = bed(5, false);
    constexpr double x = 0.01, r = 0.006, low = 0.004, high = 0.014;
    std::vector<std::array<Vec3, 3>> blades;
    for (const Vec3& arm : {Vec3{r, 0, 0}, Vec3{0, r, 0}}) {
        const Vec3 a = Vec3{x, x, low} - arm, b = Vec3{x, x, low} + arm, up = {0, 0, high - low};
        blades.push_back({a, b, b + up});
        blades.push_back({a, b + up, a + up});
    }
    setup.walls.emplace_back(
        machine::mesh_of(blades, 0, {}),
        std::vector<Motion>{
            Drive{.point = {x, x, 0}, .axis = {0, 0, 1}, .moment = 3e-4, .inertia = 5e-7, .fastest = 500}});
    return setup;
}

/// A lid pressed on a bed whose floor is drawn along: the lid may turn no way but up and down.
dem::Setup sheared_bed() {
    dem::Setup setup = pressed_bed();
    setup.walls.front() =
        dem::Wall(dem::Plane{{0, 0, 0}, {0, 0, 1}}, std::vector<Motion>{Translation{.velocity = {0.2, 0, 0}}});
    return setup;
}

/// A cube that falls, turned, into the powder.
dem::Setup fallen_cube() {
    dem::Setup setup = bed(4, false);
    const Vec3 centre{0.01, 0.01, 0.024}, half{0.004, 0.003, 0.0035};
    std::vector<std::array<Vec3, 3>> triangles;
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0}) {
            const auto corner = [&](double u, double v) {
                Vec3 x{};
                const std::size_t b = (axis + 1) % 3, c = (axis + 2) % 3;
                x[axis] = side * half[axis], x[b] = u * half[b], x[c] = side * v * half[c];
                return centre + x;
            };
            triangles.push_back({corner(-1, -1), corner(1, -1), corner(1, 1)});
            triangles.push_back({corner(-1, -1), corner(1, 1), corner(-1, 1)});
        }
    const Mesh mesh = machine::mesh_of(triangles, 0, {.axis = {0, 1, 0}, .through = centre, .angle = 0.5});
    const auto solid = solid_of(mesh.surface()).value();
    Flight start{.centre = solid.centre,
                 .mass = 3000 * solid.volume,
                 .axes = solid.axes,
                 .inertia = 3000 * solid.inertia,
                 .fastest = 5,
                 .fastest_turn = 1000};
    start.force = {0, 0, -9.81 * start.mass};
    start.velocity = {0, 0, -0.5};
    start.angular_momentum = 50 * start.inertia;
    setup.walls.emplace_back(mesh, std::vector<Motion>{start});
    return setup;
}

struct Named {
    const char* name;
    dem::Setup (*setup)();
};
class BookedWalls : public testing::TestWithParam<Named> {};
INSTANTIATE_TEST_SUITE_P(, BookedWalls,
                         testing::Values(Named{"PressedBed", pressed_bed}, Named{"DrivenVane", driven_vane},
                                         Named{"ShearedBed", sheared_bed}, Named{"FallenCube", fallen_cube}),
                         [](const auto& one) { return one.param.name; });

// Damped contacts with friction and rolling resistance. The balance of the powder is read from its contacts; in mixed
// precision the reading judges anew which springs yield.
TEST_P(BookedWalls, IsBookedToRounding) {
    for (const auto precision : both) {
        const bool mixed = precision == Precision::mixed;
        const dem::Setup setup = GetParam().setup();
        const std::size_t body = setup.walls.size() - 1;
        const auto engine = dem::make_engine(setup, method(precision));
        Ledger ledger(setup, *engine);
        for (int k = 0; k < 4000; ++k) ledger.step();
        ASSERT_EQ(engine->fault(), "");
        const BodyEnergy& energy = engine->wall_energy(body);
        const double scale = turned_over(energy);
        EXPECT_LT(energy.contacts, -0.1 * scale) << "the powder takes energy from the wall";
        EXPECT_NEAR(residual(*engine, body), 0, 1e-12 * scale);
        EXPECT_LT(std::abs(energy.turning), 1e-4 * scale);
        EXPECT_EQ(energy.bounds, 0);
        EXPECT_NEAR(ledger.residual_of_powder(), 0, (mixed ? 3e-3 : 1e-11) * ledger.scale());
        EXPECT_GT(ledger.loss(), ledger.stored()) << "contacts dissipate";
        EXPECT_GT(ledger.loss(), 0.3 * scale);
        std::printf("%s %s: wall %.1e, powder %.1e, turning %.1e; loss %.3g J, stored %.3g J, of %.3g J\n",
                    GetParam().name, mixed ? "mixed" : "double", residual(*engine, body) / scale,
                    ledger.residual_of_powder() / ledger.scale(), energy.turning / scale, ledger.loss(),
                    ledger.stored(), scale);
    }
}

TEST_P(BookedWalls, ThreadsSlicesAndCheckpointsChangeNoBit) {
    const dem::Setup setup = GetParam().setup();
    const std::size_t body = setup.walls.size() - 1;
    for (const auto precision : both) {
        const auto whole = dem::make_engine(setup, method(precision));
        whole->run(2000);
        auto parts = dem::make_engine(setup, method(precision, 2));
        for (int k = 0; k < 4; ++k) {
            parts->run(500);
            std::vector<std::byte> bytes;
            parts->save(bytes);
            parts = dem::make_engine(setup, method(precision, 1 + k % 2));
            parts->restore(bytes);
        }
        const BodyEnergy &a = whole->wall_energy(body), &b = parts->wall_energy(body);
        EXPECT_EQ(a.contacts, b.contacts);
        EXPECT_EQ(a.own, b.own);
        EXPECT_EQ(a.turning, b.turning);
        EXPECT_EQ(a.start, b.start);
        EXPECT_NE(a.contacts, 0);
    }
}

/// A sphere that falls onto a light plate on a second sphere, which lies on the floor: elastic springs, no friction.
dem::Setup ball_on_plate(double time_step) {
    dem::Setup setup;
    setup.domain = {{-0.05, -0.05, -0.05}, {0.05, 0.05, 0.1}, {}};
    setup.material.density = 2500;
    setup.material.youngs_modulus = 5e6;
    setup.material.restitution = 1;
    setup.material.friction = 0;
    setup.time_step = time_step;
    dem::Sphere sphere;
    sphere.radius = 0.005;
    sphere.position = {0, 0, 0.005};
    setup.spheres = {sphere};
    sphere.position = {0, 0, 0.0162};
    sphere.velocity = {0, 0, -0.3};
    setup.spheres.push_back(sphere);
    setup.walls.emplace_back(dem::Plane{{0, 0, 0}, {0, 0, 1}});
    const std::vector<std::array<Vec3, 3>> plate = {
        {{{-0.02, -0.02, 0.0105}, {0.02, -0.02, 0.0105}, {0, 0.03, 0.0105}}}};
    setup.walls.emplace_back(
        machine::mesh_of(plate, 0, {}),
        std::vector<Motion>{Press{.along = {0, 0, -1}, .force = 0.02, .mass = 0.002, .fastest = 5}});
    return setup;
}

// What elastic contacts take is stored; the rest is the error of the time step.
TEST(FreeWallEnergy, ElasticContactsStoreWhatTheyTakeToSecondOrder) {
    double error[2] = {};
    for (const int fine : {0, 1}) {
        const dem::Setup setup = ball_on_plate(fine == 1 ? 5e-6 : 1e-5);
        const auto engine = dem::make_engine(setup, method(Precision::double_precision));
        Ledger ledger(setup, *engine);
        double deepest = 0;
        for (int k = 0; k < (fine == 1 ? 4000 : 2000); ++k) {
            ledger.step();
            error[fine] = std::max(error[fine], std::abs(ledger.loss() - ledger.stored()));
            deepest = std::max(deepest, ledger.stored());
        }
        ASSERT_EQ(engine->fault(), "");
        EXPECT_NEAR(residual(*engine, 1), 0, 1e-12 * turned_over(engine->wall_energy(1)));
        EXPECT_NEAR(ledger.residual_of_powder(), 0, 1e-11 * ledger.scale());
        EXPECT_GT(deepest, 1e-5) << "J, of an impact";
        error[fine] /= deepest;
        std::printf("error of the time step %.2e of the stored energy\n", error[fine]);
    }
    EXPECT_LT(error[0], 2e-2);
    EXPECT_NEAR(error[0] / error[1], 4, 1);
}

// The bound of the speed, the end of its time, and a change of walls take energy; all of it is booked.
TEST(FreeWallEnergy, BoundsAndHoldsAreBooked) {
    for (const auto precision : both) {
        dem::Setup setup = pressed_bed();
        auto& lid = std::get<Press>(setup.walls[1].motions[0]);
        lid.fastest = 0.05, lid.end = 0.03;
        const auto engine = dem::make_engine(setup, method(precision));
        const auto balanced = [&] {
            EXPECT_NEAR(residual(*engine, 1), 0, 1e-12 * turned_over(engine->wall_energy(1)));
        };
        engine->run(500);
        EXPECT_LT(engine->wall_energy(1).bounds, 0) << "its speed is bounded";
        balanced();
        std::get<Press>(setup.walls[1].motions[0]).mass = 0.01;
        const double before = kinetic_energy(engine->wall(1).motions);
        engine->change_walls(setup.walls);
        EXPECT_NEAR(kinetic_energy(engine->wall(1).motions), 2 * before, 0.1 * before)
            << "in mixed precision twice kicked";
        balanced();
        engine->run(3000);
        EXPECT_EQ(kinetic_energy(engine->wall(1).motions), 0) << "held";
        balanced();
    }
}

// A flight over its bounds of speed and turn.
TEST(FreeWallEnergy, AFlightIsBookedBeyondItsBounds) {
    for (const auto precision : both) {
        dem::Setup setup = fallen_cube();
        auto& start = std::get<Flight>(setup.walls.back().motions.back());
        start.fastest = 0.52, start.fastest_turn = 60;
        start.moment = {0, 0, 1e-6};
        const auto engine = dem::make_engine(setup, method(precision));
        engine->run(2000);
        const std::size_t body = setup.walls.size() - 1;
        EXPECT_LT(engine->wall_energy(body).bounds, 0);
        EXPECT_NEAR(residual(*engine, body), 0, 1e-12 * turned_over(engine->wall_energy(body)));
    }
}

// The lid of the laboratory's shear box, by the probes that a user has.
TEST(FreeWallEnergy, TheLidOfTheShearBoxIsBooked) {
    nlohmann::json document =
        nlohmann::json::parse(std::ifstream(tests::source("configs/machines/laboratory/shear_box.json")));
    for (const char* part : {"kinetic", "contacts", "own", "bounds", "turning", "residual"})
        document["measure"][std::string("lid_") + part] =
            nlohmann::json{{"wall_energy", {{"wall", "lid"}, {"part", part}}}, {"during", "shear"}, {"as", "last"}};
    document["measure"]["stored"] = nlohmann::json::parse(R"({"contact_energy": {}, "during": "shear", "as": "last"})");
    document["measure"]["stored_at_lid"] =
        nlohmann::json::parse(R"({"contact_energy": {"wall": "lid"}, "during": "shear", "as": "last"})");
    const auto seen = answer_of(spec_of(document, {{"width", 0.03}, {"displacement", 0.003}})).scalars;
    const double scale =
        std::abs(seen.at("lid_contacts")) + std::abs(seen.at("lid_own")) + std::abs(seen.at("lid_bounds"));
    EXPECT_GT(scale, 1e-3);
    EXPECT_LT(seen.at("lid_contacts"), 0);
    EXPECT_GT(seen.at("lid_own"), 0);
    EXPECT_NEAR(seen.at("lid_residual"), 0, 1e-12 * scale);
    EXPECT_NEAR(seen.at("lid_kinetic"),
                seen.at("lid_contacts") + seen.at("lid_own") + seen.at("lid_bounds") + seen.at("lid_turning"),
                1e-12 * scale);
    EXPECT_GT(seen.at("stored"), seen.at("stored_at_lid"));
    EXPECT_GT(seen.at("stored_at_lid"), 0);
}

}  // namespace grainsweep::tests::free_wall_energy_test
