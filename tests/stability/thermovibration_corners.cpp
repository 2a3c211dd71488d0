// The corners of the declared bounds: a case finishes with finite answers or says what went wrong; it never crashes,
// never runs on with numbers that are none.
#include "solver/scenes/scene.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

using namespace grainsweep;

namespace {

const SceneInfo& info() {
    return *find_scene("thermovibration");
}

void expect_sound(Inputs inputs, const std::string& what) {
    NoArtefacts none;
    std::unique_ptr<Scene> scene;
    try {
        scene = info().make(inputs, 1, none);
    } catch (const std::invalid_argument&) {
        return;  // impossible together, said in a sentence
    }
    EXPECT_EQ(scene->time(), 0) << what;
    for (int slice = 0; slice < 20 && !scene->finished() && scene->health().stable(); ++slice)
        scene->advance(std::nextafter(scene->time(), 1e300));
    Observations found;
    scene->observe(found);
    if (!scene->health().stable()) {
        EXPECT_NE(scene->health().reason.find("t = "), std::string::npos) << what << ": " << scene->health().reason;
        return;
    }
    for (const auto& [name, value] : found.scalars) EXPECT_TRUE(std::isfinite(value)) << what << ' ' << name;
    for (const auto& particle : scene->snapshot().positions)
        for (const double x : particle) EXPECT_LE(std::abs(x), 0.5) << what;
}

Inputs tiny() {
    Inputs inputs = info().defaults();
    inputs["cells"] = std::int64_t{6};
    inputs["particles"] = std::int64_t{30};
    inputs["steps_per_period"] = std::int64_t{8};
    inputs["sampling_cells"] = std::int64_t{3};
    return inputs;
}

}  // namespace

// Every number at its lowest and highest, one at a time and in pairs, in every coupling; 20 steps each.
TEST(ThermovibrationCorners, FinishOrSayWhatWentWrong) {
    std::vector<std::pair<std::string, Value>> ends;
    for (const auto& parameter : info().parameters) {
        const auto* bounds = std::get_if<Interval>(&parameter.bounds);
        if (bounds == nullptr || parameter.name == "cells") continue;
        for (double end : {bounds->low, bounds->high}) {
            if (parameter.name == "particles" && end > 100) end = 100;
            if (parameter.name == "end_time" && end == 0) end = 1e-12;
            if (std::holds_alternative<double>(parameter.default_value)) {
                ends.emplace_back(parameter.name, end);
            } else {
                ends.emplace_back(parameter.name, static_cast<std::int64_t>(end));
            }
        }
    }
    for (const char* coupling : {"one_way", "two_way", "ddpm", "ddpm_ktgf", "cfd_dem"})
        for (std::size_t a = 0; a < ends.size(); ++a)
            for (std::size_t b = a; b < ends.size(); ++b) {
                Inputs inputs = tiny();
                inputs["coupling"] = std::string(coupling);
                inputs[ends[a].first] = ends[a].second;
                inputs[ends[b].first] = ends[b].second;
                expect_sound(inputs, std::string(coupling) + ' ' + ends[a].first + ' ' + ends[b].first);
            }
}
