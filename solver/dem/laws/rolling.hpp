// Rolling resistance by an elastic-plastic spring and a dashpot.
//
//     dM = k_r w_t dt,  M += dM        w_t = (w_i - w_j) without its part along n
//     k_r = 2.25 k_n mu_r^2 R*^2,  k_n = 4/3 E* sqrt(R* d)
//     |M| <= mu_r R* |F_n|:  moment on i  -M - 2 eta_r sqrt(I_r k_r) w_t,   1/I_r = sum of 1/(7/5 m R^2)
//     otherwise:             M := mu_r R* |F_n| M/|M|,  moment on i  -M     (no dashpot)
//
// Ai, Chen, Rotter & Ooi (2011), Powder Technol. 206, 269, model C; stiffness after Iwashita & Oda (1998),
// J. Eng. Mech. 124, 285, as LIGGGHTS 3.8 `rolling_friction epsd` evaluates it: the memory is the moment, not the
// angle, so k_r acts at the overlap of its time, and M is not turned with n (over a contact that sticks n turns by
// less than the angles the spring allows). Twisting about n is not resisted.
//
// mu_r is the tangent of the steepest slope on which a sphere stays at rest. Two differences to LIGGGHTS: at a wall it
// takes (R - d/2)/(R - d) times w_i for the relative rotation, here w_i as everywhere else; and it moves M in its
// evaluation before the first step. F_n is the normal force of the laws before this one, as in Coulomb's limit.
#pragma once

#include "solver/dem/laws/touch.hpp"
#include "solver/particles/needs.hpp"

#include <cmath>

namespace grainsweep::dem {

struct RollingResistance {
    static constexpr particles::Needs needs{
        .spin = true, .tangential_history = false, .sizes = false, .frozen = false, .rolling_history = true};

    double stiffness = 0;      ///< 2.25 mu_r^2 4/3 E*, Pa
    double friction = 0;       ///< mu_r
    double damping_ratio = 0;  ///< eta_r, of the critical damping
    double time_step = 0;      ///< s

    /// k_r, N m
    template <Partner partner>
    [[nodiscard]] double spring(const Touch<partner>& t) const {
        return stiffness * t.root * t.effective_radius * t.effective_radius;
    }

    /// `advance` false: moments only, the spring's M stays as it is.
    template <bool advance, Partner partner>
    void add(const Touch<partner>& t, Response& r, Vec3& moment) const {
        using namespace geometry;
        const double k = spring(t);
        const Vec3 turning = t.turning - dot(t.turning, t.normal) * t.normal;
        if constexpr (advance) moment += (time_step * k) * turning;
        const double limit = friction * t.effective_radius * std::abs(r.normal);
        const double size = norm(moment);
        const bool yields = size > limit;
        const double scale = yields ? limit / size : 1.0;
        const double viscosity = yields ? 0.0 : 2 * damping_ratio * std::sqrt(t.rolling_inertia * k);
        r.rolling += (-scale) * moment - viscosity * turning;
        if constexpr (advance) moment = scale * moment;
    }

    /// Stored in the spring, J.
    template <Partner partner>
    [[nodiscard]] double energy(const Touch<partner>& t, const Vec3& moment) const {
        const double k = spring(t);
        return k > 0 ? 0.5 * geometry::dot(moment, moment) / k : 0.0;
    }
};

}  // namespace grainsweep::dem
