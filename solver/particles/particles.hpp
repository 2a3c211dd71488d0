// Columns of particle data of the double-precision engine.
#pragma once

#include "solver/geometry/vector.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace grainsweep::particles {

using geometry::Vec3;

/// Makes value order[k] value k; values not in `order` are removed.
template <class T>
void reorder(std::vector<T>& column, std::span<const std::uint32_t> order) {
    std::vector<T> fresh(order.size());
    for (std::size_t k = 0; k < order.size(); ++k) fresh[k] = column[order[k]];
    column.swap(fresh);
}

struct Particles {
    std::vector<std::int32_t> id;
    std::vector<Vec3> position;          ///< m
    std::vector<Vec3> velocity;          ///< m/s
    std::vector<Vec3> force;             ///< N, of contacts only
    std::vector<Vec3> angular_velocity;  ///< rad/s
    std::vector<Vec3> torque;            ///< N m
    std::vector<double> radius;          ///< m
    std::vector<double> inverse_mass;    ///< 1/kg; 0: frozen
    std::vector<std::uint8_t> kind;      ///< of contact

    [[nodiscard]] std::size_t size() const { return id.size(); }

    /// Calls visit(column) for every column, always in the same order.
    template <class Self, class Visit>
    static void for_each_column(Self& self, Visit&& visit) {
        visit(self.id);
        visit(self.position);
        visit(self.velocity);
        visit(self.force);
        visit(self.angular_velocity);
        visit(self.torque);
        visit(self.radius);
        visit(self.inverse_mass);
        visit(self.kind);
    }

    void resize(std::size_t n) {
        for_each_column(*this, [n](auto& column) { column.resize(n); });
    }

    /// Makes particle order[k] particle k; particles not in `order` are removed.
    void reorder(std::span<const std::uint32_t> order) {
        for_each_column(*this, [order](auto& column) { particles::reorder(column, order); });
    }
};

}  // namespace grainsweep::particles
