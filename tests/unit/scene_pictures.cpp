// What scenes show of their surroundings: walls where the calculation has them, flows as they are on the grid.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <set>
#include <string>

#include "solver/scenes/dem_picture.hpp"
#include "solver/scenes/scene.hpp"
#include "sweep/campaign/installed_machines.hpp"
#include "tests/support/blade.hpp"
#include "tests/support/surfaces.hpp"

namespace grainsweep::tests::scene_pictures_test {

std::unique_ptr<Scene> scene_of(const std::string& name, const Inputs& given) {
    static NoArtefacts none;
    const SceneInfo& info = *campaign::scene_named(name);
    Inputs inputs = info.defaults();
    for (const auto& [parameter, value] : given) inputs.at(parameter) = value;
    return info.make(inputs, 1, none);
}

std::set<std::string> names_of(const std::vector<WallSurface>& walls) {
    std::set<std::string> names;
    for (const auto& wall : walls) names.insert(wall.name);
    return names;
}

const WallSurface& named(const Snapshot& picture, const std::string& name) {
    return *std::ranges::find(picture.walls, name, &WallSurface::name);
}

double lowest(const WallSurface& wall, std::size_t axis) {
    double least = wall.corners.at(0)[axis];
    for (const auto& x : wall.corners) least = std::min(least, x[axis]);
    return least;
}

double highest(const WallSurface& wall, std::size_t axis) {
    double most = wall.corners.at(0)[axis];
    for (const auto& x : wall.corners) most = std::max(most, x[axis]);
    return most;
}

TEST(ScenePictures, APlaneIsCutOutOfTheBox) {
    const auto flat = grainsweep::surface_of(dem::Plane{{5, 5, 0.25}, {0, 0, 1}}, "base", {0, 0, 0}, {2, 3, 1}, 0);
    EXPECT_EQ(flat.corners.size(), 4U);
    EXPECT_EQ(flat.triangles.size(), 2U);
    for (const auto& x : flat.corners) EXPECT_NEAR(x[2], 0.25, 1e-12);
    EXPECT_NEAR(highest(flat, 1) - lowest(flat, 1), 3, 1e-9);
    // The plane x + y + z = 3/2 cuts a hexagon out of the unit cube.
    const double n = 1 / std::sqrt(3.0);
    const auto slope = grainsweep::surface_of(dem::Plane{{0.5, 0.5, 0.5}, {n, n, n}}, "slope", {0, 0, 0}, {1, 1, 1}, 0);
    EXPECT_EQ(slope.corners.size(), 6U);
    const auto outside = grainsweep::surface_of(dem::Plane{{0, 0, 7}, {0, 0, 1}}, "lid", {0, 0, 0}, {1, 1, 1}, 0);
    EXPECT_TRUE(outside.triangles.empty());
}

TEST(ScenePictures, ABladeStandsWhereItMoves) {
    const Blade blade{.front = 0.1,
                      .thickness = 0.02,
                      .bottom = 0.01,
                      .top = 1,
                      .speed = 2,
                      .amplitude = 0.001,
                      .frequency = 10,
                      .edge_radius = 0.004};
    const auto seen = grainsweep::surface_of(blade, "blade", {0, 0, 0}, {1, 0.5, 0.05}, 0.025);
    EXPECT_NEAR(highest(seen, 0), 0.1 + 2 * 0.025, 1e-12);
    EXPECT_NEAR(lowest(seen, 0), 0.08 + 2 * 0.025, 1e-12);
    EXPECT_NEAR(lowest(seen, 2), 0.01 + 0.001, 1e-12);  // a quarter of a period: the crest
    EXPECT_NEAR(highest(seen, 2), 0.05, 1e-12);
    EXPECT_EQ(lowest(seen, 1), 0);
    EXPECT_EQ(highest(seen, 1), 0.5);
}

TEST(ScenePictures, AMeshStandsWhereItMovesAndShowsItsTrueEdges) {
    const dem::Mesh block(tests::surface_of(tests::box(0.01, 0.02)));
    const dem::Wall wall{
        block,
        {dem::Rotation{.axis = {0, 0, 1}, .speed = std::numbers::pi}, dem::Translation{.velocity = {0.1, 0, 0}}}};
    const auto seen = grainsweep::surface_of(wall, "block", {0, 0, 0}, {1, 1, 1}, 0.25);  // by an eighth of a turn
    ASSERT_EQ(seen.triangles.size(), 12U);
    ASSERT_EQ(seen.corners.size(), 8U);
    EXPECT_EQ(seen.edges.size(), 12U) << "no diagonals";
    EXPECT_NEAR(highest(seen, 0), 0.01 * std::sqrt(2.0) + 0.025, 1e-12);
    EXPECT_NEAR(highest(seen, 1), 0.01 * std::sqrt(2.0), 1e-12);
    EXPECT_NEAR(lowest(seen, 2), -0.02, 1e-15);
    const dem::Mesh plate(tests::surface_of(tests::plate(0.01, 3)));
    EXPECT_EQ(grainsweep::surface_of(plate, "plate", {}, {}, 0).edges.size(), 12U) << "its rim";
}

TEST(ScenePictures, SpreadingShowsGatesThenTheBlade) {
    const auto scene = scene_of("powder_spreading", {{"diameter", 0.004},
                                                     {"width", 3.0},
                                                     {"gap", 0.008},
                                                     {"layer_area", 1e-4},
                                                     {"travel", 0.02},
                                                     {"settle_time", 0.001}});
    const Snapshot before = scene->snapshot();
    EXPECT_EQ(names_of(before.walls), (std::set<std::string>{"base", "first_gate", "second_gate"}));
    EXPECT_EQ(before.periods, (std::array<double, 3>{0, 0.012, 0}));
    EXPECT_EQ(before.units.at("velocity"), "m/s");
    for (const auto& x : before.positions) {
        EXPECT_GT(x[0], highest(named(before, "first_gate"), 0));
        EXPECT_LT(x[0], lowest(named(before, "second_gate"), 0));
        EXPECT_GT(x[2], highest(named(before, "base"), 2));
    }
    scene->advance(0.006);
    const Snapshot after = scene->snapshot();
    EXPECT_EQ(names_of(after.walls), (std::set<std::string>{"base", "blade"}));
    const double front = highest(named(after, "blade"), 0);
    EXPECT_NEAR(front, 0.015 + 1.4 * (scene->time() - 0.001), 1e-4);
    EXPECT_NEAR(lowest(named(after, "blade"), 2), 0.008, 1e-12);
}

TEST(ScenePictures, ADrumShowsItsPlates) {
    const auto scene = scene_of(
        "rotating_drum",
        {{"ends", std::string("plates")}, {"particles", std::int64_t{50}}, {"precision", std::string("double")}});
    const Snapshot picture = scene->snapshot();
    EXPECT_EQ(names_of(picture.walls), (std::set<std::string>{"drum", "front_plate", "rear_plate"}));
    EXPECT_NEAR(highest(named(picture, "drum"), 2), 0.075, 1e-9);
    EXPECT_EQ(highest(named(picture, "front_plate"), 1), 0);
    EXPECT_EQ(lowest(named(picture, "rear_plate"), 1), 0.03);
    EXPECT_EQ(picture.periods, (std::array<double, 3>{}));
    EXPECT_EQ(scene->picture_focus(), 1.3);
    EXPECT_EQ(scene_of("rotating_drum", {{"precision", std::string("double")}})->snapshot().periods[1], 0.03);
}

TEST(ScenePictures, AHopperShowsWhatHoldsThePowder) {
    const auto picture = [](const Inputs& changed, double time) {
        Inputs inputs = changed;
        inputs["particles"] = std::int64_t{50};
        inputs["settle_time"] = 0.01;
        const auto scene = scene_of("hopper", inputs);
        scene->advance(time);
        return scene->snapshot();
    };
    const Inputs conical = {{"shape", std::string("conical")}}, slot = {{"opening", std::string("slot")}};
    EXPECT_EQ(names_of(picture({}, 0).walls), (std::set<std::string>{"container", "plug"}));
    const auto flat = picture({}, 0.02);
    EXPECT_EQ(names_of(flat.walls), (std::set<std::string>{"container", "floor"}));
    EXPECT_NEAR(highest(named(flat, "container"), 0), 0.04, 1e-9);
    EXPECT_NEAR(highest(named(flat, "floor"), 2), 0, 1e-12);
    EXPECT_NEAR(lowest(named(flat, "floor"), 2), -0.0005, 1e-12);
    const auto cone = picture(conical, 0.02);
    EXPECT_EQ(names_of(cone.walls), (std::set<std::string>{"container", "cone"}));
    EXPECT_NEAR(highest(named(cone, "cone"), 2), 0.0225 * std::sqrt(3.0), 1e-9) << "30 degrees to the vertical";
    EXPECT_EQ(names_of(picture(slot, 0.02).walls),
              (std::set<std::string>{"left", "right", "floor_left", "floor_right"}));
}

TEST(ScenePictures, ATubeIsLiftedFromItsHeap) {
    const auto scene = scene_of("heap", {{"particles", std::int64_t{50}}, {"settle_time", 0.1}, {"lift_speed", 0.2}});
    EXPECT_NEAR(lowest(named(scene->snapshot(), "tube"), 2), 0.0001, 1e-12);
    EXPECT_NEAR(highest(named(scene->snapshot(), "tube"), 1), 0.031, 1e-9);
    scene->advance(0.15);
    EXPECT_NEAR(lowest(named(scene->snapshot(), "tube"), 2), 0.0101, 1e-4);
    EXPECT_EQ(highest(named(scene->snapshot(), "plate"), 2), 0);
}

TEST(ScenePictures, ACellShowsItsSurfaceAndItsEdges) {
    const auto scene = scene_of("tpms_discharge", {{"edge", 8.0}, {"shell", 2.0}});
    const Snapshot picture = scene->snapshot();
    const auto& cell = named(picture, "cell");
    EXPECT_GT(cell.triangles.size(), 1000U);
    EXPECT_EQ(cell.edges.size(), 12U);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_EQ(lowest(cell, axis), 0);
        EXPECT_NEAR(highest(cell, axis), 8 * 45e-6, 1e-12);
    }
}

TEST(ScenePictures, AFlowIsShownOnItsGridAndAMirroredOneWhole) {
    const Inputs common = {{"cells", std::int64_t{8}},
                           {"clustering", 1.0},
                           {"particles", std::int64_t{20}},
                           {"steps_per_period", std::int64_t{16}},
                           {"end_time", 0.002},
                           {"particle_start", std::string("with_flow")}};
    Inputs halved = common;
    halved["symmetry"] = std::string("mirror");
    const auto whole = scene_of("thermovibration", common), half = scene_of("thermovibration", halved);
    EXPECT_NEAR(whole->picture_period(), 2 * 3.14159265358979 / 1.667e4, 1e-12);
    whole->advance(1e-3);
    half->advance(1e-3);
    const Snapshot a = whole->snapshot(), b = half->snapshot();
    EXPECT_EQ(names_of(a.walls), (std::set<std::string>{"cavity", "hot_wall", "cold_wall"}));
    EXPECT_EQ(lowest(named(a, "hot_wall"), 2), 0.5);
    EXPECT_EQ(highest(named(a, "cold_wall"), 2), -0.5);
    EXPECT_EQ(a.scalars.at("diameter").size(), 20U);
    ASSERT_EQ(a.fields.size(), 1U);
    ASSERT_EQ(b.fields.size(), 1U);
    EXPECT_EQ(a.fields[0].faces, b.fields[0].faces);
    const auto& velocity = a.fields[0].vectors.at("velocity");
    ASSERT_EQ(velocity.size(), 512U);
    ASSERT_EQ(b.fields[0].vectors.at("velocity").size(), 512U);
    double largest = 0, apart = 0;
    for (std::size_t c = 0; c < velocity.size(); ++c)
        for (std::size_t d = 0; d < 3; ++d) {
            largest = std::max(largest, std::abs(velocity[c][d]));
            apart = std::max(apart, std::abs(velocity[c][d] - b.fields[0].vectors.at("velocity")[c][d]));
        }
    EXPECT_GT(largest, 0);
    EXPECT_LT(apart, 1e-9 * largest);
    const auto& temperature = a.fields[0].scalars.at("temperature");
    EXPECT_LT(temperature.front(), -0.4);  // beside the cold wall, z = -1/2
    EXPECT_GT(temperature.back(), 0.4);
}

TEST(ScenePictures, AStoredFlowIsShownAtThePhaseOfTheParticles) {
    const Inputs common = {{"cells", std::int64_t{8}},
                           {"clustering", 0.0},
                           {"particles", std::int64_t{20}},
                           {"steps_per_period", std::int64_t{16}},
                           {"end_time", 0.002},
                           {"particle_start", std::string("periodic_flow")}};
    const auto scene = scene_of("thermovibration", common);
    EXPECT_EQ(scene->snapshot().fields.at(0).vectors.at("velocity").size(), 512U);
    while (!scene->finished() && scene->health().stable()) scene->advance(scene->time() + 0.05);
    ASSERT_TRUE(scene->finished()) << scene->health().reason;
    const auto picture = scene->snapshot();
    EXPECT_EQ(picture.fields.at(0).scalars.count("temperature"), 0U);
    double largest = 0;
    for (const auto& v : picture.fields[0].vectors.at("velocity")) largest = std::max(largest, std::abs(v[1]));
    EXPECT_GT(largest, 0);
}

}  // namespace grainsweep::tests::scene_pictures_test
