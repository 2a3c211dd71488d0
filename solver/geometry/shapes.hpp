// The shapes a wall can have: the list. A shape lives in its body frame; all it owes is its closest point.
//
// A shape with one contact at a time has closest(x) and moved(by). One that may be touched in several places has
// instead
//
//     void touching(const Vec3& x, double reach, std::vector<Closest>& into) const    appends the places, nearest first
//
// whose contacts go on from step to step by their normals (contact_memory.hpp). One without an inside, that a centre
// could pass, has crossed(from, to), the part of it that a point moving straight passes through, if any. One that is
// more than an image of itself across a periodic face has repeated(domain, margin): itself and its images as far as a
// centre in the domain finds them within the margin. One that can be made faster for spheres of known size has
// prepared(reach).
//
// One with closest(x) may have the same for vectors of positions (number.hpp): Numbers, plain doubles in units of its
// user's choice, numbers(centre, unit, origin), which gives them and what positions are then relative to, and
// near(numbers, x, y, z).
//
// A shape with touching consists of pieces, numbered from 0 on, so that a caller can keep the pieces near a centre. It
// has pieces(); near(x, reach, into), which lists the pieces nearer than the reach; and touching(x, reach, of, into),
// whose pieces `of` must include at least all of these. For vectors of
// positions: PieceNumbers, plain doubles, piece(number, unit), and near_piece(numbers, x, y, z).
//
// All have: unchanged_by_shift, unchanged_by_turn (motions that leave its surface where it is), extent, flaw, and
// fields, which visits what it is made of in one order, for checkpoints.
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

/// A shape that is touched in one place at most.
template <class S>
concept SingleContact = requires(const std::remove_cvref_t<S>& shape, const Vec3& x) {
    { shape.closest(x) } -> std::same_as<Closest>;
};

/// A shape without an inside.
template <class S>
concept Thin = requires(const std::remove_cvref_t<S>& shape, const Vec3& x) {
    static_cast<bool>(shape.crossed(x, x));
};

/// A shape that goes on in its images across periodic faces.
template <class S>
concept Repeated = requires(const std::remove_cvref_t<S>& shape, const Domain& domain) {
    { shape.repeated(domain, 1.0) } -> std::same_as<std::remove_cvref_t<S>>;
};

/// A shape that is faster for spheres of radius up to a reach when it knows that.
template <class S>
concept Preparable = requires(const std::remove_cvref_t<S>& shape) {
    { shape.prepared(1.0) } -> std::same_as<std::remove_cvref_t<S>>;
};

/// A shape whose closest points can be found for vectors of positions.
template <class S>
concept Vectorised = requires(const S& shape, const Vec3& centre, Vec3& origin) {
    { shape.numbers(centre, 1.0, origin) } -> std::same_as<typename S::Numbers>;
};

/// A shape made of pieces, of which a centre is near a few.
template <class S>
concept Pieced = requires(const S& shape, const Vec3& x, std::span<const std::uint32_t> of,
                          std::vector<Closest>& places, std::vector<std::uint32_t>& pieces) {
    { shape.piece(0, 1.0) } -> std::same_as<typename S::PieceNumbers>;
    shape.pieces();
    shape.near(x, 1.0, pieces);
    shape.touching(x, 1.0, of, places);
};

/// A shape that can be given displaced, so that its numbers round as if it had been given there.
template <class S>
concept Movable = requires(const S& shape, const Vec3& by) {
    { shape.moved(by) } -> std::same_as<S>;
};

}  // namespace grainsweep::geometry
