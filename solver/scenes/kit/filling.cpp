#include "solver/scenes/kit/filling.hpp"

#include "stats/random.hpp"

#include <numbers>
#include <stdexcept>
#include <string>

namespace grainsweep::kit {
namespace {

enum : std::uint64_t { size_stream = 1, place_stream = 2 };

}  // namespace

double sphere_volume(double diameter) {
    return std::numbers::pi / 6 * diameter * diameter * diameter;
}

std::vector<dem::Sphere> loose_filling(const particles::SizeDistribution& sizes, double diameter, std::int64_t count,
                                       const particles::Room& room, std::uint64_t seed, std::string_view full) {
    const stats::Stream draws(seed, size_stream);
    std::vector<double> radii;
    for (std::int64_t k = 0; k < count; ++k)
        radii.push_back(diameter / 2 *
                        (sizes.equal() ? 1 : sizes.diameter(draws.uniform(static_cast<std::uint64_t>(k)))));
    const auto centres = particles::random_addition(room, radii, stats::bits_at(seed, place_stream, 0));
    if (!centres) throw std::invalid_argument(std::string(full));
    std::vector<dem::Sphere> spheres(radii.size());
    for (std::size_t k = 0; k < radii.size(); ++k) {
        spheres[k].radius = radii[k];
        spheres[k].position = (*centres)[k];
    }
    return spheres;
}

}  // namespace grainsweep::kit
