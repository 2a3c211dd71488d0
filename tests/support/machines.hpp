// Machine files for tests: a small sound one, and what becomes of a changed one.
#pragma once

#include "solver/machine/run.hpp"
#include "sweep/campaign/machine.hpp"

#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

namespace grainsweep::tests {

/// A box of 20 mm without a lid, 20 spheres of two kinds on a lattice that fall, a feed, three phases: half a second
/// of a core for all of it.
[[nodiscard]] nlohmann::json small_machine();

/// Contents of files by name.
using FileTexts = std::map<std::string, std::string>;

[[nodiscard]] std::shared_ptr<const campaign::Machine> machine_of(const nlohmann::json& document,
                                                                  const FileTexts& files = {});
/// Defaults, with what is chosen.
[[nodiscard]] Inputs inputs_of(const campaign::Machine& machine, const Inputs& chosen = {});
[[nodiscard]] machine::Spec spec_of(const nlohmann::json& document, const Inputs& chosen = {},
                                    const FileTexts& files = {});
/// What a finished run has measured.
[[nodiscard]] Observations answer_of(const machine::Spec& spec, std::uint64_t seed = 1);
/// Expects the same answer, to the last bit, of a run that a checkpoint interrupts after a time, s, in both precisions.
void expect_same_resumed(const nlohmann::json& document, double time);
/// Scalars and series as one text, to the last bit.
[[nodiscard]] std::string text_of(const Observations& observations);

}  // namespace grainsweep::tests
