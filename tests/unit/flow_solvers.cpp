#include "solver/flow/axis_product.hpp"
#include "solver/flow/dense_product.hpp"
#include "solver/flow/dense_tiles.hpp"
#include "solver/flow/flow.hpp"
#include "solver/flow/implicit_diffusion.hpp"
#include "solver/flow/poisson.hpp"
#include "solver/flow/second_difference.hpp"
#include "stats/random.hpp"

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include <cmath>
#include <limits>

namespace grainsweep::tests::flow_solvers_test {

using namespace flow;
using stats::Stream;

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr std::array<Side, 2> walls{NoSlip{}, NoSlip{}};
constexpr std::array<Side, 2> slip{FreeSlip{}, FreeSlip{}};
constexpr std::array<Side, 2> periodic{Periodic{}, Periodic{}};

Grid box(int nx, int ny, int nz, double clustering = 0) {
    return {{Axis::clustered(nx, -1, 1, clustering), Axis::clustered(ny, 0, 1, clustering),
             Axis::clustered(nz, 0, 3, clustering)}};
}

flow::Field noise(const Grid& grid, std::uint64_t stream) {
    flow::Field field(grid);
    const Stream random(7, stream);
    for (int k = 1; k <= grid.cells(2); ++k)
        for (int j = 1; j <= grid.cells(1); ++j)
            for (int i = 1; i <= grid.cells(0); ++i)
                field(i, j, k) = random.uniform(static_cast<std::uint64_t>(field.index(i, j, k))) - 0.5;
    return field;
}

TEST(Axis, ClusteringKeepsEndsAndSymmetry) {
    const Axis axis = Axis::clustered(40, -0.5, 0.5, 1.5);
    EXPECT_EQ(axis.face(1), -0.5);
    EXPECT_EQ(axis.face(41), 0.5);
    EXPECT_LT(axis.width(1), 0.5 * axis.width(20));
    for (int i = 1; i <= 20; ++i) EXPECT_NEAR(axis.width(i), axis.width(41 - i), 1e-15);
}

TEST(Axis, LocatesItsOwnFacesAndCentresOfTheMap) {
    for (const double clustering : {0.0, 1.5}) {
        const Axis axis = Axis::clustered(10, 1, 3, clustering);
        for (int f = 1; f <= 10; ++f) {
            const Place place = axis.locate(axis.face(f) + 1e-12);
            EXPECT_EQ(place.cell, f);
            EXPECT_NEAR(place.offset, 0, 1e-9);
        }
        EXPECT_EQ(axis.locate(99).cell, 10);
        EXPECT_DOUBLE_EQ(axis.locate(99).offset, 1);
        EXPECT_EQ(axis.locate(-99).cell, 1);
    }
}

TEST(Axis, TheTableOfCellsAgreesWithTheMap) {
    const double none = std::numeric_limits<double>::quiet_NaN();
    for (const double clustering : {0.0, 0.4, 1.5, 3.0})
        for (const int cells : {1, 2, 7, 28, 80}) {
            std::vector<Axis> axes = {Axis::clustered(cells, -0.5, 0.7, clustering)};
            if (cells % 2 == 0) axes.push_back(axes.front().lower_half());
            for (const Axis& axis : axes) {
                for (int k = 0; k <= 5000; ++k) {
                    const double x = axis.low() + axis.length() * k / 5000;
                    const int cell = axis.cell_at(x);
                    ASSERT_TRUE(axis.face(cell) <= x && (x < axis.face(cell + 1) || cell == axis.cells())) << x;
                    ASSERT_NEAR(axis.locate(x).cell + axis.locate(x).offset, cell, 1 + 1e-9) << x;
                }
                for (int f = 1; f <= axis.cells(); ++f) EXPECT_EQ(axis.cell_at(axis.face(f)), f);
                EXPECT_EQ(axis.cell_at(-99), 1);
                EXPECT_EQ(axis.cell_at(99), axis.cells());
                EXPECT_EQ(axis.cell_at(1e300), axis.cells());
                EXPECT_EQ(axis.cell_at(none), 1);
                for (int i = 1; i <= axis.cells(); ++i) {
                    EXPECT_DOUBLE_EQ(axis.per_width(i) * axis.width(i), 1);
                    EXPECT_DOUBLE_EQ(axis.per_spacing(i) * axis.spacing(i), 1);
                }
            }
        }
}

TEST(Axis, RefusesTheImpossible) {
    EXPECT_THROW((void)Axis::uniform(0, 0, 1), std::invalid_argument);
    EXPECT_THROW((void)Axis::uniform(3, 1, 1), std::invalid_argument);
    EXPECT_THROW((void)Axis::clustered(3, 0, 1, -1), std::invalid_argument);
}

TEST(DenseProduct, AgreesWithEigenForEveryRemainder) {
    for (int rows = 1; rows <= 9; ++rows)
        for (int columns : {1, 3, 4, 7, 8, 13, 40, 85})
            for (int depth : {1, 5, 40}) {
                const RowMajor a = RowMajor::Random(rows, depth);
                const RowMajor b = RowMajor::Random(depth, columns);
                RowMajor c = RowMajor::Constant(rows, columns, 99);
                dense_product(rows, columns, depth, a.data(), depth, b.data(), columns, c.data(), columns);
                EXPECT_LT((c - a * b).cwiseAbs().maxCoeff(), 1e-13) << rows << ' ' << columns << ' ' << depth;
            }
}

TEST(DenseProduct, IsTheSameToTheLastBitOnEveryInstructionSet) {
    std::vector<DenseProduct*> others;
    if (__builtin_cpu_supports("x86-64-v3")) others.push_back(dense_product_avx2);
    if (__builtin_cpu_supports("x86-64-v4")) others.push_back(dense_product_avx512);
    for (DenseProduct* const other : others)
        for (int rows : {1, 4, 7, 8, 12, 21})
            for (int columns : {1, 4, 7, 8, 12, 16, 29, 40, 85}) {
                const int depth = 37;
                const RowMajor a = RowMajor::Random(rows, depth), b = RowMajor::Random(depth, columns);
                RowMajor plain(rows, columns), c = RowMajor::Constant(rows, columns, 99);
                for (int r = 0; r < rows; ++r)
                    for (int m = 0; m < columns; ++m) {
                        plain(r, m) = 0;
                        for (int k = 0; k < depth; ++k) plain(r, m) += a(r, k) * b(k, m);
                    }
                other(rows, columns, depth, a.data(), depth, b.data(), columns, c.data(), columns);
                EXPECT_TRUE((c.array() == plain.array()).all()) << rows << ' ' << columns;
            }
}

TEST(DenseProduct, SumsInOrderWhateverTheBlock) {
    // Each entry is the same whether it stands in a wide tile, a narrow one or the remainder.
    const RowMajor a = RowMajor::Random(5, 40);
    const RowMajor b = RowMajor::Random(40, 13);
    RowMajor together(5, 13);
    dense_product(5, 13, 40, a.data(), 40, b.data(), 13, together.data(), 13);
    for (int r = 0; r < 5; ++r)
        for (int c = 0; c < 13; ++c) {
            double alone = 0;
            for (int k = 0; k < 40; ++k) alone += a(r, k) * b(k, c);
            EXPECT_EQ(alone, together(r, c));
        }
}

// What is skipped of a matrix that falls off changes nothing but the last rounding; of one that does not, nothing is.
TEST(AxisProduct, SkipsWhatIsNegligible) {
    for (const int n : {2, 7, 28, 40}) {
        const Grid grid = box(n, n, n);
        const flow::Field field = noise(grid, 1);
        for (int d = 0; d < 3; ++d) {
            Eigen::MatrixXd bell(n, n);
            for (int r = 0; r < n; ++r)
                for (int c = 0; c < n; ++c) bell(r, c) = (1 + 0.1 * r) * std::exp(-0.5 * (r - c) * (r - c));
            const AxisProduct banded(grid, d, bell), whole(grid, d, bell, 0);
            EXPECT_EQ(whole.kept(), 1);
            EXPECT_LE(banded.kept(), n == 40 ? 0.6 : 1);
            EXPECT_EQ(AxisProduct(grid, d, Eigen::MatrixXd::Ones(n, n)).kept(), 1);
            flow::Field fast(grid), plain(grid);
            banded.apply(field, fast);
            whole.apply(field, plain);
            const auto line = [&](int i, int j, int k) {  // entry by entry
                double sum = 0;
                for (int m = 1; m <= n; ++m)
                    sum += bell((d == 0   ? i
                                 : d == 1 ? j
                                          : k) -
                                    1,
                                m - 1) *
                           field(d == 0 ? m : i, d == 1 ? m : j, d == 2 ? m : k);
                return sum;
            };
            double skipped = 0, wrong = 0;
            for (int k = 1; k <= n; ++k)
                for (int j = 1; j <= n; ++j)
                    for (int i = 1; i <= n; ++i) {
                        skipped = std::max(skipped, std::abs(fast(i, j, k) - plain(i, j, k)));
                        wrong = std::max(wrong, std::abs(plain(i, j, k) - line(i, j, k)));
                    }
            EXPECT_LE(skipped, n * 1e-17 * bell.maxCoeff() + 2e-16 * bell.maxCoeff()) << n << ' ' << d;
            EXPECT_LE(wrong, 1e-14 * bell.maxCoeff()) << n << ' ' << d;
        }
    }
}

TEST(SecondDifference, IsExactForQuadraticsOnUniformGrids) {
    const Axis axis = Axis::uniform(8, 0, 2);
    const SecondDifference d(axis, Edge{});
    for (int i = 2; i <= 7; ++i) {
        const auto value = [&](int m) { return 3 * axis.centre(m) * axis.centre(m); };
        const auto m = static_cast<std::size_t>(i);
        EXPECT_NEAR(d.low[m] * (value(i - 1) - value(i)) + d.high[m] * (value(i + 1) - value(i)), 6, 1e-11);
    }
}

TEST(Poisson, InvertsTheDivergenceOfTheGradient) {
    const auto check = [](const Grid& grid, const Sides& sides) {
        const Edges edges = pressure_edges(sides);
        flow::Field q = noise(grid, 1);
        // The solution is defined up to a constant: the volume mean is zero.
        double mean = 0;
        double volume = 0;
        const auto cell = [&](int i, int j, int k) { return grid[0].width(i) * grid[1].width(j) * grid[2].width(k); };
        const auto each = [&](auto body) {
            for (int k = 1; k <= grid.cells(2); ++k)
                for (int j = 1; j <= grid.cells(1); ++j)
                    for (int i = 1; i <= grid.cells(0); ++i) body(i, j, k);
        };
        each([&](int i, int j, int k) {
            mean += q(i, j, k) * cell(i, j, k);
            volume += cell(i, j, k);
        });
        each([&](int i, int j, int k) { q(i, j, k) -= mean / volume; });
        fill_ghosts(q, grid, edges);
        const Weights w(grid, edges);
        std::vector<double> values;
        each([&](int i, int j, int k) {
            double lap = 0;
            for (int d = 0; d < 3; ++d) {
                const auto m = static_cast<std::size_t>(d == 0 ? i : d == 1 ? j : k);
                const auto e = static_cast<std::size_t>(d);
                const double* p = q.data() + q.index(i, j, k);
                lap += w.low[e][m] * (p[-q.stride(d)] - *p) + w.high[e][m] * (p[q.stride(d)] - *p);
            }
            values.push_back(lap);
        });
        Poisson poisson(grid, sides);
        poisson.solve(values);
        std::size_t m = 0;
        double worst = 0;
        each([&](int i, int j, int k) { worst = std::max(worst, std::abs(values[m++] - q(i, j, k))); });
        EXPECT_LT(worst, 1e-12);
    };
    check(box(7, 6, 9), {walls, walls, slip});
    check(box(8, 12, 5, 1.5), {walls, slip, walls});
    check(box(8, 5, 6), {periodic, walls, periodic});
    check(box(1, 12, 8, 1), {slip, walls, walls});
    check(box(1, 1, 8), {periodic, periodic, walls});
}

TEST(ImplicitDiffusion, SolvesItsFactors) {
    const double a = 0.03;
    const auto check = [&](const Grid& grid, const Edges& edges) {
        const flow::Field exact = [&] {
            flow::Field x = noise(grid, 2);
            for (int d = 0; d < 3; ++d)  // known wall values do not change
                if (first_unknown(edges[static_cast<std::size_t>(d)]) == 2) {
                    for (int q = 0; q <= grid.cells(d == 2 ? 1 : 2) + 1; ++q)
                        for (int p = 0; p <= grid.cells(d == 0 ? 1 : 0) + 1; ++p)
                            (d == 0 ? x(1, p, q) : d == 1 ? x(p, 1, q) : x(p, q, 1)) = 0;
                }
            return x;
        }();
        // r = (1 - a Lx)(1 - a Ly)(1 - a Lz) x by dense matrices along each line.
        flow::Field right = exact;
        for (int d = 0; d < 3; ++d) {
            const int n = grid.cells(d);
            const Eigen::MatrixXd factor = Eigen::MatrixXd::Identity(n, n) -
                                           a * second_difference_matrix(grid[d], edges[static_cast<std::size_t>(d)]);
            const int p = d == 0 ? 1 : 0;
            const int q = d == 2 ? 1 : 2;
            for (int v = 1; v <= grid.cells(q); ++v)
                for (int u = 1; u <= grid.cells(p); ++u) {
                    Eigen::VectorXd line(n);
                    double* const start = right.data() + u * right.stride(p) + v * right.stride(q);
                    for (int m = 1; m <= n; ++m) line(m - 1) = start[m * right.stride(d)];
                    line = factor * line;
                    for (int m = 1; m <= n; ++m) start[m * right.stride(d)] = line(m - 1);
                }
        }
        flow::Field solution(grid);
        ImplicitDiffusion(grid, edges, a).solve(right, solution);
        for (int k = 1; k <= grid.cells(2); ++k)
            for (int j = 1; j <= grid.cells(1); ++j)
                for (int i = 1; i <= grid.cells(0); ++i) EXPECT_NEAR(solution(i, j, k), exact(i, j, k), 1e-12);
    };
    for (int d = 0; d < 3; ++d) {
        check(box(6, 7, 5, 1.2), velocity_edges({walls, slip, walls}, d));
        check(box(6, 7, 5), velocity_edges({periodic, walls, periodic}, d));
        check(box(6, 7, 5), velocity_edges({walls, periodic, slip}, d));
    }
    check(
        box(6, 7, 5),
        temperature_edges({walls, walls, walls},
                          {{{Insulated{}, Isothermal{1}}, {Isothermal{2}, Insulated{}}, {Insulated{}, Insulated{}}}}));
}

TEST(FlowSetup, RefusesTheImpossible) {
    const FlowSetup good{box(4, 4, 4), {walls, walls, walls}, 1, 0.1};
    FlowSetup setup = good;
    setup.time_step = 0;
    EXPECT_THROW(Flow<NoHeat>(setup, NoHeat{}), std::invalid_argument);
    setup = good;
    setup.sides[0][0] = Periodic{};
    EXPECT_THROW(Flow<NoHeat>(setup, NoHeat{}), std::invalid_argument);
    setup = good;
    setup.grid = box(4, 4, 4, 1);
    setup.sides[1] = periodic;
    EXPECT_THROW(Flow<NoHeat>(setup, NoHeat{}), std::invalid_argument);
}

TEST(Flow, ContinuesBitForBitFromASavedState) {
    const auto make = [] {
        Boussinesq heat;
        heat.sides[2] = {Isothermal{-0.5}, Isothermal{0.5}};
        heat.buoyancy = 1e4;
        heat.vibration = {40, 0.3};
        Flow<Boussinesq> flow({box(6, 7, 5, 1), {walls, walls, walls}, 0.7, 1e-3}, heat);
        flow.set_temperature([](double, double, double z) { return z / 3 - 0.5; });
        return flow;
    };
    auto straight = make();
    for (int s = 0; s < 9; ++s) straight.step();
    for (const int cut : {0, 1, 5}) {
        auto first = make();
        for (int s = 0; s < cut; ++s) first.step();
        std::vector<std::byte> saved;
        first.save(saved);
        auto second = make();
        std::span<const std::byte> from(saved);
        second.restore(from);
        EXPECT_TRUE(from.empty());
        for (int s = cut; s < 9; ++s) second.step();
        std::vector<std::byte> a;
        std::vector<std::byte> b;
        straight.save(a);
        second.save(b);
        EXPECT_EQ(a, b) << cut;
        std::span<const std::byte> tooShort(saved.data(), saved.size() - 8);
        EXPECT_THROW(second.restore(tooShort), std::invalid_argument);
    }
}

TEST(Flow, FastestNamesTheFirstValueThatIsNoNumber) {
    Flow<NoHeat> flow({box(4, 4, 4), {walls, walls, walls}, 1, 0.1}, NoHeat{});
    flow.set_velocity([](double x, double, double) { return std::array{x > 0.2 ? std::nan("") : 0.0, 0.0, 0.0}; });
    const auto fastest = flow.fastest();
    EXPECT_TRUE(std::isnan(fastest.courant));
    EXPECT_EQ(fastest.component, 0);
    EXPECT_DOUBLE_EQ(fastest.position[0], 0.5);
}

}  // namespace grainsweep::tests::flow_solvers_test
