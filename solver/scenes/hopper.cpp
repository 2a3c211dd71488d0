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

namespace grainsweep {
namespace {

/// Half of the particles on average, until Beverloo's law has let out what is asked for, or to the end.
CostEstimate cost_of_discharge(const Inputs& inputs, const Files& files) {
    const auto s = hopper::study_of(inputs, files);
    const double n = static_cast<double>(s.particles);
    const double rate = observables::beverloo_rate(s.opening, s.diameter, 0.57, s.gravity);
    const double end = s.time_of_frame(s.frames - 1);
    const double flow = rate > 0 ? std::min(end, 1.2 * s.stop_share * n / rate) : std::min(end, 2 * s.quiet_time());
    const double steps = static_cast<double>(s.settle_steps) + flow / s.time_step * (1 - 0.5 * s.stop_share);
    return kit::estimate(hopper::question::powder.method(inputs), n, std::max(steps, 1.0));
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
    info.proven_answer = [](const Inputs&) -> std::optional<ProvenAnswer> { return std::nullopt; };
    return info;
}

}  // namespace grainsweep
