// The 16 points of LIGGGHTS's spreading table run through the scene: mean mfr per point against the table with the
// scatter between seeds, chi-square over the points with gap > diameter, and the speed.
//
//     bench_spreading_reference [SEEDS [FIRST_POINT LAST_POINT [FIRST_SEED [mixed|double]]]]
#include "solver/scenes/scene.hpp"
#include "sweep/campaign/installed_machines.hpp"
#include "tests/support/reference.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <limits>
#include <string>

using namespace grainsweep;

namespace {

/// Relative standard deviation of mfr between seeds, of 106 LIGGGHTS runs.
double scatter(double gap_over_diameter, int point) {
    if (point == 16) return 0.075;
    return gap_over_diameter > 1.4 ? 0.031 : 0.051;
}

double processor_seconds() {
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

}  // namespace

int main(int argc, char** argv) {
    const auto argument = [&](int k, int otherwise) { return argc > k ? std::atoi(argv[k]) : otherwise; };
    const int seeds = argument(1, 3);
    const int first_seed = argument(4, 1);
    const std::string precision = argc > 5 ? argv[5] : "mixed";
    const auto table = tests::read_table(tests::reference("spreading/mfr_table.csv"));
    const SceneInfo& scene = *campaign::scene_named("powder_spreading");
    double chi_square = 0;
    double mean_here = 0;
    double mean_there = 0;
    double particle_steps = 0;
    int counted = 0;
    int compared = 0;
    const double start = processor_seconds();
    for (std::size_t row = 0; row < table.rows; ++row) {
        const int point = static_cast<int>(table.at("point", row));
        if (point < argument(2, 1) || point > argument(3, 1000)) continue;
        Inputs inputs = scene.defaults();
        inputs["friction"] = table.at("mu", row);
        inputs["diameter"] = table.at("D_mm", row) * 1e-3;
        inputs["gap"] = table.at("gap_mm", row) * 1e-3;
        inputs["speed"] = table.at("v", row);
        inputs["time_step"] = 1e-5;
        inputs["tangential_limit"] = std::string("spring");
        inputs["precision"] = precision;
        double mfr = 0;
        double window = 0;
        double overlap = 0;
        double seconds = processor_seconds();
        double settled_seconds = 0;
        double steps = 0;
        double settled_steps = 0;
        NoArtefacts none;
        for (int seed = first_seed; seed < first_seed + seeds; ++seed) {
            const double begin = processor_seconds();
            const auto run = scene.make(inputs, static_cast<std::uint64_t>(seed), none);
            run->advance(0.15);
            settled_seconds += processor_seconds() - begin;
            settled_steps += run->particle_steps();
            run->advance(std::numeric_limits<double>::infinity());
            if (!run->health().stable()) {
                std::printf("point %d seed %d: %s\n", point, seed, run->health().reason.c_str());
                return 1;
            }
            Observations seen;
            run->observe(seen);
            mfr += seen.scalars.at("mfr") / seeds;
            window += seen.scalars.at("mfr_window") / seeds;
            overlap = std::max(overlap, seen.scalars.at("max_overlap"));
            steps += run->particle_steps();
        }
        seconds = processor_seconds() - seconds;
        particle_steps += steps;
        const double there = table.at("MFR_flux_mean", row);
        const double ratio = table.at("gap_over_D", row);
        const double error = scatter(ratio, point) * there * std::sqrt(1.0 / seeds + 1.0 / table.at("n_seeds", row));
        const double z = error > 0 ? (mfr - there) / error : (mfr == there ? 0.0 : 99.0);
        if (ratio > 1) {
            chi_square += z * z;
            ++counted;
        }
        mean_here += mfr;
        mean_there += there;
        ++compared;
        std::printf(
            "point %2d gap/D %.3f N %4.0f  mfr %.4f table %.4f z %+5.2f  window %.4f table %.4f  overlap %.3f  "
            "%5.1f s  settle %.1f sweep %.1f M particle-steps/s\n",
            point, ratio, table.at("N", row), mfr, there, z, window, table.at("MFR_window_mean", row), overlap, seconds,
            settled_steps / settled_seconds / 1e6, (steps - settled_steps) / (seconds - settled_seconds) / 1e6);
        std::fflush(stdout);
    }
    std::printf(
        "chi-square %.2f over %d points with gap > D; mean of %d points %.4f, table %.4f (%+.2f %%); %.3g "
        "particle-steps in %.1f s: %.2f M/s\n",
        chi_square, counted, compared, mean_here / compared, mean_there / compared, 100 * (mean_here / mean_there - 1),
        particle_steps, processor_seconds() - start, particle_steps / (processor_seconds() - start) / 1e6);
    return 0;
}
