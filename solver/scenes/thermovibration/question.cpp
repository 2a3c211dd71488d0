#include "solver/scenes/thermovibration/question.hpp"

#include "solver/coupling/projected_contacts.hpp"
#include "solver/coupling/spring_contacts.hpp"
#include "solver/plain_text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace grainsweep::thermovibration {
namespace {

double number(const Inputs& inputs, const char* name) {
    return std::get<double>(inputs.at(name));
}
std::int64_t count(const Inputs& inputs, const char* name) {
    return std::get<std::int64_t>(inputs.at(name));
}
std::string word(const Inputs& inputs, const char* name) {
    return std::get<std::string>(inputs.at(name));
}

constexpr std::int64_t most_substeps = 20000;

}  // namespace

Question::Question(const Inputs& inputs)
    : rayleigh(number(inputs, "rayleigh")),
      frequency(number(inputs, "frequency")),
      start_phase(number(inputs, "start_phase")),
      acceleration(number(inputs, "acceleration")),
      prandtl(number(inputs, "prandtl")),
      density_ratio(number(inputs, "density_ratio")),
      stokes(number(inputs, "stokes")),
      particles(count(inputs, "particles")),
      level(particles > 0 ? &level_named(word(inputs, "coupling")) : &levels().front()),
      own_wake(word(inputs, "own_wake")),
      wall_contact(word(inputs, "wall_contact")),
      particle_start(word(inputs, "particle_start")),
      contact(word(inputs, "contact")),
      symmetry(word(inputs, "symmetry")),
      restitution(number(inputs, "restitution")),
      collision_restitution(number(inputs, "collision_restitution")),
      friction(number(inputs, "friction")),
      overlap(number(inputs, "overlap")),
      packing_limit(number(inputs, "packing_limit")),
      granular_temperature(number(inputs, "granular_temperature")),
      cells(count(inputs, "cells")),
      clustering(number(inputs, "clustering")),
      steps_per_period(count(inputs, "steps_per_period")),
      kernel_width(number(inputs, "kernel_width")),
      time_step(number(inputs, "time_step")),
      end_time(number(inputs, "end_time")),
      sampling_cells(count(inputs, "sampling_cells")) {
    if (particles > 0 && sphere().radius() > 0.1)
        throw std::invalid_argument("stokes = " + shortest_text(stokes) + " makes particles of radius " +
                                    shortest_text(sphere().radius()) +
                                    " L; point particles need a radius of at most 0.1 L (stokes <= 0.0022)");
    if (mirrored() && cells % 2 != 0)
        throw std::invalid_argument("cells = " + std::to_string(cells) +
                                    " has no plane in the middle; symmetry = mirror needs an even number");
    const double filled = static_cast<double>(particles) * sphere().volume();
    if (level->dense && filled > 0.6)
        throw std::invalid_argument("particles = " + std::to_string(particles) + " fill " + shortest_text(filled) +
                                    " of the cube; at most 0.6 can be filled (fewer, or a smaller stokes)");
    if (level->resolves_contacts && contact == "spring") {
        const coupling::SpringContacts contacts(sphere(), walls(), spring(), 0);
        if (contacts.substeps(step()) > most_substeps)
            throw std::invalid_argument(
                "a contact would need " + std::to_string(contacts.substeps(step())) +
                " sub-steps in each step, above " + std::to_string(most_substeps) +
                "; let overlap or collision_restitution be larger, or resolve contacts by projection (contact)");
    }
    if (end_time < 0.5 * step() * static_cast<double>(window()))
        throw std::invalid_argument("end_time = " + shortest_text(end_time) + " is less than half of " +
                                    (steady_force() ? "a time step" : "a period of vibration (2 pi/frequency)"));
}

double Question::period() const {
    return 2 * std::numbers::pi / frequency;
}

double Question::step() const {
    return steady_force() ? time_step : period() / static_cast<double>(steps_per_period);
}

std::int64_t Question::window() const {
    return steady_force() ? 1 : steps_per_period;
}

std::int64_t Question::total_steps() const {
    const double windows = std::round(end_time / (step() * static_cast<double>(window())));
    return std::max<std::int64_t>(1, static_cast<std::int64_t>(windows)) * window();
}

std::int64_t Question::sample_steps() const {
    return std::max<std::int64_t>(1, total_steps() / window() / 200) * window();
}

flow::Grid Question::grid() const {
    const auto axis = flow::Axis::clustered(static_cast<int>(cells), -0.5, 0.5, clustering);
    return {{axis, axis, axis}};
}

flow::Grid Question::flow_grid() const {
    auto whole = grid();
    if (mirrored()) whole.axes[0] = whole.axes[0].lower_half();
    return whole;
}

flow::Sides Question::sides() {
    const std::array<flow::Side, 2> walls{flow::NoSlip{}, flow::NoSlip{}};
    return {walls, walls, walls};
}

flow::Flow<flow::Boussinesq> Question::fluid() const {
    flow::Boussinesq heat;
    heat.diffusivity = 1;
    heat.sides[2] = {flow::Isothermal{-0.5}, flow::Isothermal{0.5}};
    heat.buoyancy = -prandtl * rayleigh;
    heat.direction = 1;
    heat.vibration = vibration();
    auto around = sides();
    if (mirrored()) around[0][1] = flow::FreeSlip{};
    flow::Flow<flow::Boussinesq> fluid({flow_grid(), around, prandtl, step()}, heat);
    fluid.set_temperature([](double, double, double z) { return z; });
    return fluid;
}

coupling::Walls Question::walls() const {
    const double distance = wall_contact == "radius" ? sphere().radius() : 0;
    return {{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}, {}, distance, restitution};
}

coupling::HystereticSpring Question::spring() const {
    return {coupling::SpringContacts::stiffness(sphere(), overlap, step()), collision_restitution, friction};
}

coupling::Cloud Question::cloud(std::uint64_t seed) const {
    constexpr std::uint64_t positions = 1;  // the stream of this purpose
    auto cloud = coupling::random_cloud(static_cast<std::size_t>(particles), walls(), stats::Stream(seed, positions));
    if (!level->resolves_contacts) return cloud;
    constexpr double tolerated = 1e-3;  // diameters
    coupling::OverlapRemoval removal(walls(), 2 * sphere().radius());
    double left = 1;
    for (int round = 0; round < 100 && left > tolerated; ++round) left = removal.apply(cloud.position, 10);
    if (left > tolerated)
        throw std::invalid_argument("particles = " + std::to_string(particles) +
                                    " cannot be placed at random without overlap (fewer, or a smaller stokes)");
    return cloud;
}

std::string Question::flow_key() const {
    return "thermovibration periodic flow 3; cells=" + std::to_string(cells) +
           "; clustering=" + shortest_text(clustering) + "; frequency=" + shortest_text(frequency) +
           "; prandtl=" + shortest_text(prandtl) + "; rayleigh=" + shortest_text(rayleigh) +
           "; start_phase=" + shortest_text(start_phase) + "; steps_per_period=" + std::to_string(steps_per_period) +
           "; symmetry=" + (mirrored() ? "mirror" : "none");
}

}  // namespace grainsweep::thermovibration
