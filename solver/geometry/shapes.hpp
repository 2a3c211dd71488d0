// List of the shapes of walls. A shape is defined in its body frame by its closest points.
//
// A shape with only one contact at a time has closest(x) and moved(by). A shape that may be touched in several places
// has instead
//
//     void touching(const Vec3& x, double reach, std::vector<Closest>& into) const    appends the places, nearest first
//
// Its contacts are matched between steps by their normals (contact_memory.hpp). Optional members:
//
//   crossed(from, to)        of a shape without an inside: the part that a point moving straight passes through, if any
//   repeated(domain, margin) the shape with its periodic images within the margin of a centre in the domain
//   prepared(reach)          a faster form for spheres up to this radius
//
// A shape with closest(x) may also have a form for vectors of positions (number.hpp). The type Numbers has plain
// doubles in units of its user. numbers(centre, unit, origin) returns them and sets the origin of positions.
// near(numbers, x, y, z) computes the closest point.
//
// A shape with touching consists of pieces, numbered from 0, so that a caller can store the pieces near a centre. It
// has pieces(); near(x, reach, into), which lists the pieces nearer than the reach; and touching(x, reach, of, into),
// where `of` must include all these pieces. For vectors of positions it has PieceNumbers, plain doubles, piece(number,
// unit), and near_piece(numbers, x, y, z).
//
// All shapes have unchanged_by_shift and unchanged_by_turn (motions that do not move the surface), extent, flaw, and
// fields, which visits the members in a fixed order, for checkpoints.
#pragma once

#include "solver/geometry/bar.hpp"
#include "solver/geometry/cone.hpp"
#include "solver/geometry/cylinder.hpp"
#include "solver/geometry/domain.hpp"
#include "solver/geometry/mesh.hpp"
#include "solver/geometry/plane.hpp"
#include "solver/geometry/tube.hpp"

#include <concepts>
#include <cstdint>
#include <span>
#include <variant>
#include <vector>

namespace grainsweep::geometry {

using Shape = std::variant<Plane, Bar, Cylinder, Cone, Mesh, Tube>;

/// Shape that is touched in one place at most.
template <class S>
concept SingleContact = requires(const std::remove_cvref_t<S>& shape, const Vec3& x) {
    { shape.closest(x) } -> std::same_as<Closest>;
};

/// Shape without an inside.
template <class S>
concept Thin = requires(const std::remove_cvref_t<S>& shape, const Vec3& x) {
    static_cast<bool>(shape.crossed(x, x));
};

/// Shape that continues in its images across periodic faces.
template <class S>
concept Repeated = requires(const std::remove_cvref_t<S>& shape, const Domain& domain) {
    { shape.repeated(domain, 1.0) } -> std::same_as<std::remove_cvref_t<S>>;
};

/// Shape with a faster form for spheres up to a known radius.
template <class S>
concept Preparable = requires(const std::remove_cvref_t<S>& shape) {
    { shape.prepared(1.0) } -> std::same_as<std::remove_cvref_t<S>>;
};

/// Shape whose closest points can be computed for vectors of positions.
template <class S>
concept Vectorised = requires(const S& shape, const Vec3& centre, Vec3& origin) {
    { shape.numbers(centre, 1.0, origin) } -> std::same_as<typename S::Numbers>;
};

/// Shape made of pieces.
template <class S>
concept Pieced = requires(const S& shape, const Vec3& x, std::span<const std::uint32_t> of,
                          std::vector<Closest>& places, std::vector<std::uint32_t>& pieces) {
    { shape.piece(0, 1.0) } -> std::same_as<typename S::PieceNumbers>;
    shape.pieces();
    shape.near(x, 1.0, pieces);
    shape.touching(x, 1.0, of, places);
};

/// Shape that can be displaced by changing its numbers, with the same rounding as if it had been defined there.
template <class S>
concept Movable = requires(const S& shape, const Vec3& by) {
    { shape.moved(by) } -> std::same_as<S>;
};

}  // namespace grainsweep::geometry
