// Description of an unsound state in one sentence with place and time. Used once, when the fault occurs.
#pragma once

#include <string>

#include "solver/dem/engine.hpp"
#include "solver/dem/fast/layout.hpp"
#include "solver/dem/fast/mixed_engine.hpp"
#include "solver/dem/fast/scale.hpp"
#include "solver/dem/fast/walls.hpp"

namespace grainsweep::dem::fast {

/// Overlaps divided by the smaller diameter; for walls, by the diameter.
struct SoundOverlaps {
    float pair = static_cast<float>(overlap_limit);
    float wall = static_cast<float>(overlap_limit);
};

/// Returns the largest overlaps at which the law is valid and the time step resolves the contact.
///
/// A contact of effective radius R* and reduced mass m* has the phase dt sqrt(S_n/m*) per step, S_n = 2 E* sqrt(R* d).
/// It reaches largest_sound_swing at d = (swing^2 m*/(2 E* dt^2))^2/R*, first for the smallest and lightest sphere in
/// the stiffest contact.
[[nodiscard]] SoundOverlaps resolved_overlaps(const Setup& setup);
/// Returns the largest overlaps at which the law is valid, or that the setup permits.
[[nodiscard]] SoundOverlaps deepest_overlaps(const Setup& setup);
/// Returns whether contacts beyond resolved_overlaps() may be sound: a small hard sphere may sink deeper into a large
/// soft sphere than into an equal one. Such contacts are judged individually (unsound_contact).
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
    double time;  ///< since the start, s
};

/// Returns a description of the fastest particle, or of the fastest wall where no particle is too fast.
[[nodiscard]] std::string describe_fast_body(const FaultView& view);
/// Returns a description of a particle faster than `limit` (m/s); empty: there is none.
[[nodiscard]] std::string describe_faster_than(const FaultView& view, double limit);
/// Returns the description of the fault `what` of particle `i` of the records.
[[nodiscard]] std::string describe(const FaultView& view, const std::string& what, std::int32_t i);
/// Returns a description of the first contact of the last force evaluation that is too deep or not resolved by the time
/// step; empty: none. `advanced`: the particles have advanced by a step since then.
[[nodiscard]] std::string unsound_contact(const FaultView& view, bool advanced);
/// Returns a description of the first frozen particle in a wall that forces move; empty: there is none. Between two
/// rebuilds a wall moves by less than half of the smallest diameter.
[[nodiscard]] std::string describe_frozen(const FaultView& view);
[[nodiscard]] std::string describe_overlap(const FaultView& view, const Tally& tally);

}  // namespace grainsweep::dem::fast
