// Columns of particle data: those a calculation needs, and no others.
//
// A column that is not needed has the type Absent: it holds nothing, and indexing it does not compile.
#pragma once

#include "solver/geometry/vector.hpp"
#include "solver/particles/needs.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

namespace grainsweep::particles {

using geometry::Vec3;

/// Type of a column that is not needed.
struct Absent {};

template <bool needed, class T>
using Column = std::conditional_t<needed, std::vector<T>, Absent>;

template <Needs needs>
struct Particles {
    std::vector<std::int32_t> id;
    std::vector<Vec3> position;                                       ///< m
    std::vector<Vec3> velocity;                                       ///< m/s
    std::vector<Vec3> force;                                          ///< N, of contacts only
    [[no_unique_address]] Column<needs.spin, Vec3> angular_velocity;  ///< rad/s
    [[no_unique_address]] Column<needs.spin, Vec3> torque;            ///< N m
    [[no_unique_address]] Column<needs.sizes, double> radius;         ///< m
    [[no_unique_address]] Column<needs.sizes, double> inverse_mass;   ///< 1/kg; 0: frozen
    [[no_unique_address]] Column<needs.frozen, char> mobile;

    [[nodiscard]] std::size_t size() const { return id.size(); }

    /// Calls visit(column) for every column that exists, always in the same order.
    template <class Visit>
    void for_each_column(Visit&& visit) {
        visit_columns(*this, visit);
    }
    template <class Visit>
    void for_each_column(Visit&& visit) const {
        visit_columns(*this, visit);
    }

    void resize(std::size_t n) {
        for_each_column([n](auto& column) { column.resize(n); });
    }

    /// Particle order[k] becomes particle k; those not named are gone.
    void reorder(std::span<const std::uint32_t> order) {
        for_each_column([order](auto& column) {
            std::remove_reference_t<decltype(column)> fresh(order.size());
            for (std::size_t k = 0; k < order.size(); ++k) fresh[k] = column[order[k]];
            column.swap(fresh);
        });
    }

private:
    template <class Self, class Visit>
    static void visit_columns(Self& self, Visit& visit) {
        visit(self.id);
        visit(self.position);
        visit(self.velocity);
        visit(self.force);
        if constexpr (needs.spin) {
            visit(self.angular_velocity);
            visit(self.torque);
        }
        if constexpr (needs.sizes) {
            visit(self.radius);
            visit(self.inverse_mass);
        }
        if constexpr (needs.frozen) visit(self.mobile);
    }
};

}  // namespace grainsweep::particles
