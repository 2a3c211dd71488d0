#include "solver/scenes/heap/warnings.hpp"

#include "solver/scenes/heap/study.hpp"
#include "solver/scenes/kit/pace.hpp"

#include <cmath>
#include <cstdio>
#include <string>

namespace grainsweep::heap {
namespace {

constexpr double fewest_particles = 500;
constexpr double largest_overlap = 0.1;  // of a diameter
constexpr double fast = 1;               // sqrt(g tube_diameter): beyond, the column falls freely

std::string text(const char* format, double a, double b = 0, double c = 0) {
    char buffer[300];
    std::snprintf(buffer, sizeof buffer, format, a, b, c);
    return buffer;
}

}  // namespace

std::vector<Warning> warnings_of(const Inputs& inputs) {
    const Study s = study_of(inputs);
    std::vector<Warning> warnings;
    if (static_cast<double>(s.particles) < fewest_particles)
        warnings.push_back({"few particles", text("%.0f particles make a heap of a few layers: its angle says little",
                                                  static_cast<double>(s.particles))});
    const double free = std::sqrt(s.gravity * 2 * s.tube_radius);
    if (s.lift_speed > fast * free)
        warnings.push_back({"tube lifted faster than the powder falls",
                            text("lift_speed of %.3g m/s is more than sqrt(g tube_diameter), %.3g m/s: the column "
                                 "collapses by itself, and the heap is flatter",
                                 s.lift_speed, free)});
    const double settling = static_cast<double>(s.settle_steps) * s.time_step;
    const double fall = std::sqrt(2 * s.fill_height / s.gravity);
    if (settling < fall)
        warnings.push_back({"powder still falling",
                            text("settle_time of %.3g s ends before a particle has fallen the height of the loose "
                                 "filling, in %.3g s",
                                 settling, fall)});
    const double lifted = s.lift_speed * static_cast<double>(s.last_step - s.settle_steps) * s.time_step;
    if (lifted < 2 * s.tube_radius)
        warnings.push_back({"tube still in the heap",
                            text("the tube is lifted by %.3g m until end_time, less than its diameter, %.3g m: powder "
                                 "may still be in it",
                                 lifted, 2 * s.tube_radius)});
    const double speed = std::sqrt(2 * s.gravity * s.fill_height);
    const double overlap = kit::impact_overlap(s.material, s.diameter, speed);
    if (overlap > largest_overlap)
        warnings.push_back({"particles too soft for the fall",
                            text("falling at %.3g m/s particles of this stiffness overlap by about %.2g of a diameter, "
                                 "and contact laws hold for small overlaps: raise youngs_modulus",
                                 speed, overlap)});
    return warnings;
}

}  // namespace grainsweep::heap
