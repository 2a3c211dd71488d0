// Powder spreading: a blade sweeps a settled layer of powder over a base, and the flux under it is measured.
//
// Scene, observables and default values after Wu (2020), "Parametric analysis of particle spreading with discrete
// element method", MSc thesis, Embry-Riddle Aeronautical University; the layer is flat and gated instead of a free
// pile, which runs out before the blade arrives. spreading/study.hpp has the geometry, solver/dem the mechanics.
#include "solver/dem/fast/mixed_engine.hpp"
#include "solver/scenes/catalogue.hpp"
#include "solver/scenes/spreading/experiment.hpp"
#include "solver/scenes/spreading/warnings.hpp"

namespace grainsweep {
namespace {

using Condition = Relevance::Condition;

ParameterSpec number(std::string name, std::string unit, std::string meaning, double value, Interval bounds,
                     std::vector<Relevance> relevant_if = {}) {
    return {std::move(name), std::move(unit), std::move(meaning), value, bounds, std::move(relevant_if)};
}

std::vector<ParameterSpec> parameters() {
    const auto above = [](double low, double high) { return Interval{low, high, true, false}; };
    const auto if_set = [](const char* other) { return std::vector<Relevance>{{other, Condition::nonzero, {}}}; };
    return {
        number("friction", "1", "Coulomb friction of particles, base and blade", 0.2, {0, 2}),
        number("rolling_friction", "1",
               "rolling friction of particles, base and blade: tangent of the steepest slope a particle "
               "stands on",
               0.0, {0, 1}, if_set("friction")),
        number("restitution", "1", "restitution of particles and walls", 0.5, above(0, 1)),
        number("diameter", "m", "diameter D of the particles; of unequal ones see size_distribution", 0.002,
               {1e-4, 1e-2}),
        {"size_distribution",
         "",
         "by number: 'monodisperse' all D; 'weibull_wide', 'weibull_narrow' the five classes of Wu (2020), 4.44, "
         "22.76, 40.78, 26.91, 5.11 % of (1 + k w) D, k = -2 ... 2, w = 0.15 and 0.1; 'lognormal' with mean D, without "
         "its 0.5 % smallest and largest",
         std::string("monodisperse"),
         Words{{"monodisperse", "weibull_wide", "weibull_narrow", "lognormal"}},
         {}},
        number("size_spread", "1", "standard deviation of the logarithm of the diameter, before truncation", 0.2,
               {0, 0.5}, {{"size_distribution", Condition::is_word, {"lognormal"}}}),
        number("gap", "m", "height of the blade's lower edge over the base", 0.004, {1e-5, 0.1}),
        number("speed", "m/s", "speed of the blade", 1.4, {1e-3, 10}),
        number("cohesion", "J/m3", "cohesion energy density", 0.0, {0, 1e6}),
        {"cohesion_law", "",
         "area the cohesion acts on: 'sjkr' cut of the spheres, 'sjkr2' 4 pi R* d, 'paper' "
         "pi (2 R* d - d^2)/4",
         std::string("sjkr"), Words{{"sjkr", "sjkr2", "paper"}}, if_set("cohesion")},
        number("youngs_modulus", "Pa", "Young's modulus of particles and walls", 21e6, {1e5, 1e12}),
        number("poisson_ratio", "1", "Poisson's ratio of particles and walls", 0.3, {0, 0.49}),
        number("density", "kg/m3", "density of the particles", 7980, {100, 25000}),
        number("gravity", "m/s2", "gravity, downwards", 9.81, above(0, 100)),
        number("vibration_amplitude", "m", "vertical vibration of the blade: amplitude of a sine", 0.0, {0, 0.01},
               if_set("vibration_frequency")),
        number("vibration_frequency", "Hz", "vertical vibration of the blade: frequency", 0.0, {0, 1e5},
               if_set("vibration_amplitude")),
        number("width", "1", "period of the layer across the blade's motion, in diameters", 10, {3, 1000}),
        number("layer_area", "m2", "solid area of the layer in the plane of the motion", 400e-6, {1e-6, 0.1}),
        number("settle_time", "s", "time the layer settles before the blade starts", 0.15, {0, 100}),
        {"bed_seed",
         "1",
         "which settled bed; 0: another one for each case and replicate; n: the n-th one, settled once for all cases "
         "of the same powder and time step, whatever gap, speed and blade, and kept beside the database. Cases then "
         "differ by where the blade starts, up to one diameter before the layer, and share what is particular to the "
         "bed, 8 to 31 % of the variance of mfr between seeds and a third of packing_fraction's: replicates "
         "underestimate the error by so much, and comparisons over one bed are more precise by as much",
         std::int64_t{0},
         Interval{0, 9.0e15},
         {{"settle_time", Condition::nonzero, {}}}},
        number("travel", "m", "travel of the blade; the flux counts from 2/7 of it, and the layer is 20 mm longer",
               0.07, {1e-3, 1}),
        number("blade_thickness", "m", "thickness of the blade", 0.005, {1e-4, 0.1}),
        number("blade_edge_radius", "m", "radius of the blade's lower edges; 0: sharp", 0.0, {0, 0.05}),
        number("time_step", "s",
               "time step; 0: time_step_fraction of the shorter of the Rayleigh time and the Hertz "
               "contact time at the fastest expected impact",
               0.0, {0, 1e-3}),
        number("time_step_fraction", "1", "time step over the shorter of the two limits", 0.2, above(0, 1),
               {{"time_step", Condition::zero, {}}}),
        number("standard_error", "1",
               "ends the sweep once mfr_standard_error is below this, or nothing has passed, looked at every tenth of "
               "the measured travel from its half on; 0: sweeps to the end. The flux falls by 5 to 8 % over the "
               "measured travel, so "
               "a shorter sweep answers up to 4 % higher: compare only cases asked alike",
               0.0, {0, 1}),
        {"precision",
         "",
         "arithmetic: 'mixed' vectorised, exact position differences, single precision forces; 'double' the clear "
         "reference",
         std::string("mixed"),
         Words{{"mixed", "double"}},
         {}},
    };
}

dem::Method method_of(const Inputs& inputs) {
    dem::Method method;
    const bool mixed = std::get<std::string>(inputs.at("precision")) == "mixed";
    method.precision = mixed ? dem::Method::Precision::mixed : dem::Method::Precision::double_precision;
    return method;
}

std::vector<ObservableSpec> observables_of_spreading() {
    return {
        {"mfr", "1",
         "mass flow rate under the blade over that of the swept gap filled solid: (M(t2) - M(t1))/(t2 - t1)"
         "/(W gap v rho), M the mass of the centres behind the front face, with those that left the box there, t1 at "
         "2/7 "
         "of the travel, t2 where the sweep ended"},
        {"mfr_window", "1",
         "mass between the planes of rear and front face and below the gap over that of the slot filled "
         "solid, W gap thickness rho; mean of the samples from t1 to t2"},
        {"mfr_thesis", "s",
         "the same mass over W gap v rho, as eq. 15-17 of Wu (2020) are printed: mfr_window times "
         "thickness/speed"},
        {"mfr_standard_error", "1",
         "standard error of mfr from the spread of 10 consecutive blocks of the flux; undefined where nothing passed"},
        {"end_of_travel", "m", "travel of the blade when the sweep ended"},
        {"max_overlap", "1",
         "largest overlap of two particles over the smaller diameter, over all steps of the sweep; 0: none touched"},
        {"packing_fraction", "1",
         "volume of the spread particles over that of a layer as high as the gap, from where the "
         "front face was at t1 to one thickness behind the blade at the end; undefined, as are layer_roughness and "
         "empty_share, where the blade did not get that far"},
        {"layer_roughness", "1",
         "root mean square deviation of the height of the spread layer's surface, seen from above "
         "on a grid of D/4, over the diameter; undefined where empty_share is above one half: there is no layer"},
        {"empty_share", "1", "share of the same grid that no particle covers"},
        {"particles", "1", "particles present at the end: those that left the box through its open faces are not"},
        {"vx_profile", "m/s",
         "mean velocity along the blade's motion in the 12 layers of thickness D/2 above the gap, "
         "within 6 D ahead of the front face, from t1 to t2, undefined where there was no particle; bin: top of the "
         "layer over the gap, in D",
         Shape::profile, "top of the layer over the gap (D)"},
        {"vx_unevenness", "1",
         "root mean square second difference of vx_profile from layer to layer, over the speed of the blade: 0 for a "
         "profile that rises evenly; undefined where no three neighbouring layers hold a "
         "particle per sample on average"},
        {"flux_series", "1", "mfr of each 1/140 of the travel; time since the blade started", Shape::series,
         "time since the blade started (s)"},
    };
}

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

double estimate_cost(const Inputs& inputs) {
    const auto s = spreading::study_of(inputs);
    const auto [settling, sweeping] = pace_of(method_of(inputs));
    return static_cast<double>(s.particles) *
           (settling * static_cast<double>(s.settle_steps) + sweeping * static_cast<double>(s.sweep_steps));
}

}  // namespace

SceneInfo powder_spreading_scene() {
    SceneInfo info;
    info.name = "powder_spreading";
    info.summary = "a blade spreads a settled layer of powder: flux under the blade and quality of the layer";
    info.revision = spreading::revision;
    // Error of mfr and cost of each: tests/bench/accuracy_speed, table in solver/dem/README.md.
    const auto numerics = [](double fraction, double width, const char* precision) {
        return Inputs{{"time_step_fraction", fraction}, {"width", width}, {"precision", std::string(precision)}};
    };
    info.accuracy = {{"fast", numerics(0.3, 5, "mixed")},
                     {"balanced", numerics(0.2, 10, "mixed")},
                     {"reference", numerics(0.05, 20, "double")}};
    info.parameters = parameters();
    info.observables = observables_of_spreading();
    info.maker = [](const Inputs& inputs, std::uint64_t seed, Artefacts& artefacts,
                    const Files&) -> std::unique_ptr<Scene> {
        return std::make_unique<spreading::Experiment>(spreading::study_of(inputs), seed, method_of(inputs), artefacts);
    };
    info.estimate_cost = estimate_cost;
    info.warnings = spreading::warnings_of;
    // No gap is proven to pass nothing over the whole range of stiffness, cohesion and speed: soft particles are
    // squeezed through gaps below their diameter.
    info.proven_answer = [](const Inputs&) -> std::optional<ProvenAnswer> { return std::nullopt; };
    return info;
}

}  // namespace grainsweep
