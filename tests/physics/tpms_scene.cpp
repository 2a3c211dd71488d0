// The scene tpms_discharge: closed forms, invariance, and the promises of a scene.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <sstream>

#include "solver/machine/region.hpp"
#include "solver/particles/packing.hpp"
#include "solver/scenes/scene.hpp"
#include "sweep/campaign/installed_machines.hpp"
#include "tests/support/tpms_cells.hpp"

namespace grainsweep::tests::tpms_scene_test {

using Point = std::array<double, 3>;

const SceneInfo& info() {
    static const auto scene = campaign::scene_named("tpms_discharge");
    return *scene;
}

Inputs small_cell(double edge) {
    Inputs inputs = info().defaults();
    inputs["edge"] = edge;
    inputs["shell"] = 2.0;
    inputs["gravity"] = 9.81 * 100 / edge;
    inputs["precision"] = std::string("double");
    return inputs;
}

std::unique_ptr<Scene> make(const Inputs& inputs, const Files& files = {}) {
    NoArtefacts none;
    return info().make(inputs, 1, none, files);
}

Observations run(const Inputs& inputs, const Files& files = {}) {
    const auto scene = make(inputs, files);
    scene->advance(1e9);
    EXPECT_TRUE(scene->finished());
    EXPECT_EQ(scene->health().reason, "");
    Observations answer;
    scene->observe(answer);
    return answer;
}

/// NaN equals NaN here: an undefined answer must stay undefined.
bool same(double a, double b) {
    return a == b || (std::isnan(a) && std::isnan(b));
}

void expect_same(const Observations& a, const Observations& b) {
    ASSERT_EQ(a.scalars.size(), b.scalars.size());
    for (const auto& [name, value] : a.scalars) EXPECT_TRUE(same(value, b.scalars.at(name))) << name;
    ASSERT_EQ(a.series.size(), b.series.size());
    for (const auto& [name, samples] : a.series) {
        const auto& others = b.series.at(name);
        ASSERT_EQ(samples.size(), others.size()) << name;
        for (std::size_t k = 0; k < samples.size(); ++k)
            EXPECT_TRUE(same(samples[k].time, others[k].time) && same(samples[k].bin, others[k].bin) &&
                        same(samples[k].value, others[k].value))
                << name << " " << k;
    }
}

/// The value of a parameter that names a packing file; its contents are handed in beside it.
const std::string packing_file = "file:" + std::string(32, '0') + ":/nowhere/packing.csv";

/// A packing as its file holds it.
Files packing_of(const std::vector<Point>& spheres) {
    std::ostringstream text;
    text.precision(17);
    text << "x,y,z\n";
    for (const auto& x : spheres) text << x[0] << "," << x[1] << "," << x[2] << "\n";
    return {{"packing", text.str()}};
}

/// Spheres of a lattice that lie on the kept side of a P cell, each out of reach of all others in free fall.
std::vector<Point> loose_spheres(double edge) {
    const machine::Region kept{machine::LevelSetRegion{geometry::TpmsCell::schwarz_p, edge, 2, +1}};
    std::vector<Point> spheres;
    for (double z = 0.7; z < edge; z += 1.7)
        for (double y = 0.6; y < edge; y += 1.7)
            for (double x = 0.8; x < edge; x += 1.7)
                if (kept.contains({x, y, z})) spheres.push_back({x, y, z});
    return spheres;
}

TEST(TpmsScene, SpheresWithoutWallFallFreely) {
    // z(t) = z0 - g t^2/2: in the cell until t = sqrt(2 z0/g), that is sqrt(z0/L) t*.
    const double edge = 12;
    const auto spheres = loose_spheres(edge);
    ASSERT_GT(spheres.size(), 50U);
    Inputs inputs = small_cell(edge);
    inputs["packing"] = packing_file;
    const Observations answer = run(inputs, packing_of(spheres));

    EXPECT_EQ(answer.scalars.at("particles"), static_cast<double>(spheres.size()));
    EXPECT_EQ(answer.scalars.at("wall_particles"), 0);
    EXPECT_EQ(answer.scalars.at("retention"), 0);
    EXPECT_EQ(answer.scalars.at("max_overlap"), 0);
    const auto& retention = answer.series.at("retention_series");
    const auto& velocity = answer.series.at("velocity_series");
    ASSERT_GT(retention.size(), 60U);
    double highest = 0;
    for (const auto& x : spheres) highest = std::max(highest, x[2]);
    for (std::size_t k = 0; k < retention.size(); ++k) {
        const double t = retention[k].time;
        double inside = 0;
        for (const auto& x : spheres) inside += t <= std::sqrt(x[2] / edge) ? 1 : 0;
        EXPECT_EQ(retention[k].value, inside / static_cast<double>(spheres.size())) << t;
        if (t < std::sqrt(highest / edge)) {
            EXPECT_NEAR(velocity[k].value, t, 1e-12);  // v/sqrt(2 g L) = t/t*, exact in velocity Verlet
        }
    }
    const auto& mobile = answer.series.at("mobile_series");
    const auto& at_rest = answer.series.at("at_rest_series");
    for (std::size_t k = 0; k < mobile.size(); ++k) {
        const double t = mobile[k].time;
        double present = 0;  // a sphere that left is gone at the latest when its list is rebuilt
        for (const auto& x : spheres) present += t <= std::sqrt((x[2] + 2) / edge) ? 1 : 0;
        EXPECT_EQ(mobile[k].value, present / static_cast<double>(spheres.size())) << t;
        EXPECT_EQ(at_rest[k].value, k == 0 ? 1 : 0);
    }
    // The last sphere has left the box, two diameters below: the case ends there, not at 10 t*.
    EXPECT_NEAR(retention.back().time, std::sqrt((highest + 2) / edge), 2 * 0.0165);
    EXPECT_NEAR(answer.scalars.at("peak_velocity"), std::sqrt(highest / edge), 0.0165);
    double half = 0;  // the sphere whose leaving makes it half
    std::vector<double> times;
    for (const auto& x : spheres) times.push_back(std::sqrt(x[2] / edge));
    std::ranges::sort(times);
    half = times[(times.size() + 1) / 2 - 1];
    EXPECT_NEAR(answer.scalars.at("time_to_half"), half, 0.0165);
    const double quarter = times[(times.size() + 3) / 4 - 1];
    EXPECT_NEAR(0.25 / answer.scalars.at("discharge_rate"), half - quarter, 2 * 0.0165);
}

// A cell that has run empty has no fastest particle: neither one at rest, nor the last one seen.
// W = C rho_b sqrt(g) (D - k d)^(5/2), C = 0.58, k = 1.4 (Beverloo, Leniger & van de Velde 1961, Chem. Eng. Sci. 15,
// 260), as the share of the powder per sqrt(2 L/g).
TEST(TpmsScene, BeverloosRateIsThatOfTheOutletAndThePacking) {
    Inputs inputs = small_cell(20);
    inputs["end_time"] = 0.05;
    const auto answer = run(inputs).scalars;
    const double d = std::get<double>(inputs.at("diameter")), g = std::get<double>(inputs.at("gravity"));
    const double outlet = answer.at("outlet_diameter") * d, length = 20 * d;
    ASSERT_GT(outlet, 1.4 * d);
    const double fraction = answer.at("wall_packing") * std::numbers::pi / 6 * std::pow(d / length, 3);
    EXPECT_NEAR(fraction, 0.62, 0.01);
    const double volume = 0.58 * fraction * std::sqrt(g) * std::pow(outlet - 1.4 * d, 2.5);
    const double spheres = volume / (std::numbers::pi / 6 * std::pow(d, 3));
    const double expected = spheres * std::sqrt(2 * length / g) / answer.at("particles");
    EXPECT_NEAR(answer.at("beverloo_rate"), expected, 1e-9 * expected);
    // 3/2 pi w R* over the weight, R* = d/4 (Johnson, Kendall & Roberts 1971, Proc. R. Soc. A 324, 301).
    EXPECT_FALSE(answer.contains("bond_number")) << "without cohesion";
    inputs["cohesion_law"] = std::string("jkr");
    inputs["surface_energy"] = 1e-6;
    const double mass = std::get<double>(inputs.at("density")) * std::numbers::pi / 6 * std::pow(d, 3);
    const double bond = 1.5 * std::numbers::pi * 1e-6 * d / 4 / (mass * g);
    EXPECT_NEAR(run(inputs).scalars.at("bond_number"), bond, 1e-9 * bond);
    inputs["tilt"] = 0.2;
    EXPECT_FALSE(run(inputs).scalars.contains("beverloo_rate")) << "of an upright cell only";
}

TEST(TpmsScene, AnEmptyCellHasNoVelocity) {
    const double edge = 12;
    Inputs inputs = small_cell(edge);
    inputs["packing"] = packing_file;
    const Observations answer = run(inputs, packing_of(loose_spheres(edge)));
    const auto& retention = answer.series.at("retention_series");
    const auto& velocity = answer.series.at("velocity_series");
    int empty = 0;
    double peak = 0;
    for (const auto& sample : retention) {
        const auto fastest = std::ranges::find(velocity, sample.time, &Sample::time);
        EXPECT_EQ(fastest == velocity.end(), sample.value == 0) << sample.time;
        if (fastest == velocity.end())
            ++empty;
        else
            peak = std::max(peak, fastest->value);
    }
    EXPECT_GE(empty, 3);  // on their way from the lower face to where they are gone
    EXPECT_EQ(answer.scalars.at("peak_velocity"), peak);
}

TEST(TpmsScene, AVibratingCellSeesItsPowderFallAsInTheLaboratory) {
    // z(t) = z0 + v t - g t^2/2 - A sin(w t) in the cell, v = A sin(w dt)/dt: the powder starts at rest in it.
    const double edge = 12, d = 45e-6, amplitude = 20e-6, dt = 1e-6;
    const double w = 2 * std::numbers::pi * 1000;
    const auto spheres = loose_spheres(edge);
    for (const std::size_t axis : {std::size_t{2}, std::size_t{0}}) {
        Inputs inputs = small_cell(edge);
        inputs["packing"] = packing_file;
        inputs["vibration_amplitude"] = amplitude;
        inputs["vibration_frequency"] = 1000.0;
        inputs["vibration_direction"] = std::string(axis == 2 ? "z" : "x");
        const double g = std::get<double>(inputs["gravity"]), t_star = std::sqrt(2 * edge * d / g);
        const Observations answer = run(inputs, packing_of(spheres));
        std::size_t differ = 0;
        const auto& retention = answer.series.at("retention_series");
        for (const auto& sample : retention) {
            const double t = sample.time * t_star;
            double inside = 0, above = 0;
            for (const auto& x : spheres) {
                std::array<double, 3> place = {x[0] * d, x[1] * d, x[2] * d - 0.5 * g * t * t};
                place[axis] += amplitude * (std::sin(w * dt) / dt * t - std::sin(w * t));
                const bool in = std::ranges::all_of(place, [&](double c) { return c >= 0 && c <= edge * d; });
                inside += in ? 1 : 0;
                above += x[2] * d - 0.5 * g * t * t >= 0 ? 1 : 0;
            }
            EXPECT_EQ(sample.value, inside / static_cast<double>(spheres.size())) << sample.time;
            differ += inside != above ? 1 : 0;
        }
        EXPECT_GT(differ, 5U);  // the vibration is seen
    }
}

TEST(TpmsScene, TiltedGravityPullsSideways) {
    // Under gravity along +x every centre leaves through x = L after sqrt((L - x0)/L) t*.
    const double edge = 12;
    const auto spheres = loose_spheres(edge);
    Inputs inputs = small_cell(edge);
    inputs["packing"] = packing_file;
    inputs["tilt"] = 90.0;
    const Observations answer = run(inputs, packing_of(spheres));
    for (const auto& sample : answer.series.at("retention_series")) {
        double inside = 0;
        for (const auto& x : spheres) inside += sample.time <= std::sqrt((edge - x[0]) / edge) ? 1 : 0;
        EXPECT_EQ(sample.value, inside / static_cast<double>(spheres.size())) << sample.time;
    }
}

TEST(TpmsScene, TurnedPackingAndTurnedGravityAreTheSameCase) {
    // The P cell is the same along x and z. x, y, z -> z, x, y turns -z into -x: tilt 90, azimuth 180 degrees.
    // Rounding differs, so only the first quarter t* is compared, before collisions have magnified it.
    const double edge = 8;
    const auto packing = particles::random_close_packing({.edge = edge, .fraction = 0.6, .seed = 4});
    std::vector<Point> turned;
    for (const auto& x : packing.positions) turned.push_back({x[2], x[0], x[1]});
    Inputs inputs = small_cell(edge);
    inputs["end_time"] = 0.25;
    inputs["packing"] = packing_file;
    const Observations upright = run(inputs, packing_of(packing.positions));
    inputs["tilt"] = 90.0;
    inputs["tilt_azimuth"] = 180.0;
    const Observations lying = run(inputs, packing_of(turned));
    EXPECT_EQ(upright.scalars.at("particles"), lying.scalars.at("particles"));
    EXPECT_EQ(upright.scalars.at("retention"), lying.scalars.at("retention"));
    const auto& a = upright.series.at("velocity_series");
    const auto& b = lying.series.at("velocity_series");
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t k = 0; k < a.size(); ++k) EXPECT_NEAR(a[k].value, b[k].value, 1e-7) << a[k].time;
}

class TpmsPrecision : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Both, TpmsPrecision, testing::Values("mixed", "double"),
                         [](const auto& precision) { return std::string(precision.param); });

TEST_P(TpmsPrecision, SlicesAndCheckpointsDoNotChangeTheAnswer) {
    Inputs inputs = small_cell(8);
    inputs["precision"] = std::string(GetParam());
    inputs["cohesion"] = 20e3;
    inputs["end_time"] = 1.0;
    inputs["cell"] = std::string("gyroid");
    const Observations whole = run(inputs);

    Bytes bytes;
    const auto scene = tests::run_in_slices([&] { return make(inputs); }, bytes);
    Observations sliced;
    scene->observe(sliced);
    expect_same(whole, sliced);
    EXPECT_THROW(make(inputs)->restore(std::span(bytes).first(bytes.size() - 1)), std::invalid_argument);
}

TEST(TpmsScene, AnArtefactIsMadeOnceAndChangesNothing) {
    struct Kept final : Artefacts {
        std::map<std::string, Bytes, std::less<>> kept;
        int found = 0;
        std::optional<Bytes> get(std::string_view key) override {
            const auto place = kept.find(key);
            if (place == kept.end()) return std::nullopt;
            ++found;
            return place->second;
        }
        void put(std::string_view key, std::span<const std::byte> contents) override {
            kept.emplace(std::string(key), Bytes(contents.begin(), contents.end()));
        }
    } artefacts;
    Inputs inputs = small_cell(8);
    inputs["end_time"] = 0.3;
    const Observations alone = run(inputs);
    for (const double cohesion : {0.0, 0.0, 20e3}) {
        inputs["cohesion"] = cohesion;
        const auto scene = info().make(inputs, 1, artefacts);
        if (cohesion > 0) continue;
        scene->advance(1e9);
        Observations answer;
        scene->observe(answer);
        expect_same(alone, answer);
    }
    EXPECT_EQ(artefacts.kept.size(), 1U);
    EXPECT_EQ(artefacts.found, 2);
    inputs["packing_seed"] = std::int64_t{0};  // each case its own, from its seed
    (void)info().make(inputs, 5, artefacts);
    (void)info().make(inputs, 6, artefacts);
    EXPECT_EQ(artefacts.kept.size(), 3U);
}

TEST(TpmsScene, SlicesOfOneStepEndAtTheSameSample) {
    // Quiet for long enough between two samples: a slice that ends there must not end the case.
    Inputs inputs = small_cell(8);
    inputs["cohesion"] = 35e3;
    inputs["precision"] = std::string("mixed");
    inputs["end_time"] = 6.0;
    const auto whole = make(inputs), sliced = make(inputs);
    whole->advance(1e9);
    while (!sliced->finished() && sliced->health().stable()) sliced->advance(std::nextafter(sliced->time(), 1e9));
    EXPECT_EQ(whole->health().reason, "");
    EXPECT_EQ(sliced->time(), whole->time());
    EXPECT_EQ(sliced->particle_steps(), whole->particle_steps());
}

TEST(TpmsScene, JammedPowderRestsAtItsEquilibriumOverlap) {
    // Strong cohesion jams a small cell. Two spheres held by SJKR alone rest where Hertz balances it: 0.51 % of the
    // diameter at 35 kJ/m3 (note of the reference data); the histogram of the jammed cell peaks there.
    Inputs inputs = small_cell(8);
    inputs["cohesion"] = 35e3;
    inputs["tangential_limit"] = std::string("spring");  // as in the reference data
    inputs["end_time"] = 6.0;
    const Observations early = run(inputs);
    inputs["settle_rule"] = std::string("none");
    const Observations late = run(inputs);

    EXPECT_GT(early.scalars.at("retention"), 0.5);
    EXPECT_EQ(early.scalars.count("time_to_half"), 0U);
    EXPECT_EQ(early.scalars.at("retention"), late.scalars.at("retention"));
    EXPECT_LT(early.series.at("retention_series").back().time, 4.5);
    EXPECT_NEAR(late.series.at("retention_series").back().time, 6.0, 1e-3);

    const auto& histogram = late.series.at("overlap_histogram");
    double sum = 0, mode = 0, most = 0;
    for (const auto& bin : histogram) {
        if (bin.time != histogram.back().time) continue;
        sum += bin.value;
        if (bin.value <= most) continue;
        most = bin.value;
        mode = bin.bin;
    }
    EXPECT_NEAR(sum, 1, 1e-12);
    EXPECT_NEAR(mode, 0.0051, 0.0005);
    for (const auto& layer : late.series.at("retained_profile")) EXPECT_GE(layer.value, 0);
}

TEST(TpmsScene, ImpossibleQuestionsGetASentence) {
    using testing::HasSubstr;
    const auto refusal = [](const Inputs& inputs) -> std::string {
        try {
            (void)make(inputs);
        } catch (const std::invalid_argument& error) {
            return error.what();
        }
        return "";
    };
    Inputs inputs = small_cell(8);
    inputs["shell"] = 4.0;
    EXPECT_THAT(refusal(inputs), HasSubstr("thinner than half the edge"));
    inputs = small_cell(8);
    inputs["cell"] = std::string("diamond");
    inputs["shell"] = 3.9;
    EXPECT_THAT(refusal(inputs), HasSubstr("leaves no space for a mobile particle"));
    inputs = small_cell(8);
    inputs["time_step"] = 1e-5;
    EXPECT_THAT(refusal(inputs), HasSubstr("Rayleigh time"));
    inputs = small_cell(8);
    inputs["vibration_amplitude"] = 1e-6;
    inputs["vibration_frequency"] = 6e4;
    EXPECT_THAT(refusal(inputs), HasSubstr("at least twenty time steps"));
    inputs = small_cell(8);
    inputs["packing"] = packing_file;
    EXPECT_THAT(refusal(inputs), HasSubstr("the contents of /nowhere/packing.csv are not given"));
}

TEST(TpmsScene, VibrationFreesAJammedCell) {
    // Left alone this cell keeps nine tenths of its powder; at ten times gravity most of it leaves.
    Inputs inputs = small_cell(10);
    inputs["shell"] = 1.5;
    inputs["precision"] = std::string("mixed");
    inputs["cohesion"] = 35e3;
    inputs["end_time"] = 6.0;
    const double still = run(inputs).scalars.at("retention");
    inputs["vibration_frequency"] = 500.0;
    inputs["vibration_amplitude"] = 10 * std::get<double>(inputs["gravity"]) / std::pow(2 * std::numbers::pi * 500, 2);
    const double shaken = run(inputs).scalars.at("retention");
    EXPECT_GT(still, 0.8);
    EXPECT_LT(shaken, 0.3);
}

TEST(TpmsScene, TooLongAStepIsReportedUnstable) {
    // Near the Rayleigh time contacts are not resolved: energy appears or spheres pass through one another.
    Inputs inputs = small_cell(8);
    inputs["time_step"] = 7e-6;
    inputs["cohesion"] = 40e3;
    const auto scene = make(inputs);
    scene->advance(1e9);
    EXPECT_FALSE(scene->health().stable());
}

}  // namespace grainsweep::tests::tpms_scene_test
