// Material of a contact, by the kinds of the spheres and by the wall.
#pragma once

#include "solver/dem/engine.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace grainsweep::dem {

/// Materials of all contacts. Kinds are those of the Setup. If it has no kinds, and contacts with frozen spheres
/// differ, frozen spheres are a second kind.
class ContactTable {
public:
    explicit ContactTable(const Setup& setup);

    [[nodiscard]] std::size_t kinds() const { return kinds_; }
    [[nodiscard]] std::uint8_t kind_of(const Sphere& sphere) const {
        return frozen_differ_ ? (sphere.mobile ? 0 : 1) : sphere.kind;
    }
    /// Returns the materials of the contacts of each pair, at place_of_pair().
    [[nodiscard]] const std::vector<Material>& pairs() const { return pairs_; }
    /// Returns the material of a sphere's contact with a wall. Throws std::invalid_argument if the wall lacks the
    /// material.
    [[nodiscard]] Material at_wall(const Wall& wall, std::size_t kind) const;

private:
    std::size_t kinds_ = 1;
    bool frozen_differ_ = false;
    std::vector<Material> pairs_;
};

/// Calls visit(sphere) for each sphere of the start, and for the smallest and the largest that may be added.
template <class Visit>
void for_each_extreme_sphere(const Setup& setup, Visit&& visit) {
    for (const Sphere& sphere : setup.spheres) visit(sphere);
    for (const ToCome& range : setup.to_come)
        for (const double radius : {range.smallest, range.largest}) {
            const Sphere sphere{.radius = radius, .kind = range.kind};
            visit(sphere);
        }
}
/// Smallest and largest radius of these spheres, m; 0 if there are none.
struct Radii {
    double smallest = 0, largest = 0;
    [[nodiscard]] bool differ() const { return smallest != largest; }
};
[[nodiscard]] Radii radii_of(const Setup& setup);

/// Returns the materials of all contacts that a setup may have: between particles, then wall by wall.
[[nodiscard]] std::vector<Material> materials_of(const Setup& setup);
/// Returns the density of a sphere, kg/m3.
[[nodiscard]] double density_of(const Setup& setup, const Sphere& sphere);
/// Returns whether all spheres have the same density.
[[nodiscard]] bool equally_dense(const Setup& setup);

}  // namespace grainsweep::dem
