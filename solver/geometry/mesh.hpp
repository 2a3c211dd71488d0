// A surface of triangles as a wall: where a sphere touches it.
//
// A sphere touches a surface at every place where the distance from its centre is least among all places around it.
// For triangles:
//   1. Each triangle within reach has one nearest point, on its face, an edge or a vertex.
//   2. Such a point on an edge or a vertex is no contact if it lies on another triangle whose nearest point is
//   elsewhere
//      (and so nearer: Kremmer & Favier 2001, doi 10.1002/nme.184). That triangle counts whether its own nearest point
//      is a contact or not, so that a sphere above many slivers in one plane has one contact, below its centre.
//   3. Nearest points of several triangles in one place are one contact, or none if step 2 leaves one of them out and
//      none is on a face: that on a face before one on an edge before one on a vertex, then the nearest.
//   4. Contacts whose normals differ by less than `one_contact_angle` are one, the nearest.
// No contact depends on the order of the triangles.
//
// Where two faces meet in a concave edge both are touched, for every angle between them: that is the geometry of the
// triangles. A drum or a cone made of facets has such places at every edge, at R/(R_drum - R) of its circumference
// however fine the facets are, and its stiffness there is nearly twice that of the curved wall. So a fine tessellation
// does not approach a curved wall unless one_contact_angle exceeds the angle between its facets: then one contact, with
// the nearest facet, is left everywhere, and the force tends to that of the curved wall with the angle. It must stay
// below the angle of every edge that is meant to be one.
//
// A wall has two sides: the normal points to the one where the centre is. A sphere whose centre passes a triangle is
// pushed on by it: crossed() finds that out.
//
// Triangles that meet in an edge or a vertex need not know of each other: a point lies on a triangle if it is nearer
// than `tolerance` to it. So an edge that ends on the side of another triangle (a T-junction), more than two triangles
// at an edge, and the seam between a mesh and its periodic image need no rule of their own.
#pragma once

#include "solver/geometry/domain.hpp"
#include "solver/geometry/triangle.hpp"
#include "solver/geometry/triangle_grid.hpp"
#include "solver/geometry/triangle_surface.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace grainsweep::geometry {

struct MeshContact {
    Vec3 normal{};        ///< unit, from the surface to the centre
    double distance = 0;  ///< from the centre, m
    Vec3 point{};         ///< on the surface
    Feature feature = Feature::face;
    std::uint32_t triangle = 0;  ///< one of those that have the point
};

class Mesh {
public:
    /// one_contact_angle: rad, at least 0, below pi/4. Throws std::invalid_argument where the surface has no triangle,
    /// a corner that is no number, or a triangle without area.
    explicit Mesh(const TriangleSurface& surface, double one_contact_angle = 0);

    /// The same with all of its images in a periodic domain that a sphere with its centre in the domain finds within
    /// `margin`: it goes on across the faces, and a plate from one to the other has no edge there.
    [[nodiscard]] Mesh repeated(const Domain& domain, double margin) const;

    [[nodiscard]] std::span<const Triangle> triangles() const { return triangles_; }
    /// Distance below which a point lies on a triangle, m: 1e-7 of the extent.
    [[nodiscard]] double tolerance() const { return tolerance_; }
    [[nodiscard]] const Vec3& low() const { return grid_.low(); }
    [[nodiscard]] const Vec3& high() const { return grid_.high(); }

    /// Triangles nearer than `reach` to the position, ascending.
    void near(const Vec3& position, double reach, std::vector<std::uint32_t>& into) const;

    /// Contacts of a sphere of radius `reach`, nearest first; `triangles`: at least those nearer than the reach.
    void contacts(const Vec3& position, double reach, std::span<const std::uint32_t> triangles,
                  std::vector<MeshContact>& into) const;
    void contacts(const Vec3& position, double reach, std::vector<MeshContact>& into) const;

    /// A triangle that a point moving straight passes through. A point on a plane counts to the side that the normal
    /// does not point to: of two moves that meet there exactly one crosses or none does.
    [[nodiscard]] std::optional<std::uint32_t> crossed(const Vec3& from, const Vec3& to) const;

private:
    void keep_places(std::vector<MeshContact>& touched) const;
    void unite_normals(std::vector<MeshContact>& places) const;

    std::vector<Triangle> triangles_;
    double tolerance_ = 0;
    double one_contact_angle_ = 0;
    TriangleGrid grid_;
};

}  // namespace grainsweep::geometry
