// Rollers, tools from STL files, rough bases and several layers: what must hold exactly, or follows from geometry.
#include "solver/scenes/scene.hpp"
#include "sweep/campaign/installed_machines.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <string>

namespace grainsweep::tests::powder_spreading_tools_test {

using testing::HasSubstr;

constexpr double forever = std::numeric_limits<double>::infinity();

const SceneInfo& spreading() {
    return *campaign::scene_named("powder_spreading");
}

Inputs small_case(const Inputs& changes = {}) {
    Inputs inputs = spreading().defaults();
    inputs["diameter"] = 0.003;
    inputs["gap"] = 0.006;
    inputs["width"] = 4.0;
    inputs["layer_area"] = 3e-4;
    inputs["settle_time"] = 0.05;
    inputs["speed"] = 0.5;
    for (const auto& [name, value] : changes) inputs[name] = value;
    return inputs;
}

std::unique_ptr<Scene> make(const Inputs& inputs, const Files& files = {}, std::uint64_t seed = 1) {
    NoArtefacts none;
    return spreading().make(inputs, seed, none, files);
}

Observations finish(Scene& scene) {
    scene.advance(forever);
    EXPECT_TRUE(scene.health().stable()) << scene.health().reason;
    EXPECT_TRUE(scene.finished());
    EXPECT_EQ(scene.progress(), 1);
    Observations seen;
    scene.observe(seen);
    return seen;
}

/// Mean over twelve seeds: one small bed decides nothing.
double mean_of(const char* observable, const Inputs& inputs) {
    constexpr std::uint64_t seeds = 12;
    double sum = 0;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) sum += finish(*make(inputs, {}, seed)).scalars.at(observable);
    return sum / static_cast<double>(seeds);
}

/// A box in mm: rear and front of the tool, its length across, bottom and top.
std::string box(double rear, double front, double length, double bottom, double top) {
    const double x[2] = {rear, front}, y[2] = {0, length}, z[2] = {bottom, top};
    const int corners[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                                {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    std::string text = "solid tool\n";
    for (const auto& triangle : corners) {
        text += "facet normal 0 0 0\nouter loop\n";
        for (const int c : triangle) {
            char line[120];
            std::snprintf(line, sizeof line, "vertex %.17g %.17g %.17g\n", x[c & 1], y[c >> 1 & 1], z[c >> 2 & 1]);
            text += line;
        }
        text += "endloop\nendfacet\n";
    }
    return text + "endsolid tool\n";
}

Inputs with_file(Inputs changes = {}) {
    changes["tool"] = "file:" + std::string(32, 'a') + ":/tool.stl";
    return small_case(changes);
}

std::string refusal(const Inputs& inputs, const Files& files = {}) {
    try {
        (void)make(inputs, files);
    } catch (const std::invalid_argument& reason) {
        return reason.what();
    }
    return {};
}

void expect_equal(const Observations& a, const Observations& b) {
    EXPECT_EQ(a.scalars, b.scalars);
    ASSERT_EQ(a.series.size(), b.series.size());
    for (const auto& [name, samples] : a.series) {
        const auto& others = b.series.at(name);
        ASSERT_EQ(samples.size(), others.size()) << name;
        for (std::size_t k = 0; k < samples.size(); ++k)
            EXPECT_TRUE(samples[k].value == others[k].value ||
                        (std::isnan(samples[k].value) && std::isnan(others[k].value)))
                << name;
    }
}

// A box of triangles is the blade: in double precision the sums are the same up to rounding until chaos sets in, and
// over the whole sweep the same flux within its scatter.
TEST(SpreadingTools, ABoxOfTrianglesIsABlade) {
    const Inputs bar = small_case({{"precision", std::string("double")}});
    const Inputs mesh = with_file({{"precision", std::string("double")}});
    const Files files = {{"tool", box(-7, -2, 12, 30, 150)}};  // 5 mm thick, wherever it stands in its file
    const auto one = make(bar), other = make(mesh, files);
    for (const auto& scene : {one.get(), other.get()}) scene->advance(0.055);
    const auto a = one->snapshot(), b = other->snapshot();
    ASSERT_EQ(a.positions.size(), b.positions.size());
    for (std::size_t k = 0; k < a.positions.size(); ++k)
        for (std::size_t c = 0; c < 3; ++c) ASSERT_NEAR(a.positions[k][c], b.positions[k][c], 1e-8);
    const auto blade = finish(*one).scalars, tool = finish(*other).scalars;
    EXPECT_NEAR(tool.at("mfr"), blade.at("mfr"), 0.1 * blade.at("mfr"));
    EXPECT_NEAR(tool.at("tool_force"), blade.at("tool_force"), 0.2 * blade.at("tool_force"));
    EXPECT_FALSE(tool.contains("mfr_window"));
}

TEST(SpreadingTools, ASurfaceSpansThePeriodOrIsRefused) {
    EXPECT_EQ(refusal(with_file(), {{"tool", box(0, 5, 12, 0, 100)}}), "");
    EXPECT_EQ(refusal(with_file(), {{"tool", box(0, 5, 300, 0, 100)}}), "") << "a long profile";
    EXPECT_THAT(refusal(with_file(), {{"tool", box(0, 5, 11, 0, 100)}}), HasSubstr("must span the width"));
    EXPECT_THAT(refusal(with_file({{"tool_scale", 1e-4}}), {{"tool", box(0, 5, 12, 0, 100)}}),
                HasSubstr("0.0012 m long along y, the layer 0.012 m wide"));
    std::string notched = box(0, 5, 20, 0, 100);
    const std::string tooth = box(0, 5, 7, -2, 0);
    notched.resize(notched.size() - std::string("endsolid tool\n").size());
    notched += tooth.substr(std::string("solid tool\n").size());
    EXPECT_THAT(refusal(with_file(), {{"tool", notched}}), HasSubstr("not the same all along"));
    EXPECT_THAT(refusal(with_file()), HasSubstr("are not given"));
}

TEST(SpreadingTools, ARollerTurnsAndTravels) {
    for (const double spin : {-1.0, 0.0, 2.0}) {
        const auto scene = make(small_case({{"tool", std::string("roller")}, {"roller_spin", spin}}));
        scene->advance(0.05 + 0.02);
        const auto picture = scene->snapshot();
        double low = 1, front = 0;
        for (const auto& wall : picture.walls) {
            if (wall.name != "roller") continue;
            for (const auto& x : wall.corners) {
                low = std::min(low, x[2]);
                front = std::max(front, x[0]);
            }
        }
        EXPECT_NEAR(low, 0.006, 1e-4);
        EXPECT_NEAR(front, 0.015 + 0.5 * (scene->time() - 0.05), 1e-4);
        const auto seen = finish(*scene).scalars;
        EXPECT_GT(seen.at("mfr"), 0.1);
        EXPECT_GT(seen.at("solid_behind"), 0.1);
        EXPECT_LT(seen.at("solid_behind"), 0.7);
        EXPECT_GT(seen.at("tool_force"), 0);
        EXPECT_FALSE(seen.contains("mfr_window"));
    }
    // Friction drives the powder forward under a counter-rotating roller: its travel is the easier.
    const auto force = [](double spin) {
        return mean_of("tool_force", small_case({{"tool", std::string("roller")}, {"roller_spin", spin}}));
    };
    EXPECT_LT(force(2), force(-1));
}

// The momentum balance: without friction and without powder that leaves, what a blade does against the powder's
// friction with the base is a force of the order of friction times weight.
TEST(SpreadingTools, ABladeCarriesTheWeightThatItPushes) {
    const auto seen = finish(*make(small_case({{"gap", 0.001}, {"speed", 0.1}})));  // nothing passes
    EXPECT_EQ(seen.scalars.at("mfr"), 0);
    const double weight = seen.scalars.at("particles") * 7980 * M_PI / 6 * std::pow(0.003, 3) * 9.81 / 0.012;
    EXPECT_GT(seen.scalars.at("tool_force"), 0.1 * weight) << "less than sliding of a part";
    EXPECT_LT(seen.scalars.at("tool_force"), 0.5 * weight) << "friction 0.2, and some acceleration";
}

TEST(SpreadingTools, ARoughBaseHoldsThePowder) {
    const Inputs rough = small_case({{"base", std::string("rough")}});
    const auto scene = make(rough);
    const auto start = scene->snapshot();
    std::size_t glued = 0;
    for (std::size_t k = 0; k < start.positions.size(); ++k) {
        if (start.scalars.at("mobile")[k] != 0) continue;
        ++glued;
        EXPECT_NEAR(start.positions[k][2], -0.0015, 1e-12);
    }
    EXPECT_GT(glued, 60U);
    const auto seen = finish(*scene);
    EXPECT_EQ(seen.scalars.at("particles"), static_cast<double>(scene->snapshot().positions.size() - glued));
    // Nothing slides off: more powder stays, and some lies in the hollows.
    EXPECT_GT(mean_of("packing_fraction", rough), mean_of("packing_fraction", small_case()));
    for (const auto& [name, value] : seen.scalars) EXPECT_TRUE(std::isfinite(value)) << name;
}

TEST(SpreadingLayers, LieOnEachOther) {
    const Inputs inputs = small_case({{"layers", std::int64_t{3}}});
    const auto scene = make(inputs);
    const auto seen = finish(*scene);
    const auto one = finish(*make(small_case()));
    const auto& packing = seen.series.at("packing_by_layer");
    ASSERT_EQ(packing.size(), 3U);
    EXPECT_EQ(packing[2].value, seen.scalars.at("packing_fraction"));
    double gained = 0, slabs = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        gained += packing[k].value;
        slabs += seen.series.at("bed_packing")[k].value;
        EXPECT_GT(packing[k].value, 0.2);
        EXPECT_LT(packing[k].value, 0.74);
    }
    // What the layers have brought lies between the levels, but for the tops of some particles.
    EXPECT_NEAR(slabs, gained, 0.08 * gained);
    EXPECT_FALSE(one.series.contains("packing_by_layer"));
    std::map<std::string, int> walls;
    for (const auto& wall : scene->snapshot().walls) ++walls[wall.name];
    EXPECT_EQ(walls.count("base_beyond"), 1U);
}

// From the same start, in a domain that is higher: rounding differs, and after some impacts the places of particles.
TEST(SpreadingLayers, BeginWithOneLikeTheSingleLayer) {
    constexpr int seeds = 10;
    for (const auto& [of_layers, alone] :
         {std::pair{"packing_by_layer", "packing_fraction"}, std::pair{"mfr_by_layer", "mfr"}}) {
        double sum = 0, squares = 0;
        for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
            const auto several = finish(*make(small_case({{"layers", std::int64_t{2}}}), {}, seed));
            const auto one = finish(*make(small_case(), {}, seed));
            const double difference = several.series.at(of_layers)[0].value - one.scalars.at(alone);
            sum += difference, squares += difference * difference;
        }
        const double mean = sum / seeds, error = std::sqrt((squares / seeds - mean * mean) / (seeds - 1));
        EXPECT_LT(error, 0.02) << of_layers;
        EXPECT_LT(std::abs(mean), 3 * error + 1e-12) << of_layers;
    }
}

TEST(SpreadingLayers, CheckpointsContinueBitForBit) {
    for (const char* precision : {"mixed", "double"}) {
        const Inputs inputs = small_case({{"layers", std::int64_t{2}},
                                          {"tool", std::string("roller")},
                                          {"roller_spin", 1.0},
                                          {"base", std::string("rough")},
                                          {"settle_time", 0.02},
                                          {"precision", std::string(precision)}});
        const auto whole = make(inputs);
        const auto expected = finish(*whole);
        const double layer = whole->time() / 2;
        for (const double t : {0.01, 0.1, layer, layer + 0.01, layer + 0.08}) {
            const auto first = make(inputs);
            first->advance(t);
            Bytes bytes;
            first->save(bytes);
            const auto second = make(inputs);
            second->restore(bytes);
            EXPECT_EQ(second->time(), first->time());
            expect_equal(finish(*second), expected);
        }
    }
}

TEST(SpreadingLayers, NeedWholeSweepsAndAPlatform) {
    EXPECT_THAT(refusal(small_case({{"layers", std::int64_t{2}}, {"standard_error", 0.01}})),
                HasSubstr("leave it 0 with several layers"));
    EXPECT_THAT(
        refusal(small_case({{"layers", std::int64_t{2}}, {"tool", std::string("roller")}, {"roller_diameter", 0.1}})),
        HasSubstr("make travel longer"));
    EXPECT_THAT(refusal(small_case({{"layers", std::int64_t{1000}}})), HasSubstr("at most 1 m"));
}

}  // namespace grainsweep::tests::powder_spreading_tools_test
