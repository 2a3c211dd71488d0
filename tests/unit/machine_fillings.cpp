// Particles at the start: as many as asked for or a sentence, wholly inside, apart, pure in the seed, in the shares
// asked for.
#include "solver/machine/filling.hpp"
#include "tests/support/machines.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace grainsweep::tests::machine_fillings_test {

using namespace geometry;
using machine::Fill;
using machine::Filled;
using machine::Region;
using machine::Spec;

/// Two species of 2 and 3 mm, the second of three times the density, in a box of 40 mm.
Spec two_species() {
    Spec spec;
    spec.domain = {{0, 0, 0}, {0.04, 0.04, 0.04}, {}};
    spec.materials = {"a", "b"};
    spec.densities = {1000, 3000};
    dem::Material material;
    material.youngs_modulus = 5e6;
    spec.pairs = {material, material, material};
    spec.species.push_back({"small", 0, 0.002, particles::SizeDistribution::uniform(0.2)});
    spec.species.push_back({"large", 1, 0.003, {}});
    spec.phases.push_back(
        {.name = "only", .duration = 1, .expected = {}, .until = {}, .frames = 10, .ends_at_frames = false});
    spec.time_step = 1e-5;
    return spec;
}

Fill filling(std::int64_t count, const Region& in, Fill::As as) {
    return {{{0, 0.75}, {1, 0.25}}, count, in, as, {0, 0, -1}, 0.1};
}

std::vector<Region> regions() {
    const Region box{Region::Box{{0.002, 0.002, 0.002}, {0.038, 0.038, 0.03}}};
    return {box,
            {Region::Round{{0.02, 0.02, 0.001}, {0, 0, 1}, 0.018, 0.004, 0.03}},
            {Region::Ball{{0.02, 0.02, 0.02}, 0.019}},
            {Region::All{{box, {Region::Half{{0.02, 0, 0}, {1, 0, 0}}}}}},
            {Region::All{{box, {Region::Not{{{Region::Ball{{0.02, 0.02, 0.01}, 0.01}}}}}}}}};
}

/// Distance by the nearest image.
double distance(const Spec& spec, Vec3 a, const Vec3& b) {
    for (std::size_t k = 0; k < 3; ++k)
        if (spec.domain.periodic[k]) a[k] -= spec.domain.length(k) * std::round((a[k] - b[k]) / spec.domain.length(k));
    return norm(a - b);
}

void expect_apart(const Spec& spec, const Filled& filled) {
    for (std::size_t i = 0; i < filled.spheres.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
            const auto &a = filled.spheres[i], &b = filled.spheres[j];
            ASSERT_GE(distance(spec, a.position, b.position), (a.radius + b.radius) * (1 - 1e-12)) << i << " " << j;
        }
}

constexpr std::array every_way = {Fill::As::lattice, Fill::As::random, Fill::As::rain, Fill::As::packed};

std::string refusal(const Spec& spec) {
    try {
        (void)machine::filled(spec, 1);
    } catch (const std::invalid_argument& why) {
        return why.what();
    }
    return "no complaint";
}

TEST(MachineFillings, AreInTheirRegionApartAndComplete) {
    for (const Region& region : regions())
        for (const auto as : every_way) {
            Spec spec = two_species();
            spec.fills = {filling(100, region, as)};
            const Filled filled = machine::filled(spec, 3);
            ASSERT_EQ(filled.spheres.size(), 100U);
            ASSERT_EQ(filled.species.size(), 100U);
            EXPECT_EQ(std::ranges::count(filled.species, 0), 75);
            for (std::size_t i = 0; i < 100; ++i) {
                const dem::Sphere& s = filled.spheres[i];
                EXPECT_GE(region.depth(s.position), s.radius * (1 - 1e-9)) << region.is.index() << " " << i;
                EXPECT_EQ(s.kind, filled.species[i]);
                const double d = 2 * s.radius;
                if (filled.species[i] == 0) {
                    EXPECT_GE(d, 0.0016);
                    EXPECT_LE(d, 0.0024);
                } else {
                    EXPECT_EQ(d, 0.003);
                }
                for (std::size_t k = 0; k < 3; ++k) EXPECT_LE(std::abs(s.velocity[k] - (k == 2 ? -1 : 0)), 0.1);
            }
            expect_apart(spec, filled);
        }
}

TEST(MachineFillings, AreGivenBySpecAndSeed) {
    for (const auto as : every_way) {
        Spec spec = two_species();
        spec.fills = {filling(60, regions()[0], as)};
        const auto same = [](const Filled& a, const Filled& b) {
            return a.species == b.species &&
                   std::ranges::equal(a.spheres, b.spheres, [](const dem::Sphere& x, const dem::Sphere& y) {
                       return x.position == y.position && x.velocity == y.velocity && x.radius == y.radius;
                   });
        };
        EXPECT_TRUE(same(machine::filled(spec, 5), machine::filled(spec, 5)));
        EXPECT_FALSE(same(machine::filled(spec, 5), machine::filled(spec, 6)));
    }
}

TEST(MachineFillings, RefuseWhatDoesNotFit) {
    Spec spec = two_species();
    spec.fills = {filling(100000, regions()[0], Fill::As::lattice)};
    EXPECT_NE(refusal(spec).find("small and large: "), std::string::npos) << refusal(spec);
    EXPECT_NE(refusal(spec).find(" of 100000 particles fit"), std::string::npos) << refusal(spec);
    spec.fills = {filling(10, {Region::Box{{0, 0, 0}, {0.002, 0.04, 0.04}}}, Fill::As::lattice)};
    EXPECT_NE(refusal(spec).find("0 of 10 particles"), std::string::npos) << "too thin for the largest";
    spec.fills = {filling(10, {Region::Box{{0, 0, 0}, {0.001, 0.04, 0.04}}}, Fill::As::lattice)};
    EXPECT_NE(refusal(spec).find("the region of the filling is 0.001 m wide along x"), std::string::npos)
        << refusal(spec);
    spec.fills = {filling(10, {Region::Box{{1, 1, 1}, {2, 2, 2}}}, Fill::As::lattice)};
    EXPECT_NE(refusal(spec).find("the region of the filling lies outside of the domain along x"), std::string::npos);
    for (const auto how : every_way) {
        spec.fills = {filling(10, regions()[0], how)};
        spec.walls = {{"lid", Plane{{0, 0, 0.035}, {0, 0, 1}}, {}, {{}, {}}, {}}};
        EXPECT_NE(refusal(spec).find("has no place for a particle: wall 'lid' takes it up"), std::string::npos)
            << refusal(spec);
    }
    spec.walls.clear();
    spec.fills = {filling(800, {Region::Box{{0, 0, 0}, {0.02, 0.02, 0.02}}}, Fill::As::random)};
    EXPECT_NE(refusal(spec).find("find no place at random"), std::string::npos);
    spec.fills = {filling(800, {Region::Box{{0, 0, 0}, {0.02, 0.02, 0.02}}}, Fill::As::rain)};
    EXPECT_NE(refusal(spec).find("of 800 particles fills the region up to its top"), std::string::npos);
    spec.fills = {filling(800, {Region::Box{{0, 0, 0}, {0.02, 0.02, 0.02}}}, Fill::As::packed)};
    EXPECT_NE(refusal(spec).find("of 800 particles fit into the region in a close packing"), std::string::npos);
    spec.fills = {filling(60, regions()[0], Fill::As::random), filling(60, regions()[0], Fill::As::random)};
    EXPECT_NE(refusal(spec).find("two fillings overlap"), std::string::npos);
    spec.fills = {filling(60, regions()[0], Fill::As::random)};
    EXPECT_EQ(refusal(spec), "no complaint");
}

// Of equal spheres the packing has its fraction, and the lowest come first; rain is loose, and layers do not mix.
TEST(MachineFillings, PackedIsDenseAndRainIsLoose) {
    Spec spec = two_species();
    const Region box{Region::Box{{0, 0, 0}, {0.04, 0.04, 0.04}}};
    Fill fill = filling(2000, box, Fill::As::packed);
    fill.mix = {{1, 1.0}};
    spec.fills = {fill};
    double top = 0;
    for (const auto& sphere : machine::filled(spec, 1).spheres) top = std::max(top, sphere.position[2] + 0.0015);
    // 2000 spheres of 3 mm at 0.62, centres half a diameter off every face: (2000 pi/6 d^3/0.62)/(37 mm)^2 + d.
    EXPECT_NEAR(top, 0.0363, 0.001);
    fill.as = Fill::As::rain;
    fill.count = 400;
    spec.fills = {fill};
    const Filled rain = machine::filled(spec, 1);
    top = 0;
    for (std::size_t n = 0; n < 400; ++n) {
        const double z = rain.spheres[n].position[2];
        EXPECT_GT(z, top - 0.003) << n;
        top = std::max(top, z);
    }
    EXPECT_GT(top, 400 * std::numbers::pi / 6 * 2.7e-8 / 0.17 / 0.0016) << "at most 0.17 of the space";
}

TEST(MachineFillings, KeepOffWallsWhereTheyStandAtTheStart) {
    for (const auto as : every_way) {
        Spec spec = two_species();
        const Region box{Region::Box{{0.002, 0.002, 0.002}, {0.038, 0.038, 0.038}}};
        spec.fills = {filling(100, box, as)};
        spec.phases.push_back(
            {.name = "later", .duration = 1, .expected = {}, .until = {}, .frames = 10, .ends_at_frames = false});
        machine::MachineWall plate{"plate", Plane{{0, 0, 0.02}, {0, 0, 1}}, {}, {}, {}};
        const auto lowest = [&] {
            double low = 1;
            for (const dem::Sphere& s : machine::filled(spec, 2).spheres) low = std::min(low, s.position[2] - s.radius);
            return low;
        };
        EXPECT_LT(lowest(), 0.02);
        spec.walls = {plate};
        EXPECT_GE(lowest(), 0.02);
        spec.walls[0].during = {1};
        EXPECT_LT(lowest(), 0.02) << "it comes later";
        spec.walls[0].during = {0};
        spec.walls[0].motions = {{Translation{.velocity = {0, 0, 1}}, {}}};
        EXPECT_GE(lowest(), 0.02) << "it moves, and starts here";
    }
}

TEST(MachineFillings, RepeatThemselvesWithThePeriod) {
    for (const auto as : every_way) {
        Spec spec = two_species();
        spec.domain = {{0, 0, 0}, {0.01, 0.04, 0.04}, {true, false, false}};
        // Beyond both faces along x: particles may reach across them.
        spec.fills = {filling(60, {Region::Box{{-1, 0, 0}, {1, 0.04, 0.04}}}, as)};
        const Filled filled = machine::filled(spec, 4);
        EXPECT_EQ(filled.spheres.size(), 60U);
        expect_apart(spec, filled);
    }
}

TEST(MachineFillings, SpheresOneByOneStayAsGiven) {
    Spec spec = two_species();
    dem::Sphere one;
    one.position = {0.01, 0.01, 0.01};
    one.angular_velocity = {1, 2, 3};
    one.radius = 0.0007;
    spec.fills = {std::vector<machine::Placed>{{1, one}, {0, one}}, filling(0, regions()[0], Fill::As::lattice)};
    const Filled filled = machine::filled(spec, 1);
    ASSERT_EQ(filled.spheres.size(), 2U) << "they may overlap, and a filling may be empty";
    EXPECT_EQ(filled.spheres[0].kind, 1);
    EXPECT_EQ(filled.spheres[0].angular_velocity, one.angular_velocity);
    EXPECT_EQ(filled.species, (std::vector<std::uint8_t>{1, 0}));
}

// Of 2 mm and 3 mm spheres of 1000 and 3000 kg/m3, half and half: by number 1:1; by volume n ~ 1/v, 27:8; by mass
// n ~ 1/m, 81:8.
TEST(MachineFillings, MixesAreByCountMassOrVolume) {
    const auto count_large = [](const char* by, const char* what, const nlohmann::json& much) {
        nlohmann::json document = small_machine();
        document["species"] = {{"light", {{"material", "glass"}, {"diameter", 0.002}}},
                               {"heavy", {{"material", "steel"}, {"diameter", 0.003}}}};
        document["materials"]["glass"]["density"] = 1000;
        document["materials"]["steel"]["density"] = 3000;
        auto& fill = document["fill"][0];
        fill = {{"mix", {{"light", 0.5}, {"heavy", 0.5}}}, {"by", by}, {"in", fill["in"]}};
        fill[what] = much;
        const auto spec = spec_of(document);
        const auto& given = std::get<Fill>(spec.fills[0]);
        double share = 0;
        for (const auto& [species, of] : given.mix)
            if (spec.species[species].name == "heavy") share = of;
        return std::pair(given.count, share);
    };
    EXPECT_NEAR(count_large("count", "count", 100).second, 0.5, 1e-12);
    EXPECT_NEAR(count_large("volume", "count", 100).second, 8.0 / 35, 1e-12);
    EXPECT_NEAR(count_large("mass", "count", 100).second, 8.0 / 89, 1e-12);
    const double v = std::numbers::pi / 6 * 1e-9, small = 8 * v, large = 27 * v;
    EXPECT_EQ(count_large("count", "volume", 10 * (small + large)).first, 20);
    EXPECT_EQ(count_large("count", "mass", 10 * (1000 * small + 3000 * large)).first, 20);
    EXPECT_EQ(count_large("mass", "mass", "0*bars").first, 0);
}

}  // namespace grainsweep::tests::machine_fillings_test
