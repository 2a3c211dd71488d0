// Clumps of the clear engine: columns of their states, and the way from member spheres to bodies and back.
#pragma once

#include "solver/dem/body.hpp"
#include "solver/geometry/domain.hpp"
#include "solver/particles/particles.hpp"

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace grainsweep::dem::clear {

class Bodies {
public:
    explicit Bodies(std::vector<BodyShape> shapes) : shapes_(std::move(shapes)) {}

    [[nodiscard]] std::size_t size() const { return first.size(); }
    [[nodiscard]] bool empty() const { return first.empty(); }

    // State, by body.
    std::vector<std::int32_t> first;  ///< id of the first member
    std::vector<std::uint32_t> shape;
    std::vector<double> scale;
    std::vector<Vec3> position, velocity, momentum;  ///< momentum: angular, about the centre
    std::vector<Quaternion> orientation;
    std::vector<Vec3> spin;          ///< rad/s, of the last kick or turn
    std::vector<Vec3> spin_in_step;  ///< rad/s, that the forces of the last step saw
    std::vector<Vec3> force, torque;
    std::vector<Vec3> position_at_build;
    std::vector<Vec3> offset;  ///< by sphere: periods between X + lever and the sphere

    template <class Self, class Visit>
    static void for_each_column(Self& self, Visit&& visit) {
        visit(self.first), visit(self.shape), visit(self.scale), visit(self.position), visit(self.velocity),
            visit(self.momentum), visit(self.orientation), visit(self.spin), visit(self.spin_in_step),
            visit(self.force), visit(self.torque), visit(self.position_at_build);
    }

    // Derived from the state.
    std::vector<double> mass;
    std::vector<Vec3> inertia;
    std::vector<Axes> axes;

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
        const std::size_t b = body_of_[sphere];
        const double inverse = 1 / mass[b];
        if (shapes_[shape[b]].damping == DampingMass::body) return inverse;
        return inverse + added_inverse_mass(geometry::cross(lever_[sphere], normal), axes[b], inertia[b]);
    }

    /// Appends bodies whose `first` counts from this id.
    void append(std::span<const Body> bodies, std::size_t id);
    /// Finds the members among the spheres, by their ids below `ids`. Returns whether all are there.
    [[nodiscard]] bool map(std::span<const std::int32_t> id, std::size_t ids);
    /// Computes what follows from the state.
    void derive();
    /// Places the members of all bodies, with the periods that move each into the domain, after bodies have moved into
    /// it. Calls visit(body, shift) for each body that moved by a period.
    template <class Visit>
    void wrap(const geometry::Domain& domain, particles::Particles& spheres, Visit&& visit);
    /// Removes bodies.
    void remove(const std::vector<bool>& leaving);

    /// Sums forces and torques of the members, in the order of the shape.
    void gather(const particles::Particles& spheres);
    /// Half a kick, and the drift that follows it.
    void kick_and_drift(double span, const Vec3& acceleration, particles::Particles& spheres);
    /// Half a kick to the full step.
    void kick(double span, const Vec3& acceleration, particles::Particles& spheres);
    void set_velocities(std::size_t body, particles::Particles& spheres) const;

    /// Gives a body whose motion is no longer a number a state that can be reported.
    void repair(std::size_t body) {
        position[body] = position_at_build[body];
        velocity[body] = momentum[body] = spin[body] = spin_in_step[body] = Vec3{};
        orientation[body] = {1, 0, 0, 0};
    }
    [[nodiscard]] double kinetic_energy(std::size_t body) const {
        using namespace geometry;
        return 0.5 * (mass[body] * dot(velocity[body], velocity[body]) +
                      dot(momentum[body], spin_of(momentum[body], axes[body], inertia[body])));
    }
    [[nodiscard]] BodyState state(std::size_t body) const;
    [[nodiscard]] const BodyShape& shape_of(std::size_t body) const { return shapes_[shape[body]]; }
    [[nodiscard]] std::size_t shapes() const { return shapes_.size(); }

private:
    static constexpr std::uint32_t lone = std::numeric_limits<std::uint32_t>::max();

    void half_kick(std::size_t body, double half, const Vec3& acceleration) {
        using namespace geometry;
        velocity[body] += half * ((1 / mass[body]) * force[body] + acceleration);
        momentum[body] += half * torque[body];
    }
    void set_levers(std::size_t body);

    std::vector<BodyShape> shapes_;
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
