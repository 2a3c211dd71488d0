// Retention of a TPMS cell against a curve of another program from the same packing (the tpms reference).
//
//   bench_tpms_reference PACKING.csv CURVE.csv EDGE COHESION [CELL] [PRECISION] [SEED] [STEP]
//
// PACKING: x,y,z in diameters (numpy.load("packings/pack_n20_s1.npz")["x"] written as text, all digits), or
// "generated" with a seed. CURVE: curves/TAG.csv. Gravity is 9.81 x 100/EDGE (the reference's scaling S2), the
// shell two diameters thick. Prints one JSON line: the largest deviation of the retention at the curve's times,
// where it is, the retention at whole t* and the largest overlap at the curve's times, both [ours, theirs], and what it
// cost.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include "solver/scenes/scene.hpp"
#include "sweep/campaign/installed_machines.hpp"
#include "tests/support/reference.hpp"

using namespace grainsweep;

namespace {

double at(const std::vector<Sample>& series, double t) {
    const auto after = std::ranges::lower_bound(series, t, {}, &Sample::time);
    if (after == series.end()) return series.back().value;
    if (after == series.begin()) return after->value;
    const auto before = after - 1;
    return before->value + (after->value - before->value) * (t - before->time) / (after->time - before->time);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 5) {
        std::fprintf(stderr,
                     "bench_tpms_reference PACKING.csv CURVE.csv EDGE COHESION [CELL] [PRECISION] [SEED] [STEP]\n");
        return 2;
    }
    const std::string packing = argv[1];
    const double edge = std::stod(argv[3]);
    const auto table = tests::read_table(argv[2]);
    const auto& times = table.columns.at("t_over_tstar");
    const auto& curve = table.columns.at("retention");

    Files files;
    if (packing != "generated") {
        std::ifstream stream(packing, std::ios::binary);
        if (!stream) throw std::runtime_error("cannot read " + packing);
        files["packing"] = {std::istreambuf_iterator<char>(stream), {}};
    }
    const SceneInfo& info = *campaign::scene_named("tpms_discharge");
    Inputs inputs = info.defaults();
    inputs["packing"] = packing == "generated" ? packing : "file:" + std::string(32, '0') + ":" + packing;
    inputs["edge"] = edge;
    inputs["shell"] = 2.0;
    inputs["gravity"] = 9.81 * 100 / edge;
    inputs["cohesion"] = std::stod(argv[4]);
    if (argc > 5) inputs["cell"] = std::string(argv[5]);
    inputs["precision"] = std::string(argc > 6 ? argv[6] : "double");
    if (argc > 7) inputs["packing_seed"] = std::int64_t{std::stoll(argv[7])};
    if (argc > 8) inputs["time_step"] = std::stod(argv[8]);
    inputs["end_time"] = times.back();
    inputs["settle_rule"] = std::string("none");
    inputs["tangential_limit"] = std::string("spring");

    NoArtefacts none;
    const auto scene = info.make(inputs, 1, none, files);
    // The reference looked at overlaps at these moments only; between them deeper ones come and go.
    const double t_star = std::sqrt(2 * edge * std::get<double>(inputs.at("diameter")) * edge / (9.81 * 100));
    double seconds = 0, sampled_overlap = 0;
    for (const double t : times) {
        const std::clock_t start = std::clock();
        scene->advance(t * t_star);
        seconds += static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
        const Snapshot now = scene->snapshot();
        for (const double overlap : now.scalars.at("overlap")) sampled_overlap = std::max(sampled_overlap, overlap);
    }
    sampled_overlap /= std::get<double>(inputs.at("diameter"));
    Observations answer;
    scene->observe(answer);
    const auto& ours = answer.series.at("retention_series");

    double worst = 0, when = 0;
    for (std::size_t k = 0; k < times.size(); ++k) {
        const double deviation = std::abs(at(ours, times[k]) - curve[k]);
        if (deviation > worst) {
            worst = deviation;
            when = times[k];
        }
    }
    std::printf(
        "{\"bench\": \"tpms_reference\", \"curve\": \"%s\", \"health\": \"%s\", \"largest_deviation\": %.4f, "
        "\"at\": %.2f",
        std::filesystem::path(argv[2]).stem().c_str(), scene->health().reason.c_str(), worst, when);
    std::printf(", \"sampled_max_overlap\": [%.4f, %.4f]", sampled_overlap,
                *std::ranges::max_element(table.columns.at("max_overlap_over_dp")));
    for (const auto& [name, value] : answer.scalars) std::printf(", \"%s\": %.6g", name.c_str(), value);
    for (double t = 0.5; t < times.back(); t += t < 1 ? 0.5 : 1.0) {
        const auto place = std::ranges::lower_bound(times, t) - times.begin();
        std::printf(", \"t%.1f\": [%.4f, %.4f]", t, at(ours, times[static_cast<std::size_t>(place)]),
                    curve[static_cast<std::size_t>(place)]);
    }
    std::printf(", \"cpu_seconds\": %.1f, \"nanoseconds_per_particle_step\": %.1f}\n", seconds,
                1e9 * seconds / scene->particle_steps());
    return 0;
}
