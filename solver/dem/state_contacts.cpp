#include "solver/dem/state_contacts.hpp"

#include "solver/dem/laws/contact.hpp"
#include "solver/dem/material.hpp"
#include "solver/particles/near_pairs.hpp"

#include <cmath>

namespace grainsweep::dem {

std::vector<StateContact> contacts_of(const State& state, const Material& material) {
    using namespace geometry;
    std::vector<StateContact> contacts;
    if (state.position.empty()) return contacts;
    const double radius = state.radius.front();
    const double mass = sphere_mass(radius, material.density);
    const Contact<Hertz, Cohesion<ChosenArea>> laws{
        {hertz(material), Cohesion<ChosenArea>{material.cohesion, {material.cohesion_area}}}};
    particles::for_each_near_pair(state.position, 2 * radius, [&](std::size_t i, std::size_t j, double distance) {
        if (state.mobile[i] == 0 && state.mobile[j] == 0) return;
        Touch<Partner::particle> t;
        t.overlap = 2 * radius - distance;
        t.distance = distance;
        t.radius_i = t.radius_j = radius;
        t.effective_radius = radius / 2;
        t.reduced_mass = state.mobile[i] != 0 && state.mobile[j] != 0 ? mass / 2 : mass;
        t.root = std::sqrt(t.effective_radius * t.overlap);
        t.damping_root = std::sqrt(t.root * t.reduced_mass);
        t.normal = (1 / distance) * (state.position[i] - state.position[j]);
        t.normal_velocity = dot(state.velocity[i] - state.velocity[j], t.normal);
        NoMemory none;
        contacts.push_back({t.overlap, laws.respond<false>(t, none).normal});
    });
    return contacts;
}

}  // namespace grainsweep::dem
