#include "solver/observables/particle_loads.hpp"

#include <algorithm>
#include <cmath>

namespace grainsweep::observables {

ParticleLoads particle_loads(const dem::State& state, std::span<const dem::ContactForce> contacts) {
    const std::size_t n = state.id.size();
    ParticleLoads loads{std::vector<dem::Vec3>(n), std::vector<double>(n), std::vector<double>(n),
                        std::vector<double>(n)};
    std::vector<std::size_t> place(n == 0 ? 0 : static_cast<std::size_t>(state.id.back()) + 1);  // ids ascend
    for (std::size_t i = 0; i < n; ++i) place[static_cast<std::size_t>(state.id[i])] = i;
    for (const dem::ContactForce& contact : contacts) {
        dem::Vec3 force{};
        double square = 0;
        for (std::size_t a = 0; a < 3; ++a) {
            force[a] = contact.normal_force * contact.normal[a] + contact.tangential_force[a];
            square += force[a] * force[a];
        }
        const auto bear = [&](std::int32_t id, double sign) {
            const std::size_t i = place[static_cast<std::size_t>(id)];
            for (std::size_t a = 0; a < 3; ++a) loads.force[i][a] += sign * force[a];
            loads.largest[i] = std::max(loads.largest[i], std::sqrt(square));
            loads.overlap[i] = std::max(loads.overlap[i], contact.overlap);
            loads.coordination[i] += 1;
        };
        bear(contact.first, 1);
        if (contact.second >= 0) bear(contact.second, -1);
    }
    return loads;
}

}  // namespace grainsweep::observables
