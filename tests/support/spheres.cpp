#include "tests/support/spheres.hpp"

#include "solver/geometry/vector.hpp"
#include "stats/random.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace grainsweep::tests {

dem::Setup empty_space() {
    dem::Setup setup;
    setup.domain = {{-1, -1, -1}, {1, 1, 1}, {}};
    setup.gravity = {};
    setup.time_step = 1e-6;
    return setup;
}

dem::Setup boxed_gas(std::size_t n, double speed, double largest_ratio, std::uint64_t seed) {
    auto setup = empty_space();
    setup.time_step = 5e-6;
    const stats::Stream random(seed, 9);
    const auto side = static_cast<std::size_t>(std::ceil(std::cbrt(static_cast<double>(n))));
    const double pitch = 0.0023;
    const double length = pitch * static_cast<double>(side);
    for (std::size_t k = 0; k < n; ++k) {
        dem::Sphere s;
        const std::array<std::size_t, 3> site = {k % side, k / side % side, k / side / side};
        s.radius = 0.001 * std::pow(largest_ratio, -random.uniform(7 * k + 6));
        for (std::size_t a = 0; a < 3; ++a) {
            s.position[a] = (static_cast<double>(site[a]) + 0.5) * pitch + 1e-4 * (2 * random.uniform(7 * k + a) - 1);
            s.velocity[a] = speed * (2 * random.uniform(7 * k + 3 + a) - 1);
        }
        setup.spheres.push_back(s);
    }
    setup.domain = {{-0.001, -0.001, -0.001}, {length + 0.001, length + 0.001, length + 0.001}, {}};
    for (std::size_t a = 0; a < 3; ++a)
        for (const double sign : {1.0, -1.0}) {
            dem::Plane plane{};
            plane.normal = {};
            plane.normal[a] = sign;
            plane.point[a] = sign > 0 ? 0 : length;
            setup.walls.emplace_back(plane);
        }
    return setup;
}

dem::Setup bed_on_floor(int layers) {
    dem::Setup setup;
    setup.material.density = 2500;
    setup.material.youngs_modulus = 5e6;
    setup.material.friction = 0.4;
    setup.material.restitution = 0.2;
    setup.time_step = 1e-5;
    for (int z = 0; z < layers; ++z)
        for (int y = 0; y < 6; ++y)
            for (int x = 0; x < 6; ++x) {
                dem::Sphere sphere;
                sphere.radius = 0.0014 + 0.0001 * ((x + 2 * y + 3 * z) % 3);
                sphere.position = {0.0017 + x * 0.0033 + 1e-4 * (z % 2), 0.0017 + y * 0.0033, 0.0017 + z * 0.0033};
                setup.spheres.push_back(sphere);
            }
    setup.walls.emplace_back(dem::Plane{{0, 0, 0}, {0, 0, 1}});
    return setup;
}

double mass(const dem::Setup& setup, double radius) {
    return 4.0 / 3.0 * std::numbers::pi * radius * radius * radius * setup.material.density;
}

double kinetic_energy(const dem::Setup& setup, const dem::State& state) {
    double energy = 0;
    for (std::size_t i = 0; i < state.id.size(); ++i) {
        if (!state.mobile[i]) continue;
        const double r = state.radius[i];
        energy += mass(setup, r) * (0.5 * geometry::dot(state.velocity[i], state.velocity[i]) +
                                    0.2 * r * r * geometry::dot(state.angular_velocity[i], state.angular_velocity[i]));
    }
    return energy;
}

bool finite(const dem::State& state) {
    const auto all = [](const std::vector<dem::Vec3>& column) {
        return std::ranges::all_of(column, [](const dem::Vec3& x) { return geometry::finite(x); });
    };
    return all(state.position) && all(state.velocity) && all(state.angular_velocity);
}

dem::Method method(dem::Method::Precision precision, int threads) {
    dem::Method made;
    made.precision = precision;
    made.threads = threads;
    return made;
}

dem::State state_of(const dem::Engine& engine) {
    dem::State state;
    engine.state(state);
    return state;
}

}  // namespace grainsweep::tests
