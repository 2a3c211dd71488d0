// Surface of triangles as a wall: the places where a sphere touches it.
//
// A sphere touches a surface at every local minimum of the distance from its centre. For triangles:
//   1. Each triangle within reach has one nearest point, on its face, an edge or a vertex.
//   2. A nearest point on an edge or a vertex is no contact if it also lies on another triangle whose nearest point is
//      elsewhere, and therefore nearer (Kremmer & Favier 2001, doi 10.1002/nme.184). This also holds if that nearest
//      point is no contact itself, so that a sphere above many slivers in one plane has one contact, below its centre.
//   3. Nearest points of several triangles in one place are one contact. A face has priority over an edge, an edge over
//      a vertex, then the nearest triangle. There is no contact if none of them is on a face and step 2 excludes one.
//   4. Contacts whose normals differ by less than `one_contact_angle` are one, the nearest.
// No contact depends on the order of the triangles.
//
// In a concave edge both faces are touched, for every angle between them. A drum or a cone made of facets has such
// places at every edge: at R/(R_drum - R) of its circumference, for facets of any size. There the contact is nearly
// twice as stiff as at the curved wall. So a fine tessellation approaches a curved wall only if one_contact_angle
// exceeds the angle between its facets. Then only the contact with the nearest facet is left, and its force tends to
// the force at the curved wall. one_contact_angle must be below the angle of every real edge.
//
// A wall has two sides; the normal points to the side of the centre. A triangle pushes a sphere whose centre has passed
// it further away. crossed() detects such a passage.
//
// A mesh is immutable; copies share their triangles.
//
// Triangles need no connectivity: a point lies on a triangle if it is nearer than `tolerance` to it. So three cases
// need no special rule: an edge that ends on the side of another triangle (a T-junction), an edge with more than two
// triangles, and the seam between a mesh and its periodic image.
#pragma once

#include "solver/geometry/closest.hpp"
#include "solver/geometry/domain.hpp"
#include "solver/geometry/triangle.hpp"
#include "solver/geometry/triangle_grid.hpp"
#include "solver/geometry/triangle_numbers.hpp"
#include "solver/geometry/triangle_surface.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace grainsweep::geometry {

struct MeshContact {
    Vec3 normal{};        ///< unit, from the surface to the centre
    double distance = 0;  ///< from the centre, m
    Vec3 point{};         ///< on the surface
    Feature feature = Feature::face;
    std::uint32_t triangle = 0;  ///< one of the triangles that contain the point
};

class Mesh {
public:
    /// Makes a mesh without triangles, which is no wall (flaw()).
    Mesh();
    /// one_contact_angle: rad, at least 0, below pi/4. Throws std::invalid_argument if the surface has no triangle, a
    /// triangle without area or with a missing corner, or a corner that is NaN or farther than 1e9 m away.
    explicit Mesh(TriangleSurface surface, double one_contact_angle = 0);

    /// Returns the mesh with all periodic images within `margin` of a centre in the domain. The mesh continues across
    /// the faces: a plate from one face to the other has no edge there.
    [[nodiscard]] Mesh repeated(const Domain& domain, double margin) const;

    /// Returns the mesh prepared for spheres of radius up to `reach`: it stores the triangles that can be touched from
    /// every place. Results have the same bits.
    [[nodiscard]] Mesh prepared(double reach) const;

    [[nodiscard]] std::span<const Triangle> triangles() const { return body_->triangles; }
    /// Returns the original surface without images.
    [[nodiscard]] const TriangleSurface& surface() const { return body_->surface; }
    [[nodiscard]] double one_contact_angle() const { return body_->one_contact_angle; }
    /// Returns the distance below which a point lies on a triangle, m: 1e-7 of the extent.
    [[nodiscard]] double tolerance() const { return body_->tolerance; }
    [[nodiscard]] const Vec3& low() const { return body_->grid.low(); }
    [[nodiscard]] const Vec3& high() const { return body_->grid.high(); }

    /// Lists the triangles nearer than `reach` to the position, ascending.
    void near(const Vec3& position, double reach, std::vector<std::uint32_t>& into) const;

    /// Lists the contacts of a sphere of radius `reach`, nearest first; `triangles` must include all nearer than
    /// `reach`.
    void contacts(const Vec3& position, double reach, std::span<const std::uint32_t> triangles,
                  std::vector<MeshContact>& into) const;
    void contacts(const Vec3& position, double reach, std::vector<MeshContact>& into) const;

    /// Returns a triangle that a point moving straight passes through. A point on a plane belongs to the side opposite
    /// to the normal. So of two consecutive moves that meet on the plane, at most one crosses it.
    [[nodiscard]] std::optional<std::uint32_t> crossed(const Vec3& from, const Vec3& to) const;

    // Members of every shape (shapes.hpp).
    void touching(const Vec3& x, double reach, std::vector<Closest>& into) const;
    void touching(const Vec3& x, double reach, std::span<const std::uint32_t> of, std::vector<Closest>& into) const;
    [[nodiscard]] std::size_t pieces() const { return triangles().size(); }
    using PieceNumbers = TriangleNumbers;
    [[nodiscard]] PieceNumbers piece(std::size_t number, double unit) const {
        return numbers_of(triangles()[number], unit);
    }
    template <class R>
    [[gnu::always_inline]] static inline NearPiece<R> near_piece(const R* numbers, R x, R y, R z) {
        return near_triangle(numbers, x, y, z);
    }
    [[nodiscard]] bool unchanged_by_shift(const Vec3&) const { return false; }
    [[nodiscard]] bool unchanged_by_turn(const Vec3&, const Vec3&) const { return false; }
    [[nodiscard]] Extent extent(std::size_t along) const { return {low()[along], high()[along]}; }
    [[nodiscard]] std::string flaw() const { return triangles().empty() ? "a mesh needs a triangle" : ""; }
    static void fields(auto& s, auto&& visit) {
        if constexpr (std::is_const_v<std::remove_reference_t<decltype(s)>>) {
            const auto all = [&visit](const auto& column) {
                visit(static_cast<std::uint64_t>(column.size()));
                for (const auto& one : column) visit(one);
            };
            all(s.surface().corners), all(s.surface().triangles), visit(s.one_contact_angle());
        } else {
            // One by one: a damaged count then reaches the end of the bytes instead of exhausting the memory.
            const auto all = [&visit]<class T>(std::vector<T>& column) {
                std::uint64_t size = 0;
                visit(size);
                for (T one{}; column.size() < size; column.push_back(one)) visit(one);
            };
            TriangleSurface surface;
            double angle = 0;
            all(surface.corners), all(surface.triangles), visit(angle);
            s = Mesh(std::move(surface), angle);
        }
    }

private:
    /// Four planes of a triangle, stored component by component: three through its sides, perpendicular to the triangle
    /// and positive outside, and its own plane.
    struct Prism {
        std::array<double, 4> x{}, y{}, z{}, offset{};

        explicit Prism(const Triangle& t);
        /// Returns the heights of a place above these planes, m.
        [[nodiscard]] std::array<double, 4> heights(const Vec3& place) const {
            std::array<double, 4> h{};
            for (std::size_t k = 0; k < 4; ++k) h[k] = x[k] * place[0] + y[k] * place[1] + z[k] * place[2] - offset[k];
            return h;
        }
    };
    struct Body {
        TriangleSurface surface;
        double one_contact_angle = 0;
        std::vector<Triangle> triangles;
        double tolerance = 0;
        TriangleGrid grid;
        // If it is prepared:
        double reach = 0;
        TriangleGrid reached;
        std::vector<Prism> prisms;
    };

    void keep_places(std::vector<MeshContact>& touched) const;
    void unite_normals(std::vector<MeshContact>& places) const;

    std::shared_ptr<const Body> body_;
};

}  // namespace grainsweep::geometry
