// The rotating drum in numbers.
//
// Geometry: axis y through the origin, z up; inner radius R, 0 <= y <= length, periodic there or between plates that
// turn with the drum. It turns at w = 2 pi rpm/60 about +y, at once and steadily from t = 0, so that it raises the bed
// towards negative x. The powder starts as a loose random filling of the whole drum at rest and falls while the drum
// turns.
//
// Frames: t = turning_time + k frame_interval, k = 0, 1, ... up to turning_time + measured_time, each at the next time
// step.
#pragma once

#include "solver/dem/engine.hpp"
#include "solver/particles/size_distribution.hpp"
#include "solver/scenes/values.hpp"

#include <cstdint>

namespace grainsweep::drum {

struct Study {
    dem::Material material;
    dem::Surface wall, plates;
    particles::SizeDistribution sizes;  ///< of d/D
    double diameter = 0;                ///< D, m
    double radius = 0, length = 0;      ///< m
    bool has_plates = false;
    double speed = 0;  ///< w, rad/s
    double gravity = 0;
    std::int64_t particles = 0;
    double occupancy_cell = 0;  ///< m
    double time_step = 0;
    double turning_time = 0, frame_interval = 0;
    std::int64_t frames = 0;

    [[nodiscard]] double wall_speed() const { return speed * radius; }
    [[nodiscard]] std::int64_t step_of_frame(std::int64_t frame) const;
    [[nodiscard]] double time_of_frame(std::int64_t frame) const {
        return time_step * static_cast<double>(step_of_frame(frame));
    }
    [[nodiscard]] std::int64_t last_step() const { return step_of_frame(frames - 1); }
};

/// Throws std::invalid_argument with one sentence where the inputs are impossible together or a file is not given.
[[nodiscard]] Study study_of(const Inputs& inputs, const Files& files);

/// The loose filling in the turning drum. Walls: the drum and, where it has them, its plates.
[[nodiscard]] dem::Setup filled(const Study& study, std::uint64_t seed);

/// Share of the volume at which `fill` counts powder.
inline constexpr double packed_fraction = 0.58;

/// Grows whenever answers change on purpose.
inline constexpr int revision = 1;

}  // namespace grainsweep::drum
