// Computes one case in this process. Workers, `solve` and `replay` use it.
#pragma once

#include "solver/scenes/scene.hpp"
#include "sweep/campaign/case.hpp"

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

namespace grainsweep::workers {

/// Function called between slices of the computation, about ten times a second. It cannot change the answer. It returns
/// false to interrupt the case.
using Watch = std::function<bool(const Scene&)>;

/// Camera that takes pictures during the run. The first picture is at the start, the last at the end. The others are
/// evenly spaced in the scene's time, whose length is estimated from the progress after the first step. At most a
/// quarter of them lie before picture_focus(). If picture_period() is shorter than the spacing, the spacing is rounded
/// to a whole multiple of it. Of a scene that may end early, more pictures are taken, and every second one is dropped
/// whenever they are twice as many as wanted. The moments do not depend on the slices.
struct Camera {
    std::int64_t frames = 0;                  ///< 0: none
    std::function<void(const Scene&)> shoot;  ///< must not change the scene
    /// Keeps only these of the pictures so far; indices in ascending order.
    std::function<void(const std::vector<std::size_t>&)> keep;
    /// Called once, at the first time step from `moment` (s) on, or at the end of a case that ends before.
    std::function<void(const Scene&)> at_moment{};
    double moment = std::numeric_limits<double>::infinity();
};

/// Computes a case. The outcome is `skipped` if the answer is proven without a run. It is `rejected` if the scene
/// cannot be made from the inputs, or an input file has changed. It is `unstable` if the state became unphysical, else
/// `completed`. `resume`: checkpoint from which the case continues; one that does not fit is ignored and the case
/// starts anew. Returns empty if `watch` returned false. Throws SystemError if an input file exists but cannot be read.
[[nodiscard]] std::optional<campaign::CaseResult> compute(const campaign::Case& question, std::int64_t attempt,
                                                          Artefacts& artefacts, const std::optional<Bytes>& resume,
                                                          const Watch& watch, const Camera& camera = {});

}  // namespace grainsweep::workers
