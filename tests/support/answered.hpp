// A campaign of the rehearsal scene whose cases are answered by a formula: what tests of the study need.
#pragma once

#include "sweep/campaign/campaign.hpp"
#include "sweep/store/store.hpp"
#include "tests/support/archive.hpp"

#include <functional>
#include <map>
#include <optional>
#include <string>

namespace grainsweep::tests {

/// y of a case; nothing: the case ends as unstable ("the formula has no answer").
using Formula = std::function<std::optional<double>(const Inputs&)>;

/// Enrols the campaign of the text and settles its first `cases` cases (all, where there are fewer) in one group.
campaign::Campaign answer_by(store::Store& store, const std::string& text, const Formula& formula,
                             std::size_t cases = static_cast<std::size_t>(-1),
                             const std::function<bool(const campaign::PlacedCase&)>& wanted = {});

/// Observables of a case by name; nothing: the case ends as unstable.
using Formulas = std::function<std::optional<std::map<std::string, double>>(const Inputs&)>;
campaign::Campaign answer_all_by(store::Store& store, const std::string& text, const Formulas& formulas,
                                 std::size_t cases = static_cast<std::size_t>(-1),
                                 const std::function<bool(const campaign::PlacedCase&)>& wanted = {});

/// A real input of a case.
[[nodiscard]] double input(const Inputs& inputs, std::string_view name);

}  // namespace grainsweep::tests
