// The heap in numbers.
//
// Geometry: z up, plate z = 0, tube about z, its wall 0.2 D thick, its lower end 0.02 D above the plate. The powder
// starts in the tube on a lattice of spacing 1.15 D (kit/filling.hpp), with random velocities of up to 0.2 sqrt(g D)
// per component, or as a loose random filling where that is no higher, falls and settles; then the tube is lifted at
// constant speed and the powder runs out below it. A rough plate is glued spheres with their tops at z = 0 on a plate
// at z = -D. What rolls further than 2.5 times the radius of a cone of 15 degrees is gone.
#pragma once

#include "solver/dem/engine.hpp"
#include "solver/particles/size_distribution.hpp"
#include "solver/scenes/values.hpp"

#include <cstdint>
#include <vector>

namespace grainsweep::heap {

struct Study {
    dem::Material material;
    dem::Surface wall;
    particles::SizeDistribution sizes;  ///< of d/D
    double diameter = 0;                ///< D, m
    double tube_radius = 0, lift_speed = 0, gravity = 0;
    double fill_height = 0;  ///< of the start, m
    bool rough = false;
    std::int64_t particles = 0;
    double time_step = 0;
    std::int64_t settle_steps = 0, last_step = 0, steps_per_look = 0;

    [[nodiscard]] double reach() const;                 ///< half the side of the calculation, m
    [[nodiscard]] double rest_speed() const;            ///< below which powder is at rest, m/s
    [[nodiscard]] double steps_to_rest() const;         ///< of a usual powder, an estimate
    [[nodiscard]] double glued_spheres() const;         ///< of the rough plate
    [[nodiscard]] double lower_end(double time) const;  ///< of the tube, since the start
};

/// Throws std::invalid_argument with one sentence where the inputs are impossible together or a file is not given.
[[nodiscard]] Study study_of(const Inputs& inputs, const Files& files);

/// Powder, then glued spheres; walls: plate, tube.
[[nodiscard]] dem::Setup filled(const Study& study, std::uint64_t seed);

/// Grows whenever answers change on purpose.
inline constexpr int revision = 2;

}  // namespace grainsweep::heap
