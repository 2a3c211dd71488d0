// Motion of one small sphere in a vibrated fluid (length L, time L^2/alpha, density of the fluid):
//
//   (xi + 1/2) dV/dt = 3/2 Du/Dt + f(Re_p) (Pr/St) (u - V) + (xi - 1) gamma s(t) e + a,   dX/dt = V
//
// (Maxey & Riley 1983, doi 10.1063/1.864230, without Faxen terms and history force). xi: density ratio; St = 2/9
// (R/L)^2; gamma: amplitude of the vibrational acceleration; `a`: any other force per volume of the sphere. The history
// force has the relative size R/sqrt(2 nu/omega). It would change the slip by 8 to 10 % in the runs of
// configs/lappa2024_run*, mostly its phase. The added mass 1/2 is on the left-hand side: an explicit term would
// multiply errors by 1/(2 xi) per step.
//
// A step with the fluid values of its middle is solved exactly, so relaxation times far below the step are no problem:
//   tau = (xi + 1/2) St/(f Pr),  Vinf = u + tau [3/2 Du/Dt + (xi - 1) gamma s e + a]/(xi + 1/2),  E = exp(-dt/tau)
//   X += Vinf dt + (V - Vinf) tau (1 - E),   V = Vinf + (V - Vinf) E
// f uses the slip in the middle of the step (one correction). Positions are of second order for dt << tau and for dt >>
// tau; in the second case V is the velocity of the middle of the step.
#pragma once

#include "solver/coupling/drag.hpp"
#include "solver/coupling/interpolation.hpp"

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

/// Fluid at the sphere in the middle of a step.
struct Surroundings {
    Vec3 velocity{};       ///< u
    Vec3 acceleration{};   ///< Du/Dt
    double vibration = 0;  ///< s(t)
    Vec3 other{};          ///< a
};

/// Lanes of spheres in the same vibration: [axis][lane].
struct Lanes {
    static constexpr std::size_t size = 64;
    using Row = std::array<double, size>;
    alignas(64) std::array<Row, 3> position, velocity;
    alignas(64) std::array<Row, 3> fluid_velocity, pull;  ///< pull: 3/2 Du/Dt + a
};

/// Constants of all steps.
struct MotionConstants {
    double dt, mass, free_tau, reynolds;  ///< step, xi + 1/2, tau of Stokes' drag, Re_p of slip 1
};

/// Returns tau at the slip of a sphere of velocity v in a fluid of velocity u.
template <class Drag>
[[nodiscard, gnu::always_inline]] inline double relaxation(const MotionConstants& c, const Vec3& u, const Vec3& v) {
    const double slip =
        std::sqrt((u[0] - v[0]) * (u[0] - v[0]) + (u[1] - v[1]) * (u[1] - v[1]) + (u[2] - v[2]) * (u[2] - v[2]));
    return c.free_tau / Drag::factor(c.reynolds * slip);
}

/// Returns tau at the slip in the middle of a step that begins with velocity v.
template <class Drag>
[[nodiscard, gnu::always_inline]] inline double step_relaxation(const MotionConstants& c, const Vec3& v, const Vec3& u,
                                                                const Vec3& q) {
    const double tau = relaxation<Drag>(c, u, v);
    const double half = exponential(-0.5 * c.dt / tau).value();
    Vec3 middle;
    for (std::size_t d = 0; d < 3; ++d) {
        const double limit = u[d] + tau * q[d];
        middle[d] = limit + (v[d] - limit) * half;
    }
    return relaxation<Drag>(c, u, middle);
}

/// Advances (x, v) by one step in a fluid of velocity u; q: acceleration without drag.
template <class Drag>
[[gnu::always_inline]] inline void advance_one(const MotionConstants& c, Vec3& x, Vec3& v, const Vec3& u,
                                               const Vec3& q) {
    const double tau = step_relaxation<Drag>(c, v, u, q);
    const double decayed = -exponential(-c.dt / tau).less_one();  // 1 - E, accurate for dt << tau
    for (std::size_t d = 0; d < 3; ++d) {
        const double limit = u[d] + tau * q[d];
        const double excess = v[d] - limit;
        x[d] += limit * c.dt + excess * tau * decayed;
        v[d] -= excess * decayed;
    }
}

/// Applies advance_one to the first `count` lanes; push: acceleration by vibration (motion.cpp).
void advance_lanes(StokesDrag law, const MotionConstants& constants, const Vec3& push, Lanes& lanes, std::size_t count);
void advance_lanes(SchillerNaumann law, const MotionConstants& constants, const Vec3& push, Lanes& lanes,
                   std::size_t count);

template <class Drag>
class Motion {
public:
    Motion(const Sphere& sphere, double time_step)
        : sphere_(sphere),
          constants_{time_step, sphere.density_ratio + 0.5,
                     (sphere.density_ratio + 0.5) * sphere.stokes / sphere.prandtl,
                     2 * sphere.radius() / sphere.prandtl} {}

    void advance(Vec3& x, Vec3& v, const Surroundings& around) const {
        advance_one<Drag>(constants_, x, v, around.velocity, pull(around));
    }
    /// Returns tau of the step of a sphere with velocity v before it.
    [[nodiscard]] double step_relaxation(const Vec3& v, const Surroundings& around) const {
        return coupling::step_relaxation<Drag>(constants_, v, around.velocity, pull(around));
    }

    /// Advances many spheres in vectors, with the same bits as one by one.
    void advance(Lanes& lanes, std::size_t count, double vibration) const {
        advance_lanes(Drag{}, constants_, vibrated(vibration), lanes, count);
    }

    /// Returns tau = (xi + 1/2) St/(f Pr) at the slip of a sphere of velocity v in a fluid of velocity u.
    [[nodiscard]] double relaxation(const Vec3& u, const Vec3& v) const {
        return coupling::relaxation<Drag>(constants_, u, v);
    }

    [[nodiscard]] const Sphere& sphere() const { return sphere_; }
    [[nodiscard]] double time_step() const { return constants_.dt; }

private:
    // Returns the acceleration without drag.
    [[nodiscard]] Vec3 pull(const Surroundings& around) const {
        Vec3 q = vibrated(around.vibration);
        for (std::size_t d = 0; d < 3; ++d) q[d] += (1.5 * around.acceleration[d] + around.other[d]) / constants_.mass;
        return q;
    }
    [[nodiscard]] Vec3 vibrated(double vibration) const {
        Vec3 push{};
        push[static_cast<std::size_t>(sphere_.direction)] =
            (sphere_.density_ratio - 1) * sphere_.acceleration * vibration / constants_.mass;
        return push;
    }

    Sphere sphere_;
    MotionConstants constants_;
};

}  // namespace grainsweep::coupling
