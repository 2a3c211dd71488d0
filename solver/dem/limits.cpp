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

std::string flaw_of_frozen(std::size_t wall) {
    return "wall " + std::to_string(wall) +
           ", which forces move, has reached a glued particle, and they do not touch each other: leave the particle "
           "free, or hold the wall before it";
}

}  // namespace grainsweep::dem
