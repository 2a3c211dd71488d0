// Ready machines against ensembles of LIGGGHTS: means over seeds, within three standard errors of their difference;
// minutes: slow_machines. References: ensembles.csv of tests/reference/machines, of tests/reference/laboratory and of
// tests/reference/conveying, definitions in their README.md. With
// GRAINSWEEP_WRITE_DOCUMENTS the means are written to tests/reference/measured/machines.csv for the documents.
#include "solver/scenes/scene.hpp"
#include "sweep/campaign/csv_table.hpp"
#include "sweep/campaign/installed_machines.hpp"
#include "sweep/campaign/machine.hpp"
#include "tests/support/measured.hpp"
#include "tests/support/places.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

using namespace grainsweep;

namespace {

using Scalars = std::map<std::string, double, std::less<>>;

struct Reference {
    double mean = 0, tolerance = 0;
    int seeds = 0;
};

/// By case and quantity. `tolerance`: for the mean over as many seeds.
const std::map<std::pair<std::string, std::string>, Reference>& references() {
    static const auto all = [] {
        std::map<std::pair<std::string, std::string>, Reference> found;
        for (const std::string folder : {"machines", "laboratory", "conveying"}) {
            std::ifstream file(tests::source("tests/reference/" + folder + "/ensembles.csv"));
            std::stringstream text;
            text << file.rdbuf();
            const std::string contents = text.str();
            campaign::CsvTable table(contents, [](const std::string& rule) { throw std::invalid_argument(rule); });
            while (const auto row = table.next()) {
                if ((*row)[9].empty()) continue;  // no scatter is known
                found[{(*row)[0], (*row)[3]}] = {std::stod((*row)[4]), std::stod((*row)[9]), std::stoi((*row)[1])};
            }
        }
        return found;
    }();
    return all;
}

Scalars answer(const SceneInfo& scene, const Inputs& set, std::uint64_t seed) {
    Inputs inputs = scene.defaults();
    for (const auto& [name, value] : set) inputs[name] = value;
    NoArtefacts none;
    const auto run = scene.make(inputs, seed, none);
    while (!run->finished() && run->health().stable()) run->advance(run->time() + 0.5);
    EXPECT_TRUE(run->health().stable()) << run->health().reason;
    Observations observations;
    run->observe(observations);
    return observations.scalars;
}

/// Returns the scene of an installed machine with LIGGGHTS's limit of the tangential spring.
SharedScene scene_like_liggghts(const std::string& machine) {
    const std::filesystem::path folder =
        tests::source("configs/machines/" + std::string(campaign::kind_of_installed(machine)));
    std::ifstream file(folder / (machine + ".json"));
    auto document = nlohmann::json::parse(file);
    document["contacts"]["tangential_limit"] = "spring";
    if (document["parameters"].contains("tangential_limit")) document["parameters"].erase("tangential_limit");
    return campaign::enter_machine(campaign::make_machine(std::move(document), "$", campaign::beside(folder)));
}

/// A measured number of the reference, and how a machine's observables give it.
struct Quantity {
    std::string name, observable;
    std::function<double(const Scalars&)> of;
};

Quantity same(std::string name, std::string observable) {
    return {std::move(name), observable, [observable](const Scalars& scalars) { return scalars.at(observable); }};
}

struct Case {
    std::string reference, machine;
    Inputs set;
    std::vector<Quantity> quantities;
};

std::ostream& operator<<(std::ostream& out, const Case& one) {
    return out << one.reference;
}

std::vector<Quantity> of_drum() {
    constexpr double radius = 0.06;
    const auto over_radius = [](std::string observable) {
        return [observable](const Scalars& scalars) { return scalars.at(observable) / radius; };
    };
    return {same("lacey_3", "lacey"),
            {"radius_bed_A", "radius_a", over_radius("radius_a")},
            {"radius_bed_B", "radius_b", over_radius("radius_b")},
            same("radius_bed_A_minus_B", "segregation"),
            same("angle_cm_deg", "angle")};
}

std::vector<Quantity> of_chute() {
    return {same("velocity_s1", "velocity_upper"), same("velocity_s2", "velocity_lower"),
            same("depth_s1", "depth_upper"),       same("depth_s2", "depth_lower"),
            same("holdup_kg", "holdup"),           same("height_A_s2", "small_lower"),
            same("height_B_s2", "large_lower"),    same("flux_s2_kg_s", "flux_lower")};
}

const std::vector<Quantity> of_blender = {same("lacey_5", "lacey"), same("crossed_5", "crossed")};
const std::vector<Quantity> of_screw = {same("rate_kg_s", "rate"), same("mass_per_revolution_kg", "per_revolution"),
                                        same("fill_tube", "fill_tube")};
const std::vector<Quantity> of_silo = {same("rate_kg_s", "rate")};

const std::vector<Quantity> of_compaction = {same("strain_at_20kPa", "strain_half"),
                                             same("strain_at_peak", "strain"),
                                             same("unloading_modulus_Pa", "unloading_modulus"),
                                             same("side_over_mean_axial_at_peak", "side_ratio"),
                                             same("bottom_over_top_at_peak", "bottom_ratio"),
                                             same("strain_left_at_10pc", "strain_left"),
                                             same("H0_m", "height")};
const std::vector<Quantity> of_rheometer = {
    same("energy_rotation_J", "rotation_energy"), same("energy_axial_J", "axial_energy"),
    same("flow_energy_J", "flow_energy"), same("torque_z20", "torque"), same("force_z20", "force")};

std::vector<Quantity> of_laboratory(const std::vector<std::string>& observables) {
    std::vector<Quantity> quantities;
    for (const std::string& name : observables) quantities.push_back(same(name, name));
    return quantities;
}

const std::vector<Quantity> of_conveyor = of_laboratory({"transport_speed", "height"});
const std::vector<Quantity> of_belt = of_laboratory({"load", "powder_speed", "height"});
const std::vector<Quantity> of_screen = of_laboratory({"passed_fine", "passed_middle", "passed_near"});
const std::vector<Quantity> of_vanes = of_laboratory({"rate", "solid_fraction", "torque"});

class MachinesAgainstLiggghts : public testing::TestWithParam<Case> {};

TEST_P(MachinesAgainstLiggghts, AgreeWithinThreeStandardErrors) {
    const Case& asked = GetParam();
    const auto shared = scene_like_liggghts(asked.machine);
    const SceneInfo& scene = *shared;
    // Four times as many as there: the tolerance of a mean over m seeds against one over n is 3 sd sqrt(1/m + 1/n).
    const int theirs = references().at({asked.reference, asked.quantities.front().name}).seeds, seeds = 4 * theirs;
    const double narrower = std::sqrt((1.0 / seeds + 1.0 / theirs) / (2.0 / theirs));
    std::vector<Scalars> answers;
    for (int seed = 1; seed <= seeds; ++seed)
        answers.push_back(answer(scene, asked.set, static_cast<std::uint64_t>(seed)));
    for (const Quantity& quantity : asked.quantities) {
        const Reference& reference = references().at({asked.reference, quantity.name});
        double mean = 0, squares = 0;
        for (const Scalars& scalars : answers) mean += quantity.of(scalars) / seeds;
        for (const Scalars& scalars : answers) squares += std::pow(quantity.of(scalars) - mean, 2);
        tests::remember_measured(
            "machines", {"case", "quantity", "machine", "observable", "seeds", "mean", "sd"},
            {{asked.reference, quantity.name, asked.machine, quantity.observable, fmt::format("{}", seeds),
              fmt::format("{:.6g}", mean), fmt::format("{:.3g}", std::sqrt(squares / (seeds - 1)))}},
            2);
        std::printf("%-15s %-24s reference %9.4g here %9.4g difference over tolerance %5.2f\n", asked.reference.c_str(),
                    quantity.name.c_str(), reference.mean, mean,
                    (mean - reference.mean) / (narrower * reference.tolerance));
        EXPECT_NEAR(mean, reference.mean, narrower * reference.tolerance) << quantity.name;
    }
}

INSTANTIATE_TEST_SUITE_P(
    , MachinesAgainstLiggghts,
    testing::Values(Case{"drum_density1", "binary_drum", {}, of_drum()},
                    Case{"drum_density3", "binary_drum", {{"density_b", 7500.0}}, of_drum()},
                    Case{"drum_size2", "binary_drum", {{"diameter_a", 0.007}, {"diameter_b", 0.0035}}, of_drum()},
                    Case{"blender_rpm40", "v_blender", {{"speed", 40.0}}, of_blender},
                    Case{"blender_rpm80", "v_blender", {{"speed", 80.0}}, of_blender},
                    Case{"screw_rpm60", "screw_feeder", {{"speed", 60.0}}, of_screw},
                    Case{"screw_rpm120", "screw_feeder", {{"speed", 120.0}}, of_screw},
                    Case{"silo_insert15", "silo_insert", {}, of_silo},
                    Case{"silo_no_insert", "silo_insert", {{"insert", std::string("no")}}, of_silo},
                    Case{"chute_24", "chute", {{"angle", 24.0}}, of_chute()},
                    Case{"chute_28", "chute", {{"angle", 28.0}}, of_chute()},
                    Case{"rheometer_mu0.2", "rheometer", {{"friction", 0.2}}, of_rheometer},
                    Case{"rheometer_mu0.6", "rheometer", {{"friction", 0.6}}, of_rheometer},
                    Case{"compaction_hard0", "compaction", {{"hard", 0.0}}, of_compaction},
                    Case{"compaction_hard0.5", "compaction", {{"hard", 0.5}}, of_compaction},
                    Case{"compaction_hard1", "compaction", {{"hard", 1.0}}, of_compaction},
                    Case{"hall_flow",
                         "hall_flow",
                         {{"particles", std::int64_t{1200}}, {"diameter", 0.00045}},
                         of_laboratory({"flow_time", "fraction"})},
                    Case{"apparent_density",
                         "apparent_density",
                         {{"cup_diameter", 0.008}, {"cup_height", 0.0116}, {"drop_height", 0.007}, {"opening", 0.005}},
                         of_laboratory({"fraction", "core_fraction", "struck"})},
                    Case{"tapped_density",
                         "tapped_density",
                         {{"cylinder_diameter", 0.01},
                          {"particles", std::int64_t{700}},
                          {"taps", std::int64_t{6}},
                          {"density", 7800.0}},
                         of_laboratory({"hausner", "poured_fraction", "tapped_fraction"})},
                    Case{
                        "tapped_density_wide",
                        "tapped_density",
                        {{"cylinder_diameter", 0.016},
                         {"particles", std::int64_t{3000}},
                         {"taps", std::int64_t{1}},
                         {"density", 7800.0}},
                        of_laboratory({"hausner", "poured_fraction", "tapped_fraction", "poured_core", "tapped_core"})},
                    Case{"angle_of_repose",
                         "angle_of_repose",
                         {{"plate_diameter", 0.02}, {"drop_height", 0.016}, {"opening", 0.006}, {"density", 7800.0}},
                         of_laboratory({"angle", "angle_moment", "on_plate"})},
                    Case{"angle_of_repose_large",
                         "angle_of_repose",
                         {{"plate_diameter", 0.034}, {"drop_height", 0.024}, {"opening", 0.008}, {"density", 7800.0}},
                         of_laboratory({"angle", "angle_moment", "on_plate"})},
                    Case{"shear_box",
                         "shear_box",
                         {{"width", 0.06}, {"displacement", 0.012}},
                         of_laboratory({"stress_ratio", "shear_stress", "normal_stress"})},
                    Case{"conveyor_K1.6", "vibrating_conveyor", {{"throw_number", 1.6}}, of_conveyor},
                    Case{"conveyor_K2.4", "vibrating_conveyor", {{"throw_number", 2.4}}, of_conveyor},
                    Case{"belt_slope10", "belt", {{"slope", 10.0}, {"speed", 0.8}}, of_belt},
                    Case{"screen_slope20", "screen", {{"openings", std::int64_t{10}}, {"start_time", 0.8}}, of_screen},
                    Case{"vane_rpm120", "vane_feeder", {{"speed", 120.0}}, of_vanes},
                    Case{"ribbon_rpm60",
                         "ribbon_mixer",
                         {{"particles", std::int64_t{1600}}, {"revolutions", std::int64_t{3}}},
                         of_laboratory({"torque", "lacey"})}),
    [](const auto& one) {
        std::string name = one.param.reference;
        std::ranges::replace(name, '.', '_');
        return name;
    });

}  // namespace
