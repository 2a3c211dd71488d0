#include "solver/scenes/kit/pace.hpp"

#include "solver/dem/fast/mixed_engine.hpp"

#include <cmath>

namespace grainsweep::kit {

/// Of the filling, the engine, its lists and the contacts, in a bed with contacts everywhere.
constexpr double bytes_per_sphere = 1500;

namespace {

double seconds_per_particle_step(const dem::Method& method) {
    if (method.precision == dem::Method::Precision::double_precision) return 110e-9;
    switch (dem::fast::best_path()) {
        case dem::Method::Path::avx512:
            return 24e-9;
        case dem::Method::Path::avx2:
            return 36e-9;
        default:
            return 62e-9;
    }
}

}  // namespace

double slower_by_rolling(const dem::Material& material) {
    return material.rolling_friction > 0 ? dem::resistance_of(material).cost : 1;
}

CostEstimate estimate(const dem::Method& method, const dem::Material& material, double mobile, double steps,
                      double frozen) {
    return {.seconds = mobile * steps * seconds_per_particle_step(method) * slower_by_rolling(material),
            .particle_steps = mobile * steps,
            .bytes = (mobile + frozen) * bytes_per_sphere};
}

double impact_overlap(const dem::Material& material, double diameter, double speed) {
    const double mass = dem::sphere_mass(diameter / 2, material.density) / 2;
    const double energy = 15 * mass * speed * speed / (16 * dem::effective_modulus(material) * std::sqrt(diameter / 4));
    return std::pow(energy, 0.4) / diameter;
}

}  // namespace grainsweep::kit
