#include "tests/support/wall_decks.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <fstream>
#include <numbers>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "solver/geometry/stl.hpp"
#include "solver/observables/heap.hpp"
#include "stats/random.hpp"
#include "tests/support/peer_programs.hpp"

namespace grainsweep::tests {
namespace {

using dem::Vec3;
using namespace geometry;
using std::numbers::pi;

constexpr double grain = 5e-3;  // mean diameter of the powder of drum, hopper and heap, m
constexpr int facets = 48;      // of a tessellated circle

/// A lattice of spacing 1.15 d from the bottom up, displaced and thrown about a little.
std::vector<dem::Sphere> lattice(std::int64_t count, double d, double spread, const Vec3& low, const Vec3& high,
                                 const std::function<bool(const Vec3&)>& inside) {
    stats::Generator chance(stats::bits_at(1, 1, 0));
    const auto within = [&](double half) { return half * (2 * chance.uniform() - 1); };
    const auto cells = [&](std::size_t a) { return std::floor((high[a] - low[a]) / (1.15 * d)); };
    const double nx = cells(0), ny = cells(1);
    std::vector<dem::Sphere> spheres;
    for (int layer = 0;; ++layer) {
        const double z = low[2] + (layer + 0.5) * 1.15 * d;
        if (z > high[2]) throw std::logic_error("the powder does not fit");
        for (int j = 0; j < static_cast<int>(ny); ++j)
            for (int i = 0; i < static_cast<int>(nx); ++i) {
                Vec3 x{low[0] + (i + 0.5) * (high[0] - low[0]) / nx, low[1] + (j + 0.5) * (high[1] - low[1]) / ny, z};
                if (!inside(x)) continue;
                for (double& coordinate : x) coordinate += within(0.05 * d);
                const double radius = d / 2 * (1 + within(spread));
                spheres.push_back(
                    {.position = x, .velocity = {within(0.05), within(0.05), within(0.05)}, .radius = radius});
                if (static_cast<std::int64_t>(spheres.size()) == count) return spheres;
            }
    }
}

dem::Material glass_like(double friction, double rolling_friction) {
    return {.youngs_modulus = 5e6,
            .density = 2500,
            .friction = friction,
            .rolling_friction = rolling_friction,
            .tangential_limit = dem::TangentialLimit::spring};
}

double sphere_volume(double d) {
    return pi / 6 * d * d * d;
}

using Triangles = std::vector<std::array<Vec3, 3>>;

/// Frustum about z of flat facets, from (r0, z0) to (r1, z1).
void add_ring(Triangles& into, double r0, double z0, double r1, double z1) {
    const auto corner = [](double r, int k, double z) {
        const double a = 2 * pi * k / facets;
        return Vec3{r * std::cos(a), r * std::sin(a), z};
    };
    for (int k = 0; k < facets; ++k) {
        const Vec3 a = corner(r0, k, z0), b = corner(r0, k + 1, z0), c = corner(r1, k + 1, z1), d = corner(r1, k, z1);
        into.push_back({a, b, c});
        into.push_back({a, c, d});
    }
}

std::string stl_of(const Triangles& triangles) {
    std::string text = "solid wall\n";
    for (const auto& triangle : triangles) {
        text += "facet normal 0 0 0\nouter loop\n";
        for (const auto& c : triangle) text += fmt::format("vertex {:.17g} {:.17g} {:.17g}\n", c[0], c[1], c[2]);
        text += "endloop\nendfacet\n";
    }
    return text + "endsolid wall\n";
}

dem::Mesh mesh_of(const std::string& stl) {
    return dem::Mesh(geometry::read_stl(stl).surface);
}

std::string primitive(const std::string& fix, const std::string& words) {
    return fmt::format("fix {} all wall/MODEL primitive type 1 {}\n", fix, words);
}

std::string mesh_wall(const std::string& name, double curvature) {
    return fmt::format(
        "fix {0} all mesh/surface file {0}.stl type 1 curvature {1} curvature_tolerant yes\n"
        "fix {0}_wall all wall/MODEL mesh n_meshes 1 meshes {0}\n",
        name, curvature);
}

void replace_all(std::string& text, const std::string& what, const std::string& by) {
    for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size())
        text.replace(at, what.size(), by);
}

}  // namespace

/// Diameter 30 d, 6 d long and periodic, filled to 0.35, Froude number 0.05: 3.1 s from the loose lattice on.
WallDeck drum_deck() {
    const double radius = 15 * grain, length = 6 * grain, omega = std::sqrt(0.05 * 9.81 / radius);
    WallDeck deck;
    deck.name = "drum";
    deck.steps = 38750;
    deck.start.material = glass_like(0.6, 0.1);
    deck.start.time_step = 8e-5;
    deck.start.domain = {{0, -radius - 2 * grain, -radius - 2 * grain},
                         {length, radius + 2 * grain, radius + 2 * grain},
                         {true, false, false}};
    deck.start.spheres = lattice(std::llround(0.35 * pi * radius * radius * length * 0.58 / sphere_volume(grain)),
                                 grain, 0.1, {0, -radius, -radius + 0.1 * grain}, {length, radius, radius},
                                 [radius](const Vec3& x) { return std::hypot(x[1], x[2]) < radius - 0.6 * grain; });
    const geometry::Motion turn = dem::Rotation{.axis = {1, 0, 0}, .speed = -omega};
    deck.start.walls.emplace_back(dem::Cylinder{.axis = {1, 0, 0}, .radius = radius}, std::vector{turn});
    // LIGGGHTS takes the speed at the centre of the sphere for that of the wall's surface.
    deck.running = primitive(
        "drum", fmt::format("xcylinder {:.17g} 0. 0. shear y {:.17g}", radius, -omega * radius / (radius - grain / 2)));
    deck.measured = "angle of the mass centre, degrees";
    deck.figure = [](const dem::State& state) {
        double y = 0, z = 0;
        for (std::size_t i = 0; i < state.id.size(); ++i) {
            const double r = state.radius[i];
            y += r * r * r * state.position[i][1], z += r * r * r * state.position[i][2];
        }
        return std::atan2(-y, -z) * 180 / pi;
    };
    return deck;
}

/// A cylinder of radius 8 d, its flat floor with a round opening of 6.75 d opened after 0.4 s: 1.2 s of outflow.
WallDeck hopper_deck(WallsAs walls) {
    const std::int64_t count = 4000;
    const double radius = 8 * grain, opening = 6.75 * grain / 2;
    // of the area of the circle
    const double corner = opening * std::sqrt(2 * pi / facets / std::sin(2 * pi / facets));
    WallDeck deck;
    deck.name = "hopper";
    deck.settle = 5000;
    deck.steps = 15000;
    deck.start.material = glass_like(0.5, 0);
    deck.start.time_step = 8e-5;
    deck.start.spheres = lattice(count, grain, 0.1, {-radius, -radius, 0.1 * grain}, {radius, radius, 10},
                                 [radius](const Vec3& x) { return std::hypot(x[0], x[1]) < radius - 0.62 * grain; });
    const double out = radius + 3 * grain;
    deck.start.domain = {{-out, -out, -12 * grain}, {out, out, deck.start.spheres.back().position[2] + 6 * grain}, {}};
    const dem::Cylinder container{.radius = radius};
    deck.start.walls = {container, dem::Plane{}};
    Triangles floor;
    const double outer = 1.03 * radius, middle = (opening + outer) / 2;
    add_ring(floor, corner, 0, middle, 0);
    add_ring(floor, middle, 0, outer, 0);
    const std::string stl = stl_of(floor);
    deck.files["floor.stl"] = stl;
    if (walls == WallsAs::triangles)
        deck.then = {container, mesh_of(stl)};
    else
        deck.then = {
            container,
            dem::Tube{
                .base = {0, 0, -grain / 5}, .axis = {0, 0, 1}, .inner = opening, .outer = outer, .length = grain / 5}};
    deck.settling = primitive("side", fmt::format("zcylinder {:.17g} 0. 0.", radius)) + primitive("plug", "zplane 0.");
    deck.running = "unfix plug\n" + mesh_wall("floor", 1);
    deck.measured = "share of the spheres that is out";
    deck.figure = [](const dem::State& state) {
        double above = 0;
        for (const auto& x : state.position) above += x[2] > 0 ? 1 : 0;
        return 1 - above / static_cast<double>(count);
    };
    return deck;
}

/// A tube of radius 6 d, 0.02 d above a plate, lifted with 0.1 m/s after 0.32 s: 1.5 s, then the heap is at rest.
WallDeck heap_deck(WallsAs walls) {
    const double radius = 6 * grain, lift = 0.1, lowest = 0.02 * grain;
    WallDeck deck;
    deck.name = "heap";
    deck.settle = 4000;
    deck.steps = 18750;
    deck.start.material = glass_like(0.4, 0.1);
    deck.start.time_step = 8e-5;
    deck.start.spheres = lattice(2000, grain, 0.1, {-radius, -radius, 0.1 * grain}, {radius, radius, 10},
                                 [radius](const Vec3& x) { return std::hypot(x[0], x[1]) < radius - 0.62 * grain; });
    const double out = 45 * grain, top = deck.start.spheres.back().position[2] + 2 * grain;
    deck.start.domain = {{-out, -out, -grain}, {out, out, top + lift * 1.5 + 4 * grain}, {}};
    Triangles tube;
    constexpr int rows = 6;
    const auto height = [&](int row) { return lowest + (top - lowest) * row / rows; };
    for (int row = 0; row < rows; ++row) add_ring(tube, radius, height(row), radius, height(row + 1));
    const std::string stl = stl_of(tube);
    deck.files["tube.stl"] = stl;
    const auto tube_wall = [&](std::vector<geometry::Motion> motions) {
        if (walls == WallsAs::triangles) return dem::Wall(mesh_of(stl), std::move(motions));
        const dem::Tube curved{.base = {0, 0, lowest},
                               .axis = {0, 0, 1},
                               .inner = radius,
                               .outer = radius + 0.2 * grain,
                               .length = top - lowest};
        return dem::Wall(curved, std::move(motions));
    };
    const double start = deck.start.time_step * static_cast<double>(deck.settle);
    deck.start.walls.emplace_back(dem::Plane{});
    deck.start.walls.push_back(tube_wall({dem::Translation{.velocity = {0, 0, lift}, .start = start}}));
    deck.settling = primitive("plate", "zplane 0.") + mesh_wall("tube", 8);
    deck.running = fmt::format("fix lift all move/mesh mesh tube linear 0. 0. {:.17g}\n", lift);
    deck.measured = "angle of repose by moments, degrees";
    deck.figure = [](const dem::State& state) {
        return observables::heap_shape(state, grain, 45 * grain).angle_moment;
    };
    return deck;
}

/// A roller of radius 8 D with a gap of 2 D, its surface as fast against its travel as it travels: 65 mm at 0.4 m/s.
WallDeck roller_deck() {
    constexpr double d = 2e-3, radius = 8 * d, gap = 2 * d, speed = 0.4, spin = 1, first = 0.015, length = 0.09;
    const double width = 10 * d, axis = first - radius;
    WallDeck deck;
    deck.name = "roller";
    deck.settle = 6000;
    deck.steps = 8125;
    deck.start.material = {
        .youngs_modulus = 21e6, .density = 7980, .friction = 0.2, .tangential_limit = dem::TangentialLimit::spring};
    deck.start.time_step = 2e-5;
    deck.start.spheres = lattice(3000, d, 0, {0, first + 0.05 * d, 0.05 * d}, {width, first + length - 0.05 * d, 10},
                                 [](const Vec3&) { return true; });
    const double top = std::max(deck.start.spheres.back().position[2] + 3 * d, 2 * radius + gap + 10 * d);
    deck.start.domain = {{0, axis - 0.12, -d}, {width, first + length + 0.12, top}, {true, false, false}};
    deck.start.walls = {dem::Plane{}, dem::Plane{{0, first, 0}, {0, 1, 0}},
                        dem::Plane{{0, first + length, 0}, {0, -1, 0}}};
    const Vec3 middle{0, axis, gap + radius};
    deck.then = {dem::Plane{},
                 {dem::Cylinder{.point = middle, .axis = {1, 0, 0}, .radius = radius, .side = dem::Side::outside},
                  {dem::Translation{.velocity = {0, speed, 0}},
                   dem::Rotation{.point = middle, .axis = {1, 0, 0}, .speed = spin * speed / radius}}}};
    deck.settling = primitive("base", "zplane 0.") + primitive("gate0", fmt::format("yplane {:.17g}", first)) +
                    primitive("gate1", fmt::format("yplane {:.17g}", first + length));
    deck.running =
        fmt::format("unfix base\nunfix gate0\nunfix gate1\nvelocity all set 0. {:.17g} 0. sum yes units box\n",
                    -speed) +
        primitive("base", fmt::format("zplane 0. shear y {:.17g}", -speed)) +
        primitive("roller", fmt::format("xcylinder {:.17g} {:.17g} {:.17g} shear y {:.17g}", radius, axis, gap + radius,
                                        spin * speed / (radius + d / 2)));
    deck.measured = "share of the spheres that is passed";
    deck.travelled = {0, static_cast<double>(deck.steps) * deck.start.time_step * speed, 0};
    deck.figure = [edge = axis + deck.travelled[1]](const dem::State& state) {
        double ahead = 0;
        for (const auto& x : state.position) ahead += x[1] > edge ? 1 : 0;
        return 1 - ahead / 3000;
    };
    return deck;
}

void write_deck(const WallDeck& deck, double skin, const std::filesystem::path& folder) {
    const dem::Setup& s = deck.start;
    const bool rolls = s.material.rolling_friction > 0;
    const std::string model =
        std::string("gran model hertz tangential history") + (rolls ? " rolling_friction epsd" : "");
    write_data(s, 1, folder / "start.data");
    for (const auto& [name, text] : deck.files) std::ofstream(folder / name) << text;
    std::string t = fmt::format("atom_style granular\natom_modify map array\nboundary {} f f\nnewton off\n",
                                s.domain.periodic[0] ? 'p' : 'f');
    t += "communicate single vel yes\nunits si\nread_data start.data\n";
    t += fmt::format("neighbor {:.10g} bin\nneigh_modify every 1 delay 0 check yes\n", skin);
    t += properties(s.material, 1) + fmt::format("pair_style {}\npair_coeff * *\n", model);
    t += fmt::format("timestep {:.10g}\n", s.time_step) + gravity_line(s.gravity) + "fix move all nve/sphere\n";
    t += "thermo_style custom step atoms\nthermo 250\nthermo_modify lost ignore norm no\n";
    t += deck.settling;
    if (deck.settle > 0) t += fmt::format("run {}\n", deck.settle);
    t += deck.running + fmt::format("run {}\n", deck.steps);
    t += "dump end all custom 1 end.dump id x y z vx vy vz radius\nrun 0\n";
    replace_all(t, "MODEL", model);
    std::ofstream(folder / "in.walls") << t;
}

dem::State last_frame(const WallDeck& deck, const std::filesystem::path& folder) {
    std::ifstream in(folder / "end.dump");
    dem::State state;
    std::string line;
    while (std::getline(in, line) && line.rfind("ITEM: ATOMS", 0) != 0) continue;
    while (std::getline(in, line) && line.rfind("ITEM", 0) != 0) {
        std::istringstream words(line);
        std::int32_t id = 0;
        Vec3 x{}, v{};
        double radius = 0;
        if (!(words >> id >> x[0] >> x[1] >> x[2] >> v[0] >> v[1] >> v[2] >> radius))
            throw std::runtime_error("a line of LIGGGHTS's frame is not understood: " + line);
        state.id.push_back(id);
        state.position.push_back(x + deck.travelled), state.velocity.push_back(v);
        state.radius.push_back(radius);
        state.mobile.push_back(1);
    }
    if (state.id.empty()) throw std::runtime_error("LIGGGHTS wrote no frame");
    return state;
}

double particle_steps(const std::string& out) {
    std::istringstream in(out);
    double sum = 0;
    std::optional<std::array<double, 2>> before;
    for (std::string line; std::getline(in, line);) {
        std::istringstream words(line);
        std::array<double, 2> now{};
        std::string more;
        if (!(words >> now[0] >> now[1]) || words >> more) continue;
        if (before && now[0] > (*before)[0]) sum += (now[0] - (*before)[0]) * (now[1] + (*before)[1]) / 2;
        before = now;
    }
    return sum;
}

}  // namespace grainsweep::tests
