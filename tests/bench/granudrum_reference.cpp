// The GranuDrum experiment (configs/drum_granudrum.json) against its photographs and against LIGGGHTS:
//
//     bench_granudrum_reference FOLDER [short|steady|thin [seeds [rpm ...]]]
//
// FOLDER holds measured_RPMrpm_binary.csv, measured_RPMrpm_half.csv, liggghts_RPMrpm_binary.csv and
// liggghts_RPMrpm_half.csv (pictures of 406 x 406 pixels as lines row,first,length), measured_RPMrpm_surface.csv,
// liggghts_RPMrpm_surface.csv and sizes_used.csv. They are derived from the repository ACCES-GranuDrum-Calibration
// (GPL 3.0) and no part of this one.
//     short   frames from 1.5 to 1.7 s, as LIGGGHTS ran; the ten size classes in the numbers really inserted there
//     steady  frames over one turn after two turns, which is what a photograph averages over
//     thin    as many particles per length in a periodic drum 4.5 mm long, without end faces: the engine without the
//     plates
// Prints, per speed and seed, the cost of the published comparison and the better-behaved one by the share of time in
// which a pixel is hidden, beside those of the LIGGGHTS run; angles, area, energy and coordination; then mean and
// standard deviation over the seeds. Draws drum_RPM_SEED.svg in the current folder: the grains of the last frame, and
// over them the surfaces at cover 0.5 of the photograph and of both programs. Minutes per run.
#include "solver/scenes/scene.hpp"
#include "sweep/campaign/installed_machines.hpp"
#include "sweep/campaign/reader.hpp"
#include "tests/support/drum_picture.hpp"
#include "tests/support/places.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <numeric>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

using namespace grainsweep;
using tests::DrumFrames;
using tests::DrumPicture;

namespace {

constexpr double mm2 = 1e6;
constexpr int pixels = 406;
constexpr std::size_t stored_frames = 11;  // of the LIGGGHTS run

enum class Span { short_run, steady, thin };

/// One question: the inputs and the files that they name.
struct Question {
    Inputs inputs;
    Files files;
};

std::string text_of(const std::filesystem::path& file) {
    std::ifstream in(file);
    if (!in) throw std::runtime_error("cannot read " + file.string());
    return {std::istreambuf_iterator<char>(in), {}};
}

/// The classes of sizes_used.csv by the counts of the best run, as size_file takes them.
std::string size_classes(const std::filesystem::path& folder) {
    std::istringstream lines(text_of(folder / "sizes_used.csv"));
    std::vector<std::pair<double, double>> classes;
    std::string line;
    std::getline(lines, line);
    while (std::getline(lines, line)) {
        double micrometres = 0, asked = 0, share = 0, count = 0;
        if (std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf", &micrometres, &asked, &share, &count) == 4)
            classes.emplace_back(1e-6 * micrometres, count);
    }
    const double all =
        std::accumulate(classes.begin(), classes.end(), 0.0, [](double sum, const auto& c) { return sum + c.second; });
    std::ostringstream table;
    table.precision(17);
    table << "diameter,number_fraction\n";
    for (const auto& [diameter, count] : classes) table << diameter << ',' << count / all << '\n';
    return table.str();
}

/// What the configuration fixes, over the defaults; the sizes from the folder.
Question asked(const SceneInfo& scene, const std::filesystem::path& folder, Span span, double rpm) {
    Inputs inputs = scene.defaults();
    for (const auto& [name, value] :
         campaign::parse_campaign(text_of(tests::source("configs/drum_granudrum.json")), {}).space.fixed)
        inputs.at(name) = value;
    inputs.at("rpm") = rpm;
    inputs.at("size_distribution") = std::string("file");
    inputs.at("size_file") = "file:" + std::string(32, '0') + ":sizes_used.csv";
    if (span == Span::steady) {
        inputs.at("turning_time") = 2 * 60 / rpm;
        inputs.at("measured_time") = 60 / rpm;
    }
    if (span == Span::thin) {
        inputs.at("length") = 0.0045;  // 4 mm there; here a period takes three of the largest at least
        inputs.at("ends") = std::string("periodic");
        inputs.at("particles") = std::int64_t{6567};
        if (rpm > 30) inputs.at("turning_time") = 0.8;
    }
    return {inputs, {{"size_file", size_classes(folder)}}};
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

/// Rows "x,...,z50,..." of a surface file, m; where the cover is not reached, nothing.
std::vector<std::array<double, 2>> surface_at_half(const std::filesystem::path& file) {
    std::istringstream lines(text_of(file));
    std::vector<std::array<double, 2>> points;
    std::string line;
    std::getline(lines, line);
    while (std::getline(lines, line)) {
        std::istringstream cells(line);
        std::vector<std::string> row;
        for (std::string cell; std::getline(cells, cell, ',');) row.push_back(cell);
        if (row.size() > 3 && !row[0].empty() && !row[3].empty())
            points.push_back({1e-3 * std::stod(row[0]), 1e-3 * std::stod(row[3])});
    }
    return points;
}

/// Where a column of pixels met from above first reaches a cover of one half, between two pixel centres.
std::vector<std::array<double, 2>> surface_at_half(const DrumPicture& picture, double radius,
                                                   const std::vector<double>& cover) {
    std::vector<std::array<double, 2>> points;
    const auto at = [&](int i, int j) { return cover[static_cast<std::size_t>(j * pixels + i)]; };
    for (int i = 0; i < pixels; ++i)
        for (int j = pixels - 2; j >= 0; --j) {
            if (at(i, j) < 0.5) continue;
            const double x = -radius + (i + 0.5) * picture.side(), below = -radius + (j + 0.5) * picture.side();
            points.push_back({x, below + picture.side() * (at(i, j) - 0.5) / (at(i, j) - at(i, j + 1))});
            break;
        }
    return points;
}

/// The drum along its axis, millimetres: grains of one frame, and surfaces by colour.
void draw(const std::string& name, double radius, const DrumFrames& frames,
          const std::vector<std::pair<const char*, std::vector<std::array<double, 2>>>>& surfaces) {
    std::ofstream file(name);
    const double r = 1e3 * radius;
    file << "<svg xmlns='http://www.w3.org/2000/svg' width='900' height='900' viewBox='" << -r - 1 << ' ' << -r - 1
         << ' ' << 2 * r + 2 << ' ' << 2 * r + 2 << "'><rect x='" << -r - 1 << "' y='" << -r - 1 << "' width='"
         << 2 * r + 2 << "' height='" << 2 * r + 2 << "' fill='white'/><circle r='" << r
         << "' fill='none' stroke='black' stroke-width='0.3'/><g fill='#c9b48a' stroke='#8a7a55' stroke-width='0.03'>";
    const auto& centres = frames.centres.back();
    for (std::size_t i = 0; i < centres.size(); ++i)
        file << "<circle cx='" << 1e3 * centres[i][0] << "' cy='" << -1e3 * centres[i][1] << "' r='"
             << 1e3 * frames.radius[i] << "'/>";
    file << "</g>";
    for (const auto& [colour, points] : surfaces) {
        file << "<polyline fill='none' stroke-width='0.4' stroke='" << colour << "' points='";
        for (const auto& x : points) file << 1e3 * x[0] << ',' << -1e3 * x[1] << ' ';
        file << "'/>";
    }
    file << "</svg>\n";
}

/// Over the seeds of one speed.
using Summary = std::map<std::string, std::vector<double>>;

void compare(const std::filesystem::path& folder, int rpm, std::uint64_t seed, double radius, const DrumFrames& frames,
             Summary& summary) {
    const DrumPicture picture(radius, pixels);
    const auto file = [&](const char* origin, const char* which) {
        return folder / (std::string(origin) + "_" + std::to_string(rpm) + "rpm_" + which + ".csv");
    };
    const auto photograph = picture.read(file("measured", "binary")),
               photographed_half = picture.read(file("measured", "half")),
               peer = picture.read(file("liggghts", "binary")), peer_half = picture.read(file("liggghts", "half"));
    std::printf("%d rpm: LIGGGHTS cost %.8f mm2, by cover 0.5 %.2f mm2\n", rpm,
                mm2 * picture.difference(photograph, peer), mm2 * picture.difference(photographed_half, peer_half));
    // The stored LIGGGHTS pictures are of the last 11 frames.
    DrumFrames last = frames;
    if (last.centres.size() > stored_frames)
        last.centres.erase(last.centres.begin(), last.centres.end() - static_cast<std::ptrdiff_t>(stored_frames));
    const auto binary = picture.of_map(picture.map(last));
    const auto cover = picture.cover(last);
    const auto half = picture.of_cover(cover, 0.5);
    const auto note = [&](const char* what, double value) {
        summary[what].push_back(value);
        std::printf("  %s %.2f", what, value);
    };
    std::printf("%d rpm, seed %lu, %zu frames, mm2:", rpm, seed, frames.centres.size());
    note("cost_all_frames", mm2 * picture.difference(photograph, picture.of_map(picture.map(frames))));
    note("cost_last_11", mm2 * picture.difference(photograph, binary));
    note("cover_half_last_11", mm2 * picture.difference(photographed_half, half));
    note("cover_half_all", mm2 * picture.difference(photographed_half, picture.of_cover(picture.cover(frames), 0.5)));
    note("from_liggghts_binary", mm2 * picture.difference(peer, binary));
    note("from_liggghts_cover_half", mm2 * picture.difference(peer_half, half));
    std::printf("\n");
    draw("drum_" + std::to_string(rpm) + "_" + std::to_string(seed) + ".svg", radius, last,
         {{"#1a4fd0", surface_at_half(file("liggghts", "surface"))},
          {"#000000", surface_at_half(picture, radius, picture.cover(frames))},
          {"#d01a1a", surface_at_half(file("measured", "surface"))}});
}

void run(const std::filesystem::path& folder, Span span, int rpm, std::uint64_t seed, Summary& summary) {
    const SceneInfo& info = *campaign::scene_named("rotating_drum");
    const Question question = asked(info, folder, span, rpm);
    NoArtefacts none;
    const auto start = std::chrono::steady_clock::now();
    const auto scene = info.make(question.inputs, seed, none, question.files);
    const DrumFrames frames = frames_of(*scene, question.inputs);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (!scene->health().stable()) {
        std::printf("%d rpm, seed %lu: %s\n", rpm, seed, scene->health().reason.c_str());
        return;
    }
    if (span != Span::thin)
        compare(folder, rpm, seed, std::get<double>(question.inputs.at("drum_diameter")) / 2, frames, summary);
    Observations seen;
    scene->observe(seen);
    std::printf("%d rpm, seed %lu, %.0f s:", rpm, seed, seconds);
    for (const char* name : {"angle_cover_middle", "angle_cover", "angle_surface", "angle_cm", "cover_area",
                             "kinetic_energy", "coordination", "torque", "max_overlap"}) {
        const double value = seen.scalars.at(name);
        summary[name].push_back(value);
        std::printf(" %s %.4g", name, value);
    }
    std::printf("\n");
    std::fflush(stdout);
}

}  // namespace

int main(int count, char** words) {
    if (count < 2) {
        std::printf("bench_granudrum_reference FOLDER [short|steady|thin [seeds [rpm ...]]]: not run without FOLDER\n");
        return 0;
    }
    const std::string asked_span = count > 2 ? words[2] : "short";
    const Span span = asked_span == "steady" ? Span::steady : asked_span == "thin" ? Span::thin : Span::short_run;
    const auto seeds = count > 3 ? std::strtoull(words[3], nullptr, 10) : 1;
    std::vector<int> speeds;
    for (int k = 4; k < count; ++k) speeds.push_back(std::atoi(words[k]));
    if (speeds.empty()) speeds = {15, 45};
    for (const int rpm : speeds) {
        Summary summary;
        for (std::uint64_t seed = 1; seed <= seeds; ++seed) run(words[1], span, rpm, seed, summary);
        for (const auto& [name, values] : summary) {
            const double n = static_cast<double>(values.size());
            const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
            double square = 0;
            for (const double x : values) square += (x - mean) * (x - mean);
            std::printf("%d rpm, %zu seeds: %s %.5g, standard deviation %.2g\n", rpm, values.size(), name.c_str(), mean,
                        n > 1 ? std::sqrt(square / (n - 1)) : std::numeric_limits<double>::quiet_NaN());
        }
    }
    return 0;
}
