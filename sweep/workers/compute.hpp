// One case, from question to answer, in this process: what a worker, `solve` and `replay` all do.
#pragma once

#include "solver/scenes/scene.hpp"
#include "sweep/campaign/case.hpp"

#include <functional>
#include <optional>

namespace grainsweep::workers {

/// Called between slices of the computation (about ten times a second); whatever it does cannot change
/// the answer. Returns false to give the case up unfinished.
using Watch = std::function<bool(const Scene&)>;

/// Computes the case: skipped when its answer is proven, rejected when the scene cannot be made from its
/// inputs, unstable when its state became untrustworthy, completed otherwise. `resume`, where given, is
/// the checkpoint to continue from (one that does not fit is ignored: the case starts anew). `watch`
/// returning false gives nullopt.
/// `finished`, where given, sees the scene in its last state.
[[nodiscard]] std::optional<campaign::CaseResult> compute(const campaign::Case& question, std::int64_t attempt,
                                                          Artefacts& artefacts, const std::optional<Bytes>& resume,
                                                          const Watch& watch,
                                                          const std::function<void(const Scene&)>& finished = {});

}  // namespace grainsweep::workers
