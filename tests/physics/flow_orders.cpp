// Exact solutions of the flow room: Taylor-Green vortex, oscillating slab, conservation.
#include "solver/flow/flow.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

namespace grainsweep::tests::flow_orders_test {

using namespace flow;

constexpr double pi = std::numbers::pi;

// u = sin(pi x) cos(pi y) e^{-2 pi^2 nu t}, v = -cos(pi x) sin(pi y) e^..., in a box of free-slip planes, tilted
// into any two of the three axes.
struct TaylorGreen {
    int first = 0, second = 1;
    double viscosity = 0.05;

    [[nodiscard]] std::array<double, 3> at(double t, const std::array<double, 3>& x) const {
        const double decay = std::exp(-2 * pi * pi * viscosity * t);
        const auto a = static_cast<std::size_t>(first);
        const auto b = static_cast<std::size_t>(second);
        std::array<double, 3> v{};
        v[a] = std::sin(pi * x[a]) * std::cos(pi * x[b]) * decay;
        v[b] = -std::cos(pi * x[a]) * std::sin(pi * x[b]) * decay;
        return v;
    }
    [[nodiscard]] double pressure(double t, const std::array<double, 3>& x) const {
        const double decay = std::exp(-4 * pi * pi * viscosity * t);
        return 0.25 * decay *
               (std::cos(2 * pi * x[static_cast<std::size_t>(first)]) +
                std::cos(2 * pi * x[static_cast<std::size_t>(second)]));
    }
};

Flow<NoHeat> vortex_box(const TaylorGreen& exact, int n, double dt, double clustering) {
    const auto axis = [&](int d) {
        return d == exact.first || d == exact.second ? Axis::clustered(n, 0, 1, clustering) : Axis::uniform(1, 0, 1);
    };
    const std::array<Side, 2> slip{FreeSlip{}, FreeSlip{}};
    Flow<NoHeat> flow({Grid{{axis(0), axis(1), axis(2)}}, {slip, slip, slip}, exact.viscosity, dt}, NoHeat{});
    flow.set_velocity([&](double x, double y, double z) { return exact.at(0, {x, y, z}); });
    return flow;
}

double velocity_error(const Flow<NoHeat>& flow, const TaylorGreen& exact) {
    double sum = 0;
    double volume = 0;
    const Grid& grid = flow.grid();
    for (int d = 0; d < 3; ++d)
        for (int k = 1; k <= grid.cells(2); ++k)
            for (int j = 1; j <= grid.cells(1); ++j)
                for (int i = 1; i <= grid.cells(0); ++i) {
                    std::array<double, 3> x{grid[0].centre(i), grid[1].centre(j), grid[2].centre(k)};
                    x[static_cast<std::size_t>(d)] = grid[d].face(d == 0 ? i : d == 1 ? j : k);
                    const double error = flow.velocity()[static_cast<std::size_t>(d)](i, j, k) -
                                         exact.at(flow.time(), x)[static_cast<std::size_t>(d)];
                    const double cell = grid[0].width(i) * grid[1].width(j) * grid[2].width(k);
                    sum += error * error * cell;
                    volume += cell / 3;
                }
    return std::sqrt(sum / volume);
}

double pressure_error(const Flow<NoHeat>& flow, const TaylorGreen& exact) {
    double sum = 0;
    const Grid& grid = flow.grid();
    for (int k = 1; k <= grid.cells(2); ++k)
        for (int j = 1; j <= grid.cells(1); ++j)
            for (int i = 1; i <= grid.cells(0); ++i) {
                // The pressure belongs to the middle of the last step.
                const double error = flow.pressure()(i, j, k) -
                                     exact.pressure(flow.time() - 0.5 * flow.time_step(),
                                                    {grid[0].centre(i), grid[1].centre(j), grid[2].centre(k)});
                sum += error * error * grid[0].width(i) * grid[1].width(j) * grid[2].width(k);
            }
    return std::sqrt(sum);
}

struct Errors {
    double velocity, pressure, divergence;
};

Errors run_vortex(const TaylorGreen& exact, int n, int steps, double end, double clustering) {
    auto flow = vortex_box(exact, n, end / steps, clustering);
    for (int s = 0; s < steps; ++s) flow.step();
    return {velocity_error(flow, exact), pressure_error(flow, exact), flow.largest_divergence()};
}

double observed_order(double coarse, double fine) {
    return std::log2(coarse / fine);
}

// h and dt halve together, on every pair of axes, uniform and clustered: the asymptotic order is 2 and the measured
// one must lie within 0.15 of it (the next term of the error expansion is an order smaller at n = 32).
TEST(TaylorGreen, SecondOrderInSpaceAndTimeTogether) {
    for (const auto& [first, second] : {std::pair{0, 1}, std::pair{1, 2}, std::pair{2, 0}})
        for (const double clustering : {0.0, 1.2}) {
            const TaylorGreen exact{first, second};
            const Errors coarse = run_vortex(exact, 16, 25, 0.5, clustering);
            const Errors middle = run_vortex(exact, 32, 50, 0.5, clustering);
            const Errors fine = run_vortex(exact, 64, 100, 0.5, clustering);
            EXPECT_NEAR(observed_order(middle.velocity, fine.velocity), 2, 0.15) << first << second << clustering;
            EXPECT_NEAR(observed_order(middle.pressure, fine.pressure), 2, 0.25) << first << second << clustering;
            EXPECT_LT(fine.velocity, middle.velocity);
            EXPECT_LT(middle.velocity, coarse.velocity);
            EXPECT_LT(fine.divergence, 1e-11);
            RecordProperty("velocity_order", std::to_string(observed_order(middle.velocity, fine.velocity)));
        }
}

// On one grid the spatial error is the same for every dt, so differences of successive solutions show the order in
// time alone.
TEST(TaylorGreen, SecondOrderInTime) {
    const TaylorGreen exact{0, 1, 0.05};
    constexpr int n = 24;
    const auto solution = [&](int steps) {
        auto flow = vortex_box(exact, n, 0.5 / steps, 0);
        for (int s = 0; s < steps; ++s) flow.step();
        return flow.velocity()[0].values();
    };
    const auto difference = [](const std::vector<double>& a, const std::vector<double>& b) {
        double sum = 0;
        for (std::size_t m = 0; m < a.size(); ++m) sum += (a[m] - b[m]) * (a[m] - b[m]);
        return std::sqrt(sum);
    };
    const auto s1 = solution(20);
    const auto s2 = solution(40);
    const auto s3 = solution(80);
    EXPECT_NEAR(observed_order(difference(s1, s2), difference(s2, s3)), 2, 0.15);
}

// Infinite slab |z| < 1/2, v = v(z, t), theta = z: v = Re[Vh e^{i Omega t}] up to a phase,
// Vh = -(B/Omega)[z - sinh(kz)/(2 sinh(k/2))], k = sqrt(i Omega/Pr), for the force -B z sin(Omega t).
std::complex<double> slab_amplitude(double forcing, double frequency, double viscosity, double z) {
    const std::complex<double> k = std::sqrt(std::complex<double>(0, frequency / viscosity));
    return -(forcing / frequency) * (z - std::sinh(k * z) / (2.0 * std::sinh(k * 0.5)));
}

// Largest error over the height at the end of the 12th period, over the peak of the exact solution.
double slab_error(int n, int steps_per_period, double clustering) {
    constexpr double frequency = 1.667e4;
    constexpr double forcing = 18 * 4.81e5;
    const Axis thin = Axis::uniform(1, -0.5, 0.5);
    const std::array<Side, 2> periodic{Periodic{}, Periodic{}};
    const double dt = 2 * pi / frequency / steps_per_period;
    Boussinesq heat;
    heat.sides[2] = {Isothermal{-0.5}, Isothermal{0.5}};
    heat.buoyancy = forcing;
    heat.vibration = {frequency, pi / 2};
    Flow<Boussinesq> flow({Grid{{thin, thin, Axis::clustered(n, -0.5, 0.5, clustering)}},
                           {periodic, periodic, {NoSlip{}, NoSlip{}}},
                           18,
                           dt},
                          heat);
    flow.set_temperature([](double, double, double z) { return z; });
    // The force +B z cos(Omega t) = Re[B z e^{i Omega t}] answers with Vh' = (B/(i Omega))[...] = i Vh.
    const auto exact = [&](double z, double t) {
        return (std::complex<double>(0, 1) * slab_amplitude(forcing, frequency, 18, z) *
                std::exp(std::complex<double>(0, frequency * t)))
            .real();
    };
    // Starting on the exact solution leaves no transient.
    flow.set_velocity([&](double, double, double z) { return std::array{0.0, exact(z, 0), 0.0}; });
    for (int s = 0; s < 12 * steps_per_period; ++s) flow.step();
    double error = 0;
    double peak = 0;
    // Over one more period, so that amplitude and phase both count.
    for (int s = 0; s < steps_per_period; ++s) {
        flow.step();
        for (int k = 1; k <= n; ++k) {
            const double z = flow.grid()[2].centre(k);
            error = std::max(error, std::abs(flow.velocity()[1](1, 1, k) - exact(z, flow.time())));
            peak = std::max(peak, std::abs(slab_amplitude(forcing, frequency, 18, z)));
        }
    }
    return error / peak;
}

TEST(OscillatingSlab, ExactAmplitudesAreThePublishedOnes) {
    // Independent values of the formula itself: |Vh|(0.25) and the largest |Vh| of three runs.
    EXPECT_NEAR(std::abs(slab_amplitude(8.658e6, 1.667e4, 18, 0.25)), 129.107, 2e-3);
    EXPECT_NEAR(std::abs(slab_amplitude(8.658e6, 1.667e4, 18, 0.4175)), 229.85, 1e-2);
    EXPECT_NEAR(std::abs(slab_amplitude(3.186e7, 2.33e4, 18, 0.4278)), 622.54, 5e-2);
    EXPECT_NEAR(std::abs(slab_amplitude(5.472e6, 2.33e4, 18, 0.25)), 58.510, 2e-3);
}

// Uniform grids reach the asymptotic range late (the Stokes layer is 1.9 cells at n = 40): order above 1.7 from
// 80 to 160 cells, and the error figures of the semi-discrete solution, 5.7 % at 40 cells and 1.7 % at 80.
TEST(OscillatingSlab, ErrorFallsWithTheSquareOfTheCellWidth) {
    const double at_40 = slab_error(40, 128, 0);
    const double at_80 = slab_error(80, 128, 0);
    const double at_160 = slab_error(160, 256, 0);
    EXPECT_NEAR(at_40, 0.057, 0.006);
    EXPECT_NEAR(at_80, 0.017, 0.003);
    EXPECT_NEAR(observed_order(at_80, at_160), 2, 0.3);
    // Clustered, the same number of cells is right to a percent, an eighth of the error.
    EXPECT_LT(slab_error(40, 128, 1.5), 0.01);
}

TEST(OscillatingSlab, SecondOrderInTime) {
    const double floor_error = slab_error(160, 512, 1.5);
    const double coarse = slab_error(160, 12, 1.5);
    const double fine = slab_error(160, 24, 1.5);
    EXPECT_LT(floor_error, 0.15 * fine);
    EXPECT_NEAR(observed_order(coarse, fine), 2, 0.2);
}

Flow<NoHeat> stirred_box(double viscosity, double dt, double clustering) {
    const std::array<Side, 2> walls{NoSlip{}, NoSlip{}};
    Flow<NoHeat> flow({Grid{{Axis::clustered(12, 0, 1, clustering), Axis::clustered(10, 0, 1, clustering),
                             Axis::clustered(14, 0, 1, clustering)}},
                       {walls, walls, walls},
                       viscosity,
                       dt},
                      NoHeat{});
    flow.set_velocity([](double x, double y, double z) {
        return std::array{std::sin(7 * x + 3 * y) * std::cos(2 * z), std::cos(5 * y - z) * x, std::sin(4 * z + x * y)};
    });
    return flow;
}

// Convection does no work on a divergence-free field: sum over the faces of u . C(u) vanishes against the sum of
// the magnitudes, on clustered grids as well.
TEST(Conservation, ConvectionMakesNoEnergy) {
    for (const double clustering : {0.0, 1.4}) {
        auto flow = stirred_box(0.01, 1e-9, clustering);
        flow.step();
        ASSERT_LT(flow.largest_divergence(), 1e-8);
        const Grid& grid = flow.grid();
        const std::array<int, 3> cells{grid.cells(0), grid.cells(1), grid.cells(2)};
        double work = 0;
        double magnitude = 0;
        for (int d = 0; d < 3; ++d) {
            const Weights weights(grid, velocity_edges(flow.sides(), d));
            flow::Field convection(grid);
            flow::Field diffusion(grid);
            momentum_transport(d, flow.velocity(), weights, cells, 1, convection, diffusion);
            for (int k = 1; k <= cells[2]; ++k)
                for (int j = 1; j <= cells[1]; ++j)
                    for (int i = 1; i <= cells[0]; ++i) {
                        double volume = 1;
                        for (int e = 0; e < 3; ++e) {
                            const int m = e == 0 ? i : e == 1 ? j : k;
                            volume *= e == d ? grid[e].spacing(m) : grid[e].width(m);
                        }
                        const double power =
                            flow.velocity()[static_cast<std::size_t>(d)](i, j, k) * convection(i, j, k) * volume;
                        work += power;
                        magnitude += std::abs(power);
                    }
        }
        EXPECT_GT(magnitude, 1e-3);
        EXPECT_LT(std::abs(work), 1e-12 * magnitude);
    }
}

TEST(Conservation, EveryStepIsDivergenceFreeToRoundOff) {
    for (const double clustering : {0.0, 1.4}) {
        auto flow = stirred_box(0.01, 1e-2, clustering);
        for (int s = 0; s < 20; ++s) flow.step();
        const auto fastest = flow.fastest();
        // Velocity over the smallest width bounds the terms of the divergence; their sum cancels to round-off.
        EXPECT_LT(flow.largest_divergence(), 1e-12 * fastest.courant / flow.time_step() * 100);
    }
}

// Insulated box: the volume integral of temperature does not change.
TEST(Conservation, InsulatedHeatIsKept) {
    const std::array<Side, 2> walls{NoSlip{}, NoSlip{}};
    Boussinesq heat;
    heat.diffusivity = 0.3;
    heat.sides = {{{Insulated{}, Insulated{}}, {Insulated{}, Insulated{}}, {Insulated{}, Insulated{}}}};
    heat.buoyancy = 50;
    Flow<Boussinesq> flow({Grid{{Axis::clustered(12, 0, 1, 1.3), Axis::uniform(9, 0, 1), Axis::clustered(8, 0, 1, 1)}},
                           {walls, walls, walls},
                           0.5,
                           1e-3},
                          heat);
    flow.set_temperature([](double x, double y, double z) { return std::sin(3 * x) + y * z; });
    const auto total = [&] {
        double sum = 0;
        const Grid& grid = flow.grid();
        for (int k = 1; k <= grid.cells(2); ++k)
            for (int j = 1; j <= grid.cells(1); ++j)
                for (int i = 1; i <= grid.cells(0); ++i)
                    sum += flow.temperature()(i, j, k) * grid[0].width(i) * grid[1].width(j) * grid[2].width(k);
        return sum;
    };
    const double before = total();
    for (int s = 0; s < 50; ++s) flow.step();
    EXPECT_GT(flow.fastest().courant, 1e-4);
    EXPECT_NEAR(total(), before, 1e-12);
}

// |dE/dt - (work of buoyancy - dissipation)| over the dissipation, in the step that ends at t = 0.1.
double energy_residual(int steps) {
    constexpr int n = 12;
    const double dt = 0.1 / steps;
    const std::array<Side, 2> walls{NoSlip{}, NoSlip{}};
    const Axis axis = Axis::uniform(n, -0.5, 0.5);
    Boussinesq heat;
    heat.sides[2] = {Isothermal{-0.5}, Isothermal{0.5}};
    heat.buoyancy = -2e4;
    heat.vibration = {50, 1};
    Flow<Boussinesq> flow({Grid{{axis, axis, axis}}, {walls, walls, walls}, 2, dt}, heat);
    flow.set_temperature([](double x, double, double z) { return z * (1 + 0.3 * x); });
    for (int s = 0; s < steps - 1; ++s) flow.step();
    const FaceVectors before = flow.velocity();
    const flow::Field cold = flow.temperature();
    flow.step();
    FaceVectors middle = before;
    double change = 0;
    for (std::size_t d = 0; d < 3; ++d)
        for (std::size_t m = 0; m < middle[d].size(); ++m)
            middle[d].values()[m] = 0.5 * (before[d].values()[m] + flow.velocity()[d].values()[m]);
    double work = 0;
    double dissipation = 0;
    for (int d = 0; d < 3; ++d) {
        const auto c = static_cast<std::size_t>(d);
        const Weights weights(flow.grid(), velocity_edges(flow.sides(), d));
        flow::Field convection(flow.grid());
        flow::Field diffusion(flow.grid());
        momentum_transport(d, middle, weights, {n, n, n}, 2, convection, diffusion);
        for (int k = 1; k <= n; ++k)
            for (int j = 1; j <= n; ++j)
                for (int i = 1; i <= n; ++i) {
                    const double v = middle[c](i, j, k);
                    change += v * (flow.velocity()[c](i, j, k) - before[c](i, j, k)) / dt;
                    dissipation -= v * diffusion(i, j, k);
                    if (d != 1) continue;
                    const double theta = 0.25 * (cold(i, j - 1, k) + cold(i, j, k) + flow.temperature()(i, j - 1, k) +
                                                 flow.temperature()(i, j, k));
                    work += v * heat.buoyancy * theta * heat.vibration.at(flow.time() - 0.5 * dt);
                }
    }
    EXPECT_GT(dissipation, 0);
    return std::abs(change - work + dissipation) / dissipation;
}

// Kinetic energy changes by the work of buoyancy less the dissipation; what the time scheme leaves over is of second
// order.
TEST(Conservation, TheEnergyBudgetCloses) {
    const double coarse = energy_residual(200);
    const double fine = energy_residual(400);
    EXPECT_LT(fine, 1e-3);
    EXPECT_GT(std::log2(coarse / fine), 1.7);
}

}  // namespace grainsweep::tests::flow_orders_test
