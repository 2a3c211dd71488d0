#include "tests/support/granular_scenes.hpp"

#include <algorithm>
#include <cmath>

#include "stats/random.hpp"

namespace grainsweep::tests {

using dem::Vec3;

dem::Material steel_like() {
    dem::Material m;
    m.youngs_modulus = 21e6;
    m.poisson_ratio = 0.3;
    m.density = 7980;
    m.restitution = 0.5;
    m.friction = 0.2;
    return m;
}

dem::Setup thrown_lattice(int per_side, double speed, double spread, std::uint64_t seed) {
    dem::Setup s;
    s.material = steel_like();
    s.gravity = {0, 0, 0};
    s.time_step = 2e-6;
    const double d = 1e-3, pitch = d * (1 + spread);
    const double side = pitch * per_side;
    s.domain.low = {-0.3 * d, 0.1 * d, -2 * d};
    s.domain.high = {-0.3 * d + side, 0.1 * d + side, -2 * d + side};
    s.domain.periodic = {true, true, true};
    const stats::Stream stream(seed, 7);
    std::uint64_t draw = 0;
    const auto u = [&] { return 2 * stream.uniform(draw++) - 1; };
    for (int k = 0; k < per_side; ++k)
        for (int j = 0; j < per_side; ++j)
            for (int i = 0; i < per_side; ++i) {
                dem::Sphere p;
                const int at[3] = {i, j, k};
                for (std::size_t a = 0; a < 3; ++a) {
                    p.position[a] = s.domain.low[a] + (at[a] + 0.5) * pitch + 0.01 * d * u();
                    p.velocity[a] = speed * u();
                    p.angular_velocity[a] = speed / d * u();
                }
                p.radius = 0.5 * d * (1 + spread * u());
                s.spheres.push_back(p);
            }
    return s;
}

dem::Setup boxed_lattice(int per_side, double speed, double spread, std::uint64_t seed) {
    dem::Setup s = thrown_lattice(per_side, speed, spread, seed);
    const Vec3 low = s.domain.low, high = s.domain.high;
    const double d = 1e-3;
    s.domain.periodic = {false, false, false};
    for (std::size_t a = 0; a < 3; ++a) {
        s.domain.low[a] -= 3 * d;
        s.domain.high[a] += 9 * d;
    }
    s.gravity = {0.5, 0, -9.81};
    const double tilt = 0.1;
    s.walls = {dem::Plane{{low[0], low[1], low[2] - 0.1 * d}, {std::sin(tilt), 0, std::cos(tilt)}},
               dem::Plane{low, {1, 0, 0}}, dem::Plane{low, {0, 1, 0}}, dem::Plane{high, {-1, 0, 0}},
               dem::Plane{high, {0, -1, 0}}};
    for (dem::Sphere& p : s.spheres) p.position[2] += 0.4 * d;
    return s;
}

double position_difference(const dem::State& a, const dem::State& b, const dem::Domain& domain, double diameter) {
    double most = 0;
    for (std::size_t i = 0; i < a.id.size(); ++i)
        for (std::size_t q = 0; q < 3; ++q) {
            double d = a.position[i][q] - b.position[i][q];
            const double period = domain.high[q] - domain.low[q];
            if (domain.periodic[q]) d -= period * std::nearbyint(d / period);
            most = std::max(most, std::abs(d) / diameter);
        }
    return most;
}

double velocity_difference(const dem::State& a, const dem::State& b) {
    double most = 0;
    for (std::size_t i = 0; i < a.id.size(); ++i)
        for (std::size_t q = 0; q < 3; ++q) most = std::max(most, std::abs(a.velocity[i][q] - b.velocity[i][q]));
    return most;
}

double spin_difference(const dem::State& a, const dem::State& b) {
    double most = 0;
    for (std::size_t i = 0; i < a.id.size(); ++i)
        for (std::size_t q = 0; q < 3; ++q)
            most = std::max(most, std::abs(a.angular_velocity[i][q] - b.angular_velocity[i][q]));
    return most;
}

}  // namespace grainsweep::tests
