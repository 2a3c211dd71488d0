// Heap: powder in a tube on a plate; the tube is lifted, the powder runs out below it and makes a heap: the static
// angle of repose.
//
// Definitions as in heap/study.hpp (geometry, times) and solver/observables/heap.hpp (what is measured).
#include "solver/scenes/catalogue.hpp"
#include "solver/scenes/heap/experiment.hpp"
#include "solver/scenes/heap/question.hpp"
#include "solver/scenes/heap/record.hpp"
#include "solver/scenes/heap/warnings.hpp"
#include "solver/scenes/kit/pace.hpp"

namespace grainsweep {

SceneInfo heap_scene() {
    SceneInfo info;
    info.name = "heap";
    info.summary = "powder running out of a tube lifted from a plate: static angle of repose, outline, run-out";
    info.revision = heap::revision;
    const auto numerics = [](double fraction, const char* precision) {
        return Inputs{{"time_step_fraction", fraction}, {"precision", std::string(precision)}};
    };
    info.accuracy = {{"fast", numerics(0.35, "mixed")},
                     {"balanced", numerics(0.2, "mixed")},
                     {"reference", numerics(0.05, "double")}};
    info.parameters = heap::question::parameters();
    info.observables = heap::record::observables();
    info.maker = [](const Inputs& inputs, std::uint64_t seed, Artefacts&,
                    const Files& files) -> std::unique_ptr<Scene> {
        return std::make_unique<heap::Experiment>(heap::study_of(inputs, files), seed,
                                                  heap::question::powder.method(inputs));
    };
    info.estimate_cost = [](const Inputs& inputs, const Files& files) {
        const auto s = heap::study_of(inputs, files);
        auto estimate = kit::estimate(heap::question::powder.method(inputs), s.material,
                                      static_cast<double>(s.particles), s.steps_to_rest(), s.glued_spheres());
        constexpr double bytes_per_ring = 2 * sizeof(double);  // of the outline
        estimate.bytes += bytes_per_ring * s.reach() / s.diameter;
        return estimate;
    };
    info.warnings = heap::warnings_of;
    return info;
}

}  // namespace grainsweep
