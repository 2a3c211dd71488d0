// Surfaces of triangles for tests of meshes, and the plain way to find where a sphere touches one.
#pragma once

#include "solver/geometry/mesh.hpp"
#include "solver/geometry/triangle_surface.hpp"
#include "stats/random.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace grainsweep::tests {

using geometry::Vec3;
using Soup = std::vector<std::array<Vec3, 3>>;  ///< triangles that need not know of each other

/// Corners welded as in a file.
[[nodiscard]] geometry::TriangleSurface surface_of(const Soup& soup);

/// (a, b, c) and (a, c, d): the diagonal runs from a to c.
[[nodiscard]] Soup quadrilateral(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);
/// |x|, |y| <= half, z = 0, in n x n squares of two triangles; `height` over x and y moves the corners.
[[nodiscard]] Soup plate(double half, int n, const std::function<double(double, double)>& height = {});
/// |x|, |y| <= a, -h <= z <= 0.
[[nodiscard]] Soup box(double a, double h);
/// Closed ring of n flat facets around x, |x| <= half_length, corners on the radius.
[[nodiscard]] Soup drum(int n, double radius, double half_length);

/// A point in the box around the middle; `at` counts the draws.
[[nodiscard]] Vec3 draw(const stats::Stream& random, std::uint64_t& at, const Vec3& half);
/// n triangles of up to `size` in a box of half length 1.
[[nodiscard]] Soup random_soup(std::uint64_t seed, int n, double size);
/// Triangles around one edge, like the pages of a book, and around one vertex.
[[nodiscard]] Soup random_fans(std::uint64_t seed);
/// A flat square with corners at random places in it: obtuse triangles, slivers and needles.
[[nodiscard]] Soup shattered_plate(std::uint64_t seed, int points);

[[nodiscard]] Soup joined(Soup a, const Soup& b);
/// Triangles in another order, their corners in another order each.
[[nodiscard]] Soup shuffled(Soup soup, std::uint64_t seed);

/// A place where a sphere touches: the same rule as Mesh's, by comparing every triangle with every other one.
struct PlainContact {
    Vec3 point{};
    double distance = 0;
};
/// Nearest first. A nearest point of a triangle is left out if it lies on a triangle that is nearer, or on one found
/// before.
[[nodiscard]] std::vector<PlainContact> plain_contacts(const Soup& soup, const Vec3& x, double reach, double tolerance);
/// The point of a triangle nearest to x.
[[nodiscard]] Vec3 plain_nearest(const std::array<Vec3, 3>& triangle, const Vec3& x);

}  // namespace grainsweep::tests
