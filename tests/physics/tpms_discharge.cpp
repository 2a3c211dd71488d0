// Discharge of P cells: dropped wall spheres change no bit, and the retention is that of another program.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "solver/dem/engine.hpp"
#include "solver/scenes/scene.hpp"
#include "sweep/campaign/installed_machines.hpp"
#include "tests/support/tpms_filling.hpp"

namespace grainsweep::tests::tpms_discharge_test {

std::unique_ptr<dem::Engine> engine_of(const particles::TpmsFilling& filling, double edge,
                                       dem::Method::Precision precision, double margin = 2) {
    constexpr double d = 45e-6;
    dem::Setup setup;
    for (std::size_t k = 0; k < 3; ++k) {
        setup.domain.low[k] = -margin * d;
        setup.domain.high[k] = (edge + margin) * d;
    }
    setup.material.youngs_modulus = 2.11e6;
    setup.material.restitution = 0.64;
    setup.material.friction = 0.2;
    setup.gravity = {0, 0, -300};
    setup.time_step = 1e-6;
    for (const auto& x : filling.mobile) setup.spheres.push_back({{x[0] * d, x[1] * d, x[2] * d}, {}, {}, d / 2, true});
    for (const auto& x : filling.wall) setup.spheres.push_back({{x[0] * d, x[1] * d, x[2] * d}, {}, {}, d / 2, false});
    dem::Method method;
    method.precision = precision;
    return dem::make_engine(setup, method);
}

class TpmsWall : public testing::TestWithParam<dem::Method::Precision> {};
INSTANTIATE_TEST_SUITE_P(Both, TpmsWall,
                         testing::Values(dem::Method::Precision::mixed, dem::Method::Precision::double_precision));

TEST_P(TpmsWall, SpheresOutOfReachChangeNoBit) {
    const double edge = 20;
    const auto packing = particles::random_close_packing({.edge = edge, .fraction = 0.62, .seed = 1});
    const machine::LevelSetRegion shell{geometry::TpmsCell::schwarz_p, edge, 4, +1};
    const auto whole = particles::fill_tpms(packing, shell, 0);
    const auto lean = particles::fill_tpms(packing, shell, 0.9);
    ASSERT_EQ(whole.mobile, lean.mobile);
    EXPECT_EQ(whole.wall.size(), whole.wall_spheres);
    EXPECT_EQ(lean.wall_spheres, whole.wall_spheres);
    EXPECT_LT(lean.wall.size(), whole.wall.size() * 9 / 10);  // the shell is thick: its inside is dropped

    const auto with_all = engine_of(whole, edge, GetParam()), with_few = engine_of(lean, edge, GetParam());
    with_all->run(1500);
    with_few->run(1500);
    ASSERT_EQ(with_all->fault(), "");
    dem::State a, b;
    with_all->state(a);
    with_few->state(b);
    ASSERT_EQ(a.id.size() - b.id.size(), whole.wall.size() - lean.wall.size());
    std::size_t compared = 0;
    for (std::size_t i = 0; i < b.id.size() && b.mobile[i] != 0; ++i, ++compared) {
        ASSERT_EQ(a.id[i], b.id[i]);  // mobile spheres come first
        EXPECT_EQ(a.position[i], b.position[i]);
        EXPECT_EQ(a.velocity[i], b.velocity[i]);
        EXPECT_EQ(a.angular_velocity[i], b.angular_velocity[i]);
    }
    EXPECT_GT(compared, 100U);
    std::size_t moved = 0;
    for (std::size_t i = 0; i < compared; ++i) {
        const auto& x = whole.mobile[static_cast<std::size_t>(b.id[i])];
        moved += std::abs(b.position[i][2] - x[2] * 45e-6) > 45e-6 ? 1 : 0;
    }
    EXPECT_GT(moved, 100U);  // the comparison saw motion: so many fell by more than a diameter
}

TEST(TpmsDischarge, NothingThatIsTwoDiametersOutsideComesBack) {
    // The scene takes such particles out. Here they stay in a domain three cells wide and are followed.
    const double edge = 10, d = 45e-6;
    const auto packing = particles::random_close_packing({.edge = edge, .fraction = 0.62, .seed = 1});
    const machine::LevelSetRegion shell{geometry::TpmsCell::gyroid, edge, 1, +1};
    const auto filling = particles::fill_tpms(packing, shell, 0.9);
    const auto engine = engine_of(filling, edge, dem::Method::Precision::double_precision, 20);
    std::vector<char> left(filling.mobile.size() + filling.wall.size(), 0);
    dem::State state;
    for (int look = 0; look < 300; ++look) {  // 1.7 t*
        engine->run(10);
        ASSERT_EQ(engine->fault(), "");
        engine->state(state);
        for (std::size_t i = 0; i < state.id.size(); ++i) {
            if (state.mobile[i] == 0) continue;
            double outside = 0;  // of the cell, along the worst axis
            for (const double x : state.position[i]) outside = std::max({outside, -x / d, x / d - edge});
            char& gone = left[static_cast<std::size_t>(state.id[i])];
            if (outside > 2) gone = 1;
            EXPECT_TRUE(gone == 0 || outside > 0) << state.id[i];
        }
    }
    EXPECT_GT(std::ranges::count(left, 1), 200);
}

TEST(TpmsDischarge, EarlyRetentionOfASmallCellIsThatOfAnotherProgram) {
    // P cell, edge 20, shell 2, no cohesion, gravity 9.81 x 100/20. Five packings made by the reference's own program
    // left 0.8965 +- 0.0034 and 0.7829 +- 0.0095 (standard deviations) at 0.5 and 1 t*, three of LIGGGHTS's runs
    // 0.8965 and 0.7798; LIGGGHTS itself, given the packing of this test, 0.9020 and 0.7915. Four standard deviations.
    const SceneInfo& info = *campaign::scene_named("tpms_discharge");
    Inputs inputs = info.defaults();
    inputs["edge"] = 20.0;
    inputs["shell"] = 2.0;
    inputs["gravity"] = 49.05;
    inputs["end_time"] = 1.05;
    inputs["precision"] = std::string("double");
    NoArtefacts none;
    const auto scene = info.make(inputs, 1, none);
    scene->advance(1e9);
    ASSERT_EQ(scene->health().reason, "");
    Observations answer;
    scene->observe(answer);
    const auto& retention = answer.series.at("retention_series");
    const auto at = [&](double t) { return std::ranges::lower_bound(retention, t - 0.009, {}, &Sample::time)->value; };
    EXPECT_NEAR(at(0.5), 0.8965, 0.014);
    EXPECT_NEAR(at(1.0), 0.7829, 0.038);
    // From one packing the programs differ by what a disturbance of 1e-7 diameters becomes: 0.004 at 1 t*.
    EXPECT_NEAR(at(0.5), 0.9020, 0.006);
    EXPECT_NEAR(at(1.0), 0.7915, 0.012);
    EXPECT_NEAR(answer.scalars.at("peak_velocity"), 0.53, 0.05);  // LIGGGHTS: 0.527
    EXPECT_LT(answer.scalars.at("max_overlap"), 0.02);            // 0.0153
    EXPECT_GT(answer.scalars.at("max_overlap"), 0.01);
}

}  // namespace grainsweep::tests::tpms_discharge_test
