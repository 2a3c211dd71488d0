// Hopper: powder leaving a container through an opening in its floor or at the tip of a cone; the rate, and whether it
// jams.
//
// Definitions as in hopper/study.hpp (geometry, times) and solver/observables/outflow.hpp (what is measured), law of
// comparison: solver/observables/beverloo.hpp.
#include "solver/scenes/catalogue.hpp"
#include "solver/scenes/hopper/experiment.hpp"
#include "solver/scenes/hopper/question.hpp"
#include "solver/scenes/hopper/record.hpp"
#include "solver/scenes/hopper/warnings.hpp"
#include "solver/scenes/kit/filling.hpp"
#include "solver/scenes/kit/pace.hpp"

#include "solver/observables/beverloo.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace grainsweep {
namespace {

constexpr double slope = 0.47;    // of what stays on a flat floor, 25 degrees
constexpr double packed = 0.57;   // solid fraction
constexpr double falling = 1.25;  // cost of a step: lists of falling particles are renewed more often
constexpr double trickling = 4;   // quiet times from the end of the flow to its last particle

/// Particles that stay on the floor about the opening.
double staying(const hopper::Study& s) {
    if (s.conical) return 0;
    const double a = s.opening / 2, r = s.half_width;
    const double volume = s.slot ? slope * (r - a) * (r - a) * s.slot_length
                                 : 2 * std::numbers::pi * slope * (r * r * r / 3 - a * r * r / 2 + a * a * a / 6);
    const double one = particles::sphere_volume(s.diameter) * s.sizes.moment(3);
    return std::min(static_cast<double>(s.particles), packed * volume / one);
}

/// Beverloo's law lets out what is asked for or can leave; then single particles follow until the flow has ceased.
CostEstimate cost_of_discharge(const Inputs& inputs, const Files& files) {
    const auto s = hopper::study_of(inputs, files);
    const double n = static_cast<double>(s.particles);
    const double mean = std::cbrt(s.sizes.moment(3)) * s.diameter;
    const double rate = observables::beverloo_rate(s.opening, mean, packed, s.gravity);
    const double end = s.time_of_frame(s.frames - 1), stay = rate > 0 ? staying(s) : n;
    const double leave = std::min(s.stop_share * n, n - stay);
    const double flow = rate > 0 ? std::min(end, 1.2 * leave / rate) : 0;
    const double tail = s.stop_share * n > n - stay ? std::min(end - flow, trickling * s.quiet_time()) : 0;
    const double work = static_cast<double>(s.settle_steps) * n + (flow * (n - leave / 2) + tail * stay) / s.time_step;
    auto estimate = kit::estimate(hopper::question::powder.method(inputs), s.material, n, std::max(work / n, 1.0));
    estimate.seconds *= falling;
    return estimate;
}

}  // namespace

SceneInfo hopper_scene() {
    SceneInfo info;
    info.name = "hopper";
    info.summary = "powder leaving a flat or conical hopper through a round opening or a slot: rate, jams, segregation";
    info.revision = hopper::revision;
    const auto numerics = [](double fraction, const char* precision) {
        return Inputs{{"time_step_fraction", fraction}, {"precision", std::string(precision)}};
    };
    info.accuracy = {{"fast", numerics(0.35, "mixed")},
                     {"balanced", numerics(0.2, "mixed")},
                     {"reference", numerics(0.05, "double")}};
    info.parameters = hopper::question::parameters();
    info.observables = hopper::record::observables();
    info.maker = [](const Inputs& inputs, std::uint64_t seed, Artefacts&,
                    const Files& files) -> std::unique_ptr<Scene> {
        return std::make_unique<hopper::Experiment>(hopper::study_of(inputs, files), seed,
                                                    hopper::question::powder.method(inputs));
    };
    info.estimate_cost = cost_of_discharge;
    info.warnings = hopper::warnings_of;
    return info;
}

}  // namespace grainsweep
