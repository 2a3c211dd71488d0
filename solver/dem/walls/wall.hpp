// Wall: a shape, motions that are added, and a surface that may differ from the powder's material.
#pragma once

#include "solver/dem/material.hpp"
#include "solver/geometry/motion.hpp"
#include "solver/geometry/shapes.hpp"

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::dem {

using geometry::Bar;
using geometry::Cone;
using geometry::Cylinder;
using geometry::Mesh;
using geometry::Plane;
using geometry::Rotation;
using geometry::Shape;
using geometry::Side;
using geometry::Translation;
using geometry::Tube;
using geometry::Vec3;
using geometry::Vibration;

/// Deviations from the powder's material in contacts with a wall, or with frozen spheres.
struct Surface {
    std::optional<double> friction{}, rolling_friction{}, restitution{};
    std::optional<double> cohesion{}, surface_energy{};  ///< by the powder's law, J/m3 and J/m2

    bool operator==(const Surface&) const = default;
};

/// Returns why no engine can compute the surface of `whom`, in one sentence; empty: one can.
[[nodiscard]] std::string flaw(const Surface& surface, std::string_view whom);

/// Wall; a shape alone is a wall at rest. Times of motions are measured from the setting of the walls.
struct Wall {
    Shape shape;
    std::vector<geometry::Motion> motions;
    Surface surface;
    std::vector<Material> materials;  ///< one for its contacts with each kind of spheres, if there are several kinds
    std::uint8_t passing = 0;         ///< kinds of spheres that pass through it as if it were not there, bit by bit
    bool present = true;              ///< false: no particle touches it until Engine::change_walls makes it present
    bool integrated = false;          ///< its load is integrated over every step (WallLoad::impulse)

    Wall() = default;
    template <class S>
    requires(std::constructible_from<Shape, S> && !std::same_as<std::remove_cvref_t<S>, Wall>)
        Wall(S&& of, std::vector<geometry::Motion> in_motion = {}, Surface with = {})  // NOLINT: a shape is a wall
        : shape(std::forward<S>(of)), motions(std::move(in_motion)), surface(with) {}

    [[nodiscard]] bool touches(std::size_t kind) const { return (passing >> kind & 1U) == 0; }
};

/// Returns whether two walls differ at most in motions and presence.
[[nodiscard]] bool same_body(const Wall& one, const Wall& other);

}  // namespace grainsweep::dem
