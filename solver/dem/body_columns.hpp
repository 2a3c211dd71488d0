// States of all clumps of an engine, as columns, and their motion. Where their members are is known to the engine.
#pragma once

#include "solver/dem/body.hpp"

#include <span>
#include <utility>
#include <vector>

namespace grainsweep::dem {

class BodyColumns {
public:
    explicit BodyColumns(std::vector<BodyShape> shapes) : shapes_(std::move(shapes)) {}

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

    template <class Self, class Visit>
    static void for_each_column(Self& self, Visit&& visit) {
        visit(self.first), visit(self.shape), visit(self.scale), visit(self.position), visit(self.velocity),
            visit(self.momentum), visit(self.orientation), visit(self.spin), visit(self.spin_in_step),
            visit(self.force), visit(self.torque), visit(self.position_at_build);
    }

    // Derived from the state.
    std::vector<double> mass, inverse_mass;
    std::vector<Vec3> inertia, inverse_inertia;

    /// Appends bodies whose `first` counts from this id.
    void append(std::span<const Body> bodies, std::size_t id);
    /// Computes what follows from the state.
    void derive();
    /// Removes bodies.
    void remove(const std::vector<bool>& leaving);
    /// Returns whether the states, for any bytes, are those of bodies with these shapes.
    [[nodiscard]] bool possible() const;

    /// Changes the momenta by the forces during `span` s; `acceleration`: of gravity and shaking.
    void kick_body(std::size_t body, double span, const Vec3& acceleration) {
        using namespace geometry;
        velocity[body] += span * (inverse_mass[body] * force[body] + acceleration);
        momentum[body] += span * torque[body];
    }
    /// Moves and turns a body by its momenta.
    void drift_body(std::size_t body, double span) {
        using namespace geometry;
        position[body] += span * velocity[body];
        spin[body] = spin_in_step[body] = turn(orientation[body], momentum[body], inverse_inertia[body], span);
    }
    /// Returns the axes of inertia of a body in space.
    [[nodiscard]] Axes axes(std::size_t body) const { return axes_of(orientation[body]); }
    /// Returns the place of a member from the centre of mass, in space.
    [[nodiscard]] Vec3 lever_of(std::size_t body, std::size_t member) const {
        using namespace geometry;
        return in_space(axes(body), scale[body] * shape_of(body).members[member].place);
    }
    /// Returns 1/m* of a body's side of a contact of a member with this lever.
    [[nodiscard]] double inverse_mass_at(std::size_t body, const Vec3& lever, const Vec3& normal) const {
        const double inverse = inverse_mass[body];
        if (shape_of(body).damping == DampingMass::body) return inverse;
        return inverse + added_inverse_mass(geometry::cross(lever, normal), axes(body), inverse_inertia[body]);
    }
    /// Returns the kinetic energy of a body with these momenta.
    [[nodiscard]] double kinetic_energy(std::size_t body, const Vec3& of_velocity, const Vec3& of_momentum) const {
        using namespace geometry;
        return 0.5 * (mass[body] * dot(of_velocity, of_velocity) +
                      dot(of_momentum, spin_of(of_momentum, axes(body), inverse_inertia[body])));
    }
    /// Gives a body whose motion is no longer a number a state that can be reported.
    void repair(std::size_t body) {
        position[body] = position_at_build[body];
        velocity[body] = momentum[body] = spin[body] = spin_in_step[body] = Vec3{};
        orientation[body] = {1, 0, 0, 0};
    }
    [[nodiscard]] BodyState state(std::size_t body) const;
    [[nodiscard]] const BodyShape& shape_of(std::size_t body) const { return shapes_[shape[body]]; }
    [[nodiscard]] std::size_t shapes() const { return shapes_.size(); }

private:
    std::vector<BodyShape> shapes_;
};

}  // namespace grainsweep::dem
