// Boundary conditions at the six sides of the box, and their ghost values.
//
// The nearest value of a tangential velocity or a temperature lies half a cell from the wall. A prescribed wall value a
// therefore becomes ghost = 2 a - inner, and a zero gradient ghost = inner. A periodic side copies.
#pragma once

#include "solver/flow/field.hpp"
#include "solver/threads/slabs.hpp"

#include <array>
#include <initializer_list>
#include <variant>

namespace grainsweep::flow {

/// Solid wall that may slide in its own plane; the velocity component normal to the wall is ignored.
struct NoSlip {
    std::array<double, 3> velocity{};
};
/// Plane of symmetry: no flow through it, no shear on it.
struct FreeSlip {};
/// Periodic axis; must be given for both sides.
struct Periodic {};
using Side = std::variant<NoSlip, FreeSlip, Periodic>;

/// Sides of the box: low and high side of each axis.
using Sides = std::array<std::array<Side, 2>, 3>;

struct Isothermal {
    double temperature = 0;
};
struct Insulated {};
using ThermalSide = std::variant<Insulated, Isothermal>;
/// Thermal conditions of the sides; ignored along periodic axes.
using ThermalSides = std::array<std::array<ThermalSide, 2>, 3>;

/// Ghost value = sign * inner + constant; sign -1: prescribed value, +1: zero gradient.
struct Ghost {
    double sign = 1;
    double constant = 0;
};

/// Continuation of a field beyond both sides of one axis.
struct Edge {
    bool periodic = false;
    bool on_faces = false;  ///< the field is on the faces of this axis: its outermost values are on the sides
    std::array<Ghost, 2> ghost{};
};
using Edges = std::array<Edge, 3>;

/// Returns the edges of velocity component d. Throws std::invalid_argument if only one side of an axis is periodic.
[[nodiscard]] Edges velocity_edges(const Sides& sides, int component);
[[nodiscard]] Edges temperature_edges(const Sides& sides, const ThermalSides& thermal);
/// Returns edges with zero gradient, or periodic ones.
[[nodiscard]] Edges pressure_edges(const Sides& sides);

/// Returns the first index along axis d whose value is unknown (2 for wall faces, because face 1 lies on the wall). The
/// last unknown is n.
[[nodiscard]] inline int first_unknown(const Edge& edge) {
    return edge.on_faces && !edge.periodic ? 2 : 1;
}

/// Writes every ghost value, edges and corners included, and the zero of normal velocities on walls.
void fill_ghosts(Field& field, const Grid& grid, const Edges& edges, const Slabs& slabs = {});
void fill_ghosts(FaceVectors& faces, const Grid& grid, const std::array<Edges, 3>& edges, const Slabs& slabs = {});

/// Field with its edges.
struct Bordered {
    Field& field;
    const Edges& edges;
};
/// Writes the ghost values of several fields in one pass.
void fill_ghosts(std::initializer_list<Bordered> fields, const Grid& grid, const Slabs& slabs);

}  // namespace grainsweep::flow
