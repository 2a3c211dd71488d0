// Cost of a flow step and its parts, one core: JSON lines {program, build, cells, milliseconds per call, ...}.
#include "solver/flow/flow.hpp"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>

using namespace grainsweep::flow;

namespace {

constexpr double pi = 3.14159265358979323846;

template <class Work>
double milliseconds(int calls, Work work) {
    work();
    double best = 1e300;
    for (int batch = 0; batch < 5; ++batch) {
        const auto start = std::chrono::steady_clock::now();
        for (int n = 0; n < calls; ++n) work();
        const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - start;
        best = std::min(best, spent.count() / calls);
    }
    return best;
}

void report(const char* what, int cells, double ms) {
    std::printf(R"({"program":"bench_flow","compiler":"%s","what":"%s","cells":%d,"milliseconds":%.4f})"
                "\n",
                __VERSION__, what, cells, ms);
    std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
    const int n = argc > 1 ? std::atoi(argv[1]) : 40;
    const int calls = argc > 2 ? std::atoi(argv[2]) : 50;
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

    report("flow_step", n, milliseconds(calls, [&] { flow.step(); }));
    FaceVectors velocity = face_vectors(grid);
    FaceVectors acceleration = face_vectors(grid);
    report("midpoint", n, milliseconds(calls, [&] { flow.midpoint(velocity, acceleration); }));

    Poisson poisson(grid, walls);
    std::vector<double> values(grid.total_cells());
    for (std::size_t m = 0; m < values.size(); ++m) values[m] = static_cast<double>(m % 7) - 3;
    report("poisson", n, milliseconds(calls, [&] { poisson.solve(values); }));

    ImplicitDiffusion diffusion(grid, velocity_edges(walls, 1), 18 * setup.time_step / 2);
    Field right = flow.velocity()[1];
    Field solution(grid);
    report("implicit_diffusion", n, milliseconds(calls, [&] { diffusion.solve(right, solution); }));

    const Weights weights(grid, velocity_edges(walls, 1));
    report("momentum_transport", n, milliseconds(calls, [&] {
               momentum_transport(1, flow.velocity(), weights, {n, n, n}, 18, right, solution);
           }));
    return 0;
}
