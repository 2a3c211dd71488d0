// Powder spreading: a blade, a roller or another tool spreads a settled layer of powder over a base or over earlier
// layers. The flux under the tool and the layer behind it are measured.
//
// Scene, observables and default values after Wu (2020), "Parametric analysis of particle spreading with discrete
// element method", MSc thesis, Embry-Riddle Aeronautical University. The layer is flat between gates, because a free
// pile would spread before the blade arrives. Geometry: spreading/study.hpp; mechanics: solver/dem.
#include "solver/dem/fast/mixed_engine.hpp"
#include "solver/scenes/catalogue.hpp"
#include "solver/scenes/kit/pace.hpp"
#include "solver/scenes/spreading/experiment.hpp"
#include "solver/scenes/spreading/filling.hpp"
#include "solver/scenes/spreading/question.hpp"
#include "solver/scenes/spreading/record.hpp"
#include "solver/scenes/spreading/warnings.hpp"

namespace grainsweep {
namespace {

/// Seconds per particle and step on one core, settling and sweeping (lists are rebuilt more often), measured with
/// the 16 cases of tests/bench/spreading_reference.
struct Pace {
    double settling, sweeping;
};

Pace pace_of(const dem::Method& method) {
    if (method.precision == dem::Method::Precision::double_precision) return {90e-9, 100e-9};
    switch (dem::fast::best_path()) {
        case dem::Method::Path::avx512:
            return {17e-9, 22e-9};
        case dem::Method::Path::avx2:
            return {26e-9, 34e-9};
        default:
            return {48e-9, 60e-9};
    }
}

CostEstimate cost_of_spreading(const Inputs& inputs, const Files& files) {
    const auto s = spreading::study_of(inputs, files);
    const dem::Method method = spreading::question::powder.method(inputs);
    const auto [settling, sweeping] = pace_of(method);
    const auto settle = static_cast<double>(s.settle_steps), sweep = static_cast<double>(s.sweep_steps);
    // Under each layer lie those before it, as dense as powder lies.
    const double layer = spreading::settled_fraction * s.gap * s.width * (s.end_of_platform() - s.start_of_platform()) /
                         (particles::sphere_volume(s.diameter) * s.sizes.moment(3));
    const auto n = static_cast<double>(s.layers), supplied = static_cast<double>(s.particles);
    const double moved = n * (supplied + layer * (n - 1) / 2);
    auto estimate = kit::estimate(method, s.material, moved, settle + sweep);
    estimate.seconds = moved * (settling * settle + sweeping * sweep) * kit::slower_by_rolling(s.material);
    const double glued = static_cast<double>(spreading::glued_particles(s));
    estimate.bytes = kit::estimate(method, s.material, supplied + layer * (n - 1), 0, glued).bytes;
    return estimate;
}

}  // namespace

SceneInfo powder_spreading_scene() {
    SceneInfo info;
    info.name = "powder_spreading";
    info.summary =
        "a blade, a roller or another tool spreads layers of powder: flux under it and quality of the layers";
    info.revision = spreading::revision;
    // Error of mfr and cost of each: tests/bench/accuracy_speed, table in solver/dem/README.md.
    const auto numerics = [](double fraction, double width, const char* precision) {
        return Inputs{{"time_step_fraction", fraction}, {"width", width}, {"precision", std::string(precision)}};
    };
    // Survey: for moments of the mean response over a whole range. A case costs a sixth and scatters more; its bias is
    // too small to be seen in 2,400 cases (tests/bench/accuracy_levels, numbers in docs/cost.md).
    Inputs survey = numerics(0.4, 5, "mixed");
    survey["settle_time"] = 0.08;
    info.accuracy = {{"survey", survey},
                     {"fast", numerics(0.3, 5, "mixed")},
                     {"balanced", numerics(0.2, 10, "mixed")},
                     {"fine", numerics(0.05, 20, "mixed")},
                     {"reference", numerics(0.05, 20, "double")}};
    info.stiffness = "youngs_modulus";
    info.parameters = spreading::question::parameters();
    info.observables = spreading::record::observables();
    info.main = {{"packing_fraction", "solid share of the layer"},
                 {"empty_share", "bare share of the plate"},
                 {"layer_roughness", "unevenness, in diameters"},
                 {"tool_force", "force against the tool"},
                 {"mfr", "mass flow; 1: gap full"}};
    info.maker = [](const Inputs& inputs, std::uint64_t seed, Artefacts& artefacts,
                    const Files& files) -> std::unique_ptr<Scene> {
        return std::make_unique<spreading::Experiment>(spreading::study_of(inputs, files), seed,
                                                       spreading::question::powder.method(inputs), artefacts);
    };
    info.estimate_cost = cost_of_spreading;
    info.warnings = spreading::warnings_of;
    // No gap is proven to pass nothing over the whole range of stiffness, cohesion and speed: soft particles are
    // squeezed through gaps below their diameter.
    return info;
}

}  // namespace grainsweep
