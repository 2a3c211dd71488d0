// Stored case: lookup by id, heading, and conversion for another computation.
#pragma once

#include "sweep/campaign/case.hpp"
#include "sweep/store/store.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace grainsweep::cli {

/// Returns the case of an id or its beginning. Throws InputError if there is none.
[[nodiscard]] campaign::Case require_case(const store::Store& archive, const std::string& id);
/// Returns a heading with the case and its points, so that the beginning of an id is not mistaken for the number of a
/// point.
[[nodiscard]] std::string heading_of(const store::Store& archive, const campaign::CaseId& id);

/// Returns why this build cannot compute the case again: the scene is missing, or has another revision, which is
/// another experiment. Empty: it can.
[[nodiscard]] std::string why_not_again(const campaign::Case& question);

/// Returns a stored case for the present scene. New parameters of the scene get their defaults, because a missing
/// parameter in the identity of a case means its default. Throws InputError if the case cannot be computed again.
[[nodiscard]] campaign::Case as_asked_today(campaign::Case question);

/// Words before the id of that case in the message of an adopted answer.
inline constexpr std::string_view adopted_from = "adopted from case ";
/// Returns the case that computed an adopted answer, whose seed is another one; empty: the answer is the case's own.
[[nodiscard]] std::optional<campaign::Case> origin_of(const store::Store& archive, const campaign::CaseResult& result);

}  // namespace grainsweep::cli
