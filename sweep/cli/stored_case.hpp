// A case of an archive as commands name and show it, and as it is computed again.
#pragma once

#include "sweep/campaign/case.hpp"
#include "sweep/store/store.hpp"

#include <string>

namespace grainsweep::cli {

/// By its id or the beginning of one. Throws WrongQuestion where there is none.
[[nodiscard]] campaign::Case require_case(const store::Store& archive, const std::string& id);
/// The case and the points it answers, so that an id that begins like a point's number is not mistaken for it.
[[nodiscard]] std::string heading_of(const store::Store& archive, const campaign::CaseId& id);

/// Why this build cannot compute the case again: it lacks the scene, or has another revision of it, which is another
/// experiment. Empty: it can.
[[nodiscard]] std::string why_not_again(const campaign::Case& question);

/// A case of an archive written before its scene grew: a parameter the archive does not know takes its default, which
/// is what its absence from the case's identity means. Throws WrongQuestion where it cannot be computed again.
[[nodiscard]] campaign::Case as_asked_today(campaign::Case question);

}  // namespace grainsweep::cli
