// A flow step and the levels of coupling on several threads beside the same on one: one JSON line each.
//
//   bench_flow_threads [--what NAME] [--cells N] [--threads N] [--windows N]
//
// Two systems from the same start, one thread and N (2), take turns window by window, on N^3 (40) cells with 3150
// particles. `speedup` is the ratio of their cheapest windows, `speedup_mean` that of all, in elapsed time: on a
// machine that does something else besides, both are too small. `same`: both end with the same state.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "solver/coupling/dense_suspension.hpp"
#include "solver/coupling/projected_contacts.hpp"
#include "solver/coupling/solids_pressure.hpp"
#include "solver/coupling/spring_contacts.hpp"
#include "solver/coupling/suspension.hpp"
#include "solver/flow/flow.hpp"

using namespace grainsweep;
using namespace grainsweep::flow;

namespace {

constexpr std::size_t spheres = 3150;
constexpr double kernel_width = 0.03;

struct Options {
    std::string what;
    int cells = 40, threads = 2, windows = 30;
};

double seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

template <class System>
struct Timed {
    System system;
    double least = 1e300, total = 0;

    void run(int steps) {
        const double start = seconds();
        for (int k = 0; k < steps; ++k) system.step();
        const double spent = seconds() - start;
        least = std::min(least, spent);
        total += spent;
    }
    [[nodiscard]] std::vector<std::byte> bytes() const {
        std::vector<std::byte> all;
        system.save(all);
        return all;
    }
};

template <class Make>
void compare(const Options& o, const std::string& what, Make make) {
    if (!o.what.empty() && o.what != what) return;
    constexpr int window = 10;
    Timed<decltype(make())> one{make()}, several{make()};
    several.system.use(Slabs(o.threads));
    one.run(window), several.run(window);
    one.least = several.least = 1e300;
    one.total = several.total = 0;
    for (int k = 0; k < o.windows; ++k) {
        one.run(window);
        several.run(window);
    }
    std::printf(
        "{\"bench\": \"flow_threads\", \"what\": \"%s\", \"cells\": %d, \"threads\": %d, \"ms_one\": %.3f, "
        "\"ms_several\": %.3f, \"speedup\": %.3f, \"speedup_mean\": %.3f, \"same\": %s}\n",
        what.c_str(), o.cells, o.threads, 1e3 * one.least / window, 1e3 * several.least / window,
        one.least / several.least, one.total / several.total, one.bytes() == several.bytes() ? "true" : "false");
    std::fflush(stdout);
}

/// Run 21 of Manayil Santhosh, Anwar & Lappa (2024) on a uniform grid.
struct Cavity {
    Grid grid;
    Sides sides{{{NoSlip{}, NoSlip{}}, {NoSlip{}, NoSlip{}}, {NoSlip{}, NoSlip{}}}};
    Boussinesq heat;
    double time_step = 2 * std::numbers::pi / 2.33e4 / 32;
    coupling::Sphere sphere{1.65, 3.1e-6, 18, 1.72e9, 1};
    coupling::Walls walls{{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}, {}, sphere.radius(), 1};
    coupling::Cloud cloud = coupling::random_cloud(spheres, walls, stats::Stream(1, 1));

    explicit Cavity(const Axis& axis) : grid{{axis, axis, axis}} {
        heat.sides[2] = {Isothermal{-0.5}, Isothermal{0.5}};
        heat.buoyancy = -18 * 3.04e5;
        heat.vibration = {2.33e4, 0};
    }
    [[nodiscard]] Flow<Boussinesq> fluid() const {
        Flow<Boussinesq> flow({grid, sides, 18, time_step}, heat);
        flow.set_temperature([](double, double, double z) { return z; });
        return flow;
    }
    template <class Level>
    [[nodiscard]] auto dilute(Level level) const {
        return coupling::Suspension<Boussinesq, Level, coupling::Trilinear, coupling::SchillerNaumann>(
            fluid(), heat.vibration, {sphere, time_step}, walls, cloud, std::move(level));
    }
    template <class Interaction>
    [[nodiscard]] auto dense(Interaction interaction) const {
        return coupling::DenseSuspension<Boussinesq, Interaction, coupling::Trilinear, coupling::SchillerNaumann>(
            fluid(), heat.vibration, {sphere, time_step}, walls, cloud, std::move(interaction), kernel_width);
    }
    template <class Temperature>
    [[nodiscard]] auto pressed() const {
        return dense(coupling::SolidsPressure<Temperature>(
            grid, sides, sphere, coupling::Granular::of(sphere, 0.9, 0.63), 1e-3, kernel_width));
    }
};

}  // namespace

int main(int argc, char** argv) {
    Options o;
    for (int i = 1; i + 1 < argc; i += 2) {
        const std::string name = argv[i];
        if (name == "--what") o.what = argv[i + 1];
        if (name == "--cells") o.cells = std::max(4, std::atoi(argv[i + 1]));
        if (name == "--threads") o.threads = std::max(1, std::atoi(argv[i + 1]));
        if (name == "--windows") o.windows = std::max(1, std::atoi(argv[i + 1]));
    }
    const Cavity cavity(Axis::uniform(o.cells, -0.5, 0.5));
    const auto& c = cavity;
    compare(o, "flow", [&] { return c.fluid(); });
    compare(o, "one_way", [&] { return c.dilute(coupling::OneWay{}); });
    compare(o, "two_way", [&] { return c.dilute(coupling::TwoWay(c.grid, c.sides, c.sphere, spheres, kernel_width)); });
    compare(o, "ddpm", [&] { return c.pressed<coupling::AlgebraicTemperature>(); });
    compare(o, "ddpm_ktgf", [&] { return c.pressed<coupling::TransportedTemperature>(); });
    const double stiffness = coupling::SpringContacts::stiffness(c.sphere, 0.01, c.time_step);
    compare(o, "cfd_dem_spring", [&] {
        return c.dense(coupling::SpringContacts(c.sphere, c.walls, {stiffness, 0.9, 0.3}, spheres));
    });
    compare(o, "cfd_dem_projection", [&] { return c.dense(coupling::ProjectedContacts(c.sphere, c.walls)); });
    return 0;
}
