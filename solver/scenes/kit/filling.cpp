#include "solver/scenes/kit/filling.hpp"

#include "stats/random.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

namespace grainsweep::kit {
namespace {

enum : std::uint64_t { size_stream = 1, place_stream = 2, velocity_stream = 4 };

constexpr double spacing = 1.15, most_jitter = 0.05;  // D
constexpr double lowest = 0.1;                        // D, from the floor to the lattice

std::vector<double> radii_of(const particles::SizeDistribution& sizes, double diameter, std::int64_t count,
                             std::uint64_t seed) {
    const stats::Stream draws(seed, size_stream);
    std::vector<double> radii;
    for (std::int64_t k = 0; k < count; ++k)
        radii.push_back(diameter / 2 *
                        (sizes.equal() ? 1 : sizes.diameter(draws.uniform(static_cast<std::uint64_t>(k)))));
    return radii;
}

/// Of a square lattice of n by n in the square about a circle, those that lie within another one.
std::vector<std::array<double, 2>> sites_within(double radius, double inner, int n) {
    std::vector<std::array<double, 2>> sites;
    const auto place = [&](int k) { return radius * ((2 * k + 1) / static_cast<double>(n) - 1); };
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
            if (std::hypot(place(i), place(j)) <= inner) sites.push_back({place(i), place(j)});
    return sites;
}

}  // namespace

std::vector<dem::Sphere> loose_filling(const particles::SizeDistribution& sizes, double diameter, std::int64_t count,
                                       const particles::Room& room, std::uint64_t seed, std::string_view full) {
    const auto radii = radii_of(sizes, diameter, count, seed);
    const auto centres = particles::random_addition(room, radii, stats::bits_at(seed, place_stream, 0));
    if (!centres) throw std::invalid_argument(std::string(full));
    std::vector<dem::Sphere> spheres(radii.size());
    for (std::size_t k = 0; k < radii.size(); ++k) {
        spheres[k].radius = radii[k];
        spheres[k].position = (*centres)[k];
    }
    return spheres;
}

TubeLattice::TubeLattice(double radius, double diameter, double largest, std::int64_t count)
    : count_(count),
      diameter_(diameter),
      jitter_(std::min(most_jitter * diameter, (spacing * diameter - largest) / 2)) {
    const double across = std::floor(2 * radius / (spacing * diameter));
    if (jitter_ < 0 || across * across > 2 * static_cast<double>(count) + 4) return;  // of which 0.78 lie in the circle
    const double inner = radius - largest / 2 - std::numbers::sqrt2 * jitter_;
    for (const int n : {static_cast<int>(across), static_cast<int>(across) - 1}) {
        auto sites = sites_within(radius, inner, n);
        if (sites.size() > sites_.size()) sites_ = std::move(sites);
    }
    if (static_cast<std::int64_t>(sites_.size()) > count) sites_.clear();
}

double TubeLattice::height() const {
    if (sites_.empty()) return std::numeric_limits<double>::infinity();
    const auto layers = std::ceil(static_cast<double>(count_) / static_cast<double>(sites_.size()));
    return (lowest + spacing * layers) * diameter_;
}

std::vector<dem::Sphere> TubeLattice::filled(const particles::SizeDistribution& sizes, double floor, double speed,
                                             std::uint64_t seed) const {
    const auto radii = radii_of(sizes, diameter_, count_, seed);
    const stats::Stream place(seed, place_stream), velocity(seed, velocity_stream);
    std::vector<dem::Sphere> spheres(radii.size());
    for (std::size_t k = 0; k < spheres.size(); ++k) {
        const auto& [x, y] = sites_[k % sites_.size()];
        const auto layer = static_cast<double>(k / sites_.size());
        spheres[k].radius = radii[k];
        spheres[k].position = {x, y, floor + (lowest + spacing * (layer + 0.5)) * diameter_};
        for (std::size_t a = 0; a < 3; ++a) {
            spheres[k].position[a] += jitter_ * (2 * place.uniform(3 * k + a) - 1);
            spheres[k].velocity[a] = speed * (2 * velocity.uniform(3 * k + a) - 1);
        }
    }
    return spheres;
}

}  // namespace grainsweep::kit
