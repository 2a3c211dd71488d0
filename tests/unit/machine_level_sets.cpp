// Level sets as regions, spheres cut from a packing, and what measurements of a cell need: quiet phases, relative and
// scaled values, histograms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "solver/geometry/tpms.hpp"
#include "solver/machine/filling.hpp"
#include "solver/particles/packing.hpp"
#include "stats/random.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/installed_machines.hpp"
#include "tests/support/machine_bed.hpp"
#include "tests/support/machines.hpp"
#include "tests/support/wrong_machines.hpp"

namespace grainsweep::tests::machine_level_sets_test {

using namespace geometry;
using machine::Region;
using nlohmann::json;

constexpr double edge = 8e-3, shell = 2e-3;

Region set_of(TpmsCell cell, double side) {
    return {Region::LevelSet{.cell = cell, .edge = edge, .shell = shell, .side = side}};
}

Vec3 drawn(std::uint64_t number, double size) {
    const stats::Stream stream(5, 1);
    return {size * stream.uniform(3 * number), size * stream.uniform(3 * number + 1),
            size * stream.uniform(3 * number + 2)};
}

TEST(MachineLevelSet, ABallOfItsDepthLiesInside) {
    for (const auto& traits : tpms_cells)
        for (const double side : {-1.0, 0.0, 1.0})
            for (std::uint64_t n = 0; n < 300; ++n) {
                const Region region = set_of(traits.cell, side);
                const Vec3 x = drawn(n, edge), e = drawn(1000 + n, 1) - Vec3{0.5, 0.5, 0.5};
                const double depth = region.depth(x);
                EXPECT_EQ(region.contains(x + (0.999 * depth / norm(e)) * e), depth >= 0) << traits.name;
            }
}

TEST(MachineLevelSet, IsRepeatedAndPlaced) {
    Region::LevelSet set{.cell = TpmsCell::gyroid, .edge = edge, .shell = shell, .side = 1};
    const Region one{set};
    set.at = {1e-3, 2e-3, 3e-3};
    for (std::uint64_t n = 0; n < 50; ++n) {
        const Vec3 x = drawn(n, edge);
        EXPECT_NEAR(one.depth(x + Vec3{edge, -edge, 2 * edge}), one.depth(x), 1e-12);
        EXPECT_NEAR(Region{set}.depth(x + set.at), one.depth(x), 1e-12);
    }
}

TEST(MachineLevelSet, OpeningOfAPCellIsTheClosedForm) {
    // In z = 0 the kept side is cos X + cos Y > 1 + C; its border is nearest to the middle along the diagonal,
    // where 2 cos X = 1 + C: diameter sqrt 2 L acos((1 + C)/2)/pi.
    for (const double size : {20.0, 100.0})
        for (const double thickness : {0.02 * size, 0.1 * size, 0.4 * size}) {
            const Region::LevelSet set{.edge = size, .shell = thickness, .side = 1};
            const double level = std::sin(std::numbers::pi * thickness / size);
            const double expected = std::numbers::sqrt2 * size * std::acos((1 + level) / 2) / std::numbers::pi;
            EXPECT_NEAR(set.opening(), expected, 1.5 * size / 256);
            EXPECT_EQ(set.opening(), set.opening()) << "remembered";
        }
}

TEST(MachineLevelSet, OpeningIsNarrowerInAThickerShell) {
    for (const auto& cell : tpms_cells) {
        const double side = cell.kept_side;
        const double thin = Region::LevelSet{cell.cell, 1, 0.01, side}.opening();
        const double thick = Region::LevelSet{cell.cell, 1, 0.05, side}.opening();
        EXPECT_GT(thick, 0) << cell.name;
        EXPECT_GT(thin, thick) << cell.name;
        EXPECT_LE(thin, 1) << cell.name;
    }
}

/// A P cell of 8 mm out of a packing of spheres of 1 mm, without walls.
json cell() {
    return json::parse(R"({
      "name": "cell", "parameters": {
        "packing": {"file": "packing", "default": "made"},
        "number": {"whole": true, "default": 3, "only_if": {"packing": "made"}},
        "width": {"counted_in": "diameters", "default": 8, "bounds": [6, 20]},
        "time_step": {"default": 1e-5, "above": 0}},
      "let": {"edge": "width*1e-3", "hole": {"opening": {"edge": "edge", "shell": "0.25*edge", "side": 1}}},
      "materials": {"glass": {"density": 2500, "youngs_modulus": "5 MPa"}},
      "contacts": {"friction": 0.3, "glued": {"friction": 0.1}},
      "species": {"glass": {"diameter": "1 mm"}},
      "domain": {"low": ["-2 mm", "-2 mm", "-2 mm"], "high": ["10 mm", "10 mm", "10 mm"]},
      "fill": [
        {"species": "glass", "packing": {"edge": "edge", "fraction": 0.6, "seed": "number", "file": "{packing}"},
         "in": {"level_set": {"edge": "edge", "shell": "2 mm", "side": 1}}},
        {"species": "glass", "packing": {"edge": "edge", "fraction": 0.6, "seed": "number", "file": "{packing}"},
         "in": {"level_set": {"edge": "edge", "shell": "2 mm"}}, "glued": true, "tight": 0.1, "name": "wall"}],
      "phases": [{"name": "fall", "until": {"quiet": {"in": {"box": {"low": [0, 0, 0], "high": [0.008, 0.008, 0.008]}},
                  "speed": 0.001, "for": 0.01}}, "at_most": 0.1, "every": 0.001, "ends_at_frames": true}],
      "measure": {
        "left": {"count": {"in": {"box": {"low": [0, 0, 0], "high": [0.008, 0.008, 0.008]}}}, "as": "last",
                 "relative": true},
        "left_series": {"count": {"in": {"box": {"low": [0, 0, 0], "high": [0.008, 0.008, 0.008]}}}, "as": "series",
                        "relative": true, "scale": {"time": 0.001, "over": "time, ms"}},
        "counted": {"count": {}, "as": "first"},
        "slow": {"count": {"slower_than": 0.05}, "as": "series", "every": 4},
        "fastest": {"fastest": {"along": [0, 0, -1]}, "as": "max", "scale": {"value": 0.5, "unit": "half m/s"}},
        "layers": {"profile": {"along": [0, 0, 1], "from": 0, "to": 0.008, "bins": 4, "quantity": "count"},
                   "as": "last_profile", "relative": true, "scale": {"bin": 0.008, "over": "z/L"}},
        "forces": {"contact_histogram": {"unit": 0.001, "from": 0.01, "to": 100, "per_decade": 4}, "as": "profiles",
                   "every": 10},
        "hole_mm": {"expression": "hole*1000", "unit": "mm"},
        "half": {"time_of": "left_series", "below": 0.9, "scale": {"value": 0.001, "unit": "ms"}}},
      "accuracy": {"fast": {"time_step": 2e-5}, "reference": {"precision": "double"}}
    })");
}

TEST(MachineCut, TakesTheSpheresOfOnePackingByTheirCentres) {
    const auto spec = spec_of([] {
        auto whole = cell();
        whole["fill"][1].erase("tight");
        return whole;
    }());
    const auto packing = particles::random_close_packing({.edge = 8, .fraction = 0.6, .seed = 3});
    const auto filled = machine::filled(spec, 1), lean = machine::filled(spec_of(cell()), 1);
    std::vector<Vec3> kept, wall;
    for (const auto& x : packing.positions) {
        if (set_of(TpmsCell::schwarz_p, 1).contains(1e-3 * x)) kept.push_back(1e-3 * x);
        if (set_of(TpmsCell::schwarz_p, 0).contains(1e-3 * x)) wall.push_back(1e-3 * x);
    }
    ASSERT_GT(kept.size(), 50U);
    ASSERT_EQ(filled.spheres.size(), kept.size() + wall.size());
    for (std::size_t k = 0; k < filled.spheres.size(); ++k) {
        EXPECT_EQ(filled.spheres[k].mobile, k < kept.size());
        EXPECT_EQ(filled.spheres[k].position, k < kept.size() ? kept[k] : wall[k - kept.size()]);
        EXPECT_EQ(filled.spheres[k].radius, 0.5e-3);
    }
    EXPECT_EQ(filled.counts.at("wall_particles"), static_cast<std::int64_t>(wall.size()));
    EXPECT_EQ(filled.counts.at("wall_packing"), static_cast<std::int64_t>(packing.positions.size()));
    EXPECT_EQ(lean.counts, filled.counts);
    EXPECT_LE(lean.spheres.size(), filled.spheres.size());
}

TEST(MachineCut, TakesAPackingOfAFile) {
    const std::string word = "file:" + std::string(32, '0') + ":/packing.csv";
    const auto machine = machine_of(cell());
    const auto inputs = inputs_of(*machine, {{"packing", word}});
    // One sphere on either side of the surface and one in the shell.
    const Files files = {{"packing", "x,y,z\n0.5,0.5,0.5\n4,4,4\n4,4,0\n"}};
    const auto filled = machine::filled(campaign::machine_spec(*machine, inputs, files), 1);
    EXPECT_EQ(filled.counts.at("wall_packing"), 3);
    EXPECT_EQ(filled.spheres.front().mobile, true);
    EXPECT_THROW((void)campaign::machine_spec(*machine, inputs, {}), campaign::InputError) << "no contents";
    EXPECT_THROW((void)machine::filled(campaign::machine_spec(*machine, inputs, {{"packing", "x,y,z\n9,9,9\n"}}), 1),
                 std::invalid_argument)
        << "outside of the cube";
}

TEST(MachineCut, ASeedOfZeroIsThatOfTheCase) {
    const auto of = [](std::int64_t number, std::uint64_t seed) {
        return machine::filled(spec_of(cell(), {{"number", number}}), seed).spheres.front().position;
    };
    EXPECT_EQ(of(0, 7), of(7, 1));
    EXPECT_EQ(of(3, 7), of(3, 1));
    EXPECT_NE(of(0, 7), of(0, 8));
}

TEST(MachineLevelSet, ACellIsMeasuredInItsUnits) {
    const auto machine = machine_of(cell());
    const auto answer = answer_of(spec_of(cell()));
    const double start = answer.scalars.at("counted"), rayleigh_free = answer.scalars.at("fastest");
    const auto& left = answer.series.at("left_series");
    EXPECT_EQ(left.front().value, 1);
    EXPECT_EQ(left.back().value, answer.scalars.at("left"));
    EXPECT_NEAR(left[1].time, 1, 1e-9) << "every 1 ms, shown in ms";
    EXPECT_LT(answer.scalars.at("left"), 0.9) << "cohesionless powder leaves";
    EXPECT_NEAR(std::round(answer.scalars.at("left") * start), answer.scalars.at("left") * start, 1e-9);
    const auto crossed = std::ranges::find_if(left, [](const Sample& s) { return s.value < 0.9; });
    EXPECT_LE(answer.scalars.at("half"), crossed->time);
    EXPECT_GE(answer.scalars.at("half"), (crossed - 1)->time);
    EXPECT_GT(rayleigh_free, 0.1);
    const auto& slow = answer.series.at("slow");
    EXPECT_EQ(slow.front().value, start);
    EXPECT_NEAR(slow[1].time, 4e-3, 1e-9);
    double mean = 0;
    for (const auto& layer : answer.series.at("layers")) mean += layer.value / 4;
    EXPECT_GT(mean, 0);
    EXPECT_LE(mean, 1);
    EXPECT_NEAR(answer.series.at("layers").front().bin, 0.125, 1e-12);
    double sum = 0;
    const auto& forces = answer.series.at("forces");
    for (const auto& bin : forces)
        if (bin.time == forces.back().time) sum += bin.value;
    EXPECT_NEAR(sum, 1, 1e-12);
    EXPECT_NEAR(answer.scalars.at("hole_mm"),
                1e3 * (Region::LevelSet{.edge = edge, .shell = shell, .side = 1}.opening()), 1e-9);
    EXPECT_EQ(answer.scalars.at("fall_ended"), 1) << "quiet";
    EXPECT_LT(answer.scalars.at("fall_time"), 0.1);
    EXPECT_EQ(std::get<double>(machine->accuracy.at("fast").at("time_step")), 2e-5);
    EXPECT_EQ(std::ranges::find(machine->parameters, "width", &ParameterSpec::name)->unit, "diameters");
    const auto picture = machine::Run(spec_of(cell()), 1).snapshot();
    EXPECT_EQ(picture.walls.front().name, "cell");
    EXPECT_GT(picture.walls.front().triangles.size(), 100U);
}

TEST(MachineHistogram, SharesOfBinsOfEqualWidthOnALogarithmicAxis) {
    const auto probe =
        machine::find_probe("contact_histogram")
            ->make(with("quantity", word("overlap"), "unit", 0.001, "from", 0.01, "to", 1.0, "per_decade", 2.0));
    Bed bed;
    bed.add({0, 0, 0}, 0), bed.add({0.002, 0, 0}, 0);
    (void)bed.frame();
    bed.contacts.clear();
    for (const double overlap : {0.0, 0.005, 0.02, 0.0099, 0.5, 1.0, 3.0, 1.1})
        bed.contacts.push_back({.first = 0, .second = 1, .overlap = 0.001 * overlap});
    std::vector<Sample> bins;
    probe->profile(bed.frame(), bins);
    ASSERT_EQ(bins.size(), 4U);
    EXPECT_NEAR(bins[0].bin, std::pow(10, -1.75), 1e-15);
    EXPECT_EQ(bins[0].value, 0.5) << "0.01 to 0.0316, with all that is less";
    EXPECT_EQ(bins[1].value, 0);
    EXPECT_NEAR(bins[3].bin, std::pow(10, -0.25), 1e-15);
    EXPECT_EQ(bins[3].value, 0.5) << "with all that is more";
}

TEST(MachineGlued, ASurfaceOfItsOwnOnlyWhereItDiffers) {
    auto document = cell();
    EXPECT_EQ(spec_of(document).glued, (dem::Surface{.friction = 0.1}));
    document["contacts"]["glued"]["friction"] = 0.3;
    EXPECT_EQ(spec_of(document).glued, dem::Surface{});
}

TEST(TpmsMachine, AWallHasThePropertiesOfThePowderOrItsOwn) {
    const auto machine = campaign::installed_machine("tpms_discharge");
    Inputs inputs = inputs_of(*machine);
    const auto glued = [&] { return campaign::machine_spec(*machine, inputs).glued; };
    EXPECT_EQ(glued(), dem::Surface{});
    inputs["wall_friction"] = 0.0;
    inputs["wall_restitution"] = 0.9;
    EXPECT_EQ(glued(), (dem::Surface{.friction = 0.0, .restitution = 0.9}));
    inputs["wall_friction"] = -0.5;
    EXPECT_THROW((void)glued(), campaign::InputError);
    inputs["wall_friction"] = -1.0;
    inputs["wall_restitution"] = 0.0;
    EXPECT_THROW((void)glued(), campaign::InputError);
    inputs["wall_restitution"] = -1.0;
    inputs["wall_cohesion"] = 5e3;
    inputs["wall_surface_energy"] = 0.1;
    EXPECT_EQ(glued(), (dem::Surface{.cohesion = 5e3})) << "the other kind has no effect";
    inputs["cohesion_law"] = std::string("dmt");
    EXPECT_EQ(glued(), (dem::Surface{.surface_energy = 0.1}));
    inputs["cohesion_law"] = std::string("jkr");
    EXPECT_THROW((void)glued(), campaign::InputError) << "of the wall alone";
    inputs["surface_energy"] = 0.2;
    EXPECT_EQ(glued(), (dem::Surface{.surface_energy = 0.1}));
}

TEST(MachineCut, DeepOverlapsEndACaseWhoseWallIsNotWhole) {
    auto document = cell();
    document["fill"][1]["tight"] = 1e-4;
    machine::Run run(spec_of(document), 1);
    run.advance(1);
    EXPECT_NE(run.health().reason.find("more than the 0.0001 up to which the glued"), std::string::npos)
        << run.health().reason;
    EXPECT_FALSE(run.finished());
}

TEST(MachineLevelSet, WrongFilesGetASentence) {
    const auto refused = [](const char* path, const char* value) {
        auto document = cell();
        document[json::json_pointer(path)] = json::parse(value);
        return refusal_of(document);
    };
    const auto expect = [&](const char* path, const char* value, const char* rule) {
        const auto why = refused(path, value);
        EXPECT_NE(why.find(rule), std::string::npos) << path << ": " << why;
    };
    expect("/fill/0/in/level_set/cell", R"("gyriod")", "Did you mean 'gyroid'?");
    expect("/fill/0/in/level_set/side", "2", "\"side\" of a level set is 1, -1, or 0 for its shell");
    expect("/fill/0/in/level_set/edge", "0", "a level set needs an edge above 0");
    expect("/fill/0/in/level_set/shell", "0.004", "the shell of a level set must be thinner than half the edge");
    expect("/fill/0/count", "3", "beside \"packing\" it has no effect");
    expect("/fill/0/tight", "0.1", "only glued spheres are left out");
    expect("/fill/0/packing/fraction", "0.8", "must be a number from 0.05 to 0.635");
    expect("/fill/0/packing", R"({"fraction": 0.6})", "key 'edge' is missing");
    expect("/fill/0/packing/file", R"("none.csv")", "there is no file none.csv");
    expect("/species/glass/sizes", R"({"spread": "uniform"})", "a packing is of spheres that are all equal");
    expect("/let/hole", R"({"openning": 1})", "must be a number, an expression, or {\"opening\": a level set}");
    expect("/let/hole/opening/side", "0", "an opening is of one side of a shell");
    expect("/parameters/width/unit", R"("m")", "beside \"unit\" it says too much");
    expect("/parameters/width/counted_in", R"("mm")", "'mm' is a unit: write \"unit\"");
    expect("/parameters/time_step/unit", R"("ms")", "every machine has a parameter of this name");
    expect("/phases/0/frames", "10", "beside \"frames\" it says too much");
    expect("/phases/0/until/quiet/speed", "0", "must be a number above 0");
    expect("/measure/layers/every", "0", "must be a number from 1");
    expect("/measure/half/scale", R"({"valeu": 1})", "Did you mean 'value'?");
    expect("/measure/forces/contact_histogram/to", "0.001", "\"from\" of a histogram must lie below \"to\"");
    expect("/accuracy/fats", "{}", "Did you mean 'fast'?");
    expect("/accuracy/fast", R"({"tiem_step": 1e-5})", "Did you mean 'time_step'?");
    expect("/contacts/glued", R"({"frction": 0.1})", "Did you mean 'friction'?");
    expect("/shaking", R"({"frequency": 50})", "key 'amplitude' is missing");
    expect("/rest_speed", "-1", "must be a number");
}

}  // namespace grainsweep::tests::machine_level_sets_test
