// What accuracy costs: the vibrated slab, whose solution is exact, over grid, clustering, steps per period and
// interpolation. JSON lines {program, what, cells, clustering, steps_per_period, interpolation, error_max, error_rms,
// milliseconds}: errors over the peak of the profile; milliseconds of processor time, of the flow in a cube of as many
// cells per period, of the interpolation for 3150 particles.   bench_flow_accuracy_reference [MOST CELLS]
//
// v = Re[Vh exp(i Omega t)],  Vh(z) = -(B/Omega) [z - sinh(k z)/(2 sinh(k/2))],  k = sqrt(i Omega/Pr),
// under the force B z sin(Omega t) between walls at z = -1/2 and 1/2; run 21 of IAC-24-A1.2.3.
#include "solver/coupling/cloud.hpp"
#include "solver/flow/flow.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdio>
#include <cstdlib>
#include <ctime>

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

struct Error {
    double largest = 0, rms = 0;
};

Boussinesq heat_along_z(double strength) {
    Boussinesq heat;
    heat.sides[2] = {Isothermal{-0.5}, Isothermal{0.5}};
    heat.buoyancy = strength;
    heat.vibration = {frequency, 0};
    return heat;
}

// Over the last of four periods, relative to the peak of the profile.
Error slab_error(int cells, double clustering, int steps) {
    const Axis once = Axis::uniform(1, -0.5, 0.5);
    const Axis across = Axis::clustered(cells, -0.5, 0.5, clustering);
    const Sides sides{{{Periodic{}, Periodic{}}, {Periodic{}, Periodic{}}, {NoSlip{}, NoSlip{}}}};
    const double dt = 2 * pi / frequency / steps;
    Flow<Boussinesq> flow({{{once, once, across}}, sides, prandtl, dt}, heat_along_z(buoyancy));
    flow.set_temperature([](double, double, double z) { return z; });
    flow.set_velocity([](double, double, double z) { return std::array<double, 3>{0, exact(z, 0), 0}; });
    double peak = 0;
    for (int k = 1; k <= cells; ++k) peak = std::max(peak, std::abs(amplitude(across.centre(k))));
    Error error;
    double weight = 0;
    for (int s = 1; s <= 4 * steps; ++s) {
        flow.step();
        if (s <= 3 * steps) continue;
        for (int k = 1; k <= cells; ++k) {
            const double off = (flow.velocity()[1](1, 1, k) - exact(across.centre(k), s * dt)) / peak;
            error.largest = std::max(error.largest, std::abs(off));
            error.rms += off * off * across.width(k);
            weight += across.width(k);
        }
    }
    error.rms = std::sqrt(error.rms / weight);
    return error;
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

void print(const char* what, int cells, double clustering, int steps, const char* kernel, const Error& error,
           double cost) {
    std::printf(R"({"program":"bench_flow_accuracy","what":"%s","cells":%d,"clustering":%g,"steps_per_period":%d,)"
                R"("interpolation":"%s","error_max":%.3g,"error_rms":%.3g,"milliseconds":%.4g})"
                "\n",
                what, cells, clustering, steps, kernel, error.largest, error.rms, cost);
    std::fflush(stdout);
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
    Error error;
    const double cost = milliseconds(3, [&] {
        error = {};
        for (const auto& x : cloud.position) {
            const coupling::Footing<Kernel> foot(grid, {}, x);
            const double off = (foot.gather(field)[1] - exact(x[2], t)) / peak;
            error.largest = std::max(error.largest, std::abs(off));
            error.rms += off * off / 3150;
        }
    });
    const double function = milliseconds(3, [&] {
        double sum = 0;
        for (const auto& x : cloud.position) sum += exact(x[2], t);
        if (sum == 1) std::puts("");
    });
    error.rms = std::sqrt(error.rms);
    print("interpolation", cells, clustering, 0, name, error, cost - function);
}

}  // namespace

int main(int argc, char** argv) {
    const int most = argc > 1 ? std::atoi(argv[1]) : 80;
    for (const int cells : {20, 32, 40, 64, 80}) {
        if (cells > most) continue;
        const double step = cube_step(cells);
        for (const double clustering : {0.0, 1.0, 1.5, 2.0})
            for (const int steps : {8, 16, 32, 64, 128, 256})
                print("slab", cells, clustering, steps, "", slab_error(cells, clustering, steps), steps * step);
        for (const double clustering : {0.0, 1.5}) {
            interpolate<coupling::Trilinear>("trilinear", cells, clustering);
            interpolate<coupling::Solenoidal>("solenoidal", cells, clustering);
        }
    }
    return 0;
}
