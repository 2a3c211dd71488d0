#include "tests/support/wall_case.hpp"

#include "solver/geometry/stl.hpp"
#include "tests/support/reference.hpp"

#include <nlohmann/json.hpp>

#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <stdexcept>
#include <string>

namespace grainsweep::tests {

namespace {

using nlohmann::json;
using namespace geometry;

std::size_t axis_of(char letter) {
    return static_cast<std::size_t>(letter - 'x');
}

dem::Vec3 along(std::size_t axis, double length) {
    dem::Vec3 v{};
    v[axis] = length;
    return v;
}

dem::Wall wall_of(const json& primitive, const dem::Vec3& sphere) {
    const auto kind = primitive["kind"].get<std::string>();
    const std::size_t axis = axis_of(kind[0]);
    const auto& p = primitive["param"];
    if (kind.substr(1) == "plane") {
        const double place = p[0];
        return dem::Plane{along(axis, place), along(axis, sphere[axis] > place ? 1 : -1)};
    }
    if (kind.substr(1) == "cone") {  // far longer than the sphere's way
        const double slope = std::tan(p[1].get<double>() * std::numbers::pi / 180), radius = p[0];
        return dem::Cone{.base = along(axis, -0.006),
                         .axis = along(axis, 1),
                         .base_radius = radius - 0.006 * slope,
                         .end_radius = radius + 0.05 * slope,
                         .length = 0.056,
                         .side = dem::Side::inside};
    }
    dem::Cylinder c;
    c.axis = along(axis, 1);
    c.radius = p[0];
    c.point[(axis + 1) % 3] = p[1];
    c.point[(axis + 2) % 3] = p[2];
    const dem::Vec3 from_axis = sphere - c.point;
    c.side = geometry::norm(from_axis - from_axis[axis] * c.axis) < c.radius ? dem::Side::inside : dem::Side::outside;
    if (!primitive.contains("shear")) return c;
    const std::size_t direction = axis_of(primitive["shear"][0].get<std::string>()[0]);
    const double speed = primitive["shear"][1];
    if (direction == axis) return {c, {dem::Translation{.velocity = along(axis, speed)}}};
    return {c, {dem::Rotation{.point = c.point, .axis = c.axis, .speed = speed}}};
}

}  // namespace

std::vector<geometry::Motion> motions_of(const json& mesh) {
    std::vector<geometry::Motion> motions;
    if (!mesh.contains("moves")) return motions;
    for (const json& m : mesh["moves"]) {
        const auto kind = m["kind"].get<std::string>();
        if (kind == "linear")
            motions.push_back(dem::Translation{.velocity = m["v"]});
        else if (kind == "wiggle")
            motions.push_back(dem::Vibration{.amplitude = m["amplitude"], .frequency = 1 / m["period"].get<double>()});
        else if (kind == "rotate")
            motions.push_back(dem::Rotation{.point = m["origin"],
                                            .axis = (1 / geometry::norm(m["axis"])) * m["axis"].get<dem::Vec3>(),
                                            .speed = 2 * std::numbers::pi / m["period"].get<double>()});
        else
            throw std::runtime_error("unknown motion " + kind);
    }
    return motions;
}

dem::Setup setup_of_wall_case(const json& c) {
    dem::Setup s;
    const dem::Vec3 half = c["box"];
    s.domain = {-1.0 * half, half, {}};
    s.material.youngs_modulus = c["E"];
    s.material.poisson_ratio = c["nu"];
    s.material.density = c["rho"];
    s.material.restitution = c["e"];
    s.material.friction = c["mu"];
    s.material.tangential_limit = dem::TangentialLimit::spring;
    if (!c["mur"].is_null()) {
        s.material.rolling_friction = c["mur"];
        s.material.rolling_damping = c["murv"];
        s.material.rolling_law = dem::RollingLaw::epsd_liggghts;
    }
    if (c["cohesion"] != "") s.material.cohesion = c["k"];
    s.gravity = c["g"];
    s.time_step = c["dt"];
    s.spheres = {{c["x"], c["v"], c["w"], c["diameter"].get<double>() / 2, true}};
    for (const json& primitive : c["primitives"]) s.walls.push_back(wall_of(primitive, s.spheres[0].position));
    for (const json& mesh : c["meshes"]) s.walls.push_back({mesh_of(mesh), motions_of(mesh)});
    return s;
}

geometry::Mesh mesh_of(const json& mesh) {
    std::ifstream in(reference("walls/stl/" + mesh["stl"].get<std::string>() + ".stl"), std::ios::binary);
    if (!in) throw std::runtime_error("no mesh " + mesh["stl"].get<std::string>());
    const std::string contents{std::istreambuf_iterator<char>(in), {}};
    return geometry::Mesh(geometry::read_stl(contents).surface);
}

json wall_cases(const std::string& file) {
    std::ifstream in(reference("walls/" + file));
    return json::parse(in);
}

Deviation deviation(const std::string& name, const dem::Setup& setup, const dem::Method& method) {
    const auto table = read_table(reference("walls/" + name + ".csv"));
    const auto engine = dem::make_engine(setup, method);
    const double radius = setup.spheres[0].radius;
    double fastest = 0;
    for (std::size_t r = 0; r < table.rows; ++r)
        fastest = std::max(fastest, std::hypot(table.at("vx", r), table.at("vy", r), table.at("vz", r)));
    Deviation d;
    dem::State state;
    for (std::size_t r = 0; r < table.rows; ++r) {
        engine->run(static_cast<std::int64_t>(table.at("step", r)) - engine->work().steps);
        engine->state(state);
        const auto differs = [&](const dem::Vec3& mine, const std::array<const char*, 3>& columns, double scale) {
            double worst = 0;
            for (std::size_t k = 0; k < 3; ++k)
                worst = std::max(worst, std::abs(mine[k] - table.at(columns[k], r)) * scale);
            return worst;
        };
        d.position = std::max(d.position, differs(state.position[0], {"x", "y", "z"}, 1 / (2 * radius)));
        d.velocity = std::max(d.velocity, differs(state.velocity[0], {"vx", "vy", "vz"}, 1 / fastest));
        d.spin = std::max(d.spin, differs(state.angular_velocity[0], {"omegax", "omegay", "omegaz"}, radius / fastest));
    }
    d.fault = engine->fault();
    return d;
}

}  // namespace grainsweep::tests
