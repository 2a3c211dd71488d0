// What a step of a clump's sphere costs beside a step of a sphere, in mixed precision on one core.
//
//   bench_clumps [--scene bed|drum] [--shape NAME] [--spheres N] [--path baseline|avx2|avx512] [--rounds N] [--peer
//   none]
//
// Spheres, dumbbells 1.5, tetrahedra and a stone of 12 spheres, all of 5 mm (equal volume), by 400, 4,000 and 20,000
// spheres: settled in a box with periodic sides, and in a turning drum. In each round every shape runs a hundred steps,
// so that a ratio compares times of the same minute. One JSON line per bed: nanoseconds of processor time per sphere
// and step (mean over the rounds, and the least), the ratio of the means to the spheres', touching and listed pairs per
// sphere, and rebuilds of the lists. LIGGGHTS, where it is installed, pours as many of the same shapes into the same
// box from random places and runs from then on (null for the drum and the stone).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iterator>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "solver/dem/fast/mixed_engine.hpp"
#include "solver/machine/grain_shapes.hpp"
#include "stats/random.hpp"
#include "tests/support/clump_cases.hpp"
#include "tests/support/peer_programs.hpp"
#include "tests/support/places.hpp"
#include "tests/support/process.hpp"

using namespace grainsweep;
using namespace geometry;

namespace {

constexpr double diameter = 5e-3, density = 2500, earth = 9.81;
constexpr std::int64_t window = 100;

struct Options {
    std::string scene, shape;
    std::size_t spheres = 0;
    int rounds = 10;
    bool peer = true;
    dem::Method::Path path = dem::Method::Path::best;
};

double processor_seconds() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

std::string stone_file() {
    std::ifstream in(tests::source("configs/machines/stone.stl"), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// Returns a shape with the volume of a sphere of 5 mm; none: spheres.
std::optional<dem::BodyShape> shape_named(const std::string& name) {
    if (name == "sphere") return std::nullopt;
    if (name != "stone_12") return tests::clump_shape(name, density);
    auto clump = machine::mesh_shape(stone_file(), {.most = 12}).clump;
    clump.diameter = diameter;
    return tests::body_shape(clump, density, dem::DampingMass::contact);
}

/// Adds a grain at a random orientation, thrown slowly.
void add_grain(dem::Setup& s, const Vec3& at, const stats::Stream& stream) {
    std::uint64_t draw = 6 * (s.shapes.empty() ? s.spheres.size() : s.bodies.size());
    const auto u = [&] { return stream.uniform(draw++); };
    const Vec3 velocity = {0.1 * (u() - 0.5), 0.1 * (u() - 0.5), 0.1 * (u() - 0.5)};
    if (s.shapes.empty()) {
        s.spheres.push_back({.position = at, .velocity = velocity, .radius = diameter / 2});
        return;
    }
    dem::Body body{.first = s.spheres.size(), .position = at, .velocity = velocity};
    body.orientation = orientation_at(u(), u(), u());
    for (const auto& sphere : dem::members_of(s.shapes[0], body)) s.spheres.push_back(sphere);
    s.bodies.push_back(body);
}

dem::Setup empty_setup(const std::optional<dem::BodyShape>& shape) {
    dem::Setup s;
    s.material = {.youngs_modulus = 5e6, .density = density, .restitution = 0.5, .friction = 0.4};
    s.gravity = {0, 0, -5 * earth};  // until the bed has settled
    s.time_step = 2e-5;
    if (shape) s.shapes = {*shape};
    return s;
}

std::size_t grains_of(const std::optional<dem::BodyShape>& shape, std::size_t spheres) {
    return shape ? spheres / shape->members.size() : spheres;
}
double pitch_of(const std::optional<dem::BodyShape>& shape) {
    return shape ? 2.02 * dem::reach_of(*shape) : 1.02 * diameter;
}
/// Returns the width of a box whose bed is about as high as wide.
double width_of(std::size_t grains, double pitch) {
    const double volume = static_cast<double>(grains) * std::numbers::pi / 6 * diameter * diameter * diameter / 0.6;
    return pitch * std::max(3.0, std::floor(std::cbrt(volume) / pitch));
}

/// Grains on a lattice above a floor; periodic in x and y.
dem::Setup box_of(const std::optional<dem::BodyShape>& shape, std::size_t spheres) {
    dem::Setup s = empty_setup(shape);
    const std::size_t grains = grains_of(shape, spheres);
    const double pitch = pitch_of(shape), width = width_of(grains, pitch);
    const auto side = static_cast<std::size_t>(std::lround(width / pitch));
    const stats::Stream stream(7, 1);
    for (std::size_t k = 0; k < grains; ++k)
        add_grain(s,
                  pitch * Vec3{0.5 + static_cast<double>(k % side), 0.5 + static_cast<double>(k / side % side),
                               0.5 + static_cast<double>(k / side / side)},
                  stream);
    const double height = pitch * (2 + static_cast<double>(grains / side / side));
    s.domain = {{0, 0, -diameter}, {width, width, height}, {true, true, false}};
    s.walls.emplace_back(dem::Plane{{0, 0, 0}, {0, 0, 1}});
    return s;
}

/// Grains on a lattice in a drum with its axis along y, which turns once they have settled; periodic along the axis.
dem::Setup drum_of(const std::optional<dem::BodyShape>& shape, std::size_t spheres) {
    const std::size_t grains = grains_of(shape, spheres);
    const double pitch = pitch_of(shape);
    const auto layers =
        std::max<std::size_t>(3, static_cast<std::size_t>(std::cbrt(static_cast<double>(grains) / std::numbers::pi)));
    const double length = static_cast<double>(layers) * pitch, margin = 2 * diameter;
    // The bed fills less than half of the drum, which holds the lattice.
    const double volume = static_cast<double>(grains) * std::numbers::pi / 6 * diameter * diameter * diameter;
    double radius = std::max(2 * pitch, std::sqrt(volume / (0.45 * 0.6 * std::numbers::pi * length)));
    const auto lattice = [&] {
        std::vector<Vec3> places;
        const auto rows = static_cast<int>(2 * radius / pitch);
        for (int k = 0; k < rows; ++k)
            for (int i = 0; i < rows; ++i)
                for (std::size_t j = 0; j < layers && places.size() < grains; ++j) {
                    const Vec3 at = {(i + 0.5) * pitch - radius, (static_cast<double>(j) + 0.5) * pitch,
                                     (k + 0.5) * pitch - radius};
                    if (std::hypot(at[0], at[2]) < radius - 0.6 * pitch) places.push_back(at);
                }
        return places;
    };
    std::vector<Vec3> places = lattice();
    for (; places.size() < grains; places = lattice()) radius += pitch / 4;
    dem::Setup s = empty_setup(shape);
    s.domain = {
        {-radius - margin, 0, -radius - margin}, {radius + margin, length, radius + margin}, {false, true, false}};
    s.walls = {{dem::Cylinder{.axis = {0, 1, 0}, .radius = radius}}};
    const stats::Stream stream(7, 2);
    for (const Vec3& at : places) add_grain(s, at, stream);
    return s;
}

/// Bed of one shape, settled or flowing, with its engine.
struct Bed {
    std::string shape;
    std::unique_ptr<dem::Engine> engine;
    double seconds = 0, least = 1e300;
    dem::Work before{};
};

/// Returns the setup that continues a state.
dem::Setup continued(dem::Setup s, const dem::Engine& engine) {
    dem::State state;
    engine.state(state);
    for (std::size_t i = 0; i < s.spheres.size(); ++i) {
        s.spheres[i].position = state.position[i];
        s.spheres[i].velocity = state.velocity[i];
        s.spheres[i].angular_velocity = state.angular_velocity[i];
    }
    for (std::size_t b = 0; b < s.bodies.size(); ++b) {
        const dem::BodyState& now = state.bodies[b];
        dem::Body& body = s.bodies[b];
        body.position = now.position, body.orientation = now.orientation;
        body.velocity = now.velocity, body.angular_velocity = now.angular_velocity;
    }
    s.gravity = {0, 0, -earth};
    return s;
}

void fail(const std::string& shape, const dem::Engine& engine, std::size_t spheres) {
    if (engine.fault().empty() && engine.size() == spheres) return;
    fmt::print(stderr, "{}: {} of {} spheres; {}\n", shape, engine.size(), spheres, engine.fault());
    std::exit(1);
}

Bed settled(const std::string& shape, dem::Setup setup, bool turns, dem::Method::Path path) {
    const auto pour = dem::fast::make_mixed_engine(setup, path);
    pour->run(std::llround(0.25 / setup.time_step));
    fail(shape, *pour, setup.spheres.size());
    setup = continued(std::move(setup), *pour);
    Bed bed{.shape = shape, .engine = dem::fast::make_mixed_engine(setup, path)};
    bed.engine->run(std::llround(0.1 / setup.time_step));
    if (turns) {
        const double radius = std::get<dem::Cylinder>(setup.walls[0].shape).radius;
        const double speed = std::sqrt(0.05 * earth / radius);
        setup.walls[0].motions = {dem::Rotation{.axis = {0, 1, 0}, .speed = speed}};
        bed.engine->set_walls(setup.walls);
        bed.engine->run(std::llround(1.2 / speed / setup.time_step));  // it has slid and flows
    }
    fail(shape, *bed.engine, setup.spheres.size());
    return bed;
}

/// Deck of LIGGGHTS 3.8: the same grains, poured from random places into the same box.
std::string deck(const std::optional<dem::BodyShape>& shape, std::size_t grains, double skin, std::int64_t steps) {
    const double width = width_of(grains, pitch_of(shape)), reach = shape ? dem::reach_of(*shape) : diameter / 2;
    const double height =
        static_cast<double>(grains) * std::numbers::pi / 6 * std::pow(diameter, 3) / (0.2 * width * width);
    std::string grain;
    if (shape) {
        grain = fmt::format(
            "fix pt all particletemplate/multisphere 15485863 atom_type 1 density constant {} nspheres {} ntry 100000 "
            "spheres",
            density, shape->members.size());
        for (const auto& m : shape->members)
            grain += fmt::format(" {} {} {} {}", m.place[0], m.place[1], m.place[2], m.radius);
        grain += fmt::format(" type 1 mass {} inertia_tensor {} 0 0 {} 0 {} use_density\n", shape->mass,
                             shape->inertia[0], shape->inertia[1], shape->inertia[2]);
    } else {
        grain = fmt::format(
            "fix pt all particletemplate/sphere 15485863 atom_type 1 density constant {} radius constant {}\n", density,
            diameter / 2);
    }
    return fmt::format(
               "atom_style granular\natom_modify map array sort 0 0\nboundary p p f\nnewton off\n"
               "communicate single vel yes\nprocessors 1 1 1\nunits si\n"
               "region box block 0 {0} 0 {0} {1} {2} units box\ncreate_box 2 box\nneighbor {3} bin\n"
               "neigh_modify every 1 delay 0 check yes\n"
               "fix m1 all property/global youngsModulus peratomtype 5e6 5e6\n"
               "fix m2 all property/global poissonsRatio peratomtype 0.3 0.3\n"
               "fix m3 all property/global coefficientRestitution peratomtypepair 2 0.5 0.5 0.5 0.5\n"
               "fix m4 all property/global coefficientFriction peratomtypepair 2 0.4 0.4 0.4 0.4\n"
               "pair_style gran model hertz tangential history\npair_coeff * *\ntimestep 2e-5\n"
               "fix grav all gravity {4} vector 0 0 -1\n",
               width, -diameter, height + 6 * reach, skin, earth) +
           grain +
           fmt::format(
               "fix pd all particledistribution/discrete 15485867 1 pt 1.0\n"
               "region ri block 0 {0} 0 {0} 0.0005 {1} units box\n"
               "fix ins all insert/pack seed 32452843 distributiontemplate pd vel constant 0. 0. -0.5 {2} "
               "insert_every once maxattempt 500 overlapcheck yes all_in yes region ri ntry_mc 100000 "
               "particles_in_region {3}\n"
               "fix integr all {4}\nthermo_style custom step atoms cpu\nthermo 100000\n"
               "thermo_modify lost ignore norm no\nrun 1\nunfix ins\n"
               "fix floor all wall/gran model hertz tangential history primitive type 2 zplane 0.0\nrun {5}\n",
               width, height + 2 * reach, shape ? "orientation random" : "", grains,
               shape ? "multisphere" : "nve/sphere", steps);
}

/// Returns LIGGGHTS's nanoseconds per sphere and step of a settled bed, from the difference of two runs.
std::optional<double> liggghts(const std::optional<dem::BodyShape>& shape, std::size_t spheres) {
    if (!tests::installed("liggghts")) return std::nullopt;
    constexpr std::int64_t settling = 30000, steps = 2000;
    double seconds[2] = {0, 0};
    for (int k = 0; k < 2; ++k) {
        const tests::Folder folder;
        folder.write("in.clumps", deck(shape, grains_of(shape, spheres), 0.16 * diameter, settling + k * steps));
        const auto ran = tests::run_timed({"liggghts", "-in", "in.clumps", "-log", "none"}, folder.path());
        if (ran.code != 0) {
            fmt::print(stderr, "liggghts ended with {}:\n{}\n", ran.code,
                       ran.out.substr(ran.out.size() - std::min<std::size_t>(400, ran.out.size())));
            return std::nullopt;
        }
        seconds[k] = ran.user_seconds;
    }
    return 1e9 * (seconds[1] - seconds[0]) / steps / static_cast<double>(spheres);
}

void print(const std::string& scene, const Bed& bed, const Bed& spheres, int rounds, std::optional<double> peer) {
    const auto n = static_cast<double>(bed.engine->size());
    const dem::Work after = bed.engine->work();
    const auto steps = static_cast<double>(after.steps - bed.before.steps);
    std::vector<dem::ContactForce> contacts;
    bed.engine->contacts(contacts);
    const auto pairs = std::ranges::count_if(contacts, [](const auto& c) { return c.second >= 0; });
    const auto ns = [&](const Bed& b) {
        return 1e9 * b.seconds / rounds / window / static_cast<double>(b.engine->size());
    };
    fmt::print(
        "{{\"bench\": \"clumps\", \"scene\": \"{}\", \"shape\": \"{}\", \"spheres\": {}, \"ns\": {:.1f}, \"ns_min\": "
        "{:.1f}, \"ratio\": {:.2f}, \"touching_pairs\": {:.2f}, \"touches_of_walls\": {:.2f}, \"listed_pairs\": "
        "{:.2f}, "
        "\"rebuilds_per_1000\": {:.1f}, \"liggghts_ns\": {}}}\n",
        scene, bed.shape, bed.engine->size(), ns(bed), 1e9 * bed.least / window / n, ns(bed) / ns(spheres),
        static_cast<double>(pairs) / n, (static_cast<double>(contacts.size()) - static_cast<double>(pairs)) / n,
        (after.pair_visits - bed.before.pair_visits) / steps / n,
        1000 * static_cast<double>(after.rebuilds - bed.before.rebuilds) / steps,
        peer ? fmt::format("{:.0f}", *peer) : "null");
    std::fflush(stdout);
}

void compare(const Options& o, const std::string& scene, std::size_t spheres) {
    std::vector<Bed> beds;
    for (const char* name : {"sphere", "dumbbell_1_5", "tetra_1_5", "stone_12"}) {
        if (!o.shape.empty() && o.shape != name && std::string(name) != "sphere") continue;
        const auto shape = shape_named(name);
        beds.push_back(
            settled(name, scene == "drum" ? drum_of(shape, spheres) : box_of(shape, spheres), scene == "drum", o.path));
    }
    for (Bed& bed : beds) bed.before = bed.engine->work();
    for (int round = 0; round < o.rounds; ++round)
        for (Bed& bed : beds) {
            const double start = processor_seconds();
            bed.engine->run(window);
            const double spent = processor_seconds() - start;
            bed.seconds += spent;
            bed.least = std::min(bed.least, spent);
        }
    for (const Bed& bed : beds) {
        const bool same = o.peer && scene == "bed" && bed.shape != "stone_12";
        print(scene, bed, beds.front(), o.rounds, same ? liggghts(shape_named(bed.shape), spheres) : std::nullopt);
    }
}

}  // namespace

int main(int argc, char** argv) {
    Options o;
    for (int i = 1; i + 1 < argc; i += 2) {
        const std::string name = argv[i], value = argv[i + 1];
        if (name == "--scene") o.scene = value;
        if (name == "--shape") o.shape = value;
        if (name == "--spheres") o.spheres = std::stoul(value);
        if (name == "--peer") o.peer = value != "none";
        if (name == "--rounds") o.rounds = std::stoi(value);
        if (name == "--path")
            o.path = value == "avx2"     ? dem::Method::Path::avx2
                     : value == "avx512" ? dem::Method::Path::avx512
                                         : dem::Method::Path::baseline;
    }
    if (!tests::installed("liggghts"))
        fmt::print(stderr, "LIGGGHTS is not installed (Debian package liggghts): only grainsweep is measured\n");
    for (const char* scene : {"bed", "drum"})
        for (const std::size_t spheres : {std::size_t{400}, std::size_t{4000}, std::size_t{20000}})
            if ((o.scene.empty() || o.scene == scene) && (o.spheres == 0 || o.spheres == spheres))
                compare(o, scene, spheres);
    return 0;
}
