// `run --adopt OLD`: takes over answers of an earlier version of a program if the user's changes alter none of them.
#pragma once

#include "sweep/campaign/campaign.hpp"
#include "sweep/campaign/cases.hpp"
#include "sweep/campaign/program.hpp"
#include "sweep/campaign/program_changes.hpp"
#include "sweep/store/store.hpp"

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace grainsweep::cli {

/// Refuses a campaign that the store has with another program: names what changed, and how to go on.
void refuse_another_program(const store::Store& store, const campaign::Campaign& campaign,
                            const std::filesystem::path& database);

/// Earlier program whose answers a campaign takes over.
struct Adopted {
    std::shared_ptr<const campaign::Program> program;  ///< nullptr: none are
    std::vector<campaign::ProgramChange> changes;      ///< since then
    std::filesystem::path cases;                       ///< folders of its cases, if they were kept
    campaign::Filter where;                            ///< cases whose answers are taken over; empty: all
};

/// Returns the program of the campaign `old` in the database. Throws InputError if there is no such campaign, one of
/// the campaigns has no program, or a change is none of these: contents of files, files that do not count, another
/// folder of a program or file in the command, a further observable.
[[nodiscard]] Adopted adopted_program(const store::Store& store, const campaign::Campaign& campaign,
                                      const std::string& old);

struct AdoptedCounts {
    std::size_t answers = 0;
    std::size_t read_again = 0;  ///< of these, with observables read from the folders of their cases
    std::size_t without = 0;     ///< answers not taken over, because a further observable is nowhere to be read
    std::size_t excluded = 0;    ///< answers not taken over, because the condition excludes them
};

/// Stores the answers of an earlier program to the same inputs as answers of the campaign, unless it has its own. Each
/// is an attempt whose message names its original case and program. The campaign must be enrolled.
AdoptedCounts adopt_answers(store::Store& store, const campaign::Campaign& campaign, const campaign::Cases& cases,
                            const Adopted& adopted);

}  // namespace grainsweep::cli
