// `run --adopt OLD`: takes over answers of an earlier version of a program if only the contents of its files changed.
#pragma once

#include "sweep/campaign/campaign.hpp"
#include "sweep/campaign/cases.hpp"
#include "sweep/campaign/program.hpp"
#include "sweep/store/store.hpp"

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace grainsweep::cli {

/// Returns a line for each file with other contents in two programs with the same files: "script.sh: 1f0c -> 93ab",
/// with the beginnings of the hashes.
[[nodiscard]] std::vector<std::string> changed_files(const campaign::Program& old_program,
                                                     const campaign::Program& program);

/// Returns the program of the campaign `old` in the database. Throws WrongQuestion if there is no such campaign, one of
/// the campaigns has no program, or more than the contents of files changed.
[[nodiscard]] std::shared_ptr<const campaign::Program> adopted_program(const store::Store& store,
                                                                       const campaign::Campaign& campaign,
                                                                       const std::string& old);

/// Stores the answers of `old` to the same inputs as answers of the campaign, unless it has its own. Each is an attempt
/// whose message names its original case and program. The campaign must be enrolled. Returns their number.
std::size_t adopt_answers(store::Store& store, const campaign::Campaign& campaign, const campaign::Cases& cases,
                          const campaign::Program& old_program);

}  // namespace grainsweep::cli
