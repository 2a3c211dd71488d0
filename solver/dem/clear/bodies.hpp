// Clumps of the clear engine: the way from member spheres to bodies and back.
#pragma once

#include "solver/dem/body_columns.hpp"
#include "solver/geometry/domain.hpp"
#include "solver/particles/particles.hpp"

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace grainsweep::dem::clear {

class Bodies : public BodyColumns {
public:
    using BodyColumns::BodyColumns;

    std::vector<Vec3> offset;  ///< by sphere: periods between X + lever and the sphere

    [[nodiscard]] bool is_member(std::size_t sphere) const { return !body_of_.empty() && body_of_[sphere] != lone; }
    [[nodiscard]] std::uint32_t body_of(std::size_t sphere) const { return body_of_[sphere]; }
    [[nodiscard]] const Vec3& lever(std::size_t sphere) const { return lever_[sphere]; }
    [[nodiscard]] bool same_body(std::size_t i, std::size_t j) const {
        return !body_of_.empty() && body_of_[i] == body_of_[j] && body_of_[i] != lone;
    }
    /// Returns the members of a body, as places in the columns of spheres, in the order of its shape.
    [[nodiscard]] std::span<const std::uint32_t> members(std::size_t body) const {
        return std::span(member_).subspan(begin_[body], begin_[body + 1] - begin_[body]);
    }
    /// Returns 1/m* of a member's side of a contact.
    [[nodiscard]] double inverse_mass_at(std::size_t sphere, const Vec3& normal) const {
        return BodyColumns::inverse_mass_at(body_of_[sphere], lever_[sphere], normal);
    }

    /// Finds the members among the spheres, by their ids below `ids`. Returns whether all are there.
    [[nodiscard]] bool map(std::span<const std::int32_t> id, std::size_t ids);
    /// Places the members of all bodies, with the periods that move each into the domain, after bodies have moved into
    /// it. Calls visit(body, shift) for each body that moved by a period.
    template <class Visit>
    void wrap(const geometry::Domain& domain, particles::Particles& spheres, Visit&& visit);
    /// Sums forces and torques of the members, in the order of the shape.
    void gather(const particles::Particles& spheres);
    /// Half a kick, and the drift that follows it.
    void kick_and_drift(double span, const Vec3& acceleration, particles::Particles& spheres);
    /// Half a kick to the full step.
    void kick(double span, const Vec3& acceleration, particles::Particles& spheres);
    void set_velocities(std::size_t body, particles::Particles& spheres) const;

    [[nodiscard]] double kinetic_energy(std::size_t body) const {
        return BodyColumns::kinetic_energy(body, velocity[body], momentum[body]);
    }

private:
    static constexpr std::uint32_t lone = std::numeric_limits<std::uint32_t>::max();

    void set_levers(std::size_t body);

    std::vector<std::uint32_t> body_of_;  // by sphere
    std::vector<Vec3> lever_;             // likewise: from the centre of mass, in space
    std::vector<std::uint32_t> begin_, member_;
};

template <class Visit>
void Bodies::wrap(const geometry::Domain& domain, particles::Particles& spheres, Visit&& visit) {
    using namespace geometry;
    for (std::size_t b = 0; b < size(); ++b) {
        const Vec3 shift = domain.wrapping(position[b]);
        if (shift != Vec3{}) {
            position[b] += shift;
            visit(b, shift);
        }
        for (const std::uint32_t i : members(b)) {
            const Vec3 x = position[b] + lever_[i];
            offset[i] = domain.wrapping(x);
            spheres.position[i] = x + offset[i];
        }
    }
}

}  // namespace grainsweep::dem::clear
