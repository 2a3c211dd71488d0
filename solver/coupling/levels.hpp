// Levels of coupling between particles and fluid. Each level is a type, so code that a level does not need is not
// compiled.
//
// One-way: the particles do not act on the fluid.
//
// Two-way, force form: each particle exerts on the fluid the opposite of the fluid's force on it, except the
// hydrostatic part. With F the sum of drag, added mass and pressure-gradient force, the particle's equation of motion
// gives F = v_p [xi dV/dt - (xi - 1) gamma s e], so
//     s_m = -sum k v_p [ xi dV_p/dt - (xi - 1) gamma s(t) e ]
// with the kernel k of spreading.hpp. (Point-force coupling, Crowe, Sharma & Stock 1977, doi 10.1115/1.3448756.) For a
// Boussinesq fluid it includes the vibrational buoyancy of the cloud, which dominates. This form has no stiffness,
// unlike the drag law: the large term is exact, and dV_p/dt comes from the step before. The dV_p/dt term is a share xi
// phi_p of the whole and lags by a step to a step and a half. So the error of the force is of first order in the step,
// times this share. The scheme is stable for a share below about 1.
//
// Two-way, equation 9 of Manayil Santhosh, Anwar & Lappa 2024 (IAC-24-A1.2.3) as printed:
//     s_m = -(1/fluid fraction) sum k v_p xi dV_p/dt.
// It is right for particles without body force; here it omits the reaction to the vibrational buoyancy.
#pragma once

#include "solver/bytes.hpp"
#include "solver/coupling/cloud.hpp"
#include "solver/coupling/motion.hpp"
#include "solver/coupling/plane_cuts.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace grainsweep::coupling {

struct OneWay {
    static constexpr bool acts_on_fluid = false;
    static constexpr bool mirrored = false;
};

/// One-way coupling in a fluid that is symmetric in x. Only the half x < 0 of the flow is computed, bounded by a plane
/// of symmetry (FreeSlip). Particles beyond the plane use mirrored values.
struct OneWayMirrored {
    static constexpr bool acts_on_fluid = false;
    static constexpr bool mirrored = true;

    [[nodiscard]] static Vec3 below(Vec3 x) {
        x[0] = -std::abs(x[0]);
        return x;
    }
    /// Converts fluid values at the image of x below the plane to values at x.
    static void turn(const Vec3& x, Surroundings& around) {
        if (!(x[0] > 0)) return;
        around.velocity[0] = -around.velocity[0];
        around.acceleration[0] = -around.acceleration[0];
    }
};

/// Returns what a particle gives the fluid: its reaction, with the vibrational buoyancy.
inline Vec3 force_on_fluid(const Sphere& sphere, const Vec3& rate, double vibration) {
    Vec3 force;
    for (std::size_t d = 0; d < 3; ++d) force[d] = -sphere.volume() * sphere.density_ratio * rate[d];
    force[static_cast<std::size_t>(sphere.direction)] +=
        sphere.volume() * (sphere.density_ratio - 1) * sphere.acceleration * vibration;
    return force;
}

/// Momentum budget: sums over all particles along the vibration, in units of rho alpha^2. They are the force on the
/// fluid in the last step, and the vibrational buoyancy (xi - 1) gamma s N v_p. The difference is the
/// inertia of the particles, sum xi v_p dV_p/dt.
struct MomentumBudget {
    double given = 0;
    double drive = 0;
};

/// Two-way coupling: deposits particle forces on the faces as accelerations of the fluid.
class TwoWay {
public:
    static constexpr bool acts_on_fluid = true;
    static constexpr bool mirrored = false;

    /// kernel_width, hats: see spreading.hpp.
    TwoWay(const flow::Grid& grid, const flow::Sides& sides, const Sphere& sphere, std::size_t particles,
           double kernel_width, Hats hats = Hats::linear)
        : sphere_(sphere),
          deposit_(grid, sides, kernel_width, hats),
          planes_(grid.cells(2) + 2),
          rate_(particles, Vec3{}),
          source_(flow::face_vectors(grid)) {}

    /// Sets the threads that compute; no bit depends on their number.
    void use(const Slabs& slabs) {
        slabs_ = slabs;
        deposit_.use(slabs);
    }

    /// Returns the acceleration of the fluid by the particles with these stencils, at vibration s.
    template <class Stencils>
    const flow::FaceVectors& source(const Stencils& stencils, double vibration) {
        FaceDeposit::clear(source_, slabs_);
        budget_ = {0, static_cast<double>(rate_.size()) * sphere_.volume() * (sphere_.density_ratio - 1) *
                          sphere_.acceleration * vibration};
        for (const Vec3& rate : rate_)
            budget_.given += force_on_fluid(sphere_, rate, vibration)[static_cast<std::size_t>(sphere_.direction)];
        cuts_.make(rate_.size(), planes_, slabs_, [&](std::size_t p) { return stencils[p].planes(); });
        cuts_.each(slabs_, [&](std::size_t p, const flow::Planes& own) {
            stencils[p].scatter(force_on_fluid(sphere_, rate_[p], vibration), source_, own);
        });
        deposit_.spread(source_);
        return source_;
    }

    /// Stores dV/dt of particle p in this step, before contact with walls.
    void remember(std::size_t p, const Vec3& rate) { rate_[p] = rate; }
    [[nodiscard]] const MomentumBudget& budget() const { return budget_; }

    /// Returns the force of particle p on the fluid in this step.
    [[nodiscard]] Vec3 force(std::size_t p, double vibration) const {
        return force_on_fluid(sphere_, rate_[p], vibration);
    }

    void save(std::vector<std::byte>& into) const { append_bytes<Vec3>(into, rate_); }
    void restore(std::span<const std::byte>& from) { take_bytes<Vec3>(from, rate_); }

private:
    Sphere sphere_;
    FaceDeposit deposit_;
    int planes_;
    PlaneCuts cuts_;
    Slabs slabs_;
    MomentumBudget budget_;
    std::vector<Vec3> rate_;  // dV_p/dt of the last step
    flow::FaceVectors source_;
};

}  // namespace grainsweep::coupling
