#include "solver/scenes/drum/warnings.hpp"

#include "solver/scenes/drum/study.hpp"
#include "solver/scenes/kit/pace.hpp"
#include "solver/scenes/kit/rare_sizes.hpp"
#include "solver/scenes/kit/sentence.hpp"

#include <cmath>
#include <numbers>
#include <string>

namespace grainsweep::drum {
namespace {

using kit::sentence;

constexpr double narrowest = 5;           // largest diameters between a particle and its periodic image
constexpr double fewest_particles = 200;  // of which a bed's statistics can be formed
constexpr double fewest_across = 10;      // diameters across the drum
constexpr double largest_overlap = 0.1;   // of a diameter
constexpr double centrifuging = 1;        // Froude number
constexpr double least_turned = 0.25;     // turns before measuring: the bed has been carried up and has slid back
constexpr double fewest_frames = 20;

void warn_of_drum(std::vector<Warning>& warnings, const Study& s) {
    const double largest = s.sizes.largest() * s.diameter;
    if (2 * s.radius < fewest_across * s.diameter)
        warnings.push_back(
            {"small drum",
             sentence("the drum is %.3g diameters wide: below about %.0f walls are everywhere and there is "
                      "no bed with a surface",
                      2 * s.radius / s.diameter, fewest_across)});
    if (!s.has_plates && s.length < narrowest * largest)
        warnings.push_back(
            {"short drum", sentence("the drum repeats itself after %.3g of the largest diameters (length): "
                                    "particles feel their own images below about %.0f",
                                    s.length / largest, narrowest)});
    if (static_cast<double>(s.particles) < fewest_particles)
        warnings.push_back(
            {"few particles", sentence("%.0f particles are too few for an angle: make fill or length larger "
                                       "or the diameter smaller",
                                       static_cast<double>(s.particles))});
}

void warn_of_turning(std::vector<Warning>& warnings, const Study& s) {
    const double froude = s.speed * s.speed * s.radius / s.gravity;
    if (froude >= centrifuging)
        warnings.push_back({"centrifuging drum",
                            sentence("w^2 R/g is %.3g: from 1 on the powder is carried round at the wall and has no "
                                     "surface to have an angle",
                                     froude)});
    const double before = s.turning_time * s.speed / (2 * std::numbers::pi);
    const double fall = 2 * std::sqrt(2 * 2 * s.radius / s.gravity);
    if (before < least_turned || s.turning_time < fall)
        warnings.push_back(
            {"measured before the bed flows steadily",
             sentence("turning_time is %.3g turns and %.3g s: powder falling through the drum needs %.3g s "
                      "to come to rest, and the bed about a quarter of a turn to flow steadily",
                      before, s.turning_time, fall)});
    if (static_cast<double>(s.frames) < fewest_frames)
        warnings.push_back({"few frames", sentence("%.0f frames: means over fewer than %.0f say little",
                                                   static_cast<double>(s.frames), fewest_frames)});
    const double speed = std::sqrt(2 * s.gravity * 2 * s.radius) + s.wall_speed();
    const double overlap = kit::impact_overlap(s.material, s.diameter, speed);
    if (overlap > largest_overlap)
        warnings.push_back(
            {"particles too soft for the fall",
             sentence(
                 "falling into the drum at %.3g m/s particles of this stiffness overlap by about %.2g of a diameter, "
                 "and contact laws hold for small overlaps: raise youngs_modulus",
                 speed, overlap)});
}

}  // namespace

std::vector<Warning> warnings_of(const Inputs& inputs, const Files& files) {
    const Study s = study_of(inputs, files);
    std::vector<Warning> warnings;
    warn_of_drum(warnings, s);
    warn_of_turning(warnings, s);
    kit::warn_of_rare_sizes(warnings, s.sizes, s.diameter, static_cast<double>(s.particles));
    return warnings;
}

}  // namespace grainsweep::drum
