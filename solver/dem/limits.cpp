#include "solver/dem/limits.hpp"

#include <cstdio>

namespace grainsweep::dem {

std::string flaw_of_contact(double share, double swing, double deepest) {
    char text[200];
    if (!(share <= deepest)) {
        std::snprintf(text, sizeof text, "overlap of %.3g diameters (limit %.3g) with ", share, deepest);
        return text;
    }
    if (share <= 0 || swing <= largest_sound_swing) return {};
    std::snprintf(text, sizeof text,
                  "the time step is too large: a contact swings by %.3g rad per step (limit %.3g) with ", swing,
                  largest_sound_swing);
    return text;
}

std::string flaw_of_speed(double speed, double limit) {
    char text[200];
    std::snprintf(text, sizeof text, "a particle moves at %.4g m/s, above the most this case can produce (%.4g m/s)",
                  speed, limit);
    return text;
}

std::string flaw_of_wall_speed(std::size_t wall, double speed, double step, double smallest_radius,
                               std::int64_t steps) {
    const double share = speed * step / smallest_radius;
    if (share <= largest_sound_displacement) return {};
    char text[200];
    std::snprintf(text, sizeof text,
                  "wall %zu moves at %.4g m/s, %.3g of the smallest radius in one time step (limit %.3g), after "
                  "%lld steps",
                  wall, speed, share, largest_sound_displacement, static_cast<long long>(steps));
    return text;
}

std::string place_and_time(std::int32_t id, const std::array<double, 3>& place, std::int64_t steps, double time) {
    char text[200];
    std::snprintf(text, sizeof text, ": particle %d at (%.6g, %.6g, %.6g) m, after %lld steps, %.6g s", id, place[0],
                  place[1], place[2], static_cast<long long>(steps), time);
    return text;
}

std::string flaw_of_frozen(std::size_t wall) {
    return "wall " + std::to_string(wall) +
           ", which forces move, has reached a glued particle, and they do not touch each other: leave the particle "
           "free, or hold the wall before it";
}

}  // namespace grainsweep::dem
