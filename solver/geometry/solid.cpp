#include "solver/geometry/solid.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <map>
#include <utility>

namespace grainsweep::geometry {
namespace {

bool is_closed(const TriangleSurface& surface) {
    std::map<std::pair<std::int32_t, std::int32_t>, int> directed;
    for (const auto& t : surface.triangles)
        for (std::size_t k = 0; k < 3; ++k)
            if (++directed[{t[k], t[(k + 1) % 3]}] > 1) return false;
    for (const auto& [edge, count] : directed)
        if (!directed.contains({edge.second, edge.first})) return false;
    return true;
}

}  // namespace

std::optional<Solid> solid_of(const TriangleSurface& surface) {
    if (surface.triangles.empty() || !is_closed(surface)) return std::nullopt;
    const Vec3 origin = surface.corners[static_cast<std::size_t>(surface.triangles.front()[0])];
    double volume = 0, extent = 0;
    Eigen::Vector3d first = Eigen::Vector3d::Zero();   // integral of x
    Eigen::Matrix3d second = Eigen::Matrix3d::Zero();  // integral of x x^T
    for (const auto& t : surface.triangles) {
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
    Solid solid{.volume = std::abs(volume), .centre = origin, .axes = {}, .inertia = {}};
    solid.centre += Vec3{centre[0], centre[1], centre[2]};
    const double off = std::abs(inertia(0, 1)) + std::abs(inertia(0, 2)) + std::abs(inertia(1, 2));
    if (off <= 1e-12 * inertia.trace()) {  // x, y and z are the axes, in this order
        solid.axes = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
        solid.inertia = {inertia(0, 0), inertia(1, 1), inertia(2, 2)};
        return solid;
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(inertia);
    for (std::size_t k = 0; k < 3; ++k) {
        const auto column = static_cast<Eigen::Index>(k);
        solid.inertia[k] = principal.eigenvalues()[column];
        for (std::size_t a = 0; a < 3; ++a)
            solid.axes[k][a] = principal.eigenvectors()(static_cast<Eigen::Index>(a), column);
    }
    return solid;
}

}  // namespace grainsweep::geometry
