#include "solver/scenes/hopper/warnings.hpp"

#include "solver/scenes/hopper/study.hpp"
#include "solver/scenes/kit/falling.hpp"
#include "solver/scenes/kit/filling.hpp"
#include "solver/scenes/kit/rare_sizes.hpp"
#include "solver/scenes/kit/sentence.hpp"

#include <cmath>
#include <string>

namespace grainsweep::hopper {
namespace {

using kit::sentence;

constexpr double smallest_opening = 1;  // of the smallest diameter: nothing passes
constexpr double widest_opening = 0.6;  // of the container, beyond which its walls limit the flow
constexpr double fewest_particles = 500;
constexpr double settled_fraction = 0.57;
constexpr double lowest = 1;  // openings of powder above the opening

}  // namespace

std::vector<Warning> warnings_of(const Inputs& inputs, const Files& files) {
    const Study s = study_of(inputs, files);
    std::vector<Warning> warnings;
    const double smallest = s.sizes.smallest() * s.diameter;
    if (s.opening < smallest_opening * smallest)
        warnings.push_back({"opening below one diameter",
                            sentence("an opening of %.3g m is %.2g of the smallest diameter: nothing passes it",
                                     s.opening, s.opening / smallest)});
    if (s.opening > widest_opening * 2 * s.half_width)
        warnings.push_back(
            {"opening nearly as wide as the container",
             sentence("the opening is %.2g of the container's width: above about %.1f its walls, not the "
                      "opening, decide the rate",
                      s.opening / (2 * s.half_width), widest_opening)});
    if (static_cast<double>(s.particles) < fewest_particles)
        warnings.push_back({"few particles", sentence("%.0f particles are too few for a steady rate",
                                                      static_cast<double>(s.particles))});
    const double solid = static_cast<double>(s.particles) * particles::sphere_volume(s.diameter) * s.sizes.moment(3);
    const double height = solid / (settled_fraction * s.section());
    if (height < lowest * s.opening)
        warnings.push_back(
            {"low filling", sentence("the settled powder stands about %.3g m high, less than the opening of "
                                     "%.3g m is wide: the rate falls all the time",
                                     height, s.opening)});
    const double settling = static_cast<double>(s.settle_steps) * s.time_step;
    kit::warn_of_short_settling(warnings, settling, s.fill_height(), s.gravity);
    kit::warn_of_softness(warnings, s.material, s.diameter, s.fill_height(), s.gravity);
    kit::warn_of_rare_sizes(warnings, s.sizes, s.diameter, static_cast<double>(s.particles));
    return warnings;
}

}  // namespace grainsweep::hopper
