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

/// Takes pictures on the way: the first at the start, the last at the end, the others evenly spaced in the scene's
/// time, as far as its progress after the first step foretells the end, but at most a quarter of them before its
/// picture_focus(). Where the scene has a picture_period() shorter than their distance, at its nearest whole multiple.
/// The same moments however the run is sliced.
struct Camera {
    std::int64_t frames = 0;                  ///< 0: none
    std::function<void(const Scene&)> shoot;  ///< reads only
};

/// Computes the case: skipped when its answer is proven, rejected when the scene cannot be made from its
/// inputs or a file among them has changed, unstable when its state became untrustworthy, completed otherwise.
/// `resume`, where given, is the checkpoint to continue from (one that does not fit is ignored: the case starts anew).
/// `watch` returning false gives nullopt. Throws BrokenWorld where a file among the inputs is there and cannot
/// be read.
[[nodiscard]] std::optional<campaign::CaseResult> compute(const campaign::Case& question, std::int64_t attempt,
                                                          Artefacts& artefacts, const std::optional<Bytes>& resume,
                                                          const Watch& watch, const Camera& camera = {});

}  // namespace grainsweep::workers
