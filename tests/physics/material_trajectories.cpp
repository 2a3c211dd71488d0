// Spheres and walls of unlike materials against LIGGGHTS 3.8 (tests/reference/machines): every pair has its own
// restitution and friction, every material its own elastic constants and density, so a wrong index shows.
#include "solver/dem/engine.hpp"
#include "solver/geometry/stl.hpp"
#include "tests/support/against_plain.hpp"
#include "tests/support/reference.hpp"
#include "tests/support/wall_case.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

namespace grainsweep::tests::material_trajectories_test {

using dem::Material;
using dem::Method;
using nlohmann::json;

json all_cases() {
    std::ifstream in(reference("machines/cases.json"));
    return json::parse(in);
}

std::string named_pair(const json& c, const std::string& a, const std::string& b) {
    return c["pairs"].contains(a + b) ? a + b : b + a;
}

/// How two materials touch.
Material contact_of(const json& c, const std::string& a, const std::string& b) {
    const json &one = c["materials"][a], &other = c["materials"][b], &pair = c["pairs"][named_pair(c, a, b)];
    Material m;
    m.youngs_modulus = one["E"];
    m.poisson_ratio = one["nu"];
    m.partner = dem::Elasticity{other["E"], other["nu"]};
    m.restitution = pair["e"];
    m.friction = pair["mu"];
    m.tangential_limit = dem::TangentialLimit::spring;
    if (!c["rolling"].is_null()) {
        m.rolling_friction = pair["mur"];
        m.rolling_damping = pair["murv"];
        m.rolling_law = c["rolling"] == "cdt" ? dem::RollingLaw::cdt : dem::RollingLaw::epsd_liggghts;
    }
    return m;
}

dem::Setup setup_of(const json& c) {
    dem::Setup s;
    const double half = c["box"];
    s.domain = {{-half, -half, -half}, {half, half, half}, {}};
    s.gravity = c["g"];
    s.time_step = c["dt"];
    std::vector<std::string> kinds;
    for (const json& body : c["bodies"]) {
        const std::string material = body["material"];
        auto at = std::ranges::find(kinds, material);
        if (at == kinds.end()) {
            kinds.push_back(material);
            s.kinds.densities.push_back(body["rho"]);
            at = kinds.end() - 1;
        }
        s.spheres.push_back({body["x"], body["v"], body["w"], body["diameter"].get<double>() / 2, true,
                             static_cast<std::uint8_t>(at - kinds.begin())});
    }
    for (std::size_t b = 0; b < kinds.size(); ++b)
        for (std::size_t a = 0; a <= b; ++a) s.kinds.pairs.push_back(contact_of(c, kinds[a], kinds[b]));
    const auto add_wall = [&](dem::Wall wall, const std::string& material) {
        for (const std::string& kind : kinds) wall.materials.push_back(contact_of(c, kind, material));
        s.walls.push_back(std::move(wall));
    };
    for (const json& wall : c["walls"])
        add_wall(wall["kind"] == "zplane" ? dem::Plane{{}, {0, 0, 1}}
                                          : dem::Plane{{}, {s.spheres[0].position[0] > 0 ? 1.0 : -1.0, 0, 0}},
                 wall["material"]);
    for (const json& mesh : c["meshes"]) add_wall({mesh_of(mesh), motions_of(mesh)}, mesh["material"]);
    return s;
}

/// Largest differences over all bodies and rows: position over the largest diameter, velocity and surface speed over
/// the largest speed.
Deviation differences(const std::string& name, const dem::Setup& setup, const Method& method) {
    const auto table = read_table(reference("machines/" + name + ".csv"));
    const auto engine = dem::make_engine(setup, method);
    double fastest = 0, diameter = 0;
    for (std::size_t r = 0; r < table.rows; ++r)
        fastest = std::max(fastest, std::hypot(table.at("vx", r), table.at("vy", r), table.at("vz", r)));
    for (const dem::Sphere& s : setup.spheres) diameter = std::max(diameter, 2 * s.radius);
    Deviation d;
    dem::State state;
    for (std::size_t r = 0; r < table.rows; ++r) {
        engine->run(static_cast<std::int64_t>(table.at("step", r)) - engine->work().steps);
        engine->state(state);
        const auto body = static_cast<std::size_t>(table.at("id", r)) - 1;
        if (state.id.size() <= body) {
            d.fault = "a body left";
            break;
        }
        const auto differs = [&](const dem::Vec3& mine, const std::array<const char*, 3>& columns, double unit) {
            double worst = 0;
            for (std::size_t k = 0; k < 3; ++k)
                worst = std::max(worst, std::abs(mine[k] - table.at(columns[k], r)) / unit);
            return worst;
        };
        d.position = std::max(d.position, differs(state.position[body], {"x", "y", "z"}, diameter));
        d.velocity = std::max(d.velocity, differs(state.velocity[body], {"vx", "vy", "vz"}, fastest));
        d.spin = std::max(d.spin, differs(state.angular_velocity[body], {"omegax", "omegay", "omegaz"},
                                          fastest / state.radius[body]));
    }
    if (d.fault.empty()) d.fault = engine->fault();
    return d;
}

// Rounding alone: LIGGGHTS differs from the law written plainly by 3e-15 of the largest speed.
TEST(MaterialTrajectories, EqualTheReferenceToRounding) {
    std::set<std::string> seen;
    const json all = all_cases();
    for (const auto& [name, c] : all.items()) {
        const auto d = differences(name, setup_of(c), {});
        EXPECT_EQ(d.fault, "") << name;
        EXPECT_LT(d.largest(), 1e-11) << name;
        seen.insert(name);
    }
    EXPECT_EQ(seen.size(), 16U);
}

/// Differences that the double-precision engine has where the start is moved by up to 1e-7 diameters: springs that
/// yield a step sooner or later, and contacts that begin or end so, multiply the rounding of single precision.
double growth(const std::string& name, const dem::Setup& setup) {
    double most = 0;
    for (const double part : {1e-8, 1e-7, -1e-7}) {
        dem::Setup moved = setup;
        for (dem::Sphere& s : moved.spheres)
            for (std::size_t k = 0; k < 3; ++k) s.position[k] += part * s.radius * static_cast<double>(3 - k);
        most = std::max(most, differences(name, moved, {}).largest());
    }
    return most;
}

// A wrong index or mean is worth 1e-2 to 3e-1.
TEST(MaterialTrajectories, MixedPrecisionEqualsTheReference) {
    const json all = all_cases();
    for (const auto& [name, c] : all.items()) {
        const dem::Setup setup = setup_of(c);
        const double tolerance = std::min(1e-2, 1e-5 + 5 * growth(name, setup));
        for (const auto path : paths()) {
            const auto d = differences(name, setup, {Method::Precision::mixed, path});
            EXPECT_EQ(d.fault, "") << name << " " << path_name(path);
            EXPECT_LT(d.largest(), tolerance) << name << " " << path_name(path);
        }
    }
}

/// A small hard sphere about to hit a large soft one; the step (s) is far too long for two of the small ones.
dem::Setup small_on_large(double time_step) {
    dem::Setup s;
    s.domain = {{-0.01, -0.01, -0.01}, {0.01, 0.01, 0.01}, {}};
    s.gravity = {};
    s.time_step = time_step;
    Material soft, hard, both;
    soft.youngs_modulus = both.youngs_modulus = 1e6;
    hard.youngs_modulus = 1e9;
    both.partner = dem::Elasticity{1e9, 0.3};
    s.kinds = {{2500, 2500}, {soft, both, hard}};
    s.spheres = {{{}, {}, {}, 2e-3, true, 0}, {{0, 0, 2.5001e-3}, {0, 0, -0.5}, {}, 5e-4, true, 1}};
    return s;
}

// Each contact is judged by its own masses and moduli, as in double precision.
TEST(MaterialTrajectories, ContactsOfUnlikeKindsAreJudgedOneByOne) {
    for (const auto path : paths()) {
        const dem::Setup sound = small_on_large(5e-6);
        const auto clear = dem::make_engine(sound, {});
        const auto mixed = dem::make_engine(sound, {Method::Precision::mixed, path});
        clear->run(200), mixed->run(200);
        EXPECT_EQ(clear->fault() + mixed->fault(), "");
        EXPECT_GT(mixed->peak_overlap(), 0.03);
        EXPECT_LT(mixed->peak_overlap() / clear->peak_overlap() - 1, 1e-4);
        dem::Setup hard = sound;  // two of the small ones at that step
        hard.spheres[0] = {{0, 0, 1.4999e-3}, {}, {}, 5e-4, true, 1};
        hard.spheres[1].velocity[2] = -1;
        for (const dem::Setup& unsound : {small_on_large(9e-5), hard}) {
            const auto one = dem::make_engine(unsound, {});
            const auto other = dem::make_engine(unsound, {Method::Precision::mixed, path});
            one->run(30), other->run(30);
            EXPECT_NE(one->fault().find("the time step is too large"), std::string::npos) << one->fault();
            EXPECT_NE(other->fault().find("the time step is too large"), std::string::npos) << other->fault();
        }
    }
}

}  // namespace grainsweep::tests::material_trajectories_test
