// Cases of tests/reference/clumps: clumps of spheres against LIGGGHTS 3.8.
#pragma once

#include <nlohmann/json.hpp>

#include "solver/dem/engine.hpp"
#include "solver/particles/clump.hpp"

#include <string>
#include <vector>

namespace grainsweep::tests {

/// A case as a setup, with the turn of each body from its axes of inertia into the frame of its list of spheres.
struct ClumpCase {
    dem::Setup setup;
    std::vector<geometry::Quaternion> turns;
    std::vector<double> reach;  ///< of each body, m
};

[[nodiscard]] nlohmann::json clump_cases();
/// Returns a case of cases.json in its box; LIGGGHTS's damping and limit of friction.
[[nodiscard]] ClumpCase clump_case(const nlohmann::json& given);
/// Returns a shape of shapes.json at scale 1, with a density.
[[nodiscard]] dem::BodyShape clump_shape(const std::string& name, double density,
                                         dem::DampingMass damping = dem::DampingMass::contact);
/// Returns a shape for the engines, m and kg.
[[nodiscard]] dem::BodyShape body_shape(const particles::Clump& clump, double density, dem::DampingMass damping);

inline constexpr double clump_density = 2500;  // kg/m3
/// Returns an empty box of 0.1 m without gravity, for stiff grains, at steps of a microsecond.
[[nodiscard]] dem::Setup clump_room();
/// Adds a body with its member spheres.
void add_body(dem::Setup& setup, const dem::Body& given);

}  // namespace grainsweep::tests
