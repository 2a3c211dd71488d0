#include "solver/coupling/motion.hpp"

#include "solver/flow/vector_clones.hpp"

namespace grainsweep::coupling {
namespace {

template <class Drag>
[[gnu::always_inline]] inline void advance_all(const MotionConstants& c, const Vec3& push, Lanes& lanes,
                                               std::size_t count) {
    auto& [x0, x1, x2] = lanes.position;
    auto& [v0, v1, v2] = lanes.velocity;
    const auto& [u0, u1, u2] = lanes.fluid_velocity;
    const auto& [a0, a1, a2] = lanes.pull;
    const Vec3 p = push;
    for (std::size_t i = 0; i < count; ++i) {
        Vec3 x{x0[i], x1[i], x2[i]};
        Vec3 v{v0[i], v1[i], v2[i]};
        const Vec3 u{u0[i], u1[i], u2[i]};
        const Vec3 q{a0[i] / c.mass + p[0], a1[i] / c.mass + p[1], a2[i] / c.mass + p[2]};
        advance_one<Drag>(c, x, v, u, q);
        x0[i] = x[0], x1[i] = x[1], x2[i] = x[2];
        v0[i] = v[0], v1[i] = v[1], v2[i] = v[2];
    }
}

}  // namespace

GRAINSWEEP_VECTOR_CLONES
void advance_lanes(StokesDrag /*law*/, const MotionConstants& constants, const Vec3& push, Lanes& lanes,
                   std::size_t count) {
    advance_all<StokesDrag>(constants, push, lanes, count);
}

GRAINSWEEP_VECTOR_CLONES
void advance_lanes(SchillerNaumann /*law*/, const MotionConstants& constants, const Vec3& push, Lanes& lanes,
                   std::size_t count) {
    advance_all<SchillerNaumann>(constants, push, lanes, count);
}

}  // namespace grainsweep::coupling
