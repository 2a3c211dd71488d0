// The kit of scenes: what a handle declares is what it reads, and the powder block means what it says.
#include "solver/dem/material.hpp"
#include "solver/scenes/kit/powder.hpp"
#include "solver/scenes/kit/stl_wall.hpp"
#include "solver/scenes/scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace grainsweep::tests::scenes_kit_test {

constexpr kit::Powder powder;
constexpr kit::Whole count{"count", "how many", 3, {0, 10}, {kit::if_set("friction"), kit::if_zero("cohesion")}};
constexpr kit::Scalar seen{"seen", "m", "what is seen"};
constexpr kit::Series course{"course", "m", "what is seen", "time (s)"};

Inputs defaults(const std::vector<ParameterSpec>& specs) {
    Inputs inputs;
    for (const auto& spec : specs) inputs.emplace(spec.name, spec.default_value);
    return inputs;
}

std::vector<ParameterSpec> block() {
    return kit::declared(powder.diameter, powder.size_distribution, powder.size_spread, powder.size_file,
                         powder.density, powder.youngs_modulus, powder.poisson_ratio, powder.restitution,
                         powder.friction, powder.rolling_friction, powder.rolling_law, powder.tangential_limit,
                         powder.cohesion, powder.cohesion_law, powder.surface_energy, powder.time_step,
                         powder.time_step_fraction, powder.precision);
}

TEST(Kit, HandlesReadWhatTheyDeclare) {
    const auto specs = kit::declared(powder.friction, powder.cohesion_law, powder.size_file, count);
    auto inputs = defaults(specs);
    EXPECT_EQ(powder.friction(inputs), 0.2);
    EXPECT_EQ(powder.cohesion_law(inputs), dem::CohesionLaw::sjkr);
    EXPECT_FALSE(powder.size_file(inputs));
    EXPECT_EQ(count(inputs), 3);
    inputs["cohesion_law"] = std::string("paper");
    EXPECT_EQ(powder.cohesion_law(inputs), dem::CohesionLaw::paper);
    inputs["cohesion_law"] = std::string("glue");
    EXPECT_THROW((void)powder.cohesion_law(inputs), std::invalid_argument);
    EXPECT_THROW((void)powder.density(inputs), std::logic_error) << "not declared";

    ASSERT_EQ(specs[3].relevant_if.size(), 2U);
    EXPECT_EQ(specs[3].relevant_if[0].other, "friction");
    EXPECT_EQ(specs[3].relevant_if[1].condition, Relevance::Condition::zero);
    ASSERT_EQ(specs[2].relevant_if.size(), 1U);
    EXPECT_EQ(specs[2].relevant_if[0].words, std::vector<std::string>{"file"});
    EXPECT_TRUE(std::get<Words>(specs[2].bounds).file_allowed);
    EXPECT_THROW(std::get<Words>(specs[2].bounds).check_file("no table"), std::invalid_argument);
}

TEST(Kit, HandlesRecordWhatTheyDeclare) {
    const auto specs = kit::observed(seen, course);
    Observations into;
    seen.record(into, 2);
    seen.record(into, 3);
    course.in(into).push_back({.time = 1, .value = 4});
    EXPECT_EQ(into.scalars.at(specs[0].name), 3);
    EXPECT_EQ(into.series.at(specs[1].name).size(), 1U);
    EXPECT_EQ(specs[1].shape, Shape::series);
    EXPECT_EQ(specs[1].over, "time (s)");
}

TEST(Kit, SizesInAFileAreTakenAsTheyAre) {
    auto inputs = defaults(block());
    inputs["size_distribution"] = std::string("file");
    EXPECT_THROW((void)powder.sizes(inputs, {}), std::invalid_argument) << "no file named";
    inputs["size_file"] = "file:" + std::string(32, '0') + ":/sizes.csv";
    EXPECT_THROW((void)powder.sizes(inputs, {}), std::invalid_argument) << "no file given";
    const Files files = {{"size_file", "diameter,number_fraction\n1e-3,0.5\n3e-3,0.5\n"}};
    const auto sizes = powder.sizes(inputs, files);
    EXPECT_DOUBLE_EQ(sizes.smallest() * powder.diameter(inputs), 1e-3);
    EXPECT_DOUBLE_EQ(sizes.moment(1), 1);
    inputs["diameter"] = 4e-3;
    EXPECT_THROW((void)powder.sizes(inputs, files), std::invalid_argument) << "D outside of the file";
}

// The largest value of k A(d) - 4/3 E* sqrt(R*) d^(3/2), searched for.
TEST(Kit, BondNumberIsTheLargestAttractionOverTheWeight) {
    auto inputs = defaults(block());
    inputs["diameter"] = 50e-6;
    inputs["cohesion"] = 2e5;
    for (const auto& [word, factor] : {std::pair("sjkr", 1.0), std::pair("sjkr2", 2.0), std::pair("paper", 0.25)}) {
        inputs["cohesion_law"] = std::string(word);
        const auto material = powder.material(inputs);
        const double radius = 25e-6, stiffness = 4.0 / 3 * dem::effective_modulus(material) * std::sqrt(radius / 2);
        double largest = 0;
        for (int k = 0; k < 200'000; ++k) {
            const double d = 1e-13 * std::pow(1.0001, k);
            if (d > 0.01 * radius) break;
            largest = std::max(largest, 2e5 * factor * std::numbers::pi * radius * d - stiffness * std::pow(d, 1.5));
        }
        EXPECT_NEAR(kit::pull_off_force(material, 50e-6) / largest, 1, 1e-6) << word;
        Observations into;
        kit::record_bond_number(into, material, 50e-6, 9.81);
        EXPECT_NEAR(into.scalars.at("bond_number") * dem::sphere_mass(radius, material.density) * 9.81 / largest, 1,
                    1e-6);
    }
    inputs["surface_energy"] = 2e-3;  // which 'paper' does not know
    EXPECT_EQ(powder.material(inputs).surface_energy, 0);
    for (const auto& [word, factor] : {std::pair("jkr", 1.5), std::pair("dmt", 2.0)}) {
        inputs["cohesion_law"] = std::string(word);
        const auto material = powder.material(inputs);
        EXPECT_EQ(material.cohesion, 0) << "which " << word << " does not know";
        EXPECT_NEAR(kit::pull_off_force(material, 50e-6) / (factor * std::numbers::pi * 2e-3 * 12.5e-6), 1, 1e-12);
    }
    inputs["surface_energy"] = 0.0;
    Observations none;
    kit::record_bond_number(none, powder.material(inputs), 50e-6, 9.81);
    EXPECT_TRUE(none.scalars.empty());
}

TEST(Kit, AWallFromAnStlFileIsItsContents) {
    constexpr kit::StlWall tool = kit::stl_wall("tool_file", "the tool", "tool_scale", "tool_facet_angle");
    const auto specs = kit::declared(tool.file, tool.scale, tool.facet_angle);
    auto inputs = defaults(specs);
    EXPECT_FALSE(tool.given(inputs));
    const std::string text =
        "solid t\nfacet normal 0 0 1\nouter loop\nvertex 0 0 1\nvertex 2 0 1\nvertex 0 3 1\nendloop\nendfacet\n"
        "endsolid t\n";
    const auto& check = std::get<Words>(specs[0].bounds).check_file;
    EXPECT_NO_THROW(check(text));
    EXPECT_THROW(check("x,y,z\n1,2,3\n"), std::invalid_argument);

    inputs["tool_file"] = "file:" + std::string(32, 'a') + ":/somewhere/tool.stl";
    inputs["tool_facet_angle"] = 6.0;
    ASSERT_TRUE(tool.given(inputs));
    const auto mesh = tool.mesh(inputs, {{"tool_file", text}});
    ASSERT_EQ(mesh.triangles().size(), 1U);
    EXPECT_DOUBLE_EQ(mesh.high()[1], 3e-3) << "mm";
    EXPECT_NEAR(mesh.one_contact_angle(), 0.10472, 1e-5);
    const auto refusal = [&](const Files& files) {
        try {
            (void)tool.mesh(inputs, files);
        } catch (const std::invalid_argument& reason) {
            return std::string(reason.what());
        }
        return std::string();
    };
    EXPECT_EQ(refusal({}), "tool_file: the contents of /somewhere/tool.stl are not given");
    EXPECT_EQ(refusal({{"tool_file", "solid t\nendsolid t\n"}}), "tool_file: STL: there is no triangle in it");
}

}  // namespace grainsweep::tests::scenes_kit_test
