// Shapes of grains: rigid bodies of spheres, scaled to the volume of a sphere.
#pragma once

#include "solver/geometry/ball_union.hpp"
#include "solver/geometry/quaternion.hpp"

#include <span>
#include <string>
#include <vector>

namespace grainsweep::particles {

using geometry::Ball;
using geometry::Vec3;

/// Largest number of spheres of a shape.
inline constexpr std::size_t most_balls = 200;

/// Shape in the frame of its centre of mass and axes of inertia. The unit of length is D, the diameter of the sphere of
/// equal volume.
struct Clump {
    std::vector<Ball> balls;
    double mass = 0;                        ///< divided by density times D^3; pi/6 unless it was given
    Vec3 inertia{};                         ///< principal moments divided by density times D^5
    geometry::Quaternion turn{1, 0, 0, 0};  ///< from this frame into the one in which it was described
    Vec3 centre{};                          ///< of mass, in the frame in which it was described, m
    double diameter = 1;                    ///< D as it was described, m
    double lightness = 1;  ///< least mass that an impact on a sphere feels, divided by the sphere's own, at most 1; of
                           ///< a union it is 1 (Rayleigh's principle: no part is lighter within a body than alone)

    /// Returns the largest distance of a point from the centre of mass, in D.
    [[nodiscard]] double reach() const;
    /// Returns the radius of the smallest sphere, in D.
    [[nodiscard]] double smallest() const;
    /// Returns the number of the axis, 0 to 2, with the least moment of inertia.
    [[nodiscard]] std::size_t long_axis() const;
};

/// Returns why spheres are no shape, in one sentence; empty: they are one. They must overlap or touch, none may lie in
/// another, and there are 2 to most_balls of them.
[[nodiscard]] std::string flaw_of(std::span<const Ball> balls);
/// Returns why a mass, kg, and moments about the centre, kg m2, belong to no body within the spheres; empty: they do.
/// `solid`: the union of the spheres, of this density.
[[nodiscard]] std::string flaw_of(std::span<const Ball> balls, const geometry::Solid& solid, double density,
                                  double mass, const geometry::Inertia& inertia, const Vec3& centre);

/// Returns spheres of radius 1 in a row along x whose ends are `aspect_ratio` diameters apart, in (1, 20]: two up to
/// 1.5, else 1 + ceil(2 (A - 1)), at most a radius apart.
[[nodiscard]] std::vector<Ball> row_of(double aspect_ratio);

/// Sets mass and moments of a shape, divided by density times D^3 and D^5.
void take_mass(Clump& clump, double mass, const Vec3& inertia);

/// Returns the shape of spheres that touch, with volume, centre and inertia of a body: their union, or a mesh.
[[nodiscard]] Clump clump_of(std::span<const Ball> balls, const geometry::Solid& solid);

}  // namespace grainsweep::particles
