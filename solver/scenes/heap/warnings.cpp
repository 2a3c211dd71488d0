#include "solver/scenes/heap/warnings.hpp"

#include "solver/scenes/heap/study.hpp"
#include "solver/scenes/kit/falling.hpp"
#include "solver/scenes/kit/rare_sizes.hpp"
#include "solver/scenes/kit/sentence.hpp"

#include <cmath>
#include <string>

namespace grainsweep::heap {
namespace {

using kit::sentence;

constexpr double fewest_particles = 500;
constexpr double fast = 1;  // sqrt(g tube_diameter): beyond, the column falls freely

}  // namespace

std::vector<Warning> warnings_of(const Inputs& inputs, const Files& files) {
    const Study s = study_of(inputs, files);
    std::vector<Warning> warnings;
    if (static_cast<double>(s.particles) < fewest_particles)
        warnings.push_back(
            {"few particles", sentence("%.0f particles make a heap of a few layers: its angle says little",
                                       static_cast<double>(s.particles))});
    const double free = std::sqrt(s.gravity * 2 * s.tube_radius);
    if (s.lift_speed > fast * free)
        warnings.push_back({"tube lifted faster than the powder falls",
                            sentence("lift_speed of %.3g m/s is more than sqrt(g tube_diameter), %.3g m/s: the column "
                                     "collapses by itself, and the heap is flatter",
                                     s.lift_speed, free)});
    const double settling = static_cast<double>(s.settle_steps) * s.time_step;
    kit::warn_of_short_settling(warnings, settling, s.fill_height, s.gravity);
    const double lifted = s.lift_speed * static_cast<double>(s.last_step - s.settle_steps) * s.time_step;
    if (lifted < 2 * s.tube_radius)
        warnings.push_back(
            {"tube still in the heap",
             sentence("the tube is lifted by %.3g m until end_time, less than its diameter, %.3g m: powder "
                      "may still be in it",
                      lifted, 2 * s.tube_radius)});
    kit::warn_of_softness(warnings, s.material, s.diameter, s.fill_height, s.gravity);
    kit::warn_of_rare_sizes(warnings, s.sizes, s.diameter, static_cast<double>(s.particles));
    return warnings;
}

}  // namespace grainsweep::heap
