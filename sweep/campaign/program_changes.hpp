// Differences between two versions of a program, as a user would name them.
#pragma once

#include "sweep/campaign/program.hpp"

#include <string>
#include <vector>

namespace grainsweep::campaign {

struct ProgramChange {
    /// What `run --adopt` may do about a change: it takes answers over as they are, takes them over if a further
    /// observable can be read from the folder of the case, or refuses them.
    enum class Kind { adoptable, further_observable, another_program };
    Kind kind = Kind::another_program;
    std::string place;   ///< path in the campaign file: "$.program.command[2]"
    std::string name;    ///< of the file, variable, observable or parameter; else empty
    std::string before;  ///< as it was; empty: absent
    std::string now;     ///< empty: gone

    /// Returns "sim.py: 8e526a6cddf7 -> c1cd71826254".
    [[nodiscard]] std::string line() const;
};

/// Returns every difference that changes the program's scene, and the contents of files that do not count.
[[nodiscard]] std::vector<ProgramChange> program_changes(const Program& before, const Program& now);

/// Refuses a campaign whose stored program is another one: names what changed, and how to go on.
[[noreturn]] void refuse_changed_program(const std::string& campaign, const std::string& database,
                                         const std::vector<ProgramChange>& changes);

}  // namespace grainsweep::campaign
