// Thermovibrational particle accumulation: a fluid-filled cube, heated from one side and shaken along another axis,
// carries small particles that gather into structures.
//
//   fluid:     solver/flow/flow.hpp           (Boussinesq, non-dimensional: L, L^2/alpha)
//   particles: solver/coupling/motion.hpp     coupling levels: thermovibration/levels.hpp
//   measured:  solver/observables/accumulation.hpp, flow_state.hpp
// after Manayil Santhosh, Anwar & Lappa 2024 (IAC-24-A1.2.3), with Ra_omega = gamma beta/Pr (their eq. 28 prints
// gamma beta Pr, with which their own Gershuni numbers do not come out).
#include "solver/scenes/catalogue.hpp"
#include "solver/scenes/thermovibration/runs.hpp"
#include "solver/scenes/thermovibration/warnings.hpp"

#include <cmath>

namespace grainsweep {
namespace {

using thermovibration::LevelInfo;
using thermovibration::Question;
using Condition = Relevance::Condition;

/// Names of the levels with a trait.
std::vector<std::string> level_names(bool (*with)(const LevelInfo&)) {
    std::vector<std::string> names;
    for (const LevelInfo& level : thermovibration::levels())
        if (with(level)) names.emplace_back(level.name);
    return names;
}
Relevance at_levels(bool (*with)(const LevelInfo&)) {
    return {"coupling", Condition::is_word, level_names(with)};
}

const Relevance with_particles{"particles", Condition::nonzero, {}};
const Relevance vibrated{"frequency", Condition::nonzero, {}};
const Relevance one_way = at_levels([](const LevelInfo& l) { return !l.acts_on_fluid; });
const Relevance felt_by_fluid = at_levels([](const LevelInfo& l) { return l.acts_on_fluid; });
const Relevance two_way = at_levels([](const LevelInfo& l) { return l.acts_on_fluid && !l.dense; });
const Relevance colliding = at_levels([](const LevelInfo& l) { return l.dense; });
const Relevance stressed = at_levels([](const LevelInfo& l) { return l.stressed; });
const Relevance without_contacts = at_levels([](const LevelInfo& l) { return !l.resolves_contacts; });
const Relevance with_contacts = at_levels([](const LevelInfo& l) { return l.resolves_contacts; });
const Relevance springs{"contact", Condition::is_word, {"spring"}};

ParameterSpec real(std::string name, std::string unit, std::string meaning, double value, Interval bounds,
                   std::vector<Relevance> relevant_if = {}) {
    return {std::move(name), std::move(unit), std::move(meaning), value, bounds, std::move(relevant_if)};
}

ParameterSpec whole(std::string name, std::string meaning, std::int64_t value, Interval bounds,
                    std::vector<Relevance> relevant_if = {}) {
    return {std::move(name), "1", std::move(meaning), value, bounds, std::move(relevant_if)};
}

ParameterSpec word(std::string name, std::string meaning, std::vector<std::string> allowed,
                   std::vector<Relevance> relevant_if) {
    std::string first = allowed.front();
    return {std::move(name),       "", std::move(meaning), std::move(first), Words{std::move(allowed)},
            std::move(relevant_if)};
}

Interval between(double low, double high) {
    return {low, high, false, false};
}
Interval above(double low, double high) {
    return {low, high, true, false};
}

std::vector<ParameterSpec> parameters() {
    return {
        real("rayleigh", "1", "vibrational Rayleigh number b w^2 beta DT L^3/(nu alpha)", 4.81e5, between(0, 1e9)),
        real("frequency", "1", "angular frequency w L^2/alpha; 0: a steady force", 1.667e4, between(0, 1e7)),
        real("start_phase", "rad", "phase of the vibration sin(w t + phase) at the start", 0, between(0, 6.2832),
             {vibrated}),
        real("acceleration", "1", "amplitude of the vibrational acceleration b w^2 L^3/alpha^2 (gamma)", 1.72e9,
             between(0, 1e12), {with_particles}),
        real("prandtl", "1", "Prandtl number nu/alpha", 18, between(1e-3, 1e4)),
        real("density_ratio", "1", "particle density over fluid density (xi)", 1.65, between(0, 1e4), {with_particles}),
        real("stokes", "1", "Stokes number (2/9)(R/L)^2", 3.1e-6, between(1e-12, 2.2e-3), {with_particles}),
        whole("particles", "number of particles; 0: the flow alone", 3150, between(0, 1e6)),
        word("coupling",
             "forces between fluid and particles: the fluid's on the particles; also the particles' on the fluid; also "
             "their volume, with solids pressure from an algebraic (ddpm) or transported (ddpm_ktgf) granular "
             "temperature; or with resolved contacts (cfd_dem)",
             level_names([](const LevelInfo&) { return true; }), {with_particles}),
        word("own_wake",
             "what a particle does to the fluid at its own place: felt as if others had done it, or taken out of the "
             "fluid it feels",
             {"kept", "subtracted"}, {with_particles, two_way}),
        word("wall_contact", "a particle meets a wall with its surface or with its centre", {"radius", "centre"},
             {with_particles}),
        real("restitution", "1", "of the rebound from walls", 1, between(0, 1), {with_particles, without_contacts}),
        word("contact", "contacts as hysteretic springs with friction in sub-steps, or as displacement out of overlap",
             {"spring", "projection"}, {with_particles, with_contacts}),
        real("collision_restitution", "1", "of collisions among particles", 0.9, between(0.05, 1),
             {with_particles, colliding}),
        real("friction", "1", "of contacts", 0.3, between(0, 10), {with_particles, with_contacts, springs}),
        real("overlap", "1", "of springs under the vibrational force and impact, over the diameter", 0.01,
             between(1e-5, 0.1), {with_particles, with_contacts, springs}),
        real("packing_limit", "1", "largest volume fraction of particles", 0.63, between(0.3, 0.74),
             {with_particles, stressed}),
        real("granular_temperature", "(alpha/L)^2", "least granular temperature, and that of the start", 1e-3,
             between(0, 1e9), {with_particles, stressed}),
        word("particle_start",
             "particles start with the flow, from rest, or are released into the flow once it is periodic",
             {"with_flow", "periodic_flow"}, {with_particles, vibrated, one_way}),
        real("kernel_width", "diameters",
             "standard deviation of the Gaussian over which a particle's force and volume are spread; no narrower than "
             "the cells of the grid",
             4, between(0, 20), {with_particles, felt_by_fluid}),
        whole("cells", "cells of the flow grid per side", 28, between(4, 128)),
        real("clustering", "1", "clustering c of the grid towards all walls, tanh(c s)/tanh(c); 0: uniform", 1.5,
             between(0, 3)),
        word("symmetry",
             "the flow of one-way particles: the whole cube, or half of it as its own mirror image in x (even cells), "
             "which it starts as and stays unless a convection that breaks the symmetry sets in",
             {"none", "mirror"}, {one_way}),
        whole("steps_per_period", "time steps per period of vibration", 24, between(8, 4096), {vibrated}),
        real("time_step", "L^2/alpha", "time step under a steady force", 1e-4, between(1e-9, 1),
             {{"frequency", Condition::zero, {}}}),
        real("end_time", "L^2/alpha", "time the particles are followed, to whole periods", 0.98, above(0, 100)),
        whole("sampling_cells", "cells per side of the sampling grid of the accumulation", 10, between(2, 100),
              {with_particles}),
    };
}

ObservableSpec scalar(std::string name, std::string unit, std::string meaning, std::string absent) {
    return {std::move(name), std::move(unit), std::move(meaning), Shape::scalar, {}, std::move(absent)};
}

ObservableSpec over_time(std::string name, std::string meaning) {
    return {std::move(name), "1", std::move(meaning), Shape::series, "time (L^2/alpha)"};
}

std::vector<ObservableSpec> thermovibration_observables() {
    const std::string too_few = "there are fewer than two particles";
    const std::string flow_shared = "the particles cannot act on the flow, which was computed once for all such cases";
    const std::string not_felt = "the particles do not act on the fluid at this coupling";
    return {
        scalar("accumulation", "1", "K on sampling_cells^3 at the end; undefined for fewer than two particles",
               too_few),
        scalar("accumulation_excess", "1", "(K - K_random)/(1 - K_random): 0 random, 1 all in one cell", too_few),
        scalar("structures", "1",
               "connected groups of cells above twice the mean that hold at least 5 % of the particles; undefined for "
               "fewer particles than half of the cells, where a cell with one is such a group",
               "there are fewer particles than half of the cells"),
        scalar("formation_time", "L^2/alpha",
               "from when K stays within a tenth of its rise, or three standard deviations of a random cloud's K, from "
               "its last value; undefined where that is only in the last tenth of the time: still rising",
               "the accumulation still rises in the last tenth of the time, or there are fewer than two particles"),
        scalar("gershuni", "1", "Gershuni number (Pr/2)(Ra/Omega)^2; undefined under a steady force",
               "the force is steady"),
        scalar("kinetic_energy", "(alpha/L)^2", "mean of |V|^2/2 over the volume and the last period", flow_shared),
        scalar("nusselt", "1", "heat flux through the hot wall over that of conduction, mean of the last period",
               flow_shared),
        scalar("packing_limited", "1", "share of the steps in which the packing limit moved particles (ddpm levels)",
               "the coupling has no packing limit"),
        scalar("peak_velocity", "alpha/L", "largest velocity component in the last period", flow_shared),
        scalar("force_on_fluid", "rho alpha^2",
               "what all particles together give the fluid along the vibration, root mean square of the last period "
               "(levels that act on the fluid)",
               not_felt),
        scalar("vibrational_force", "rho alpha^2",
               "vibrational buoyancy of all particles, root mean square of the last period; force_on_fluid differs "
               "from it by the inertia of the particles (likewise)",
               not_felt),
        over_time("accumulation_series", "K on sampling_cells^3, always at the same phase"),
        over_time("accumulation_5", "K on 5^3 cells"),
        over_time("accumulation_20", "K on 20^3 cells"),
        over_time("accumulation_40", "K on 40^3 cells"),
        over_time("accumulation_cells", "K on as many cells as the flow grid has, all of one size"),
        {"density_y", "1", "particles per slab across y over the mean, at the end", Shape::profile, "y/L"},
        {"density_z", "1", "particles per slab across z over the mean, at the end", Shape::profile, "z/L"},
    };
}

std::unique_ptr<Scene> make(const Inputs& inputs, std::uint64_t seed, Artefacts& artefacts, const Files&) {
    using namespace thermovibration;
    const Question question(inputs);
    if (!question.carried()) return std::make_unique<Live>(question, seed);
    return std::make_unique<Carried>(question, seed, artefacts, carried_step(question));
}

// Of fields with their scratch, and of particles with their lists.
constexpr double bytes_per_cell = 600, bytes_per_particle = 800;

// Measured in campaigns at 16^3 and 28^3 with 500 and 3150 particles, one case on each core, with AVX-512. At 40^3 a
// fluid step takes 2.9 ms, on half the grid half of this. A step of the particles takes 0.64 ms, and spreading their
// force on the fluid 1.3 ms. Their volume and contacts take 1.2 ms more per 3150 particles, and 7 ms (ddpm) or 4 ms
// (cfd_dem) on the grid.
double seconds_of_vibration(const Question& question) {
    const double size = static_cast<double>(question.cells) / 40;
    const double cube = size * size * size * (0.7 + 0.3 * size);
    const double cloud = static_cast<double>(question.particles) / 3150;
    const double fluid_step = (question.mirrored() ? 1.45e-3 : 2.9e-3) * cube;
    const double sweep = 0.64e-3 * cloud;
    const double spreading = 1.3e-3 * cube + 0.13e-3 * cloud;
    const auto steps = static_cast<double>(question.total_steps());
    if (question.particles == 0) return steps * fluid_step;
    if (question.level->dense)
        return steps * (fluid_step + sweep + spreading + 1.2e-3 * cloud + question.level->seconds_on_grid * cube);
    if (question.level->acts_on_fluid) return steps * (fluid_step + sweep + spreading);
    if (!question.carried()) return steps * (fluid_step + sweep);
    return steps * sweep + 0.2 / question.step() * fluid_step;
}

CostEstimate cost_of_vibration(const Inputs& inputs, const Files&) {
    const Question question(inputs);
    const auto particles = static_cast<double>(question.particles), cells = static_cast<double>(question.cells);
    return {.seconds = seconds_of_vibration(question),
            .particle_steps = particles * static_cast<double>(question.total_steps()),
            .bytes = bytes_per_cell * cells * cells * cells + bytes_per_particle * particles};
}

std::optional<ProvenAnswer> proven_answer(const Inputs& inputs) {
    const Question question(inputs);
    if (question.rayleigh != 0 || question.particles != 0) return std::nullopt;
    ProvenAnswer answer;
    answer.reason = "without buoyancy and particles nothing drives the fluid: it rests and conducts";
    answer.observations.scalars = {{"kinetic_energy", 0}, {"nusselt", 1}, {"peak_velocity", 0}};
    if (!question.steady_force()) answer.observations.scalars["gershuni"] = 0;
    return answer;
}

Inputs accuracy(std::int64_t cells, double clustering, std::int64_t steps) {
    return {{"cells", cells}, {"clustering", clustering}, {"steps_per_period", steps}};
}

}  // namespace

SceneInfo thermovibration_scene() {
    SceneInfo info;
    info.name = "thermovibration";
    info.summary = "particles in a heated, vibrated cube of fluid: do they gather, into what, how fast";
    info.revision = 7;
    info.parameters = parameters();
    info.observables = thermovibration_observables();
    info.main = {{"accumulation_excess", "gathering; 0: none, 1: all"},
                 {"structures", "groups of particles"},
                 {"formation_time", "time until they gathered"},
                 {"nusselt", "heat; 1: conduction alone"},
                 {"peak_velocity", "fastest velocity of the fluid"}};
    info.accuracy = {
        {"fast", accuracy(20, 1.5, 16)}, {"balanced", accuracy(28, 1.5, 24)}, {"reference", accuracy(48, 1.5, 64)}};
    info.maker = make;
    info.estimate_cost = cost_of_vibration;
    info.warnings = thermovibration::warnings_of;
    info.proven_answer = proven_answer;
    return info;
}

}  // namespace grainsweep
