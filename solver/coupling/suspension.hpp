// Fluid and particles, advanced together step by step:
//   1. forces of the particles on the fluid, at their predicted middle positions X + V dt/2 (two-way levels only)
//   2. the fluid step
//   3. the particles, with the fluid in the middle of the step gathered at the same positions
//   4. walls
#pragma once

#include "solver/coupling/levels.hpp"
#include "solver/coupling/march.hpp"
#include "solver/coupling/visit_order.hpp"
#include "solver/flow/flow.hpp"

#include <utility>
#include <vector>

namespace grainsweep::coupling {

template <class Heat, class Level, class Kernel, class Drag>
class Suspension {
public:
    Suspension(flow::Flow<Heat> fluid, const flow::Vibration& vibration, const Motion<Drag>& motion, const Walls& walls,
               Cloud cloud, Level level)
        : fluid_(std::move(fluid)),
          vibration_(vibration),
          motion_(motion),
          walls_(walls),
          cloud_(std::move(cloud)),
          level_(std::move(level)),
          velocity_(flow::face_vectors(fluid_.grid())),
          acceleration_(velocity_) {}

    /// Sets the threads that compute a step; no bit depends on their number.
    void use(const Slabs& slabs) {
        slabs_ = slabs;
        fluid_.use(slabs);
        if constexpr (Level::acts_on_fluid) level_.use(slabs);
    }

    void step() {
        const double dt = fluid_.time_step();
        const double s = vibration_.at(fluid_.time() + 0.5 * dt);
        if constexpr (Level::acts_on_fluid) {
            find_stencils();
            fluid_.step(level_.source(stencils_, s));
        } else {
            fluid_.step();
        }
        if (cloud_.size() == 0) return;
        fluid_.midpoint(velocity_, acceleration_);
        const auto& order = order_.of(cloud_, fluid_.grid());
        const auto gathered = [&]([[maybe_unused]] std::size_t p, const Stencil<Kernel>& at) {
            Surroundings around{at.gather(velocity_), at.gather(acceleration_), s, {}};
            if constexpr (requires { Level::subtracts_own_wake; }) level_.subtract(p, middle(p), s, walls_, around);
            return around;
        };
        const auto moved = [&]([[maybe_unused]] std::size_t p, [[maybe_unused]] const Vec3& before) {
            if constexpr (Level::acts_on_fluid) {
                const Vec3& v = cloud_.velocity[p];
                level_.remember(p, {(v[0] - before[0]) / dt, (v[1] - before[1]) / dt, (v[2] - before[2]) / dt});
            }
        };
        const auto advance = [&](auto locate, auto gather) {
            march(cloud_, motion_, walls_, s, order, locate, gather, moved, slabs_);
        };
        if constexpr (Level::acts_on_fluid)
            advance([](std::size_t p) { return p; },
                    [&](std::size_t p, std::size_t /*itself*/) { return gathered(p, stencils_[p]); });
        else if constexpr (Level::mirrored)
            advance([&](std::size_t p) { return stencil_at(Level::below(middle(p))); },
                    [&](std::size_t p, const Stencil<Kernel>& at) {
                        Surroundings around = gathered(p, at);
                        Level::turn(middle(p), around);
                        return around;
                    });
        else
            advance([&](std::size_t p) { return stencil_at(middle(p)); }, gathered);
    }

    [[nodiscard]] const flow::Flow<Heat>& fluid() const { return fluid_; }
    [[nodiscard]] const Cloud& cloud() const { return cloud_; }
    [[nodiscard]] const Level& level() const { return level_; }
    /// Returns the budget of the last step.
    [[nodiscard]] const MomentumBudget& budget() const requires(Level::acts_on_fluid) { return level_.budget(); }

    void save(std::vector<std::byte>& into) const {
        fluid_.save(into);
        append_bytes<Vec3>(into, cloud_.position);
        append_bytes<Vec3>(into, cloud_.velocity);
        if constexpr (Level::acts_on_fluid) level_.save(into);
    }
    void restore(std::span<const std::byte>& from) {
        fluid_.restore(from);
        take_bytes<Vec3>(from, cloud_.position);
        take_bytes<Vec3>(from, cloud_.velocity);
        if constexpr (Level::acts_on_fluid) level_.restore(from);
    }

private:
    [[nodiscard]] Vec3 middle(std::size_t p) const { return predicted(cloud_, p, fluid_.time_step(), walls_); }
    [[nodiscard]] Stencil<Kernel> stencil_at(const Vec3& x) const { return {fluid_.grid(), walls_.periodic, x}; }

    void find_stencils() {
        stencils_.resize(cloud_.size());
        each_of(cloud_.size(), slabs_, [&](std::size_t p) { stencils_[p] = stencil_at(middle(p)); });
    }

    flow::Flow<Heat> fluid_;
    flow::Vibration vibration_;
    Motion<Drag> motion_;
    Walls walls_;
    Cloud cloud_;
    Level level_;
    flow::FaceVectors velocity_, acceleration_;
    VisitOrder order_;
    Slabs slabs_;
    std::vector<Stencil<Kernel>> stencils_;  // only for levels that act on the fluid
};

}  // namespace grainsweep::coupling
