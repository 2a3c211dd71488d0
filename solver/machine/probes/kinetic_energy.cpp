// Kinetic energy of translation, sum of m v^2/2, and of rotation, sum of w . I w/2.
#include "solver/machine/probe.hpp"
#include "solver/machine/selection.hpp"

namespace grainsweep::machine::probes {
namespace {

double energy_of_translation(const Frame& frame, const Selection& selection) {
    double energy = 0;
    selection.each(frame, [&](std::size_t i) {
        energy += frame.mass(i) / 2 * geometry::dot(frame.state.velocity[i], frame.state.velocity[i]);
    });
    return energy;
}

double energy_of_rotation(const Frame& frame, const Selection& selection) {
    double energy = 0;
    const auto of_sphere = [&](std::size_t i) {
        const double r = frame.state.radius[i];
        return 0.2 * frame.mass(i) * r * r *
               geometry::dot(frame.state.angular_velocity[i], frame.state.angular_velocity[i]);
    };
    selection.each(frame, [&](std::size_t i) { energy += of_sphere(i); });
    frame.each_clump([&](std::size_t i, const dem::BodyState& clump) {
        if (!selection.holds(frame, i)) return;
        energy += geometry::dot(clump.angular_momentum, clump.angular_velocity) / 2 - of_sphere(i);
    });
    return energy;
}

constexpr std::array kinetic_energy_options = {of_option, in_option};

}  // namespace

ProbeInfo kinetic_energy() {
    return probe_row<SelectionProbe<energy_of_translation>>("kinetic_energy", "J", "kinetic energy of translation",
                                                            kinetic_energy_options);
}
ProbeInfo rotational_energy() {
    return probe_row<SelectionProbe<energy_of_rotation>>("rotational_energy", "J", "kinetic energy of rotation",
                                                         kinetic_energy_options);
}

}  // namespace grainsweep::machine::probes
