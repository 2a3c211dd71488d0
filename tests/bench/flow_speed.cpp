// Cost of a flow step and its parts: JSON lines {program, compiler, what, cells, milliseconds}, processor time per
// call, best of five batches.   bench_flow [CELLS [CALLS [NAME]]]
#include "solver/coupling/dense_suspension.hpp"
#include "solver/coupling/drag.hpp"
#include "solver/coupling/march.hpp"
#include "solver/coupling/periodic_flow.hpp"
#include "solver/coupling/projected_contacts.hpp"
#include "solver/coupling/solids_pressure.hpp"
#include "solver/coupling/spring_contacts.hpp"
#include "solver/coupling/suspension.hpp"
#include "solver/flow/flow.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>

using namespace grainsweep::flow;

namespace {

constexpr double pi = 3.14159265358979323846;

std::string wanted;  // only lines whose name contains it
int cells = 40;
int calls = 50;

template <class Work>
double milliseconds(Work work) {
    work();
    double best = 1e300;
    for (int batch = 0; batch < 5; ++batch) {
        const std::clock_t start = std::clock();
        for (int n = 0; n < calls; ++n) work();
        best = std::min(best, 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC / calls);
    }
    return best;
}

template <class Work>
void measure(const std::string& what, Work work) {
    if (what.find(wanted) == std::string::npos) return;
    std::printf(R"({"program":"bench_flow","compiler":"%s","what":"%s","cells":%d,"milliseconds":%.4f})"
                "\n",
                __VERSION__, what.c_str(), cells, milliseconds(work));
    std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc > 1) cells = std::atoi(argv[1]);
    if (argc > 2) calls = std::atoi(argv[2]);
    if (argc > 3) wanted = argv[3];
    const int n = cells;
    const Axis axis = Axis::uniform(n, -0.5, 0.5);
    const Grid grid{{axis, axis, axis}};
    const Sides walls{{{NoSlip{}, NoSlip{}}, {NoSlip{}, NoSlip{}}, {NoSlip{}, NoSlip{}}}};
    const double frequency = 2.33e4;
    const FlowSetup setup{grid, walls, 18, 2 * pi / frequency / 32};
    Boussinesq heat;
    heat.sides[2] = {Isothermal{-0.5}, Isothermal{0.5}};
    heat.buoyancy = -18 * 3.04e5;
    heat.vibration = {frequency, 0};
    Flow<Boussinesq> flow(setup, heat);
    flow.set_temperature([](double, double, double z) { return z; });

    measure("flow_step", [&] { flow.step(); });
    const Grid half_grid{{n % 2 == 0 ? axis.lower_half() : axis, axis, axis}};
    Sides half_walls = walls;
    half_walls[0][1] = FreeSlip{};
    Flow<Boussinesq> half({half_grid, half_walls, 18, setup.time_step}, heat);
    half.set_temperature([](double, double, double z) { return z; });
    if (n % 2 == 0) measure("flow_step_mirrored", [&] { half.step(); });
    FaceVectors velocity = face_vectors(grid);
    FaceVectors acceleration = face_vectors(grid);
    measure("midpoint", [&] { flow.midpoint(velocity, acceleration); });

    Poisson poisson(grid, walls);
    std::vector<double> values(grid.total_cells());
    for (std::size_t m = 0; m < values.size(); ++m) values[m] = static_cast<double>(m % 7) - 3;
    measure("poisson", [&] { poisson.solve(values); });

    ImplicitDiffusion diffusion(grid, velocity_edges(walls, 1), 18 * setup.time_step / 2);
    grainsweep::flow::Field right = flow.velocity()[1];
    grainsweep::flow::Field solution(grid);
    measure("implicit_diffusion", [&] { diffusion.solve(right, solution); });

    const Weights weights(grid, velocity_edges(walls, 1));
    measure("momentum_transport", [&] {
        momentum_transport(1, flow.velocity(), weights, {n, n, n}, 18, right, solution);
    });

    namespace coupling = grainsweep::coupling;
    const coupling::Sphere sphere{1.65, 3.1e-6, 18, 1.72e9, 1};
    const coupling::Walls box{{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}, {}, sphere.radius(), 1};
    const coupling::Motion<coupling::SchillerNaumann> motion(sphere, setup.time_step);
    const std::size_t particles = 3150;
    const auto cloud = coupling::random_cloud(particles, box, grainsweep::stats::Stream(1, 1));
    const auto suspension = [&]<class Kernel, class Level>(Kernel, Level level) {
        return coupling::Suspension<Boussinesq, Level, Kernel, coupling::SchillerNaumann>(flow, heat.vibration, motion,
                                                                                          box, cloud, std::move(level));
    };
    auto one_way = suspension(coupling::Trilinear{}, coupling::OneWay{});
    measure("one_way_trilinear", [&] { one_way.step(); });
    if (n % 2 == 0) {
        coupling::Suspension<Boussinesq, coupling::OneWayMirrored, coupling::Trilinear, coupling::SchillerNaumann>
            mirrored(half, heat.vibration, motion, box, cloud, coupling::OneWayMirrored{});
        measure("one_way_mirrored", [&] { mirrored.step(); });
    }
    auto two_way = suspension(coupling::Trilinear{}, coupling::TwoWay(grid, walls, sphere, particles, 0.03));
    measure("two_way_force", [&] { two_way.step(); });

    const auto dense = [&]<class Interaction>(const char* what, Interaction interaction) {
        coupling::DenseSuspension<Boussinesq, Interaction, coupling::Trilinear, coupling::SchillerNaumann> together(
            flow, heat.vibration, motion, box, cloud, std::move(interaction), 0.03);
        measure(what, [&] { together.step(); });
    };
    const auto grains = coupling::Granular::of(sphere, 0.9, 0.63);
    dense("ddpm", coupling::SolidsPressure<coupling::AlgebraicTemperature>(grid, walls, sphere, grains, 1e-3, 0.03));
    dense("ddpm_ktgf",
          coupling::SolidsPressure<coupling::TransportedTemperature>(grid, walls, sphere, grains, 1e-3, 0.03));
    const double stiffness = coupling::SpringContacts::stiffness(sphere, 0.01, setup.time_step);
    dense("cfd_dem_spring", coupling::SpringContacts(sphere, box, {stiffness, 0.9, 0.3}, particles));
    dense("cfd_dem_projection", coupling::ProjectedContacts(sphere, box));

    coupling::PeriodSum period(grid);
    for (int s = 0; s < 32; ++s) period.add(2 * pi * (s + 0.5) / 32, 32, velocity, acceleration);
    const coupling::PeriodicFlow periodic(grid, period);
    auto carried = cloud;
    coupling::VisitOrder order;
    int step = 0;
    measure("replay_trilinear", [&] {
        const double phase = 2 * pi * (step++ % 32 + 0.5) / 32;
        const double c = std::cos(phase);
        const double s = std::sin(phase);
        const std::array<double, 5> basis{1, c, s, c * c - s * s, 2 * s * c};
        using Stencil = coupling::Stencil<coupling::Trilinear>;
        coupling::march(
            carried, motion, box, std::sin(phase), order.of(carried, grid),
            [&](std::size_t p) { return Stencil(grid, box.periodic, box.clipped(carried.position[p])); },
            [&](std::size_t, const Stencil& stencil) { return periodic.at(stencil, basis); },
            [](std::size_t, const coupling::Vec3&) {});
    });
    return 0;
}
