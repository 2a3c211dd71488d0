#include "solver/scenes/thermovibration/warnings.hpp"

#include "solver/scenes/kit/sentence.hpp"
#include "solver/scenes/thermovibration/question.hpp"

#include <cmath>
#include <string>

namespace grainsweep::thermovibration {
namespace {

using kit::sentence;

constexpr double boussinesq = 0.1;       // largest relative change of density the approximation is made for
constexpr double densest = 0.6;          // share of the cube that spheres can fill
constexpr double dilute_mass = 0.1;      // mass of particles relative to the fluid up to which one-way coupling holds
constexpr double fewest_periods = 10;    // to speak of a mean over periods
constexpr double fewest_per_cell = 0.1;  // particles per sampling cell

void warn_of_flow(std::vector<Warning>& warnings, const Question& q) {
    // Ra = gamma beta DT/Pr
    if (q.particles > 0 && q.rayleigh > 0 && q.rayleigh * q.prandtl > boussinesq * q.acceleration)
        warnings.push_back({"density changes beyond Boussinesq",
                            sentence("rayleigh prandtl/acceleration = beta DT = %.2g: fluid and particles are shaken "
                                     "alike only below about %.1f; raise acceleration or lower rayleigh",
                                     q.rayleigh * q.prandtl / q.acceleration, boussinesq)});
    if (q.steady_force()) return;
    if (const double periods = q.end_time / q.period(); periods < fewest_periods)
        warnings.push_back(
            {"few periods", sentence("end_time of %.3g is %.2g periods of vibration: means over a period say "
                                     "little before about %.0f",
                                     q.end_time, periods, fewest_periods)});
    const double layer = std::sqrt(2 * q.prandtl / q.frequency), cell = q.grid().axes[1].width(1);
    if (q.rayleigh > 0 && layer < cell)
        warnings.push_back(
            {"vibration finer than the grid",
             sentence("the viscous layer sqrt(2 prandtl/frequency) of %.2g L is thinner than the cell at the "
                      "wall, %.2g L: more cells or clustering",
                      layer, cell)});
}

void warn_of_particles(std::vector<Warning>& warnings, const Question& q) {
    if (q.particles == 0) return;
    const auto particles = static_cast<double>(q.particles);
    const double filled = particles * q.sphere().volume(), diameter = 2 * q.sphere().radius();
    if (filled > densest)
        warnings.push_back(
            {"more particles than fit",
             sentence("%.0f particles of diameter %.2g L fill %.2g of the cube", particles, diameter, filled)});
    else if (!q.level->acts_on_fluid && filled * q.density_ratio > dilute_mass)
        warnings.push_back(
            {"too heavy for one way",
             sentence("the particles weigh %.2g of the fluid (they fill %.2g of the cube): it cannot be moved "
                      "without feeling them; take two_way or above",
                      filled * q.density_ratio, filled)});
    if (!q.level->dense && diameter * static_cast<double>(q.cells) > 1)
        warnings.push_back(
            {"particles larger than cells",
             sentence("a diameter of %.2g L is more than a cell of the flow, %.2g L: a point does not stand for "
                      "such a particle; fewer cells or a smaller stokes",
                      diameter, 1 / static_cast<double>(q.cells))});
    const double sampled = std::pow(static_cast<double>(q.sampling_cells), 3);
    if (particles < fewest_per_cell * sampled)
        warnings.push_back(
            {"sampled too finely", sentence("%.0f particles on %.0f sampling cells: most cells are empty however "
                                            "they are arranged; take fewer sampling_cells",
                                            particles, sampled)});
}

}  // namespace

std::vector<Warning> warnings_of(const Inputs& inputs, const Files&) {
    const Question question(inputs);
    std::vector<Warning> warnings;
    warn_of_flow(warnings, question);
    warn_of_particles(warnings, question);
    return warnings;
}

}  // namespace grainsweep::thermovibration
