// Levels of coupling between particles and fluid. A level is a type; what it does not do is not compiled.
//
// One-way: the particles do not act on the fluid.
//
// Two-way, force form: each particle acts on the fluid with the opposite of what the fluid does to it beyond the
// hydrostatic pressure. With F the sum of drag, added mass and pressure-gradient force, the particle's own equation
// of motion gives F = v_p [xi dV/dt - (xi - 1) gamma s e], so
//     s_m = -sum k v_p [ xi dV_p/dt - (xi - 1) gamma s(t) e ]
// (point-force coupling, Crowe, Sharma & Stock 1977, doi 10.1115/1.3448756, for a Boussinesq fluid: the vibrational
// buoyancy of the cloud is part of it and dominates; k is the kernel of spreading.hpp). Written through the balance
// instead of the drag law it has no stiffness: the large term is known exactly, dV_p/dt is that of the step before.
// That term is a share xi phi_p of the whole and lags by a step to a step and a half. So the force is of first order in
// the step, with that share as its factor. It is stable below a share of about 1.
//
// Two-way, equation 9 of Manayil Santhosh, Anwar & Lappa 2024 (IAC-24-A1.2.3) as printed:
//     s_m = -(1/fluid fraction) sum k v_p xi dV_p/dt.
// Right for particles without body force; here it leaves out the reaction to the vibrational buoyancy.
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

/// One-way coupling in a fluid that is its own mirror image in x. Only the half x < 0 of the flow exists, closed by a
/// plane of symmetry (FreeSlip). Particles beyond it take the mirrored values.
struct OneWayMirrored {
    static constexpr bool acts_on_fluid = false;
    static constexpr bool mirrored = true;

    [[nodiscard]] static Vec3 below(Vec3 x) {
        x[0] = -std::abs(x[0]);
        return x;
    }
    /// Fluid values at x from those at its image below the plane.
    static void turn(const Vec3& x, Surroundings& around) {
        if (!(x[0] > 0)) return;
        around.velocity[0] = -around.velocity[0];
        around.acceleration[0] = -around.acceleration[0];
    }
};

struct ForceForm {
    static constexpr bool per_fluid_volume = false;
    static Vec3 force_on_fluid(const Sphere& sphere, const Vec3& rate, double vibration) {
        Vec3 force;
        for (std::size_t d = 0; d < 3; ++d) force[d] = -sphere.volume() * sphere.density_ratio * rate[d];
        force[static_cast<std::size_t>(sphere.direction)] +=
            sphere.volume() * (sphere.density_ratio - 1) * sphere.acceleration * vibration;
        return force;
    }
};

struct EquationNine {
    static constexpr bool per_fluid_volume = true;
    static Vec3 force_on_fluid(const Sphere& sphere, const Vec3& rate, double /*vibration*/) {
        Vec3 force;
        for (std::size_t d = 0; d < 3; ++d) force[d] = -sphere.volume() * sphere.density_ratio * rate[d];
        return force;
    }
};

/// Sums over all particles along the vibration, in units of rho alpha^2: what they gave the fluid in the last step, and
/// the vibrational buoyancy (xi - 1) gamma s N v_p. In the force form the difference is the inertia of the particles,
/// sum xi v_p dV_p/dt.
struct MomentumBudget {
    double given = 0;
    double drive = 0;
};

/// Deposits particle forces on the faces as accelerations of the fluid.
template <class Form>
class TwoWay {
public:
    static constexpr bool acts_on_fluid = true;
    static constexpr bool mirrored = false;
    /// Least share of a cell that is fluid: random close packing leaves 1 - 0.63.
    static constexpr double least_fluid = 0.37;

    /// kernel_width, hats: see spreading.hpp.
    TwoWay(const flow::Grid& grid, const flow::Sides& sides, const Sphere& sphere, std::size_t particles,
           double kernel_width, Hats hats = Hats::linear)
        : sphere_(sphere),
          deposit_(grid, sides, kernel_width, hats),
          planes_(grid.cells(2) + 2),
          rate_(particles, Vec3{}),
          source_(flow::face_vectors(grid)) {
        if constexpr (Form::per_fluid_volume) solid_ = flow::face_vectors(grid);
    }

    /// Threads that compute from now on; no bit depends on their number.
    void use(const Slabs& slabs) {
        slabs_ = slabs;
        deposit_.use(slabs);
    }

    /// Acceleration of the fluid by the particles with these stencils, at vibration s.
    template <class Stencils>
    const flow::FaceVectors& source(const Stencils& stencils, double vibration) {
        FaceDeposit::clear(source_, slabs_);
        budget_ = {0, static_cast<double>(rate_.size()) * sphere_.volume() * (sphere_.density_ratio - 1) *
                          sphere_.acceleration * vibration};
        for (const Vec3& rate : rate_)
            budget_.given +=
                Form::force_on_fluid(sphere_, rate, vibration)[static_cast<std::size_t>(sphere_.direction)];
        cuts_.make(rate_.size(), planes_, slabs_, [&](std::size_t p) { return stencils[p].planes(); });
        cuts_.each(slabs_, [&](std::size_t p, const flow::Planes& own) {
            stencils[p].scatter(Form::force_on_fluid(sphere_, rate_[p], vibration), source_, own);
        });
        deposit_.spread(source_);
        if constexpr (Form::per_fluid_volume) {
            FaceDeposit::clear(solid_, slabs_);
            const double v = sphere_.volume();
            cuts_.each(slabs_, [&](std::size_t p, const flow::Planes& own) {
                stencils[p].scatter({v, v, v}, solid_, own);
            });
            deposit_.spread(solid_);
            for (std::size_t d = 0; d < 3; ++d)
                each_of(source_[d].size(), slabs_,
                        [&](std::size_t m) { source_[d].data()[m] /= std::max(1 - solid_[d].data()[m], least_fluid); });
        }
        return source_;
    }

    /// Motion of particle p in this step, before it touched any wall.
    void remember(std::size_t p, const Vec3& rate) { rate_[p] = rate; }
    [[nodiscard]] const MomentumBudget& budget() const { return budget_; }

    /// What particle p gives the fluid in this step.
    [[nodiscard]] Vec3 force(std::size_t p, double vibration) const {
        return Form::force_on_fluid(sphere_, rate_[p], vibration);
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
    flow::FaceVectors solid_;  // per_fluid_volume only
};

}  // namespace grainsweep::coupling
