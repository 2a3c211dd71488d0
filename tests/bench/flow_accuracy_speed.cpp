// What accuracy costs in a thermovibrated cube, over grid, wall clustering, steps per period and interpolation.
//
//   bench_flow_accuracy [--most CELLS] [--figure FILE.svg]
//
//   slab           root mean square error of the velocity of the vibrated slab, whose solution is exact, over the peak;
//                  cost: processor time of a period of the flow in a cube of as many cells
//   run 21, 33     kinetic energy of the cube after 0.02 L^2/alpha from rest, through the scene, against 48 cells,
//                  clustering 1.5, 64 steps per period; cost: of a period
//   interpolation  root mean square error of the exact profile gathered at 3150 random places; cost: of one gather
//
// v = Re[Vh exp(i Omega t)],  Vh(z) = -(B/Omega) [z - sinh(k z)/(2 sinh(k/2))],  k = sqrt(i Omega/Pr),
// under the force B z sin(Omega t) between walls at z = -1/2 and 1/2; run 21 of IAC-24-A1.2.3. One JSON line per
// setting.
#include "solver/coupling/cloud.hpp"
#include "solver/flow/flow.hpp"
#include "solver/scenes/scene.hpp"
#include "tests/support/trade_off.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdio>
#include <ctime>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

using namespace grainsweep;
using namespace grainsweep::flow;

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double prandtl = 18;
constexpr double frequency = 1.667e4;
constexpr double buoyancy = 18 * 4.81e5;

std::complex<double> amplitude(double z) {
    const auto k = std::sqrt(std::complex<double>(0, frequency / prandtl));
    return -(buoyancy / frequency) * (z - std::sinh(k * z) / (2.0 * std::sinh(0.5 * k)));
}
double exact(double z, double t) {
    return (amplitude(z) * std::exp(std::complex<double>(0, frequency * t))).real();
}

Boussinesq heat_along_z(double strength) {
    Boussinesq heat;
    heat.sides[2] = {Isothermal{-0.5}, Isothermal{0.5}};
    heat.buoyancy = strength;
    heat.vibration = {frequency, 0};
    return heat;
}

// Root of the mean square over the last of four periods, relative to the peak of the profile.
double slab_error(int cells, double clustering, int steps) {
    const Axis once = Axis::uniform(1, -0.5, 0.5);
    const Axis across = Axis::clustered(cells, -0.5, 0.5, clustering);
    const Sides sides{{{Periodic{}, Periodic{}}, {Periodic{}, Periodic{}}, {NoSlip{}, NoSlip{}}}};
    const double dt = 2 * pi / frequency / steps;
    Flow<Boussinesq> flow({{{once, once, across}}, sides, prandtl, dt}, heat_along_z(buoyancy));
    flow.set_temperature([](double, double, double z) { return z; });
    flow.set_velocity([](double, double, double z) { return std::array<double, 3>{0, exact(z, 0), 0}; });
    double peak = 0;
    for (int k = 1; k <= cells; ++k) peak = std::max(peak, std::abs(amplitude(across.centre(k))));
    double square = 0, weight = 0;
    for (int s = 1; s <= 4 * steps; ++s) {
        flow.step();
        if (s <= 3 * steps) continue;
        for (int k = 1; k <= cells; ++k) {
            const double off = (flow.velocity()[1](1, 1, k) - exact(across.centre(k), s * dt)) / peak;
            square += off * off * across.width(k);
            weight += across.width(k);
        }
    }
    return std::sqrt(square / weight);
}

template <class Work>
double milliseconds(int calls, Work work) {
    work();
    double best = 1e300;
    for (int batch = 0; batch < 3; ++batch) {
        const std::clock_t start = std::clock();
        for (int n = 0; n < calls; ++n) work();
        best = std::min(best, 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC / calls);
    }
    return best;
}

double cube_step(int cells) {
    const Axis axis = Axis::uniform(cells, -0.5, 0.5);
    const Sides walls{{{NoSlip{}, NoSlip{}}, {NoSlip{}, NoSlip{}}, {NoSlip{}, NoSlip{}}}};
    Flow<Boussinesq> flow({{{axis, axis, axis}}, walls, prandtl, 1e-5}, heat_along_z(-buoyancy));
    flow.set_temperature([](double, double, double z) { return z; });
    return milliseconds(3, [&] { flow.step(); });
}

std::vector<tests::Setting> settings;

void add(const std::string& scene, const std::string& name, const std::string& measured, double error, double seconds,
         bool is_reference = false) {
    settings.push_back({scene, name, measured, seconds, error, 0, is_reference, false, false});
}

std::string name_of(int cells, double clustering, int steps) {
    return fmt::format("{}, c {}, P/{}", cells, clustering, steps);
}

// Kinetic energy at the end of the start-up, and the processor time of a period.
std::pair<double, double> cube(double rayleigh, double omega, int cells, double clustering, int steps) {
    const SceneInfo& info = *find_scene("thermovibration");
    Inputs inputs = info.defaults();
    inputs["rayleigh"] = rayleigh;
    inputs["frequency"] = omega;
    inputs["particles"] = std::int64_t{0};
    inputs["symmetry"] = std::string("mirror");
    inputs["cells"] = std::int64_t{cells};
    inputs["clustering"] = clustering;
    inputs["steps_per_period"] = std::int64_t{steps};
    inputs["end_time"] = 0.02;
    NoArtefacts none;
    const auto scene = info.make(inputs, 1, none);
    const std::clock_t start = std::clock();
    scene->advance(1);
    const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    Observations found;
    scene->observe(found);
    return {found.scalars.at("kinetic_energy"), seconds / (0.02 * omega / (2 * pi))};
}

// The exact profile at a quarter period on the nodes, gathered at 3150 random places.
template <class Kernel>
void interpolate(const char* name, int cells, double clustering) {
    const Axis axis = Axis::clustered(cells, -0.5, 0.5, clustering);
    const Grid grid{{axis, axis, axis}};
    auto field = face_vectors(grid);
    const double t = 0.5 * pi / frequency * 0.1;
    double peak = 0;
    for (int k = 1; k <= cells; ++k) {
        peak = std::max(peak, std::abs(exact(axis.centre(k), t)));
        for (int j = 1; j <= cells + 1; ++j)
            for (int i = 1; i <= cells; ++i) field[1](i, j, k) = exact(axis.centre(k), t);
    }
    for (int j = 0; j <= cells + 1; ++j)  // no-slip in z alone: the slab has no other walls
        for (int i = 0; i <= cells + 1; ++i) {
            field[1](i, j, 0) = -field[1](i, j, 1);
            field[1](i, j, cells + 1) = -field[1](i, j, cells);
        }
    const coupling::Walls box{{-0.4, -0.4, -0.5}, {0.4, 0.4, 0.5}, {}, 0, 1};
    const auto cloud = coupling::random_cloud(3150, box, stats::Stream(1, 1));
    double square = 0;
    const double cost = milliseconds(3, [&] {
        square = 0;
        for (const auto& x : cloud.position) {
            const coupling::Stencil<Kernel> stencil(grid, {}, x);
            const double off = (stencil.gather(field)[1] - exact(x[2], t)) / peak;
            square += off * off / 3150;
        }
    });
    const double function = milliseconds(3, [&] {
        double sum = 0;
        for (const auto& x : cloud.position) sum += exact(x[2], t);
        if (sum == 1) std::puts("");
    });
    add("interpolation", fmt::format("{} {}, c {}", name, cells, clustering), "velocity", std::sqrt(square),
        1e-3 * (cost - function));
}

}  // namespace

int main(int argc, char** argv) {
    int most = 48;
    std::string figure;
    for (int k = 1; k + 1 < argc; k += 2) {
        if (std::string(argv[k]) == "--most") most = std::stoi(argv[k + 1]);
        if (std::string(argv[k]) == "--figure") figure = argv[k + 1];
    }
    for (const auto& [run, rayleigh, omega] : {std::tuple{"run 21", 481e3, 16670.0}, {"run 33", 1770e3, 23300.0}}) {
        const auto [exact_energy, exact_cost] = cube(rayleigh, omega, 48, 1.5, 64);
        add(run, name_of(48, 1.5, 64), "kinetic energy", 0, exact_cost, true);
        for (const int cells : {20, 24, 28, 32, 40})
            for (const double clustering : {0.0, 1.5, 2.0})
                for (const int steps : {16, 24, 32}) {
                    const auto [energy, cost] = cube(rayleigh, omega, cells, clustering, steps);
                    add(run, name_of(cells, clustering, steps), "kinetic energy", energy / exact_energy - 1, cost);
                }
    }
    for (const int cells : {20, 24, 28, 32, 40, 48, 64, 80}) {
        if (cells > most) continue;
        const double step = 1e-3 * cube_step(cells);
        for (const double clustering : {0.0, 1.5, 2.0})
            for (const int steps : {8, 16, 24, 32, 64})
                add("slab", name_of(cells, clustering, steps), "velocity", slab_error(cells, clustering, steps),
                    steps * step);
        for (const double clustering : {0.0, 1.5}) {
            interpolate<coupling::Trilinear>("trilinear", cells, clustering);
        }
    }
    tests::mark_dominated(settings);
    for (const auto& s : settings) std::printf("%s\n", tests::json_line(s).c_str());
    if (!figure.empty()) tests::draw(settings, figure);
    return 0;
}
