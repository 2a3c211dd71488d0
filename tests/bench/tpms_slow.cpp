// Mixed against double precision where errors of single precision would add up for longest: a Schwarz-P cell that
// cohesion jams, minutes of processor time: slow_tpms.
//
// A close packing that only just touches is an unstable equilibrium once its spheres attract each other: which of
// two pairs, both within 2e-8 diameters of contact, is drawn together first depends on the last digits of the
// coordinates, and decides which arches form. One packing that two programs, or two precisions, round differently is
// therefore two realisations. Precisions are compared over many packings, each disturbed by both in its own way.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>

#include "solver/scenes/scene.hpp"
#include "sweep/campaign/installed_machines.hpp"

using namespace grainsweep;

namespace {

constexpr int packings = 16;

struct Mean {
    double value = 0, square = 0;  ///< of its standard error
};

/// Retention at `time` (in t*) over packings, edge 20 diameters, k_c 35 kJ/m3, gravity scaled as in the full cell.
Mean retention(const std::string& precision, double time) {
    double sum = 0, squares = 0;
    for (int seed = 1; seed <= packings; ++seed) {
        const SceneInfo& info = *campaign::scene_named("tpms_discharge");
        Inputs inputs = info.defaults();
        inputs["edge"] = 20.0;
        inputs["shell"] = 2.0;
        inputs["gravity"] = 9.81 * 100 / 20;
        inputs["cohesion"] = 35e3;
        inputs["packing_seed"] = std::int64_t{seed};
        inputs["precision"] = precision;
        inputs["end_time"] = time;
        inputs["settle_rule"] = std::string("none");
        NoArtefacts none;
        const auto scene = info.make(inputs, 1, none);
        scene->advance(1e9);
        EXPECT_TRUE(scene->health().stable()) << scene->health().reason;
        Observations found;
        scene->observe(found);
        const double r = found.scalars.at("retention");
        sum += r;
        squares += r * r;
    }
    const double mean = sum / packings;
    return {mean, (squares / packings - mean * mean) / (packings - 1)};
}

}  // namespace

TEST(CohesiveJam, IsTheSameInMixedAndDoublePrecision) {
    const Mean mixed = retention("mixed", 2), exact = retention("double", 2);
    const double error = std::sqrt(mixed.square + exact.square);
    std::printf("retention at 2 t*: mixed %.4f, double %.4f, standard error of the difference %.4f\n", mixed.value,
                exact.value, error);
    EXPECT_LT(error, 0.01);
    EXPECT_NEAR(mixed.value, exact.value, 3 * error);
}
