// The motion of one small sphere in a vibrated fluid (length L, time L^2/alpha, density of the fluid):
//
//   (xi + 1/2) dV/dt = 3/2 Du/Dt + f(Re_p) (Pr/St) (u - V) + (xi - 1) gamma s(t) e + a,   dX/dt = V
//
// (Maxey & Riley 1983, doi 10.1063/1.864230, without history and Faxen terms; added mass 1/2 on the left-hand side,
// where it belongs: taken explicitly it multiplies errors by 1/(2 xi) per step). xi density ratio, St = 2/9 (R/L)^2,
// gamma amplitude of the vibrational acceleration, `a` any other force per volume of the sphere.
//
// One step with the fluid frozen at its middle is solved exactly, so relaxation times far below the step are
// harmless:
//   tau = (xi + 1/2) St/(f Pr),  Vinf = u + tau [3/2 Du/Dt + (xi - 1) gamma s e + a]/(xi + 1/2),  E = exp(-dt/tau)
//   X += Vinf dt + (V - Vinf) tau (1 - E),   V = Vinf + (V - Vinf) E
// f follows the slip in the middle of the step (one correction). Positions are second order for dt << tau and
// for dt >> tau, where V is then the velocity of the middle of the step.
#pragma once

#include "solver/coupling/interpolation.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace grainsweep::coupling {

struct Sphere {
    double density_ratio = 1;  ///< xi
    double stokes = 1;         ///< St > 0
    double prandtl = 1;        ///< Pr = nu/alpha
    double acceleration = 0;   ///< gamma
    int direction = 1;         ///< axis e of vibration

    [[nodiscard]] double radius() const { return std::sqrt(4.5 * stokes); }  ///< R/L
    [[nodiscard]] double volume() const {
        const double r = radius();
        return 4.0 / 3.0 * 3.14159265358979323846 * r * r * r;
    }
};

/// What the sphere feels in the middle of a step.
struct Surroundings {
    Vec3 velocity{};       ///< u
    Vec3 acceleration{};   ///< Du/Dt
    double vibration = 0;  ///< s(t)
    Vec3 other{};          ///< a
};

template <class Drag>
class Motion {
public:
    Motion(const Sphere& sphere, double time_step)
        : sphere_(sphere),
          dt_(time_step),
          mass_(sphere.density_ratio + 0.5),
          free_tau_(mass_ * sphere.stokes / sphere.prandtl),
          reynolds_(2 * sphere.radius() / sphere.prandtl) {}

    void advance(Vec3& x, Vec3& v, const Surroundings& around) const {
        Vec3 pull;
        for (std::size_t d = 0; d < 3; ++d) pull[d] = (1.5 * around.acceleration[d] + around.other[d]) / mass_;
        pull[static_cast<std::size_t>(sphere_.direction)] +=
            (sphere_.density_ratio - 1) * sphere_.acceleration * around.vibration / mass_;
        double tau = relaxation(around.velocity, v);
        const double half = std::exp(-0.5 * dt_ / tau);
        Vec3 middle;
        for (std::size_t d = 0; d < 3; ++d) {
            const double limit = around.velocity[d] + tau * pull[d];
            middle[d] = limit + (v[d] - limit) * half;
        }
        tau = relaxation(around.velocity, middle);
        const double decayed = -std::expm1(-dt_ / tau);  // 1 - E, accurate for dt << tau
        for (std::size_t d = 0; d < 3; ++d) {
            const double limit = around.velocity[d] + tau * pull[d];
            const double excess = v[d] - limit;
            x[d] += limit * dt_ + excess * tau * decayed;
            v[d] -= excess * decayed;
        }
    }

    /// tau = (xi + 1/2) St/(f Pr) at the slip of a sphere of velocity v in a fluid of velocity u.
    [[nodiscard]] double relaxation(const Vec3& u, const Vec3& v) const {
        const double slip =
            std::sqrt((u[0] - v[0]) * (u[0] - v[0]) + (u[1] - v[1]) * (u[1] - v[1]) + (u[2] - v[2]) * (u[2] - v[2]));
        return free_tau_ / Drag::factor(reynolds_ * slip);
    }

    [[nodiscard]] const Sphere& sphere() const { return sphere_; }
    [[nodiscard]] double time_step() const { return dt_; }

private:
    Sphere sphere_;
    double dt_, mass_, free_tau_, reynolds_;
};

}  // namespace grainsweep::coupling
