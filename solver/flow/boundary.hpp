// What happens at the six sides of the box, and the ghost values that say so.
//
// A tangential velocity or a temperature has its nearest value half a cell from the wall, so a prescribed wall
// value a becomes ghost = 2 a - inner, a zero gradient ghost = inner, and a periodic side copies.
#pragma once

#include "solver/flow/field.hpp"
#include "solver/threads/slabs.hpp"

#include <array>
#include <initializer_list>
#include <variant>

namespace grainsweep::flow {

/// A solid wall that may slide in its own plane; the component normal to the wall is ignored.
struct NoSlip {
    std::array<double, 3> velocity{};
};
/// A plane of symmetry: no flow through it, no shear on it.
struct FreeSlip {};
/// Both sides of the axis are one; must be given for both.
struct Periodic {};
using Side = std::variant<NoSlip, FreeSlip, Periodic>;

/// Low and high side of each axis.
using Sides = std::array<std::array<Side, 2>, 3>;

struct Isothermal {
    double temperature = 0;
};
struct Insulated {};
using ThermalSide = std::variant<Insulated, Isothermal>;
/// Ignored along periodic axes.
using ThermalSides = std::array<std::array<ThermalSide, 2>, 3>;

/// ghost = sign * inner + constant; sign -1: value prescribed, +1: gradient zero.
struct Ghost {
    double sign = 1;
    double constant = 0;
};

/// How one field continues beyond both sides of one axis.
struct Edge {
    bool periodic = false;
    bool on_faces = false;  ///< the field is on the faces of this axis: its outermost values are on the sides
    std::array<Ghost, 2> ghost{};
};
using Edges = std::array<Edge, 3>;

/// Edges of velocity component d. Throws std::invalid_argument when only one side of an axis is periodic.
[[nodiscard]] Edges velocity_edges(const Sides& sides, int component);
[[nodiscard]] Edges temperature_edges(const Sides& sides, const ThermalSides& thermal);
/// Zero gradient or periodic.
[[nodiscard]] Edges pressure_edges(const Sides& sides);

/// First index along axis d whose value is unknown (2 for wall faces: face 1 lies on the wall); the last is n.
[[nodiscard]] inline int first_unknown(const Edge& edge) {
    return edge.on_faces && !edge.periodic ? 2 : 1;
}

/// Writes every ghost value, edges and corners included, and the zero of normal velocities on walls.
void fill_ghosts(Field& field, const Grid& grid, const Edges& edges, const Slabs& slabs = {});
void fill_ghosts(FaceVectors& faces, const Grid& grid, const std::array<Edges, 3>& edges, const Slabs& slabs = {});

/// A field and how it continues beyond the sides.
struct Bordered {
    Field& field;
    const Edges& edges;
};
/// The same of several fields at once.
void fill_ghosts(std::initializer_list<Bordered> fields, const Grid& grid, const Slabs& slabs);

}  // namespace grainsweep::flow
