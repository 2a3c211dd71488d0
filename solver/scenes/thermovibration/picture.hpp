// Pictures of a thermovibration case: particles, the cavity with its hot and cold wall, the flow in its cells.
#pragma once

#include "solver/coupling/cloud.hpp"
#include "solver/scenes/thermovibration/question.hpp"
#include "solver/scenes/values.hpp"

namespace grainsweep::thermovibration {

/// Returns particles and walls; lengths in L, time in L^2/alpha.
[[nodiscard]] Snapshot picture(const Question& question, const coupling::Cloud& cloud);

/// Returns velocity, and temperature (theta) unless it is nullptr, at the cell centres of the whole cube. A velocity is
/// the mean of two faces of its cell. Both fields are on question.flow_grid(); a half cube is mirrored.
[[nodiscard]] FlowField drawn_flow(const Question& question, const flow::FaceVectors& velocity,
                                   const flow::Field* temperature);

}  // namespace grainsweep::thermovibration
