// Walls that appear at the beginning of a phase: none may lie deep in a particle.
#include "solver/machine/contact_place.hpp"
#include "solver/machine/run.hpp"
#include "solver/scenes/kit/sentence.hpp"

#include <algorithm>

namespace grainsweep::machine {

/// Ends the run if a wall that this phase brings lies in a particle: the overlap would throw the particle out.
void Run::judge_walls_that_appear() {
    const auto appears = [this](const MachineWall& wall) {
        return phase_ > 0 && wall.present(phase_) && (!wall.present(phase_ - 1) || wall.starts_anew(phase_));
    };
    if (std::ranges::none_of(spec_.walls, appears)) return;
    const Frame frame = look(Contacts::present);
    for (const dem::ContactForce& contact : contacts_) {
        if (contact.second >= 0) continue;
        const MachineWall& wall = spec_.walls[static_cast<std::size_t>(-1 - contact.second)];
        const std::size_t i = place_of(frame, contact.first);
        const double share = contact.overlap / (2 * spheres_.radius[i]);
        if (share <= deepest_at_start || !appears(wall)) continue;
        const Vec3& x = spheres_.position[i];
        fault_ = "wall '" + wall.name + "' appears" +
                 kit::sentence(" %.3g diameters deep (limit %.3g) in a particle", share, deepest_at_start) +
                 kit::sentence(" at (%.4g, %.4g, %.4g) m, after %.6g s", x[0], x[1], x[2], time());
        return;
    }
}

}  // namespace grainsweep::machine
