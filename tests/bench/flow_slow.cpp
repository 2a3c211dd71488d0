// Published cubes, minutes each: slow_flow [--gtest_filter=...]. Figures found are printed beside the published ones.
#include "solver/flow/flow.hpp"
#include "tests/support/interpolation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

using namespace grainsweep::flow;

namespace {

constexpr std::array<Side, 2> walls{NoSlip{}, NoSlip{}};

// Mean Nusselt number of the hot side of a cube, gravity along y, gradient along z.
double heated_cube(double rayleigh, int n, double dt, double end) {
    const Axis axis = Axis::uniform(n, -0.5, 0.5);
    Boussinesq heat;
    heat.sides[2] = {Isothermal{-0.5}, Isothermal{0.5}};
    heat.buoyancy = 0.71 * rayleigh;
    Flow<Boussinesq> flow({Grid{{axis, axis, axis}}, {walls, walls, walls}, 0.71, dt}, heat);
    flow.set_temperature([](double, double, double z) { return z; });
    while (flow.time() < end) flow.step();
    double nusselt = 0;
    for (int j = 1; j <= n; ++j)
        for (int i = 1; i <= n; ++i) nusselt += (0.5 - flow.temperature()(i, j, n)) * 2.0 / n;
    return nusselt;
}

}  // namespace

// Tric, Labrosse & Betrouni 2000, doi 10.1016/S0017-9310(00)00037-5: mean Nu of the hot wall.
class HeatedCube : public testing::TestWithParam<std::tuple<double, double, double, double, double>> {};

TEST_P(HeatedCube, Tric) {
    const auto [rayleigh, published, dt, end, on_forty] = GetParam();
    const double coarse = heated_cube(rayleigh, 20, dt, end);
    const double fine = heated_cube(rayleigh, 40, dt, end);
    const double extrapolated = (4 * fine - coarse) / 3;
    std::printf("Ra %g: Nu(20) %.5f Nu(40) %.5f extrapolated %.5f, Tric %.4f\n", rayleigh, coarse, fine, extrapolated,
                published);
    EXPECT_NEAR(extrapolated, published, 0.003 * published);
    EXPECT_NEAR(fine, published, on_forty * published);
}

INSTANTIATE_TEST_SUITE_P(Rayleigh, HeatedCube,
                         testing::Values(std::tuple{1e3, 1.0700, 2e-3, 1.2, 0.003},
                                         std::tuple{1e4, 2.0542, 1e-3, 1.0, 0.009},
                                         std::tuple{1e5, 4.3370, 3e-4, 0.6, 0.025}));

namespace {

struct Lines {
    std::vector<double> at, v_on_x, u_on_y;
};

Lines driven_cube(int n) {
    const Axis axis = Axis::clustered(n, -0.5, 0.5, 1.2);
    Sides sides{walls, walls, walls};
    sides[0][0] = NoSlip{{0, 1, 0}};
    Flow<NoHeat> flow({Grid{{axis, axis, axis}}, sides, 1e-3, 0.01}, NoHeat{});
    while (flow.time() < 60) flow.step();
    const int m = n / 2;  // v at (i, m + 1) lies on y = 0; z = 0 is between m and m + 1
    Lines lines{{-0.5}, {1}, {0}};
    for (int i = 1; i <= n; ++i) {
        lines.at.push_back(axis.centre(i));
        const auto& [u, v, w] = flow.velocity();
        lines.v_on_x.push_back(0.5 * (v(i, m + 1, m) + v(i, m + 1, m + 1)));
        lines.u_on_y.push_back(0.5 * (u(m + 1, i, m) + u(m + 1, i, m + 1)));
    }
    lines.at.push_back(0.5);
    lines.v_on_x.push_back(0);
    lines.u_on_y.push_back(0);
    return lines;
}

}  // namespace

// Albensoeder & Kuhlmann 2005, doi 10.1016/j.jcp.2004.12.024, tables 5 and 6, Re = 1000: the lid x = -1/2 moves
// along +y; v on the x axis and u on the y axis. Extrapolated with order 2 from 32 and 48 cells per side; the bound is
// 1 % of the largest published value on the line away from the lid.
TEST(LidDrivenCube, AlbensoederKuhlmann) {
    const Lines coarse = driven_cube(32);
    const Lines fine = driven_cube(48);
    const auto extrapolated = [&](std::vector<double> Lines::*line, double at) {
        const double f = grainsweep::tests::cubic(fine.at, fine.*line, at);
        return f + (f - grainsweep::tests::cubic(coarse.at, coarse.*line, at)) / (48.0 * 48.0 / (32.0 * 32.0) - 1);
    };
    constexpr std::array x = {-0.4531, -0.3516, -0.2344, -0.1172, 0.0, 0.0469, 0.2187, 0.3281, 0.3984, 0.4297, 0.4453};
    constexpr std::array v_published = {0.33171,  0.12183,  0.07334,  0.03905,  0.00802, -0.00612,
                                        -0.10999, -0.25160, -0.27293, -0.23696, -0.20623};
    constexpr std::array y = {-0.4375, -0.4219, -0.4062, -0.3437, -0.2734, 0.0, 0.3047, 0.3594, 0.4063, 0.4453, 0.4688};
    constexpr std::array u_published = {-0.21738, -0.23503, -0.24407, -0.22924, -0.17580, -0.03674,
                                        0.15223,  0.31117,  0.43423,  0.33511,  0.18864};
    for (std::size_t a = 0; a < x.size(); ++a) {
        const double v = extrapolated(&Lines::v_on_x, x[a]);
        const double u = extrapolated(&Lines::u_on_y, y[a]);
        std::printf("v(%7.4f) %8.5f published %8.5f   u(%7.4f) %8.5f published %8.5f\n", x[a], v, v_published[a], y[a],
                    u, u_published[a]);
        EXPECT_NEAR(v, v_published[a], 0.01 * 0.33171);
        EXPECT_NEAR(u, u_published[a], 0.01 * 0.43423);
    }
}
