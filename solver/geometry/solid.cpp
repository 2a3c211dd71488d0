#include "solver/geometry/solid.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

namespace grainsweep::geometry {
namespace {

/// One side of a triangle, as it runs along its edge.
struct SideOfEdge {
    std::size_t triangle = 0;
    bool upwards = false;  ///< from the corner with the lower number
};

/// The triangles, all the same way round in every connected part; nullopt: an edge belongs to other than two.
std::optional<std::vector<std::array<std::int32_t, 3>>> oriented(const TriangleSurface& surface) {
    auto triangles = surface.triangles;
    std::map<std::pair<std::int32_t, std::int32_t>, std::vector<SideOfEdge>> edges;
    const auto edge_of = [&](std::size_t t, std::size_t k) {
        return std::pair(surface.triangles[t][k], surface.triangles[t][(k + 1) % 3]);
    };
    for (std::size_t t = 0; t < triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            const auto [from, to] = edge_of(t, k);
            edges[std::minmax(from, to)].push_back({t, from < to});
        }
    for (const auto& [edge, sides] : edges)
        if (sides.size() != 2) return std::nullopt;
    enum class Turned : std::uint8_t { unknown, no, yes };
    std::vector<Turned> turned(triangles.size(), Turned::unknown);
    for (std::size_t first = 0; first < triangles.size(); ++first) {
        if (turned[first] != Turned::unknown) continue;
        turned[first] = Turned::no;
        for (std::vector<std::size_t> reached{first}; !reached.empty();) {
            const std::size_t t = reached.back();
            reached.pop_back();
            for (std::size_t k = 0; k < 3; ++k) {
                const auto [from, to] = edge_of(t, k);
                const auto& sides = edges.at(std::minmax(from, to));
                const SideOfEdge& other = sides[0].triangle == t ? sides[1] : sides[0];
                const bool same = other.upwards != (from < to);  // sound neighbours run against each other
                const Turned needed = same == (turned[t] == Turned::no) ? Turned::no : Turned::yes;
                if (turned[other.triangle] == Turned::unknown) {
                    turned[other.triangle] = needed;
                    reached.push_back(other.triangle);
                } else if (turned[other.triangle] != needed) {
                    return std::nullopt;  // one-sided
                }
            }
        }
    }
    for (std::size_t t = 0; t < triangles.size(); ++t)
        if (turned[t] == Turned::yes) std::swap(triangles[t][1], triangles[t][2]);
    return triangles;
}

}  // namespace

Solid solid_of(double volume, const Vec3& centre, const Inertia& given) {
    const auto& [xx, xy, xz, yy, yz, zz] = given;
    Solid solid{.volume = volume, .centre = centre, .axes = {}, .inertia = {}};
    const double off = std::abs(xy) + std::abs(xz) + std::abs(yz);
    if (off <= 1e-12 * (xx + yy + zz)) {  // x, y and z are the axes, in this order
        solid.axes = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
        solid.inertia = {xx, yy, zz};
        return solid;
    }
    Eigen::Matrix3d inertia;
    inertia << xx, xy, xz, xy, yy, yz, xz, yz, zz;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(inertia);
    for (std::size_t k = 0; k < 3; ++k) {
        const auto column = static_cast<Eigen::Index>(k);
        solid.inertia[k] = principal.eigenvalues()[column];
        for (std::size_t a = 0; a < 3; ++a)
            solid.axes[k][a] = principal.eigenvectors()(static_cast<Eigen::Index>(a), column);
    }
    return solid;
}

std::optional<Solid> solid_of(const TriangleSurface& surface) {
    const auto triangles = oriented(surface);
    if (!triangles || triangles->empty()) return std::nullopt;
    const Vec3 origin = surface.corners[static_cast<std::size_t>(surface.triangles.front()[0])];
    double volume = 0, extent = 0;
    Eigen::Vector3d first = Eigen::Vector3d::Zero();   // integral of x
    Eigen::Matrix3d second = Eigen::Matrix3d::Zero();  // integral of x x^T
    for (const auto& t : *triangles) {
        std::array<Eigen::Vector3d, 3> corner;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 x = surface.corners[static_cast<std::size_t>(t[k])] - origin;
            corner[k] = {x[0], x[1], x[2]};
            extent = std::max(extent, corner[k].norm());
        }
        const double six_volumes = corner[0].dot(corner[1].cross(corner[2]));
        const Eigen::Vector3d sum = corner[0] + corner[1] + corner[2];
        volume += six_volumes / 6;
        first += six_volumes / 24 * sum;
        second += six_volumes / 120 * (sum * sum.transpose());
        for (const auto& x : corner) second += six_volumes / 120 * (x * x.transpose());
    }
    if (!(std::abs(volume) > 1e-12 * extent * extent * extent)) return std::nullopt;
    const Eigen::Vector3d centre = first / volume;
    const Eigen::Matrix3d about_centre = (second - volume * centre * centre.transpose()) * (volume < 0 ? -1 : 1);
    const Eigen::Matrix3d inertia = about_centre.trace() * Eigen::Matrix3d::Identity() - about_centre;
    const Vec3 from_origin{centre[0], centre[1], centre[2]};
    return solid_of(std::abs(volume), origin + from_origin,
                    {inertia(0, 0), inertia(0, 1), inertia(0, 2), inertia(1, 1), inertia(1, 2), inertia(2, 2)});
}

}  // namespace grainsweep::geometry
