// Hysteretic linear spring: a normal contact force that is stiffer in unloading (Walton & Braun 1986,
// doi 10.1122/1.549893).
//
// Loading follows K_l s. Unloading and reloading follow the stiffer K_u = K_l/e^2, limited to between 1e-3 K_l s and
// K_l s:
//   s grows:   F = min(F + K_u ds, K_l s)
//   s shrinks: F = max(F + K_u ds, 1e-3 K_l s)
// A head-on pair separates with e times its speed, for any speed, after a contact of duration
//   (pi/2) (sqrt(m*/K_l) + sqrt(m*/K_u)).
// Tangential: F_t = -K_l xi, xi the displacement in contact turned with the plane, |F_t| <= mu F (Cundall & Strack
// 1979, doi 10.1680/geot.1979.29.1.47); sliding keeps xi at mu F/K_l.
#pragma once

#include "solver/geometry/vector.hpp"

#include <algorithm>
#include <cmath>

namespace grainsweep::coupling {

using geometry::Vec3;

/// Memory of a contact.
struct SpringMemory {
    double overlap = 0;
    double force = 0;
    Vec3 tangential{};  ///< xi
};

struct HystereticSpring {
    double stiffness = 0;    ///< K_l > 0
    double restitution = 1;  ///< e, above 0
    double friction = 0;     ///< mu

    [[nodiscard]] double unloading() const { return stiffness / (restitution * restitution); }

    /// Returns the normal force at overlap s > 0; a new memory means the beginning of contact.
    double push(double s, SpringMemory& memory) const {
        const double change = unloading() * (s - memory.overlap);
        memory.force = change >= 0 ? std::min(memory.force + change, stiffness * s)
                                   : std::max(memory.force + change, 1e-3 * stiffness * s);
        memory.overlap = s;
        return memory.force;
    }

    /// Returns the tangential force on i for the present normal force. slip: tangential displacement of i relative to j
    /// in this step; n: normal from j to i.
    Vec3 drag(const Vec3& n, const Vec3& slip, SpringMemory& memory) const {
        using namespace geometry;
        Vec3& xi = memory.tangential;
        const double length = std::sqrt(dot(xi, xi));
        xi -= dot(xi, n) * n;
        const double turned = std::sqrt(dot(xi, xi));
        if (turned > 0) xi = (length / turned) * xi;
        xi += slip;
        const double most = friction * memory.force / stiffness;
        const double now = std::sqrt(dot(xi, xi));
        if (now > most) xi = (now > 0 ? most / now : 0) * xi;
        return -stiffness * xi;
    }
};

}  // namespace grainsweep::coupling
