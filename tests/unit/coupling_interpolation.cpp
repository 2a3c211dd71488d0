#include "solver/coupling/cloud.hpp"
#include "solver/coupling/interpolation.hpp"
#include "solver/flow/flow.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace grainsweep::tests::coupling_interpolation_test {

using namespace coupling;
using flow::Axis;
using flow::Grid;

constexpr std::array<flow::Side, 2> walls{flow::NoSlip{}, flow::NoSlip{}};
constexpr std::array<flow::Side, 2> slip{flow::FreeSlip{}, flow::FreeSlip{}};
constexpr std::array<flow::Side, 2> periodic{flow::Periodic{}, flow::Periodic{}};

Vec3 random_place(const Grid& grid, std::uint64_t p) {
    const stats::Stream random(3, 1);
    Vec3 x;
    for (int d = 0; d < 3; ++d)
        x[static_cast<std::size_t>(d)] =
            grid[d].low() + grid[d].length() * random.uniform(3 * p + static_cast<std::uint64_t>(d));
    return x;
}

// A divergence-free field of round-off quality: any velocity after a projection.
flow::Flow<flow::NoHeat> projected(const Grid& grid, const flow::Sides& sides) {
    flow::Flow<flow::NoHeat> fluid({grid, sides, 1e-9, 1e-9}, flow::NoHeat{});
    fluid.set_velocity([](double x, double y, double z) {
        return std::array{std::sin(5 * x + 3 * y) * z, std::cos(4 * y - 2 * z) + x, std::sin(6 * z + x * y)};
    });
    fluid.step();
    return fluid;
}

Vec3 gather(const Grid& grid, const std::array<bool, 3>& wraps, const flow::FaceVectors& field, const Vec3& x) {
    return Stencil<Trilinear>(grid, wraps, x).gather(field);
}

const Grid uniform{{Axis::uniform(9, -0.5, 0.5), Axis::uniform(8, -0.5, 0.5), Axis::uniform(10, -0.5, 0.5)}};
const Grid clustered{
    {Axis::clustered(9, -0.5, 0.5, 1.3), Axis::clustered(8, -0.5, 0.5, 1.5), Axis::clustered(10, -0.5, 0.5, 1)}};

// The nodes of a plane flow against the wall y = 0 that obeys it and div V = 0: u = 2 a x y, v = -a y^2, a = 1.
flow::FaceVectors stagnation(const Grid& grid) {
    auto field = flow::face_vectors(grid);
    for (int k = 0; k <= grid.cells(2) + 1; ++k)
        for (int j = 1; j <= grid.cells(1) + 1; ++j)
            for (int i = 0; i <= grid.cells(0) + 1; ++i) {
                field[0](i, j, k) = 2 * grid[0].face(i) * grid[1].centre(j);
                field[1](i, j, k) = -grid[1].face(j) * grid[1].face(j);
            }
    for (int k = 0; k <= grid.cells(2) + 1; ++k)  // no slip: the ghost is the negative of the first cell
        for (int i = 0; i <= grid.cells(0) + 1; ++i) field[0](i, 0, k) = -field[0](i, 1, k);
    return field;
}

struct BesideWall {
    Vec3 velocity;
    double divergence;
};

BesideWall beside_wall(const Grid& grid, double x, double y) {
    const auto field = stagnation(grid);
    const double e = 1e-3 * grid[1].width(1);
    const auto at = [&](double px, double py) { return gather(grid, {}, field, {px, py, 0.5}); };
    return {at(x, y), (at(x + e, y)[0] - at(x - e, y)[0] + at(x, y + e)[1] - at(x, y - e)[1]) / (2 * e)};
}

// In the half cell beside a no-slip wall, at distance y < h/2, the kernel carries the particle towards the wall by
// v = -a h y instead of -a y^2. It follows the shear u = 2 a x y exactly and so compresses by a (2 y - h).
TEST(Interpolation, KeepsTheShearBesideAWall) {
    const Axis axis = Axis::uniform(10, 0, 1);
    const Grid grid{{axis, axis, axis}};
    const double h = 0.1;
    const double x = 0.34;
    for (const double y : {0.005, 0.02, 0.04}) {
        const auto linear = beside_wall(grid, x, y);
        EXPECT_NEAR(linear.velocity[0], 2 * x * y, 1e-14);
        EXPECT_NEAR(linear.velocity[1], -h * y, 1e-14);
        EXPECT_NEAR(linear.divergence, 2 * y - h, 1e-10);
    }
}

TEST(Interpolation, LetsNothingThroughAWall) {
    for (const Grid* grid : {&uniform, &clustered}) {
        const auto fluid = projected(*grid, {walls, walls, walls});
        for (std::uint64_t p = 0; p < 50; ++p)
            for (std::size_t d = 0; d < 3; ++d)
                for (const double side : {-0.5, 0.5}) {
                    Vec3 x = random_place(*grid, p);
                    x[d] = side;
                    EXPECT_NEAR(gather(*grid, {}, fluid.velocity(), x)[d], 0, 1e-14);
                }
    }
}

TEST(Interpolation, IsContinuousAcrossCells) {
    for (const Grid* grid : {&uniform, &clustered}) {
        const auto fluid = projected(*grid, {walls, walls, walls});
        for (std::uint64_t p = 0; p < 50; ++p)
            for (int d = 0; d < 3; ++d)
                for (int f = 2; f < grid->cells(d); ++f)
                    for (const double knot : {(*grid)[d].face(f), (*grid)[d].centre(f)}) {
                        Vec3 below = random_place(*grid, p);
                        Vec3 above = below;
                        below[static_cast<std::size_t>(d)] = knot - 1e-9;
                        above[static_cast<std::size_t>(d)] = knot + 1e-9;
                        const Vec3 a = gather(*grid, {}, fluid.velocity(), below);
                        const Vec3 b = gather(*grid, {}, fluid.velocity(), above);
                        for (std::size_t e = 0; e < 3; ++e) EXPECT_NEAR(a[e], b[e], 1e-6);
                    }
    }
}

// Second order for a smooth field that satisfies the walls: the error falls fourfold when the cells halve.
TEST(Interpolation, ConvergesWithSecondOrder) {
    const auto error = [](int n, double clustering) {
        const Axis axis = Axis::clustered(n, 0, 1, clustering);
        const Grid grid{{axis, axis, axis}};
        const auto exact = [](const Vec3& x) {
            const double pi = 3.14159265358979323846;
            return Vec3{std::sin(pi * x[0]) * std::cos(2 * x[1]) * std::exp(x[2]),
                        std::sin(pi * x[1]) * std::cos(x[0] + x[2]), std::sin(pi * x[2]) * x[0] * x[1]};
        };
        flow::FaceVectors field = flow::face_vectors(grid);
        for (int d = 0; d < 3; ++d)
            for (int k = 0; k <= n + 1; ++k)
                for (int j = 0; j <= n + 1; ++j)
                    for (int i = 0; i <= n + 1; ++i) {
                        Vec3 x{axis.centre(i), axis.centre(j), axis.centre(k)};
                        x[static_cast<std::size_t>(d)] = axis.face(d == 0 ? i : d == 1 ? j : k);
                        field[static_cast<std::size_t>(d)](i, j, k) = exact(x)[static_cast<std::size_t>(d)];
                    }
        double sum = 0;
        int count = 0;
        for (std::uint64_t p = 0; p < 4000; ++p) {
            const Vec3 x = random_place(grid, p);
            if (std::ranges::any_of(x, [](double c) { return c < 0.1 || c > 0.9; })) continue;
            const Vec3 got = gather(grid, {}, field, x);
            for (std::size_t d = 0; d < 3; ++d) sum += (got[d] - exact(x)[d]) * (got[d] - exact(x)[d]);
            ++count;
        }
        return std::sqrt(sum / count);
    };
    for (const double clustering : {0.0, 1.0})
        EXPECT_NEAR(std::log2(error(20, clustering) / error(40, clustering)), 2, 0.2);
}

// <scatter(F), V> = F . gather(V) for every F and V, spread or not: the pair exchanges power exactly.
TEST(Interpolation, ScatterIsTheTransposeOfGather) {
    const flow::Sides box{walls, walls, walls};
    struct Case {
        Grid grid;
        flow::Sides sides;
        double width;
    };
    for (const auto& [grid, sides, width] :
         {Case{uniform, box, 0}, Case{uniform, box, 0.15}, Case{clustered, box, 0.1},
          Case{uniform, {periodic, slip, walls}, 0}, Case{uniform, {periodic, slip, walls}, 0.15}}) {
        const auto fluid = projected(grid, sides);
        FaceDeposit deposit(grid, sides, width);
        flow::FaceVectors spread = fluid.velocity();
        deposit.spread_transposed(spread);
        for (std::uint64_t p = 0; p < 200; ++p) {
            const Stencil<Trilinear> stencil(grid, periodic_axes(sides), random_place(grid, p));
            const Vec3 force{1.3, -0.7, 2.1};
            flow::FaceVectors onto = flow::face_vectors(grid);
            stencil.scatter(force, onto);
            deposit.spread(onto);
            double power = 0;
            for (int d = 0; d < 3; ++d) {
                const auto m = static_cast<std::size_t>(d);
                for (int k = 1; k <= grid.cells(2); ++k)
                    for (int j = 1; j <= grid.cells(1); ++j)
                        for (int i = 1; i <= grid.cells(0); ++i) {
                            const auto length = [&](int e, int at) {
                                return e == d ? grid[e].spacing(at) : grid[e].width(at);
                            };
                            const double volume = length(0, i) * length(1, j) * length(2, k);
                            power += onto[m](i, j, k) * volume * fluid.velocity()[m](i, j, k);
                        }
            }
            const Vec3 v = stencil.gather(spread);
            EXPECT_NEAR(power, force[0] * v[0] + force[1] * v[1] + force[2] * v[2], 1e-13);
        }
    }
}

TEST(RandomCloud, StandsWhereCentresMayBe) {
    const Walls box{{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}, {false, true, false}, 0.1, 1};
    const Cloud cloud = random_cloud(2000, box, stats::Stream(1, 2));
    double mean = 0;
    double largest = 0;
    for (const Vec3& x : cloud.position) {
        EXPECT_LE(std::abs(x[0]), 0.4);
        EXPECT_LE(std::abs(x[2]), 0.4);
        mean += x[0] / 2000;
        largest = std::max(largest, std::abs(x[1]));
    }
    EXPECT_LT(std::abs(mean), 4 * 0.4 / std::sqrt(3.0 * 2000));  // four standard errors
    EXPECT_GT(largest, 0.49);
}

}  // namespace grainsweep::tests::coupling_interpolation_test
