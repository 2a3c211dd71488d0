// Machines that repeat a step on what lies there: regions that move with walls, walls that start anew, fillings and
// removals at a phase, numbers by repeat, a start that cases share.
#include "sweep/campaign/input_error.hpp"
#include "tests/support/machines.hpp"
#include "tests/support/wrong_machines.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace grainsweep::tests::machine_layers_test {

using nlohmann::json;
using testing::HasSubstr;

constexpr double diameter = 2e-3;

/// A rake of two layers: powder settles before a gate, the gate opens, a bar pushes it along a periodic channel.
json rake() {
    return json::parse(R"json({
      "name": "rake",
      "parameters": {"layers": {"whole": true, "default": 2, "bounds": [1, 5]},
                     "lip": {"unit": "m", "default": "3 mm"},
                     "wanted": {"default": 0, "bounds": [0, 100]},
                     "start_seed": {"whole": true, "default": 0, "bounds": [0, 9]}},
      "impact_speed": 1,
      "domain": {"low": [-0.02, 0, -0.01], "high": [0.06, 0.01, 0.05], "sides": ["open", "periodic", "open"]},
      "materials": {"rock": {"density": 2500, "youngs_modulus": "5 MPa", "poisson_ratio": 0.25}},
      "contacts": {"friction": 0.3},
      "species": {"sand": {"diameter": "2 mm", "sizes": {"spread": "uniform", "half_width": 0.1}}},
      "walls": {
        "base": {"plane": {"normal": [0, 0, 1]}},
        "rear": {"plane": {"point": [0, 0, 0], "normal": [1, 0, 0]}, "during": ["settle"],
                 "again": {"each": "settle", "by": [0, 0, "lip"]}},
        "front": {"plane": {"point": [0.02, 0, 0], "normal": [-1, 0, 0]}, "during": ["settle"]},
        "bar": {"bar": {"front": 0, "thickness": 0.002, "bottom": "lip", "top": 0.04}, "during": ["push"],
                "scattered": ["if(start_seed > 0, -0.001, 0)", 0, 0],
                "motion": [{"shift": {"velocity": [0.2, 0, 0]}, "during": ["push"]}],
                "again": {"each": "settle", "by": [0, 0, "lip"]}}},
      "fill": [{"species": "sand", "volume": 4e-7, "exact": true, "as": "cells", "shaken": 0.05, "at": "settle",
                "counter": "k", "on_top": true,
                "in": {"box": {"low": [0.0005, 0, "k*lip"], "high": [0.0195, 0.01, "k*lip + 0.03"]}}}],
      "remove": [{"in": {"half_space": {"point": [0.02, 0, 0], "normal": [1, 0, 0]}}, "of": "part", "at": "settle"},
                 {"in": {"half_space": {"point": [0, 0, 0], "normal": [-1, 0, 0]}}, "of": "part", "at": "settle"}],
      "phases": [{"repeat": "layers", "as": "n", "phases": [
        {"name": "settle", "for": 0.08, "frames": 2},
        {"name": "push", "until": {"known": {"measure": "passed", "error": "wanted", "from": 0.5, "every": 5}},
         "at_most": 0.1, "frames": 20, "ends_at_frames": true}]}],
      "start": {"phase": "settle", "seed": "start_seed"},
      "measure": {
        "passed": {"count": {"in": {"moving": {"with": ["gone", "bar"], "along": [1, 0, 0],
                     "in": {"half_space": {"point": [0, 0, 0], "normal": [-1, 0, 0]}}}}, "filling": "latest",
                   "gone": "stay"}, "during": "push", "as": "rate", "repeats": "last", "error": "passed_spread"},
        "passed_each": {"count": {"in": {"moving": {"with": "bar", "along": [1, 0, 0],
                     "in": {"half_space": {"point": [0, 0, 0], "normal": [-1, 0, 0]}}}}, "filling": "latest",
                   "gone": "stay"}, "during": "push", "as": "rate", "repeats": "each"},
        "passed_rates": {"count": {"in": {"moving": {"with": "bar",
                     "in": {"half_space": {"point": [0, 0, 0], "normal": [-1, 0, 0]}}}}, "filling": "latest",
                   "gone": "stay"}, "during": "push", "as": "rates", "repeats": "last", "since": "push"},
        "way": {"wall_position": {"wall": "bar", "along": [1, 0, 0]}, "during": "push", "as": "last", "repeats": "each"},
        "rise": {"wall_position": {"wall": "bar", "along": [0, 0, 1]}, "during": "push", "as": "last",
                 "repeats": "each"},
        "there": {"count": {}, "during": "push", "as": "first", "repeats": "each"},
        "newest": {"count": {"filling": "latest"}, "during": "push", "as": "first", "repeats": "each"},
        "fraction": {"layer_fraction": {"in": {"box": {"low": [0.002, -1, -1], "high": [0.012, 1, 1]}}, "height": "lip"},
                     "during": "push", "as": "last", "repeats": "each"},
        "bare": {"layer_bare_share": {"in": {"box": {"low": [0.002, -1, -1], "high": [0.012, 1, 1]}}, "pitch": 0.0005},
                 "during": "push", "as": "last"},
        "slabs": {"profile": {"along": [0, 0, 1], "from": 0, "to": "layers*lip", "bins": "layers",
                              "quantity": "cut_volume", "bin": "top"}, "during": "push", "as": "last_profile"},
        "volume": {"volume": {}, "during": "push", "as": "last"},
        "only_of_many": {"when": "layers > 1", "count": {}, "during": "push", "as": "last"}}
    })json");
}
// "gone" of the first region is no wall of this machine.
json sound_rake() {
    json machine = rake();
    machine["measure"]["passed"]["count"]["in"]["moving"]["with"] = "bar";
    return machine;
}

TEST(MachineLayers, WallsStartAnewAndFillingsComeAgain) {
    for (const char* precision : {"mixed", "double"}) {
        const auto seen = answer_of(spec_of(sound_rake(), {{"precision", std::string(precision)}}));
        const auto of = [&](const char* name, std::size_t k) { return seen.series.at(name).at(k).value; };
        ASSERT_EQ(seen.series.at("way").size(), 2U);
        EXPECT_EQ(seen.series.at("way")[1].bin, 2);
        EXPECT_NEAR(of("way", 0), 0.02, 1e-5);
        EXPECT_NEAR(of("way", 1), 0.02, 1e-5) << "from where it is drawn";
        EXPECT_NEAR(of("rise", 0), 0, 1e-12);
        EXPECT_NEAR(of("rise", 1), 0.003, 1e-12);
        EXPECT_EQ(of("there", 0), of("newest", 0));
        EXPECT_GT(of("there", 1), of("newest", 1)) << "some of the first layer lie below";
        EXPECT_LT(of("there", 1), of("newest", 0) + of("newest", 1)) << "and some were taken away";
        EXPECT_EQ(seen.series.at("passed_each")[1].value, seen.scalars.at("passed"));
        EXPECT_TRUE(seen.scalars.contains("passed_spread"));
        double mean = 0;
        for (const auto& rate : seen.series.at("passed_rates")) mean += rate.value / 20;
        ASSERT_EQ(seen.series.at("passed_rates").size(), 20U);
        EXPECT_NEAR(seen.series.at("passed_rates")[0].time, 0.005, 1e-4) << "since the last push began";
        EXPECT_NEAR(mean, seen.scalars.at("passed"), 0.02 * std::abs(mean) + 1);
        EXPECT_GT(of("fraction", 0), 0.1);
        EXPECT_GT(of("fraction", 1), 0.1);
        double slabs = 0;
        for (const auto& slab : seen.series.at("slabs")) slabs += slab.value;
        EXPECT_EQ(seen.series.at("slabs")[1].bin, 0.006);
        EXPECT_LT(slabs, seen.scalars.at("volume"));
        EXPECT_GT(slabs, 0.3 * seen.scalars.at("volume"));
    }
}

TEST(MachineLayers, AFillingIntoThePowderThatIsThereSaysSo) {
    json machine = sound_rake();
    machine["fill"][0]["on_top"] = false;
    machine["fill"][0]["in"]["box"]["low"][2] = 0;
    machine::Run run(spec_of(machine), 5);
    while (!run.finished() && run.health().stable()) run.advance(1e9);
    EXPECT_THAT(run.health().reason,
                HasSubstr("sand: the filling of this phase puts a particle into one that is there"));
}

TEST(MachineLayers, CellsHoldParticlesThatDoNotTouch) {
    const auto spec = spec_of(sound_rake());
    const auto run = machine::Run(spec, 5).snapshot();
    const auto& diameters = run.scalars.at("diameter");
    double volume = 0;
    for (std::size_t i = 0; i < run.positions.size(); ++i) {
        volume += std::numbers::pi / 6 * std::pow(diameters[i], 3);
        for (std::size_t j = 0; j < i; ++j) {
            auto apart = geometry::operator-(run.positions[i], run.positions[j]);
            apart[1] -= 0.01 * std::round(apart[1] / 0.01);
            EXPECT_GT(geometry::norm(apart), (diameters[i] + diameters[j]) / 2);
        }
    }
    EXPECT_NEAR(volume, 4e-7, std::numbers::pi / 12 * std::pow(1.1 * diameter, 3)) << "to half of a particle";
}

TEST(MachineLayers, ContinueFromACheckpoint) {
    for (const double time : {0.03, 0.12, 0.2, 0.27}) expect_same_resumed(sound_rake(), time);
}

TEST(MachineLayers, APhaseEndsWhenItsMeasurementIsKnown) {
    const auto whole = answer_of(spec_of(sound_rake(), {{"layers", std::int64_t{1}}}));
    EXPECT_FALSE(whole.scalars.contains("only_of_many"));
    EXPECT_FALSE(whole.series.contains("missing"));
    EXPECT_NEAR(whole.scalars.at("push_time"), 0.1, 1e-4);
    const double error = whole.scalars.at("passed_spread");
    const auto known = answer_of(spec_of(sound_rake(), {{"layers", std::int64_t{1}}, {"wanted", 100 * error}}));
    EXPECT_NEAR(known.scalars.at("push_time"), 0.1, 1e-4) << "ten blocks of two rates need all 20";
    // Where nothing passes, it is known at the first look.
    const auto none = answer_of(spec_of(sound_rake(), {{"layers", std::int64_t{1}}, {"wanted", 1.0}, {"lip", 1e-5}}));
    EXPECT_NEAR(none.scalars.at("push_time"), 0.05, 1e-3);
    EXPECT_FALSE(none.scalars.contains("passed_spread"));
}

/// Artefacts in memory.
class Shelf final : public Artefacts {
public:
    [[nodiscard]] std::optional<Bytes> get(std::string_view key) override {
        const auto found = kept.find(key);
        return found == kept.end() ? std::nullopt : std::optional(found->second);
    }
    void put(std::string_view key, std::span<const std::byte> contents) override {
        kept[std::string(key)] = Bytes(contents.begin(), contents.end());
    }
    std::map<std::string, Bytes, std::less<>> kept;
};

/// Returns the observables of a case and the particle steps that it computed itself.
std::pair<std::string, std::int64_t> finished(const machine::Spec& spec, std::uint64_t seed, Artefacts* artefacts) {
    machine::Run run(spec, seed, artefacts);
    run.advance(std::numeric_limits<double>::infinity());
    EXPECT_TRUE(run.finished()) << run.health().reason;
    Observations seen;
    run.observe(seen);
    return {text_of(seen), run.particle_steps()};
}

TEST(MachineLayers, AStartIsTheSameTakenOrComputed) {
    for (const char* precision : {"mixed", "double"}) {
        const Inputs shared = {{"start_seed", std::int64_t{3}}, {"precision", std::string(precision)}};
        Shelf shelf;
        const auto spec = spec_of(sound_rake(), shared);
        const auto alone = finished(spec, 1, nullptr), first = finished(spec, 1, &shelf),
                   taken = finished(spec, 1, &shelf);
        EXPECT_EQ(first.first, alone.first);
        EXPECT_EQ(taken.first, alone.first);
        EXPECT_LT(taken.second, first.second);
        EXPECT_NE(finished(spec, 2, &shelf).first, alone.first) << "the bar stands elsewhere";
        Inputs other = shared;
        other["lip"] = 4e-3;  // of a wall that joins after the start
        (void)finished(spec_of(sound_rake(), other), 1, &shelf);
        EXPECT_EQ(shelf.kept.size(), 1U);
        other["start_seed"] = std::int64_t{4};
        (void)finished(spec_of(sound_rake(), other), 1, &shelf);
        EXPECT_EQ(shelf.kept.size(), 2U);
        shelf.kept.begin()->second.resize(100);
        EXPECT_EQ(finished(spec, 1, &shelf).first, alone.first) << "a damaged one does no harm";
    }
}

/// A lid presses grains in the second phase of the start.
TEST(MachineLayers, AStartOfSeveralPhasesIsThatOfItsCase) {
    const json press = json::parse(R"json({
      "name": "press", "parameters": {"speed": {"unit": "m/s", "default": 0}},
      "materials": {"rock": {"density": 2500, "youngs_modulus": "5 MPa"}},
      "species": {"sand": {"diameter": "4 mm"}},
      "walls": {"box": {"box": {"low": [0, 0, 0], "high": [0.02, 0.02, 0.06], "open": ["+z"]}},
                "lid": {"rectangle": {"corner": [0, 0, 0.03], "along": [0.02, 0, 0], "across": [0, 0.02, 0]},
                        "motion": [{"shift": {"velocity": [0, 0, "-speed"]}, "during": "press"}]}},
      "fill": [{"species": "sand", "count": 60, "in": {"box": {"low": [0, 0, 0], "high": [0.02, 0.02, 0.029]}}}],
      "phases": [{"name": "settle", "for": 0.05, "frames": 2}, {"name": "press", "for": 0.1, "frames": 2},
                 {"name": "hold", "for": 0.01, "frames": 5}],
      "start": {"phase": "press", "seed": 1},
      "measure": {"height": {"height": {}, "during": "hold", "as": "last"}}
    })json");
    Shelf shelf;
    const auto slow = spec_of(press, {{"speed", 0.0}}), fast = spec_of(press, {{"speed", 0.1}});
    const auto alone = finished(fast, 1, nullptr).first;
    EXPECT_NE(finished(slow, 1, &shelf).first, alone);
    EXPECT_EQ(finished(fast, 1, &shelf).first, alone);
    EXPECT_EQ(finished(fast, 1, &shelf).first, alone);
}

TEST(MachineLayers, WrongOnesGetOneSentence) {
    const auto why = [](const char* path, const char* value) {
        json machine = sound_rake();
        machine[json::json_pointer(path)] = json::parse(value);
        return refusal_of(machine);
    };
    EXPECT_THAT(refusal_of(rake()), HasSubstr("must be"));
    EXPECT_THAT(why("/measure/passed/as", "\"rates\""), HasSubstr("standard error"));
    EXPECT_THAT(why("/measure/way/as", "\"series\""), HasSubstr("'each' is of measurements that are one number"));
    EXPECT_THAT(why("/phases/0/phases/1/ends_at_frames", "false"), HasSubstr("looked at when it is measured"));
    EXPECT_THAT(why("/start/phase", "\"push\""), HasSubstr("phases last"));
    EXPECT_THAT(why("/fill/0/counter", "\"lip\""), HasSubstr("a parameter or"));
    EXPECT_THAT(why("/walls/base/fit", "1"), HasSubstr("only an stl file is fitted"));
}

}  // namespace grainsweep::tests::machine_layers_test
