// Cases of an archive, to be computed again.
#pragma once

#include "sweep/campaign/case.hpp"

#include <string>

namespace grainsweep::cli {

/// Why this build cannot compute the case again: it lacks the scene, or has another revision of it, which is another
/// experiment. Empty: it can.
[[nodiscard]] std::string why_not_again(const campaign::Case& question);

/// A case of an archive written before its scene grew: a parameter the archive does not know takes its default, which
/// is what its absence from the case's identity means. Throws WrongQuestion where it cannot be computed again.
[[nodiscard]] campaign::Case as_asked_today(campaign::Case question);

}  // namespace grainsweep::cli
