// Times of frames within a phase, and motions that frames can fall in step with.
//
// Equal frames see a periodic motion at few of its phases if their interval is nearly p/q of its period, q small. Means
// of values at such frames are wrong by up to the amplitude of what moves with the wall. Frames that the user did not
// choose are then scattered, frame k at
//
//     t_k = (k + frac(k phi) - 1/2) T/n,   phi = (sqrt(5) - 1)/2,   0 < k < n
//
// which meets all phases of the motion equally: k phi is the one-dimensional sequence of lowest discrepancy.
#pragma once

#include "solver/machine/spec.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace grainsweep::machine {

/// Periodic motion of a wall that equal frames of a phase see at few of its phases.
struct InStep {
    std::string wall;
    double period = 0;        ///< s
    std::int64_t phases = 0;  ///< seen, at most four
};

/// Returns the first wall that moves in step with equal frames of a phase.
[[nodiscard]] std::optional<InStep> in_step(const Spec& spec, std::size_t phase);
/// Returns, in one sentence, which frames that the user chose are in step with a motion while snapshots at them are
/// averaged; empty: none.
[[nodiscard]] std::string flaw_of_frames(const Spec& spec);
/// Returns the time of a frame, divided by the duration of its phase. `scattered`: frames are in step with a motion.
[[nodiscard]] double share_of_frame(std::int64_t frame, std::int64_t frames, bool scattered);

}  // namespace grainsweep::machine
