// Powder of unequal spheres under the blade: what is drawn is what was asked, and equal spheres are a limit of it.
#include "solver/scenes/scene.hpp"
#include "sweep/campaign/installed_machines.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <numbers>

namespace grainsweep::tests::powder_spreading_sizes_test {

std::unique_ptr<Scene> make(const Inputs& inputs, std::uint64_t seed) {
    static NoArtefacts none;
    return campaign::scene_named("powder_spreading")->make(inputs, seed, none);
}

Inputs powder(const char* distribution, double spread = 0.2) {
    Inputs inputs = campaign::scene_named("powder_spreading")->defaults();
    inputs["size_distribution"] = std::string(distribution);
    inputs["size_spread"] = spread;
    return inputs;
}

double volume(const std::vector<double>& diameters) {
    double sum = 0;
    for (const double d : diameters) sum += std::numbers::pi / 6 * d * d * d;
    return sum;
}

// The sizes of a layer of about 9000 particles: shares of the five classes by chi-square with 4 degrees of freedom,
// 18.5 at one in a thousand; and half of the last sphere is all the volume may miss.
TEST(PowderSizes, AreDrawnAsAsked) {
    Inputs inputs = powder("weibull_wide");
    inputs["width"] = 50.0;
    const auto scene = make(inputs, 11);
    const auto diameters = scene->snapshot().scalars.at("diameter");
    std::map<long, double> counts;
    for (const double d : diameters) ++counts[std::lround(d / 0.002 * 100)];
    const std::map<long, double> shares = {{70, 4.44}, {85, 22.76}, {100, 40.78}, {115, 26.91}, {130, 5.11}};
    ASSERT_EQ(counts.size(), shares.size());
    double chi_square = 0;
    for (const auto& [d, share] : shares) {
        const double expected = share / 100 * static_cast<double>(diameters.size());
        chi_square += (counts.at(d) - expected) * (counts.at(d) - expected) / expected;
    }
    EXPECT_LT(chi_square, 18.5);
    const double largest = std::numbers::pi / 6 * std::pow(0.0026, 3);
    EXPECT_NEAR(volume(diameters), 400e-6 * 0.1, largest / 2 * (1 + 1e-3));
}

// No particle is lost or counted twice: every sphere stays, and what passed the blade plus what lies ahead of it is
// the mass of the layer. mfr in volumes is the difference of the volumes behind at its two times.
TEST(PowderSizes, MassIsConserved) {
    Inputs inputs = powder("lognormal", 0.3);
    inputs["layer_area"] = 2e-4;
    const auto scene = make(inputs, 3);
    const auto before = scene->snapshot().scalars.at("diameter");
    scene->advance(0.15 + 0.02 / 1.4 + 1e-9);  // at or one step beyond t1
    const auto behind = [&](double travel) {
        const auto picture = scene->snapshot();
        double sum = 0;
        for (std::size_t i = 0; i < picture.positions.size(); ++i)
            if (picture.positions[i][0] < 0.015 + travel)
                sum += std::numbers::pi / 6 * std::pow(picture.scalars.at("diameter")[i], 3);
        return sum;
    };
    const double first = behind(0.02);
    scene->advance(std::numeric_limits<double>::infinity());
    ASSERT_TRUE(scene->finished()) << scene->health().reason;
    const double last = behind(0.07);
    EXPECT_EQ(scene->snapshot().scalars.at("diameter"), before);
    Observations seen;
    scene->observe(seen);
    const double expected = (last - first) / (0.02 * 0.004 * 0.05);
    EXPECT_NEAR(seen.scalars.at("mfr"), expected, 0.02 * expected);
    EXPECT_EQ(seen.scalars.at("particles"), static_cast<double>(before.size()));
    for (const auto& [name, value] : seen.scalars) EXPECT_TRUE(std::isfinite(value)) << name;
}

// A lognormal distribution without spread is the same powder as a monodisperse one, started differently (random
// addition against the lattice) and computed with the laws of unequal spheres: the mean over 8 seeds of each must
// agree within three standard errors of their difference, 3.5 % of the mean per seed.
TEST(PowderSizes, EqualSpheresAreTheLimitOfNoSpread) {
    constexpr int seeds = 8;
    const auto mean = [](Inputs inputs) {
        inputs["diameter"] = 0.0025;
        inputs["gap"] = 0.005;
        double sum = 0;
        for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
            const auto scene = make(inputs, seed);
            scene->advance(std::numeric_limits<double>::infinity());
            Observations seen;
            scene->observe(seen);
            sum += seen.scalars.at("mfr") / seeds;
        }
        return sum;
    };
    const double equal = mean(powder("monodisperse"));
    EXPECT_NEAR(mean(powder("lognormal", 0)) / equal, 1, 3 * 0.035 * std::sqrt(2.0 / seeds));
    // Order is lost with a few percent of spread: at a gap of two diameters a wide distribution passes a quarter less.
    EXPECT_LT(mean(powder("weibull_wide")), 0.88 * equal);
}

TEST(PowderSizes, RefusesSpheresTooLargeForTheWidth) {
    Inputs inputs = powder("lognormal", 0.5);
    inputs["width"] = 4.0;
    EXPECT_THROW((void)make(inputs, 1), std::invalid_argument);
}

}  // namespace grainsweep::tests::powder_spreading_sizes_test
