#include "tests/support/granular_beds.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <stdexcept>

#include "solver/dem/fast/mixed_engine.hpp"
#include "stats/random.hpp"
#include "tests/support/blade.hpp"
#include "tests/support/surfaces.hpp"

namespace grainsweep::tests {

namespace {

constexpr double d = 45e-6;
constexpr double gravity = 9.81;

dem::Setup powder() {
    dem::Setup s;
    s.material.youngs_modulus = 1e7;
    s.material.poisson_ratio = 0.3;
    s.material.density = 4430;
    s.material.restitution = 0.6;
    s.material.friction = 0.5;
    s.gravity = {0, 0, -gravity};
    s.time_step = 5e-7;
    s.domain.periodic = {true, true, false};
    return s;
}

/// The setup's spheres where `time` carries them.
void move_on(dem::Setup& setup, double time) {
    const auto engine = dem::fast::make_mixed_engine(setup, dem::Method::Path::best);
    engine->run(static_cast<std::int64_t>(time / setup.time_step));
    if (!engine->fault().empty()) throw std::runtime_error(engine->fault());
    dem::State state;
    engine->state(state);
    if (state.id.size() != setup.spheres.size()) throw std::runtime_error("the bed lost particles");
    for (std::size_t i = 0; i < state.id.size(); ++i) {
        dem::Sphere& p = setup.spheres[i];
        p.position = state.position[i];
        p.velocity = state.velocity[i];
        p.angular_velocity = state.angular_velocity[i];
    }
}

}  // namespace

dem::Setup settled_bed(const BedOptions& o) {
    dem::Setup s = powder();
    const double pitch = d * std::max(26.0 / 22, 1.04 * (1 + o.spread));
    const double side = pitch * o.per_side;
    s.domain.low = {0, 0, -d};
    s.domain.high = {side, side, pitch * (o.layers + 4)};
    const stats::Stream stream(o.seed, 1);
    std::uint64_t draw = 0;
    const auto u = [&] { return 2 * stream.uniform(draw++) - 1; };
    for (int k = 0; k < o.layers; ++k)
        for (int j = 0; j < o.per_side; ++j)
            for (int i = 0; i < o.per_side; ++i) {
                dem::Sphere p;
                p.radius = 0.5 * d * (1 + o.spread * u());
                p.position = {(i + 0.5) * pitch + 0.02 * d * u(), (j + 0.5) * pitch + 0.02 * d * u(),
                              (k + 0.7) * pitch + 0.02 * d * u()};
                for (double& v : p.velocity) v = 0.03 * u();
                s.spheres.push_back(p);
            }
    dem::Setup falling = s;
    falling.material.restitution = 0.2;
    falling.walls = {dem::Plane{{0, 0, 0}, {0, 0, 1}}};
    falling.gravity[2] = -5 * gravity;
    move_on(falling, o.settle_time);  // pressed together, then relieved to rest under its own weight
    falling.gravity[2] = -gravity;
    move_on(falling, o.settle_time);
    for (std::size_t i = 0; i < s.spheres.size(); ++i) {
        dem::Sphere& p = s.spheres[i] = falling.spheres[i];
        p.mobile = p.position[2] > 1.4 * d;  // thick enough to let no particle through
        if (!p.mobile) p.velocity = p.angular_velocity = {};
    }
    return s;
}

dem::Setup flowing(dem::Setup bed, double degrees, double time) {
    bed = tilted(std::move(bed), degrees);
    bed.domain.high[2] += bed.domain.high[2] - bed.domain.low[2];  // room to jump
    move_on(bed, time);
    return bed;
}

dem::Setup replicated(const dem::Setup& bed, int nx, int ny) {
    dem::Setup s = bed;
    s.spheres.clear();
    const double lx = bed.domain.high[0] - bed.domain.low[0], ly = bed.domain.high[1] - bed.domain.low[1];
    for (int a = 0; a < nx; ++a)
        for (int b = 0; b < ny; ++b)
            for (dem::Sphere p : bed.spheres) {
                p.position[0] += a * lx;
                p.position[1] += b * ly;
                s.spheres.push_back(p);
            }
    s.domain.high[0] = bed.domain.low[0] + nx * lx;
    s.domain.high[1] = bed.domain.low[1] + ny * ly;
    return s;
}

dem::Setup tilted(dem::Setup bed, double degrees) {
    const double angle = degrees * std::numbers::pi / 180;
    bed.gravity = {gravity * std::sin(angle), 0, -gravity * std::cos(angle)};
    return bed;
}

dem::Setup small_chute(std::uint64_t seed) {
    BedOptions o;
    o.per_side = 10, o.layers = 20, o.seed = seed;
    dem::Setup s = tilted(settled_bed(o), 26);
    s.domain.high[2] += s.domain.high[2] - s.domain.low[2];  // room to jump
    return s;
}

dem::Setup loose_gas(int per_side) {
    dem::Setup s = powder();
    s.domain.periodic = {true, true, true};
    s.gravity = {0, 0, 0};
    const double pitch = 2 * d;
    s.domain.high = {pitch * per_side, pitch * per_side, pitch * per_side};
    const stats::Stream stream(6, 1);
    std::uint64_t draw = 0;
    const auto u = [&] { return 2 * stream.uniform(draw++) - 1; };
    for (int k = 0; k < per_side; ++k)
        for (int j = 0; j < per_side; ++j)
            for (int i = 0; i < per_side; ++i) {
                dem::Sphere p;
                p.radius = 0.5 * d;
                p.position = {(i + 0.5) * pitch + 0.3 * d * u(), (j + 0.5) * pitch + 0.3 * d * u(),
                              (k + 0.5) * pitch + 0.3 * d * u()};
                for (double& v : p.velocity) v = 0.05 * u();
                s.spheres.push_back(p);
            }
    return s;
}

dem::Setup of_triangles(dem::Setup setup) {
    constexpr int rings = 28, slices = 14;
    const auto& mantle = std::get<dem::Cylinder>(setup.walls.at(0).shape);
    const double length = std::get<dem::Plane>(setup.walls.at(2).shape).point[1];
    // Ring k of a disc has 6 k corners.
    const auto corner = [&](int k, int n, double y) {
        const double angle = k == 0 ? 0 : std::numbers::pi / 3 * n / k, r = mantle.radius * k / rings;
        return dem::Vec3{r * std::cos(angle), y, r * std::sin(angle)};
    };
    tests::Soup soup;
    for (const double y : {0.0, length})
        for (int k = 1; k <= rings; ++k)
            for (int sector = 0; sector < 6; ++sector)
                for (int n = 0; n < k; ++n) {
                    const int outer = sector * k + n, inner = sector * (k - 1) + n;
                    soup.push_back({corner(k, outer, y), corner(k, outer + 1, y), corner(k - 1, inner, y)});
                    if (n + 1 < k)
                        soup.push_back({corner(k - 1, inner, y), corner(k, outer + 1, y), corner(k - 1, inner + 1, y)});
                }
    for (int n = 0; n < 6 * rings; ++n)
        for (int slice = 0; slice < slices; ++slice) {
            const double low = length * slice / slices, high = length * (slice + 1) / slices;
            const auto square = tests::quadrilateral(corner(rings, n, low), corner(rings, n + 1, low),
                                                     corner(rings, n + 1, high), corner(rings, n, high));
            soup.insert(soup.end(), square.begin(), square.end());
        }
    const double one_contact_angle = 1.3 * std::numbers::pi / (3 * rings);
    setup.walls = {{dem::Mesh(tests::surface_of(soup), one_contact_angle), setup.walls[0].motions}};
    return setup;
}

dem::Setup turning_drum() {
    constexpr double radius = 42e-3, length = 20e-3, diameter = 1.2e-3, pitch = 1.22e-3, margin = 2e-3;
    constexpr std::size_t spheres = 29185;
    dem::Setup s;
    s.material = {.youngs_modulus = 5e6, .density = 1580, .restitution = 0.3, .friction = 0.5};
    s.gravity = {0, 0, -gravity};
    s.time_step = 1e-5;
    s.domain = {{-radius - margin, -margin, -radius - margin}, {radius + margin, length + margin, radius + margin}, {}};
    const dem::Rotation turns{.axis = {0, 1, 0}, .speed = 2 * std::numbers::pi * 15 / 60};
    s.walls = {{dem::Cylinder{.axis = {0, 1, 0}, .radius = radius}, {turns}},
               {dem::Plane{{0, 0, 0}, {0, 1, 0}}, {turns}},
               {dem::Plane{{0, length, 0}, {0, -1, 0}}, {turns}}};
    const stats::Stream stream(3, 2);
    std::uint64_t draw = 0;
    const auto u = [&] { return 2 * stream.uniform(draw++) - 1; };
    const auto layers = static_cast<int>(length / pitch), rows = static_cast<int>(2 * radius / pitch);
    for (int k = 0; k < rows && s.spheres.size() < spheres; ++k)
        for (int i = 0; i < rows; ++i)
            for (int j = 0; j < layers && s.spheres.size() < spheres; ++j) {
                const double x = (i + 0.5) * pitch - radius, z = (k + 0.5) * pitch - radius;
                if (std::hypot(x, z) > radius - 0.6 * pitch) continue;
                s.spheres.push_back({{x + 5e-6 * u(), (j + 0.5) * length / layers + 5e-6 * u(), z + 5e-6 * u()},
                                     {},
                                     {},
                                     diameter / 2,
                                     true});
            }
    move_on(s, 0.25);
    return s;
}

dem::Setup read_bed(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    const auto number = [&](auto& x) { in.read(reinterpret_cast<char*>(&x), sizeof x); };
    std::int64_t n = 0;
    dem::Setup s = powder();
    number(n);
    for (double& x : s.domain.high) number(x);
    s.domain.low = {0, 0, -d};
    for (std::int64_t i = 0; i < n && in; ++i) {
        double q[11];
        for (double& x : q) number(x);
        dem::Sphere p{{q[0], q[1], q[2]}, {q[4], q[5], q[6]}, {q[7], q[8], q[9]}, q[3], q[10] < 0.5};
        if (!p.mobile) p.velocity = p.angular_velocity = {};
        s.spheres.push_back(p);
    }
    if (!in) throw std::runtime_error("cannot read the bed " + file.string());
    return s;
}

dem::Setup spreading_start(double diameter, double friction, std::uint64_t seed) {
    const double mm = 1e-3, width = 10 * diameter, gate = 15 * mm, length = 90 * mm;
    dem::Setup s;
    s.domain = {{-60 * mm, 0, -1 * mm}, {300 * mm, width, 160 * mm}, {false, true, false}};
    s.material.youngs_modulus = 21e6;
    s.material.poisson_ratio = 0.3;
    s.material.density = 7980;
    s.material.restitution = 0.5;
    s.material.friction = friction;
    s.time_step = 1e-5;
    const auto count = std::lround(400e-6 * width / (std::numbers::pi / 6 * diameter * diameter * diameter));
    const auto nx = static_cast<long>((length - 0.1 * diameter) / (1.1 * diameter));
    const auto ny = static_cast<long>(width / (1.1 * diameter));
    const double sx = (length - 0.1 * diameter) / static_cast<double>(nx), sy = width / static_cast<double>(ny);
    const stats::Stream stream(seed, 1);
    std::uint64_t draw = 0;
    const auto u = [&] { return 2 * stream.uniform(draw++) - 1; };
    for (long k = 0; k < count; ++k) {
        const double iz = static_cast<double>(k / (nx * ny)), iy = static_cast<double>(k % (nx * ny) / nx),
                     ix = static_cast<double>(k % nx);
        dem::Sphere p;
        p.radius = diameter / 2;
        p.position = {gate + 0.05 * diameter * (1 + u()) + (ix + 0.5) * sx, (iy + 0.5) * sy + 0.05 * diameter * u(),
                      0.05 * diameter * (1 + u()) + (iz + 0.5) * 1.1 * diameter};
        for (double& v : p.velocity) v = 0.1 * u();
        s.spheres.push_back(p);
    }
    s.walls = {dem::Plane{{0, 0, 0}, {0, 0, 1}}, dem::Plane{{gate, 0, 0}, {1, 0, 0}},
               dem::Plane{{gate + length, 0, 0}, {-1, 0, 0}}};
    return s;
}

std::vector<dem::Wall> spreading_blade(double gap, double speed) {
    Blade b;
    b.front = 15e-3;
    b.thickness = 5e-3;
    b.bottom = gap;
    b.top = 150e-3;
    b.speed = speed;
    return {dem::Plane{{0, 0, 0}, {0, 0, 1}}, b};
}

}  // namespace grainsweep::tests
