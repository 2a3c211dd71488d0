// Import of the answers of a spool's tasks into a database, case by case.
#pragma once

#include "sweep/campaign/campaign.hpp"
#include "sweep/campaign/cases.hpp"
#include "sweep/spool/spool.hpp"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace grainsweep::spool {

struct Collected {
    std::size_t imported = 0;  ///< cases
    std::size_t known = 0;     ///< cases that were already settled in the database
    std::size_t claimed = 0;   ///< files of unfinished attempts
    std::size_t unusable = 0;  ///< files that are damaged, incomplete, or of another campaign
};

struct Collector {
    /// Whether the case is already settled in the database.
    std::function<bool(const campaign::CaseId&)> is_settled;
    /// Called with the attempts of a finished case: failed ones, then the answer unless the case was given up.
    std::function<void(const campaign::CaseId&, std::vector<Answer>)> import;
    /// Called with a sentence on every unusable file.
    std::function<void(const std::string&)> note;
};

/// Reads every file of cases/ and imports finished cases: with an answer, that of the lowest number, or with
/// limits.attempts failures.
[[nodiscard]] Collected collect(const std::filesystem::path& cases_folder, const campaign::Campaign& campaign,
                                const campaign::Cases& cases, const Collector& collector);

}  // namespace grainsweep::spool
