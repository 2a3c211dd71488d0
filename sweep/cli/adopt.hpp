// `run --adopt OLD`: answers of an earlier version of a program, where only the contents of its files changed.
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

/// Files whose contents differ between two programs with the same files, a line each: "script.sh: 1f0c -> 93ab", the
/// beginnings of the hashes of their contents.
[[nodiscard]] std::vector<std::string> changed_files(const campaign::Program& old_program,
                                                     const campaign::Program& program);

/// The program of the campaign `old` in the database. Throws WrongQuestion where there is no such campaign, where one
/// of both campaigns has no program, and where more than the contents of files changed.
[[nodiscard]] std::shared_ptr<const campaign::Program> adopted_program(const store::Store& store,
                                                                       const campaign::Campaign& campaign,
                                                                       const std::string& old);

/// Stores the answers that `old` has to the same inputs as answers of the campaign, where it has none yet: each is an
/// attempt whose message names case and program it comes from. The campaign is enrolled. Returns how many.
std::size_t adopt_answers(store::Store& store, const campaign::Campaign& campaign, const campaign::Cases& cases,
                          const campaign::Program& old_program);

}  // namespace grainsweep::cli
