// Boxes of fluid for tests of coupling, and every interaction of the dense levels from the same arguments.
#pragma once

#include "solver/coupling/dense_suspension.hpp"
#include "solver/coupling/drag.hpp"
#include "solver/coupling/projected_contacts.hpp"
#include "solver/coupling/solids_pressure.hpp"
#include "solver/coupling/spring_contacts.hpp"

#include <array>
#include <type_traits>
#include <variant>

namespace grainsweep::tests::flow_boxes {

using namespace grainsweep::coupling;
using flow::Axis;
using flow::Flow;
using flow::Grid;

inline constexpr std::array<flow::Side, 2> walls{flow::NoSlip{}, flow::NoSlip{}};
inline constexpr std::array<flow::Side, 2> periodic{flow::Periodic{}, flow::Periodic{}};
inline const flow::Sides closed{walls, walls, walls};
inline const flow::Sides endless{periodic, periodic, periodic};

[[nodiscard]] inline Grid cube(int n, double clustering = 0) {
    const Axis axis = clustering > 0 ? Axis::clustered(n, -0.5, 0.5, clustering) : Axis::uniform(n, -0.5, 0.5);
    return {{axis, axis, axis}};
}

[[nodiscard]] inline Walls box(const flow::Sides& sides, double contact) {
    const bool open = std::holds_alternative<flow::Periodic>(sides[0][0]);
    return {{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}, {open, open, open}, contact, 1};
}

[[nodiscard]] inline Flow<flow::NoHeat> still_fluid(const Grid& grid, const flow::Sides& sides, double viscosity,
                                                    double dt) {
    return {{grid, sides, viscosity, dt}, flow::NoHeat{}};
}

template <class Interaction, class Heat = flow::NoHeat>
using Dense = DenseSuspension<Heat, Interaction, Trilinear, SchillerNaumann>;

using Ddpm = SolidsPressure<AlgebraicTemperature>;
using DdpmKtgf = SolidsPressure<TransportedTemperature>;

/// Particles that do nothing to each other: the volume they take from the fluid alone.
struct NoInteraction {
    void use(const Slabs& slabs) { slabs_ = slabs; }
    template <class Motion, class Stencils, class Around>
    void move(Cloud& cloud, const Motion& motion, const Walls& walls, SolidsVolume&, const Stencils&,
              const Around& around, std::vector<Vec3>& transmitted) {
        advance_free(
            cloud, motion, walls, around, [](std::size_t) { return Vec3{}; }, transmitted, slabs_);
    }
    void settle(Cloud&, const Walls&, SolidsVolume&) {}
    void save(std::vector<std::byte>&) const {}
    void restore(std::span<const std::byte>&) {}

private:
    Slabs slabs_;
};

/// Every interaction with the same arguments.
struct BoxCase {
    Grid grid;
    flow::Sides sides;
    Sphere sphere;
    double dt;
    std::size_t particles;
    double collision = 0.8;
    double granular_temperature = 1;
    double kernel_width = 0.1;
    double friction = 0.3;

    template <class Interaction>
    [[nodiscard]] Interaction make() const {
        const Walls around = box(sides, sphere.radius());
        if constexpr (std::is_same_v<Interaction, SpringContacts>)
            return {sphere, around, {SpringContacts::stiffness(sphere, 0.01, dt), collision, friction}, particles};
        else if constexpr (std::is_same_v<Interaction, ProjectedContacts>)
            return {sphere, around};
        else if constexpr (std::is_same_v<Interaction, NoInteraction>)
            return {};
        else
            return {grid, sides, sphere, Granular::of(sphere, collision, 0.63), granular_temperature, kernel_width};
    }
    template <class Interaction>
    [[nodiscard]] Dense<Interaction> together(const flow::Vibration& vibration, const Cloud& cloud) const {
        return {still_fluid(grid, sides, sphere.prandtl, dt),
                vibration,
                Motion<SchillerNaumann>(sphere, dt),
                box(sides, sphere.radius()),
                cloud,
                make<Interaction>(),
                kernel_width};
    }
};

}  // namespace grainsweep::tests::flow_boxes
