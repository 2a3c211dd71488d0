// Why a state is not sound any more, in one sentence: what, where and when. Called once, when it happened.
#pragma once

#include <string>

#include "solver/dem/engine.hpp"
#include "solver/dem/fast/layout.hpp"
#include "solver/dem/fast/mixed_engine.hpp"
#include "solver/dem/fast/scale.hpp"
#include "solver/dem/fast/walls.hpp"

namespace grainsweep::dem::fast {

/// Overlaps over the smaller diameter; of walls over the diameter.
struct SoundOverlaps {
    float pair = static_cast<float>(overlap_limit);
    float wall = static_cast<float>(overlap_limit);
};

/// Up to which a contact is both meant by the law and resolved by the time step.
///
/// One of effective radius R* and reduced mass m* swings dt sqrt(S_n/m*), S_n = 2 E* sqrt(R* d), in one step; at
/// largest_sound_swing d = (swing^2 m*/(2 E* dt^2))^2/R*. Of all contacts those of the smallest and lightest sphere in
/// the stiffest contact come first.
[[nodiscard]] SoundOverlaps resolved_overlaps(const Setup& setup);
/// Up to which a contact is meant by the law, or by the setup.
[[nodiscard]] SoundOverlaps deepest_overlaps(const Setup& setup);
/// Whether contacts beyond resolved_overlaps() may be sound: a small hard sphere sinks into a large soft one farther
/// than it may into its like. Such contacts are judged one by one (unsound_contact).
[[nodiscard]] bool contacts_differ(const Setup& setup);

/// Input of a description.
struct FaultView {
    const Field& field;
    const std::int32_t* id;
    const Scale& scale;
    const Walls& walls;
    const ContactTable& table;
    float smallest_diameter;
    SoundOverlaps sound;
    std::int64_t steps;
};

[[nodiscard]] std::string describe_fast_particle(const FaultView& view);
/// Empty where no particle moves faster than `limit` (m/s).
[[nodiscard]] std::string describe_faster_than(const FaultView& view, double limit);
/// `what` is wrong, with particle number `i` of the records.
[[nodiscard]] std::string describe(const FaultView& view, const std::string& what, std::int32_t i);
/// The first contact, as forces were computed last, that is too deep or not resolved by the time step; empty: none.
/// `advanced`: the particles have moved on by a step since.
[[nodiscard]] std::string unsound_contact(const FaultView& view, bool advanced);
[[nodiscard]] std::string describe_overlap(const FaultView& view, const Tally& tally);

}  // namespace grainsweep::dem::fast
