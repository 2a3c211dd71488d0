#include "solver/dem/kinds.hpp"

#include <algorithm>
#include <stdexcept>

namespace grainsweep::dem {
namespace {

/// Whether there are frozen spheres in contacts with which something differs from the material.
bool frozen_spheres_differ(const Setup& setup) {
    return at_surface(setup.material, setup.frozen) != setup.material &&
           std::ranges::any_of(setup.spheres, [](const Sphere& s) { return !s.mobile; });
}

}  // namespace

ContactTable::ContactTable(const Setup& setup) : pairs_{setup.material} {
    if (!setup.kinds.densities.empty()) {
        kinds_ = setup.kinds.densities.size();
        pairs_ = setup.kinds.pairs;
    } else if (frozen_spheres_differ(setup)) {
        frozen_differ_ = true;
        kinds_ = 2;
        pairs_.resize(3, at_surface(setup.material, setup.frozen));
    }
}

Material ContactTable::at_wall(const Wall& wall, std::size_t kind) const {
    if (wall.materials.empty() && (kinds_ == 1 || frozen_differ_)) return at_surface(pairs_.front(), wall.surface);
    if (wall.materials.size() != kinds_)
        throw std::invalid_argument("a wall needs a material for its contacts with each kind of spheres");
    return wall.materials[kind];
}

Radii radii_of(const Setup& setup) {
    Radii radii;
    for_each_extreme_sphere(setup, [&](const Sphere& sphere) {
        radii.smallest = radii.largest > 0 ? std::min(radii.smallest, sphere.radius) : sphere.radius;
        radii.largest = std::max(radii.largest, sphere.radius);
    });
    return radii;
}

std::vector<Material> materials_of(const Setup& setup) {
    const ContactTable table(setup);
    std::vector<Material> all = table.pairs();
    for (const Wall& wall : setup.walls)
        for (std::size_t kind = 0; kind < table.kinds(); ++kind) all.push_back(table.at_wall(wall, kind));
    return all;
}

double density_of(const Setup& setup, const Sphere& sphere) {
    return setup.kinds.densities.empty() ? setup.material.density : setup.kinds.densities[sphere.kind];
}

bool equally_dense(const Setup& setup) {
    const auto& all = setup.kinds.densities;
    return std::ranges::all_of(all, [&](double density) { return density == all.front(); });
}

}  // namespace grainsweep::dem
