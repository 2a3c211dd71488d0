// Fluid and particles that displace each other's volume, advanced together:
//   1. forces of the particles on the fluid at their predicted middle positions (levels.hpp, force form), without the
//      forces between particles
//   2. the fluid step for the volume flux of both (shared_space.hpp)
//   3. the particles, in the fluid between them, with their interaction
//   4. their volume in the cells and the flux that brought it there (solids_volume.hpp)
//
// The level adds an Interaction: SolidsPressure<AlgebraicTemperature> (ddpm), SolidsPressure<TransportedTemperature>
// (ddpm_ktgf), SpringContacts or ProjectedContacts (cfd_dem).
// Terms with phi_p and dV_p/dt lag by one step. Their error is of first order in the step, with the factor phi_p. For
// phi_p -> 0 the scheme equals that of suspension.hpp with TwoWay.
#pragma once

#include "solver/coupling/levels.hpp"
#include "solver/coupling/march.hpp"
#include "solver/coupling/solids_volume.hpp"
#include "solver/flow/flow.hpp"
#include "solver/flow/shared_space.hpp"

#include <utility>
#include <vector>

namespace grainsweep::coupling {

template <class Heat, class Interaction, class Kernel, class Drag>
class DenseSuspension {
public:
    DenseSuspension(flow::Flow<Heat> fluid, const flow::Vibration& vibration, const Motion<Drag>& motion,
                    const Walls& walls, Cloud cloud, Interaction interaction, double kernel_width)
        : fluid_(std::move(fluid)),
          vibration_(vibration),
          motion_(motion),
          walls_(walls),
          cloud_(std::move(cloud)),
          interaction_(std::move(interaction)),
          space_(fluid_.grid(), fluid_.sides(), fluid_.viscosity()),
          deposit_(fluid_.grid(), fluid_.sides(), kernel_width, Kernel::hats),
          solids_(fluid_.grid(), fluid_.sides(), motion.sphere().volume(), kernel_width),
          transmitted_(cloud_.size(), Vec3{}),
          source_(flow::face_vectors(fluid_.grid())),
          flux_before_(source_),
          velocity_(source_),
          acceleration_(source_) {
        solids_.start(cloud_.position);
        interaction_.settle(cloud_, walls_, solids_);
        solids_.start(cloud_.position);
    }

    /// Sets the threads that compute a step; no bit depends on their number.
    void use(const Slabs& slabs) {
        slabs_ = slabs;
        fluid_.use(slabs);
        space_.use(slabs);
        deposit_.use(slabs);
        solids_.use(slabs);
        interaction_.use(slabs);
    }

    void step() {
        const double dt = fluid_.time_step();
        const double s = vibration_.at(fluid_.time() + 0.5 * dt);
        find_stencils();
        find_source(s, dt);
        fluid_.step(source_, solids_.fraction());
        fluid_.midpoint(velocity_, acceleration_);
        space_.interstitial(velocity_, solids_.flux(), solids_.fraction(), between_);
        keep_flux();
        interaction_.move(cloud_, motion_, walls_, solids_, stencils_, Around{*this, s}, transmitted_);
        solids_.place(cloud_.position);
        interaction_.settle(cloud_, walls_, solids_);
        solids_.carry(dt);
    }

    /// Returns the fluid solver, whose velocity is the volume flux of fluid and particles together.
    [[nodiscard]] const flow::Flow<Heat>& fluid() const { return fluid_; }
    [[nodiscard]] const Cloud& cloud() const { return cloud_; }
    [[nodiscard]] const Interaction& interaction() const { return interaction_; }
    [[nodiscard]] const SolidsVolume& solids() const { return solids_; }
    /// Returns the budget of the last step; `given` includes the effect of other particles and walls.
    [[nodiscard]] const MomentumBudget& budget() const { return budget_; }
    /// Returns the momentum flux of the fluid alone, J - j, on face m of component d, after the last step.
    [[nodiscard]] double fluid_flux(std::size_t d, std::size_t m) const {
        return fluid_.velocity()[d].values()[m] - flux_before_[d].values()[m];
    }

    void save(std::vector<std::byte>& into) const {
        fluid_.save(into);
        append_bytes<Vec3>(into, cloud_.position);
        append_bytes<Vec3>(into, cloud_.velocity);
        append_bytes<Vec3>(into, transmitted_);
        for (std::size_t d = 0; d < 3; ++d) {
            append_bytes<double>(into, solids_.flux()[d].values());
            append_bytes<double>(into, flux_before_[d].values());
        }
        interaction_.save(into);
    }
    void restore(std::span<const std::byte>& from) {
        fluid_.restore(from);
        take_bytes<Vec3>(from, cloud_.position);
        take_bytes<Vec3>(from, cloud_.velocity);
        take_bytes<Vec3>(from, transmitted_);
        for (std::size_t d = 0; d < 3; ++d) {
            take_bytes<double>(from, solids_.flux()[d].values());
            take_bytes<double>(from, flux_before_[d].values());
        }
        interaction_.restore(from);
        solids_.start(cloud_.position);
    }

private:
    using FaceVectors = flow::FaceVectors;

    // The fluid at particle p in this step.
    struct Around {
        const DenseSuspension& all;
        double vibration;
        [[nodiscard]] Surroundings operator()(std::size_t p) const {
            return {all.stencils_[p].gather(all.between_), all.stencils_[p].gather(all.acceleration_), vibration, {}};
        }
        /// Returns rot u/2 at x by differences over a diameter, or the part of it inside the box.
        [[nodiscard]] Vec3 rotation(const Vec3& x) const {
            const double r = all.motion_.sphere().radius();
            std::array<Vec3, 3> slope;
            for (std::size_t e = 0; e < 3; ++e) {
                Vec3 low = x;
                Vec3 high = x;
                low[e] -= r;
                high[e] += r;
                low = all.walls_.clipped(low);
                high = all.walls_.clipped(high);
                const Vec3 below = all.stencil_at(low).gather(all.between_);
                const Vec3 above = all.stencil_at(high).gather(all.between_);
                const double apart = all.walls_.periodic[e] ? 2 * r : high[e] - low[e];
                for (std::size_t d = 0; d < 3; ++d) slope[e][d] = (above[d] - below[d]) / apart;
            }
            return {0.5 * (slope[1][2] - slope[2][1]), 0.5 * (slope[2][0] - slope[0][2]),
                    0.5 * (slope[0][1] - slope[1][0])};
        }
    };

    [[nodiscard]] Stencil<Kernel> stencil_at(const Vec3& x) const { return {fluid_.grid(), walls_.periodic, x}; }

    void find_source(double vibration, double dt) {
        const Sphere& sphere = motion_.sphere();
        const auto axis = static_cast<std::size_t>(sphere.direction);
        const double drive = (sphere.density_ratio - 1) * sphere.acceleration * vibration;
        FaceDeposit::clear(source_, slabs_);
        budget_ = {0, static_cast<double>(cloud_.size()) * sphere.volume() * drive};
        const auto force = [&](std::size_t p) {
            Vec3 all;
            for (std::size_t d = 0; d < 3; ++d) all[d] = sphere.volume() * transmitted_[p][d];
            all[axis] += sphere.volume() * drive;
            return all;
        };
        for (std::size_t p = 0; p < cloud_.size(); ++p) budget_.given += force(p)[axis];
        cuts_.make(cloud_.size(), fluid_.grid().cells(2) + 2, slabs_,
                   [&](std::size_t p) { return stencils_[p].planes(); });
        cuts_.each(slabs_,
                   [&](std::size_t p, const flow::Planes& own) { stencils_[p].scatter(force(p), source_, own); });
        deposit_.spread(source_);
        const FaceVectors& flux = solids_.flux();
        each_value([&](std::size_t d, std::size_t m) {
            source_[d].data()[m] += (flux[d].data()[m] - flux_before_[d].data()[m]) / dt;
        });
        space_.add_excess(fluid_.velocity(), flux, solids_.fraction(), source_);
    }

    void find_stencils() {
        stencils_.resize(cloud_.size());
        each_of(cloud_.size(), slabs_,
                [&](std::size_t p) { stencils_[p] = stencil_at(predicted(cloud_, p, fluid_.time_step(), walls_)); });
    }
    void keep_flux() {
        each_value([&](std::size_t d, std::size_t m) { flux_before_[d].data()[m] = solids_.flux()[d].data()[m]; });
    }
    template <class Body>
    void each_value(Body body) const {
        for (std::size_t d = 0; d < 3; ++d) each_of(source_[d].size(), slabs_, [&](std::size_t m) { body(d, m); });
    }

    flow::Flow<Heat> fluid_;
    flow::Vibration vibration_;
    Motion<Drag> motion_;
    Walls walls_;
    Cloud cloud_;
    Interaction interaction_;
    flow::SharedSpace space_;
    FaceDeposit deposit_;
    SolidsVolume solids_;
    MomentumBudget budget_;
    std::vector<Vec3> transmitted_;  // per volume: force of other particles and walls minus inertia, in the last step
    FaceVectors source_, flux_before_;
    FaceVectors velocity_, acceleration_;
    FaceVectors between_ = flow::face_vectors(fluid_.grid());  // velocity of the fluid between the particles
    std::vector<Stencil<Kernel>> stencils_;
    PlaneCuts cuts_;
    Slabs slabs_;
};

}  // namespace grainsweep::coupling
