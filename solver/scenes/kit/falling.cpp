#include "solver/scenes/kit/falling.hpp"

#include "solver/scenes/kit/pace.hpp"
#include "solver/scenes/kit/sentence.hpp"

#include <cmath>

namespace grainsweep::kit {
namespace {

constexpr double largest_overlap = 0.1;  // of a diameter

}  // namespace

void warn_of_short_settling(std::vector<Warning>& warnings, double settle_time, double height, double gravity) {
    const double fall = std::sqrt(2 * height / gravity);
    if (settle_time < fall)
        warnings.push_back({"powder still falling",
                            sentence("settle_time of %.3g s ends before a particle has fallen the height of the loose "
                                     "filling, in %.3g s",
                                     settle_time, fall)});
}

void warn_of_softness(std::vector<Warning>& warnings, const dem::Material& material, double diameter, double height,
                      double gravity) {
    const double speed = std::sqrt(2 * gravity * height);
    const double overlap = impact_overlap(material, diameter, speed);
    if (overlap > largest_overlap)
        warnings.push_back({"particles too soft for the fall",
                            sentence("falling at %.3g m/s particles of this stiffness overlap by about %.2g of a "
                                     "diameter, and contact laws hold for small overlaps: raise youngs_modulus",
                                     speed, overlap)});
}

}  // namespace grainsweep::kit
