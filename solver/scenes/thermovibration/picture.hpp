// What a thermovibration case shows: particles, the cavity with its hot and cold wall, the flow in its cells.
#pragma once

#include "solver/coupling/cloud.hpp"
#include "solver/scenes/thermovibration/question.hpp"
#include "solver/scenes/values.hpp"

namespace grainsweep::thermovibration {

/// Particles and walls; lengths in L, time in L^2/alpha.
[[nodiscard]] Snapshot picture(const Question& question, const coupling::Cloud& cloud);

/// Velocity, and temperature (theta) unless it is nullptr, at the cell centres of the whole cube; a velocity there is
/// the mean of the two faces of its cell. Both live on question.flow_grid(): half of the cube is unfolded.
[[nodiscard]] FlowField drawn_flow(const Question& question, const flow::FaceVectors& velocity,
                                   const flow::Field* temperature);

}  // namespace grainsweep::thermovibration
