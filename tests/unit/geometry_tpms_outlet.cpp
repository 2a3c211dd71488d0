#include "solver/geometry/tpms_outlet.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "solver/observables/beverloo.hpp"

namespace grainsweep::tests::geometry_tpms_outlet_test {

using geometry::TpmsCell;
using geometry::TpmsShell;

TEST(TpmsOutlet, OfAPCellIsTheClosedForm) {
    // In z = 0 the kept side is cos X + cos Y > 1 + C; its border is nearest to the middle along the diagonal,
    // where 2 cos X = 1 + C: diameter sqrt 2 L acos((1 + C)/2)/pi.
    for (const double edge : {20.0, 100.0})
        for (const double thickness : {0.02 * edge, 0.1 * edge, 0.4 * edge}) {
            const TpmsShell shell(TpmsCell::schwarz_p, +1, edge, thickness);
            const double expected = std::numbers::sqrt2 * edge * std::acos((1 + shell.level()) / 2) / std::numbers::pi;
            EXPECT_NEAR(geometry::outlet_diameter(shell), expected, 1.5 * edge / 256);
        }
}

TEST(TpmsOutlet, IsNarrowerInAThickerShell) {
    for (const auto& cell : geometry::tpms_cells) {
        const double thin = geometry::outlet_diameter(TpmsShell(cell.cell, cell.kept_side, 1, 0.01));
        const double thick = geometry::outlet_diameter(TpmsShell(cell.cell, cell.kept_side, 1, 0.05));
        EXPECT_GT(thick, 0) << cell.name;
        EXPECT_GT(thin, thick) << cell.name;
        EXPECT_LE(thin, 1) << cell.name;
    }
}

TEST(Beverloo, IsThePublishedLaw) {
    // D = 10 mm, d = 1 mm, phi = 0.6: C phi sqrt(g) (D - 1.4 d)^(5/2) / (pi d^3/6) = 14278 grains a second.
    EXPECT_NEAR(observables::beverloo_rate(10e-3, 1e-3, 0.6, 9.81), 14278, 1);
    EXPECT_EQ(observables::beverloo_rate(1.4e-3, 1e-3, 0.6, 9.81), 0);
    const double once = observables::beverloo_rate(11.4e-3, 1e-3, 0.6, 9.81);
    EXPECT_NEAR(observables::beverloo_rate(21.4e-3, 1e-3, 0.6, 9.81) / once, std::pow(2, 2.5), 1e-12);
    EXPECT_NEAR(observables::beverloo_rate(11.4e-3, 1e-3, 0.6, 4 * 9.81) / once, 2, 1e-12);
}

}  // namespace grainsweep::tests::geometry_tpms_outlet_test
