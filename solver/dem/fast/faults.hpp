// Why a state is not sound any more, in one sentence: what, where and when. Called once, when it happened.
#pragma once

#include <string>

#include "solver/dem/engine.hpp"
#include "solver/dem/fast/layout.hpp"
#include "solver/dem/fast/scale.hpp"
#include "solver/dem/fast/walls.hpp"

namespace grainsweep::dem::fast {

/// Overlaps, over the smaller diameter, up to which a contact is both meant by the law and resolved by the time step.
struct SoundOverlaps {
    float pair = 0;
    float wall = 0;
};

/// A contact of effective radius R* and reduced mass m* swings dt sqrt(S_n/m*), S_n = 2 E* sqrt(R* d), in one step; at
/// largest_sound_swing d = (swing^2 m*/(2 E* dt^2))^2/R*. Of all contacts those of the smallest sphere come first.
[[nodiscard]] SoundOverlaps sound_overlaps(const Setup& setup);

/// Input of a description.
struct FaultView {
    const Field& field;
    const std::int32_t* id;
    const Scale& scale;
    const Walls& walls;
    float smallest_diameter;
    SoundOverlaps sound;
    std::int64_t steps;
};

[[nodiscard]] std::string describe_fast_particle(const FaultView& view);
/// Empty where no particle moves faster than `limit` (m/s).
[[nodiscard]] std::string describe_faster_than(const FaultView& view, double limit);
/// `what` is wrong, with particle number `i` of the records.
[[nodiscard]] std::string describe(const FaultView& view, const std::string& what, std::int32_t i);
[[nodiscard]] std::string describe_overlap(const FaultView& view, const Tally& tally);

}  // namespace grainsweep::dem::fast
