// Body that a closed surface bounds.
#pragma once

#include "solver/geometry/triangle_surface.hpp"

#include <optional>

namespace grainsweep::geometry {

/// Volume, centre of mass and principal axes of inertia of a body of uniform density.
struct Solid {
    double volume = 0;  ///< m3
    Vec3 centre{};      ///< m
    std::array<Vec3, 3> axes{};
    Vec3 inertia{};  ///< about them, divided by the density, m5
};

/// Tensor of inertia: xx, xy, xz, yy, yz, zz, where xy is minus the product of inertia.
using Inertia = std::array<double, 6>;
/// Adds weight a a^T, in the order of Inertia.
inline void add_square(Inertia& to, const Vec3& a, double weight) {
    for (std::size_t i = 0, c = 0; i < 3; ++i)
        for (std::size_t j = i; j < 3; ++j) to[c++] += weight * (a[i] * a[j]);
}

/// Returns the body with these properties; `inertia`: about the centre, divided by the density. A tensor without
/// products of inertia has the axes x, y and z in this order.
[[nodiscard]] Solid solid_of(double volume, const Vec3& centre, const Inertia& inertia);

/// Returns the body as a sum of tetrahedra between the triangles and one point (Tonon 2004, J. Math. Stat. 1, 8-11),
/// for any orientation of the triangles. Empty if an edge does not belong to exactly two triangles, or the surface has
/// only one side or no volume.
[[nodiscard]] std::optional<Solid> solid_of(const TriangleSurface& surface);

}  // namespace grainsweep::geometry
