#include "tests/support/clump_cases.hpp"

#include "tests/support/places.hpp"

#include <fstream>

namespace grainsweep::tests {

using nlohmann::json;
using namespace geometry;

namespace {

std::vector<Ball> balls_of(const json& spheres) {
    std::vector<Ball> balls;
    for (const json& s : spheres)
        balls.push_back({{s[0].get<double>(), s[1].get<double>(), s[2].get<double>()}, s[3].get<double>()});
    return balls;
}

Vec3 vector_of(const json& v) {
    return {v[0].get<double>(), v[1].get<double>(), v[2].get<double>()};
}

}  // namespace

json clump_cases() {
    std::ifstream in(tests::reference("clumps/cases.json"));
    return json::parse(in);
}

dem::BodyShape body_shape(const particles::Clump& clump, double density, dem::DampingMass damping) {
    const double d = clump.diameter;
    dem::BodyShape shape;
    for (const Ball& ball : clump.balls) shape.members.push_back({d * ball.centre, d * ball.radius});
    shape.mass = density * d * d * d * clump.mass;
    shape.inertia = (density * d * d * d * d * d) * clump.inertia;
    shape.damping = damping;
    return shape;
}

dem::BodyShape clump_shape(const std::string& name, double density, dem::DampingMass damping) {
    std::ifstream in(tests::reference("clumps/shapes.json"));
    const auto balls = balls_of(json::parse(in)[name]["spheres"]);
    return body_shape(particles::clump_of(balls, solid_of(balls)), density, damping);
}

ClumpCase clump_case(const json& c) {
    ClumpCase made;
    dem::Setup& setup = made.setup;
    const double box = c["box"].get<double>();
    setup.domain = {{-box, -box, -box}, {box, box, box}, {}};
    setup.gravity = vector_of(c["g"]);
    setup.time_step = c["dt"].get<double>();
    std::vector<std::string> names;
    for (const auto& [name, m] : c["materials"].items()) names.push_back(name);
    const auto pair = [&](const std::string& a, const std::string& b) {
        const json& pairs = c["pairs"];
        dem::Material m;
        m.tangential_limit = dem::TangentialLimit::spring;
        m.youngs_modulus = c["materials"][a]["E"].get<double>();
        m.poisson_ratio = c["materials"][a]["nu"].get<double>();
        m.partner = {c["materials"][b]["E"].get<double>(), c["materials"][b]["nu"].get<double>()};
        const std::string key = pairs.contains(a + b) ? a + b : b + a;
        if (pairs.contains(key)) {
            m.restitution = pairs[key]["e"].get<double>();
            m.friction = pairs[key]["mu"].get<double>();
        }
        return m;
    };
    const auto kind_of = [&](const json& body) {
        return static_cast<std::uint8_t>(std::ranges::find(names, body["material"].get<std::string>()) - names.begin());
    };
    setup.kinds.densities.assign(names.size(), 2500);
    for (std::size_t b = 0; b < names.size(); ++b)
        for (std::size_t a = 0; a <= b; ++a) setup.kinds.pairs.push_back(pair(names[a], names[b]));
    setup.material = setup.kinds.pairs.front();
    for (const json& w : c["walls"]) {
        Plane plane;
        const auto axis = static_cast<std::size_t>(w["kind"].get<std::string>()[0] - 'x');
        plane.normal = plane.point = Vec3{};
        plane.normal[axis] = w.value("side", 1);
        plane.point[axis] = w["at"].get<double>();
        dem::Wall wall(plane);
        for (const auto& name : names) wall.materials.push_back(pair(name, w["material"].get<std::string>()));
        setup.walls.push_back(wall);
    }
    for (const json& f : c["fixed"])
        setup.spheres.push_back(
            {.position = vector_of(f["x"]), .radius = f["r"].get<double>(), .mobile = false, .kind = kind_of(f)});
    for (const json& b : c["bodies"]) {
        const auto balls = balls_of(b["spheres"]);
        const double mass = b["mass"].get<double>(), volume = mass / b["rho"].get<double>();
        Inertia inertia{};
        for (std::size_t k = 0; k < 6; ++k) inertia[k] = b["inertia"][k].get<double>() / b["rho"].get<double>();
        const auto clump = particles::clump_of(balls, solid_of(volume, {}, inertia));
        setup.shapes.push_back(body_shape(clump, b["rho"].get<double>(), dem::DampingMass::body));
        Quaternion q{};
        for (std::size_t k = 0; k < 4; ++k) q[k] = b["q"][k].get<double>();
        dem::Body body{.shape = setup.shapes.size() - 1,
                       .first = setup.spheres.size(),
                       .position = vector_of(b["x"]),
                       .orientation = normalised(product(normalised(q), clump.turn)),
                       .velocity = vector_of(b["v"]),
                       .angular_velocity = vector_of(b["w"])};
        for (const auto& sphere : dem::members_of(setup.shapes.back(), body, kind_of(b)))
            setup.spheres.push_back(sphere);
        made.turns.push_back(clump.turn);
        made.reach.push_back(dem::reach_of(setup.shapes.back()));
        setup.bodies.push_back(body);
    }
    return made;
}

dem::Setup clump_room() {
    dem::Setup setup;
    setup.domain = {{-0.05, -0.05, -0.05}, {0.05, 0.05, 0.05}, {}};
    setup.gravity = {};
    setup.material.youngs_modulus = 2.1e7;
    setup.material.density = clump_density;
    setup.time_step = 1e-6;
    return setup;
}

void add_body(dem::Setup& setup, const dem::Body& given) {
    dem::Body body = given;
    body.first = setup.spheres.size();
    for (const auto& sphere : dem::members_of(setup.shapes[body.shape], body)) setup.spheres.push_back(sphere);
    setup.bodies.push_back(body);
}

}  // namespace grainsweep::tests
