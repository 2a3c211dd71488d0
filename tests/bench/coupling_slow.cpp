// Accumulation of one-way particles in the periodic flow of run 21, minutes of processor time: slow_coupling.
// Compared with an independent program (trilinear gather, harmonics, 16 steps per period, one cloud of 3150): K on 10^3
// cells has a standard deviation of 0.005 between clouds, so bounds are three of those.
#include "solver/scenes/scene.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

using namespace grainsweep;

namespace {

class Shelf final : public Artefacts {
public:
    [[nodiscard]] std::optional<Bytes> get(std::string_view key) override {
        const auto found = kept_.find(key);
        return found == kept_.end() ? std::nullopt : std::optional<Bytes>(found->second);
    }
    void put(std::string_view key, std::span<const std::byte> contents) override {
        kept_[std::string(key)] = Bytes(contents.begin(), contents.end());
    }

private:
    std::map<std::string, Bytes, std::less<>> kept_;
};

Shelf shelf;  // the flow is found once for all tests

// K on 10^3 cells as time goes by.
struct History {
    std::vector<Sample> samples;

    [[nodiscard]] double at(double time) const {
        const Sample* nearest = &samples.front();
        for (const Sample& sample : samples)
            if (std::abs(sample.time - time) < std::abs(nearest->time - time)) nearest = &sample;
        return nearest->value;
    }
};

History accumulation(const Inputs& changes, double end_time) {
    const SceneInfo& info = *find_scene("thermovibration");
    Inputs inputs = info.defaults();
    inputs["particle_start"] = std::string("periodic_flow");
    inputs["symmetry"] = std::string("mirror");
    inputs["steps_per_period"] = std::int64_t{16};
    inputs["end_time"] = end_time;
    for (const auto& [name, value] : changes) inputs[name] = value;
    const auto scene = info.make(inputs, 1, shelf);
    while (!scene->finished() && scene->health().stable()) scene->advance(scene->time() + 0.01);
    EXPECT_TRUE(scene->health().stable()) << scene->health().reason;
    Observations found;
    scene->observe(found);
    std::printf("t %g (flow and particles %g): K %.4f excess %.4f structures %g\n", end_time, scene->time(),
                found.scalars["accumulation"], found.scalars["accumulation_excess"], found.scalars["structures"]);
    std::fflush(stdout);
    return {found.series["accumulation_series"]};
}

}  // namespace

// xi = 1: no slip, so particles follow an incompressible flow and stay random (0.2234) whatever the kernel.
TEST(OneWayAccumulation, TracersStayRandom) {
    for (const char* kernel : {"trilinear", "solenoidal"}) {
        const auto history = accumulation({{"density_ratio", 1.0}, {"interpolation", std::string(kernel)}}, 0.339);
        for (const double t : {0.188, 0.339}) EXPECT_NEAR(history.at(t), 0.2234, 0.015) << kernel << ' ' << t;
    }
}

TEST(OneWayAccumulation, GrowsAsInAnIndependentProgram) {
    const auto history = accumulation({}, 0.678);
    const std::pair<double, double> table[] = {{0.188, 0.2527}, {0.339, 0.2712}, {0.490, 0.3022}, {0.678, 0.3114}};
    for (const auto& [t, k] : table) {
        std::printf("t %g: K %.4f, elsewhere %.4f\n", t, history.at(t), k);
        EXPECT_NEAR(history.at(t), k, 0.015) << t;
    }
}

// Contact of the centre instead of the surface: two thirds to nine tenths of the excess.
TEST(OneWayAccumulation, IsWeakerWithContactOfTheCentre) {
    const auto history = accumulation({{"wall_contact", std::string("centre")}}, 0.678);
    const std::pair<double, double> table[] = {{0.188, 0.2452}, {0.339, 0.2564}, {0.490, 0.2797}, {0.678, 0.2948}};
    for (const auto& [t, k] : table) {
        std::printf("t %g: K %.4f, elsewhere %.4f\n", t, history.at(t), k);
        EXPECT_NEAR(history.at(t), k, 0.015) << t;
    }
}
