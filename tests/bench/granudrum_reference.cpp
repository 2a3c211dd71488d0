// The GranuDrum experiment (configs/drum_granudrum.json) against its photographs and against LIGGGHTS:
//
//     bench_granudrum_reference FOLDER [seeds [rpm ...]]
//
// FOLDER holds measured_RPMrpm_binary.csv, measured_RPMrpm_half.csv, liggghts_RPMrpm_binary.csv and
// liggghts_RPMrpm_half.csv: pictures of 406 x 406 pixels as lines row,first,length. They are derived from the
// repository ACCES-GranuDrum-Calibration (GPL 3.0) and no part of this one. Prints, per speed and seed, the cost of the
// published comparison and the better-behaved one by the share of time in which a pixel is hidden, beside those of the
// LIGGGHTS run; angles, area, energy and coordination. Minutes per run.
#include "solver/scenes/scene.hpp"
#include "sweep/campaign/reader.hpp"
#include "tests/support/drum_picture.hpp"
#include "tests/support/places.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <vector>

using namespace grainsweep;
using test::DrumFrames;
using test::DrumPicture;

namespace {

constexpr double mm2 = 1e6;

/// What the configuration fixes, over the defaults.
Inputs asked(const SceneInfo& scene, double rpm) {
    std::ifstream file(tests::source("configs/drum_granudrum.json"));
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    Inputs inputs = scene.defaults();
    for (const auto& [name, value] : campaign::parse_campaign(text, {}).space.fixed) inputs.at(name) = value;
    inputs.at("rpm") = rpm;
    return inputs;
}

/// Runs the case and keeps where the particles were in each frame.
DrumFrames frames_of(Scene& scene, const Inputs& inputs) {
    DrumFrames frames;
    const double first = std::get<double>(inputs.at("turning_time"));
    const double interval = std::get<double>(inputs.at("frame_interval"));
    for (int k = 0; scene.health().stable() && !scene.finished(); ++k) {
        scene.advance(first + k * interval - 1e-9);
        const auto seen = scene.snapshot();
        frames.radius.clear();
        for (const double d : seen.scalars.at("diameter")) frames.radius.push_back(d / 2);
        auto& centres = frames.centres.emplace_back();
        for (const auto& x : seen.positions) centres.push_back({x[0], x[2]});
    }
    return frames;
}

void report(const std::filesystem::path& folder, int rpm, std::uint64_t seed) {
    const SceneInfo& info = *find_scene("rotating_drum");
    const Inputs inputs = asked(info, rpm);
    const DrumPicture picture(std::get<double>(inputs.at("drum_diameter")) / 2, 406);
    const auto read = [&](const char* whose, const char* which) {
        return picture.read(folder / (std::string(whose) + "_" + std::to_string(rpm) + "rpm_" + which + ".csv"));
    };
    const auto photograph = read("measured", "binary"), photographed_half = read("measured", "half");
    const auto theirs = read("liggghts", "binary"), their_half = read("liggghts", "half");
    std::printf("%d rpm: LIGGGHTS cost %.8f mm2, by cover 0.5 %.2f mm2\n", rpm,
                mm2 * picture.difference(photograph, theirs), mm2 * picture.difference(photographed_half, their_half));

    NoArtefacts none;
    const auto scene = info.make(inputs, seed, none);
    const DrumFrames frames = frames_of(*scene, inputs);
    if (!scene->health().stable()) {
        std::printf("%d rpm, seed %lu: %s\n", rpm, seed, scene->health().reason.c_str());
        return;
    }
    // The stored LIGGGHTS pictures are of the last 11 frames.
    DrumFrames last = frames;
    if (last.centres.size() > 11) last.centres.erase(last.centres.begin(), last.centres.end() - 11);
    const auto binary = picture.of_map(picture.map(last));
    const auto half = picture.of_cover(picture.cover(last), 0.5);
    std::printf(
        "%d rpm, seed %lu: cost of all %zu frames %.2f, of the last 11 %.2f mm2, by cover 0.5 %.2f mm2; "
        "against LIGGGHTS: binary %.2f, cover 0.5 %.2f mm2\n",
        rpm, seed, frames.centres.size(), mm2 * picture.difference(photograph, picture.of_map(picture.map(frames))),
        mm2 * picture.difference(photograph, binary), mm2 * picture.difference(photographed_half, half),
        mm2 * picture.difference(theirs, binary), mm2 * picture.difference(their_half, half));
    Observations seen;
    scene->observe(seen);
    std::printf("   ");
    for (const char* name : {"angle_cover_middle", "angle_cover", "angle_surface", "angle_cm", "cover_area",
                             "kinetic_energy", "coordination", "torque", "max_overlap"})
        std::printf(" %s %.4g", name, seen.scalars.at(name));
    std::printf("\n");
    std::fflush(stdout);
}

}  // namespace

int main(int count, char** words) {
    if (count < 2) {
        std::printf("bench_granudrum_reference FOLDER [seeds [rpm ...]]: not run without the pictures\n");
        return 0;
    }
    const auto seeds = count > 2 ? std::strtoull(words[2], nullptr, 10) : 1;
    std::vector<int> speeds;
    for (int k = 3; k < count; ++k) speeds.push_back(std::atoi(words[k]));
    if (speeds.empty()) speeds = {15, 45};
    for (const int rpm : speeds)
        for (std::uint64_t seed = 1; seed <= seeds; ++seed) report(words[1], rpm, seed);
    return 0;
}
