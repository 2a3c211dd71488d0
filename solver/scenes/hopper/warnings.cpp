#include "solver/scenes/hopper/warnings.hpp"

#include "solver/scenes/hopper/study.hpp"
#include "solver/scenes/kit/filling.hpp"
#include "solver/scenes/kit/pace.hpp"

#include <cmath>
#include <cstdio>
#include <string>

namespace grainsweep::hopper {
namespace {

constexpr double smallest_opening = 1;  // of the smallest diameter: nothing passes
constexpr double widest_opening = 0.6;  // of the container, beyond which its walls limit the flow
constexpr double fewest_particles = 500;
constexpr double largest_overlap = 0.1;  // of a diameter
constexpr double settled_fraction = 0.57;
constexpr double lowest = 1;  // openings of powder above the opening

std::string text(const char* format, double a, double b = 0, double c = 0) {
    char buffer[300];
    std::snprintf(buffer, sizeof buffer, format, a, b, c);
    return buffer;
}

}  // namespace

std::vector<Warning> warnings_of(const Inputs& inputs) {
    const Study s = study_of(inputs);
    std::vector<Warning> warnings;
    const double smallest = s.sizes.smallest() * s.diameter;
    if (s.opening < smallest_opening * smallest)
        warnings.push_back({"opening below one diameter",
                            text("an opening of %.3g m is %.2g of the smallest diameter: nothing passes it", s.opening,
                                 s.opening / smallest)});
    if (s.opening > widest_opening * 2 * s.half_width)
        warnings.push_back({"opening nearly as wide as the container",
                            text("the opening is %.2g of the container's width: above about %.1f its walls, not the "
                                 "opening, decide the rate",
                                 s.opening / (2 * s.half_width), widest_opening)});
    if (static_cast<double>(s.particles) < fewest_particles)
        warnings.push_back(
            {"few particles", text("%.0f particles are too few for a steady rate", static_cast<double>(s.particles))});
    const double solid = static_cast<double>(s.particles) * kit::sphere_volume(s.diameter) * s.sizes.moment(3);
    const double height = solid / (settled_fraction * s.section());
    if (height < lowest * s.opening)
        warnings.push_back({"low filling", text("the settled powder stands about %.3g m high, less than the opening of "
                                                "%.3g m is wide: the rate falls all the time",
                                                height, s.opening)});
    const double settling = static_cast<double>(s.settle_steps) * s.time_step;
    const double fall = std::sqrt(2 * s.fill_height() / s.gravity);
    if (settling < fall)
        warnings.push_back({"powder still falling",
                            text("settle_time of %.3g s ends before a particle has fallen the height of the loose "
                                 "filling, in %.3g s",
                                 settling, fall)});
    const double speed = std::sqrt(2 * s.gravity * s.fill_height());
    const double overlap = kit::impact_overlap(s.material, s.diameter, speed);
    if (overlap > largest_overlap)
        warnings.push_back({"particles too soft for the fall",
                            text("falling at %.3g m/s particles of this stiffness overlap by about %.2g of a diameter, "
                                 "and contact laws hold for small overlaps: raise youngs_modulus",
                                 speed, overlap)});
    return warnings;
}

}  // namespace grainsweep::hopper
