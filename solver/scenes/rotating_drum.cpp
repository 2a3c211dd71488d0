// Rotating drum: powder in a horizontal cylinder that turns steadily; the dynamic angle of repose, the flow down the
// surface, and what a camera that looks along the axis sees.
//
// Definitions as in drum/study.hpp (geometry, times) and solver/observables/turned_bed.hpp (what is measured). The
// regimes go with the Froude number w^2 R/g (Mellmann 2001, Powder Technol. 118, 251: rolling below about 0.1,
// cascading and cataracting above, centrifuging from 1).
#include "solver/observables/turned_bed.hpp"
#include "solver/scenes/catalogue.hpp"
#include "solver/scenes/drum/experiment.hpp"
#include "solver/scenes/drum/question.hpp"
#include "solver/scenes/drum/record.hpp"
#include "solver/scenes/drum/warnings.hpp"
#include "solver/scenes/kit/pace.hpp"

namespace grainsweep {

SceneInfo rotating_drum_scene() {
    SceneInfo info;
    info.name = "rotating_drum";
    info.summary = "powder in a turning drum: dynamic angle of repose, flowing layer, torque, occupancy image";
    info.revision = drum::revision;
    const auto numerics = [](double fraction, const char* precision) {
        return Inputs{{"time_step_fraction", fraction}, {"precision", std::string(precision)}};
    };
    info.accuracy = {{"fast", numerics(0.35, "mixed")},
                     {"balanced", numerics(0.2, "mixed")},
                     {"reference", numerics(0.05, "double")}};
    info.parameters = drum::question::parameters();
    info.observables = drum::record::observables();
    info.maker = [](const Inputs& inputs, std::uint64_t seed, Artefacts&,
                    const Files& files) -> std::unique_ptr<Scene> {
        return std::make_unique<drum::Experiment>(drum::study_of(inputs, files), seed,
                                                  drum::question::powder.method(inputs));
    };
    info.estimate_cost = [](const Inputs& inputs, const Files& files) {
        const auto s = drum::study_of(inputs, files);
        auto estimate = kit::estimate(drum::question::powder.method(inputs), s.material,
                                      static_cast<double>(s.particles), static_cast<double>(s.last_step()));
        estimate.bytes += observables::section_bytes(s.radius, s.diameter, s.occupancy_cell);
        return estimate;
    };
    info.warnings = drum::warnings_of;
    return info;
}

}  // namespace grainsweep
