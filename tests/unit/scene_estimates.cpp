// What a case will cost, and what is warned of, where files say how large the particles are and what the tool is.
#include "solver/particles/packing.hpp"
#include "solver/particles/random_addition.hpp"
#include "solver/scenes/scene.hpp"
#include "sweep/campaign/installed_machines.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace grainsweep::tests::scene_estimates_test {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

const std::string file_input = "file:" + std::string(32, '0') + ":/there";

Inputs sized(const char* scene, double diameter) {
    Inputs inputs = campaign::scene_named(scene)->defaults();
    inputs["diameter"] = diameter;
    inputs["size_distribution"] = std::string("file");
    inputs["size_file"] = file_input;
    return inputs;
}

Files sizes(const std::string& rows) {
    return {{"size_file", "diameter,number_fraction\n" + rows}};
}

std::string facet(const std::array<std::array<double, 3>, 3>& corners) {
    std::string text = "facet normal 0 0 0\nouter loop\n";
    for (const auto& c : corners)
        text += "vertex " + std::to_string(c[0]) + " " + std::to_string(c[1]) + " " + std::to_string(c[2]) + "\n";
    return text + "endloop\nendfacet\n";
}

/// A bar from x0 to x1, z0 to z1, m in the file, as long as `length`.
std::string bar(double x0, double x1, double z0, double z1, double length) {
    const std::array<std::array<double, 2>, 4> at = {{{x0, z0}, {x1, z0}, {x1, z1}, {x0, z1}}};
    std::string text;
    for (std::size_t k = 0; k < 4; ++k) {
        const auto &a = at[k], &b = at[(k + 1) % 4];
        text += facet({{{a[0], 0, a[1]}, {b[0], 0, b[1]}, {b[0], length, b[1]}}});
        text += facet({{{a[0], 0, a[1]}, {b[0], length, b[1]}, {a[0], length, a[1]}}});
    }
    return text;
}

std::string solid(const std::string& facets) {
    return "solid tool\n" + facets + "endsolid tool\n";
}

std::vector<std::string> kinds(const Inputs& inputs, const Files& files) {
    std::vector<std::string> found;
    for (const auto& warning : campaign::scene_named("powder_spreading")->warnings(inputs, files))
        found.push_back(warning.kind);
    return found;
}

Inputs with_tool(double scale) {
    Inputs inputs = campaign::scene_named("powder_spreading")->defaults();
    inputs["tool"] = file_input;
    inputs["tool_scale"] = scale;
    return inputs;
}

// The smallest size sets the step, and their number follows from the mean volume.
TEST(SceneEstimates, CountWhatIsDrawnFromAFile) {
    const auto& spreading = *campaign::scene_named("powder_spreading");
    const double d = 1e-3;
    const auto one = spreading.estimate_cost(sized("powder_spreading", d), sizes("1e-3,1\n"));
    const auto half = spreading.estimate_cost(sized("powder_spreading", d), sizes("0.5e-3,0.5\n1e-3,0.5\n"));
    // The mean volume is (1/8 + 1)/2 of that of D; steps are at most twice as many, where Rayleigh's time limits.
    const double more = 2 / (1 + 0.125);
    EXPECT_GT(half.particle_steps, 1.5 * more * one.particle_steps);
    EXPECT_LT(half.particle_steps, 2.1 * more * one.particle_steps);
    // Steps are 2.5 times as many. A hopper holds 0.53 of the volume and is empty so much sooner: 1.33 times at least.
    for (const auto& [scene, least] : {std::pair("hopper", 1.33), {"heap", 1.8}, {"rotating_drum", 1.8}}) {
        const auto& info = *campaign::scene_named(scene);
        Inputs inputs = sized(scene, 5e-3);
        const double coarse = info.estimate_cost(inputs, sizes("5e-3,1\n")).seconds;
        const double fine = info.estimate_cost(inputs, sizes("2e-3,0.5\n5e-3,0.5\n")).seconds;
        EXPECT_GT(fine, least * coarse) << scene;
    }
    EXPECT_THROW((void)spreading.estimate_cost(sized("powder_spreading", d), {}), std::invalid_argument);
}

TEST(SceneEstimates, WarnOfSizesThatTheNumberCannotHold) {
    const auto kind = std::string("sizes too rare for the number of particles");
    Inputs inputs = sized("powder_spreading", 1e-3);
    inputs["width"] = 20.0;
    EXPECT_THAT(kinds(inputs, sizes("1e-3,0.5\n1.2e-3,0.5\n")), testing::Not(testing::Contains(kind)));
    EXPECT_THAT(kinds(inputs, sizes("1e-3,0.9999\n4e-3,0.0001\n")), testing::Not(testing::Contains(kind)))
        << "0.6 % of the volume";
    EXPECT_THAT(kinds(inputs, sizes("1e-3,0.9997\n9e-3,0.0003\n")), testing::Contains(kind)) << "18 % of the volume";
}

TEST(SceneEstimates, AToolFromAFileDrawsTheWarningOfABar) {
    EXPECT_THAT(kinds(with_tool(1e-3), {{"tool", solid(bar(0, 5, 0, 40, 200))}}), testing::IsEmpty());
    EXPECT_THAT(kinds(with_tool(1e-3), {{"tool", solid(bar(0, 60, 0, 40, 200))}}),
                testing::Contains("tool thicker than the measured travel"));
    EXPECT_THAT(kinds(with_tool(1e-3), {{"tool", solid(bar(0, 0.5, 0, 40, 200))}}),
                testing::Contains("size of the tool"));
    EXPECT_THAT(kinds(with_tool(1e-3), {{"tool", solid(bar(0, 5, 0, 10, 200))}}), testing::ElementsAre("low tool"))
        << "the layer is 7 mm high before the tool";
}

TEST(SceneEstimates, AToolOfAWrongUnitIsRefusedWithItsSize) {
    const auto ask = [](double scale, const std::string& stl) {
        return [=] { (void)campaign::scene_named("powder_spreading")->warnings(with_tool(scale), {{"tool", stl}}); };
    };
    EXPECT_THAT(ask(1, solid(bar(0, 5, 0, 40, 200))),
                ThrowsMessage<std::invalid_argument>(HasSubstr("5 m thick along x and 40 m high")));
    const std::string blade = bar(0, 5, 0, 40, 200);
    for (const auto& stray : {bar(0, 0.1, -3, -2.9, 200), bar(90, 90.1, 10, 10.1, 200), bar(-80, -79.9, 5, 5.1, 200)})
        EXPECT_THAT(ask(1e-3, solid(blade + stray)),
                    ThrowsMessage<std::invalid_argument>(HasSubstr("remove stray triangles")));
    EXPECT_NO_THROW(ask(1e-3, solid(blade + bar(10, 15, 0, 40, 200)))()) << "two bars are a tool";
    const std::string joined = facet({{{0, 0, 0}, {0.01, 0, -3}, {-0.01, 200, -3}}});
    EXPECT_THAT(ask(1e-3, solid(blade + joined)), ThrowsMessage<std::invalid_argument>(AllOf(
                                                      HasSubstr("1 of 9 triangles"), HasSubstr("-0.003) m of the file"),
                                                      HasSubstr("reach 0.003 m beyond"))));
}

TEST(SceneEstimates, AToolWhoseEdgeIsTheTipOfANeedleIsWarnedOf) {
    const auto with = [](const std::string& tip) {
        return kinds(with_tool(1e-3), {{"tool", solid(bar(0, 5, 0, 40, 200) + tip)}});
    };
    // Drawn out of the blade's open end.
    EXPECT_THAT(with(facet({{{0, 0, 0}, {5, 0, 0}, {2, 0, -8}}})), testing::IsEmpty()) << "as wide as the blade";
    EXPECT_THAT(with(facet({{{0, 0, 0}, {5, 0, 0}, {2, 0, -13}}})), testing::Contains("tip of the tool"));
}

// 4e14 boxes of two diameters would not fit any machine.
TEST(SceneEstimates, AFillingTakesMemoryByItsSpheres) {
    const std::vector<double> radii(400, 5e-7);
    const particles::Room room{{0, 0, 0}, {0.1, 0.1, 0.1}, {}, {}};
    const auto placed = particles::random_addition(room, radii, 7);
    ASSERT_TRUE(placed);
    EXPECT_EQ(placed->size(), radii.size());
}

TEST(SceneEstimates, CountTheGluedSpheres) {
    Inputs rough = campaign::scene_named("powder_spreading")->defaults();
    rough["diameter"] = 1e-6;
    rough["gap"] = 1e-5;
    rough["travel"] = 0.5;
    rough["layer_area"] = 1e-9;
    rough["blade_thickness"] = 1e-4;
    const double smooth_bytes = campaign::scene_named("powder_spreading")->estimate_cost(rough, {}).bytes;
    rough["base"] = std::string("rough");
    const double glued = 0.52e6 * 10 / (1.2 * 1.2);
    EXPECT_NEAR(campaign::scene_named("powder_spreading")->estimate_cost(rough, {}).bytes - smooth_bytes, 1500 * glued,
                0.05 * 1500 * glued);
}

TEST(SceneEstimates, APackingWithoutRoomIsRefusedBeforeItsPairs) {
    std::string csv = "x,y,z\n";
    for (int k = 0; k < 4000; ++k) csv += std::to_string(0.002 * k) + ",0.5,0.5\n";
    EXPECT_THAT([&] { (void)particles::read_packing(csv, 10); },
                ThrowsMessage<std::invalid_argument>(HasSubstr("have room, so that they overlap")));
}

}  // namespace grainsweep::tests::scene_estimates_test
