#include "solver/geometry/contact_memory.hpp"

#include <algorithm>
#include <cmath>

namespace grainsweep::geometry {

void match_contacts(std::span<const Vec3> before, std::span<const Vec3> now, std::span<std::uint32_t> from) {
    std::ranges::fill(from, no_contact);
    const double chord = 2 * std::sin(largest_turn / 2);
    for (std::size_t matched = 0; matched < std::min(before.size(), now.size()); ++matched) {
        double least2 = chord * chord;
        std::size_t heir = now.size();
        std::uint32_t origin = no_contact;
        for (std::size_t k = 0; k < now.size(); ++k) {
            if (from[k] != no_contact) continue;
            for (std::uint32_t n = 0; n < before.size(); ++n) {
                const Vec3 turn = now[k] - before[n];
                const double turn2 = dot(turn, turn);
                if (!(turn2 < least2) || std::ranges::find(from, n) != from.end()) continue;
                least2 = turn2;
                heir = k;
                origin = n;
            }
        }
        if (origin == no_contact) return;
        from[heir] = origin;
    }
}

Vec3 turned(const Vec3& vector, const Vec3& from, const Vec3& to) {
    const Vec3 axis = cross(from, to);  // its length is the sine of the angle
    const Vec3 once = cross(axis, vector);
    return vector + once + (1 / (1 + dot(from, to))) * cross(axis, once);
}

}  // namespace grainsweep::geometry
