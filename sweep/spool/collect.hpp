// What a spool's tasks have answered, case by case, for an archive.
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
    std::size_t known = 0;     ///< cases that were settled in the archive before
    std::size_t claimed = 0;   ///< files of attempts that have not ended
    std::size_t unusable = 0;  ///< files that are damaged, half written, or of another campaign
};

struct Collector {
    /// Whether the archive needs no answer of the case any more.
    std::function<bool(const campaign::CaseId&)> is_settled;
    /// The attempts that ended a case: failed ones, then the answer, if it was not given up.
    std::function<void(const campaign::CaseId&, std::vector<Answer>)> import;
    /// A sentence on every file that cannot be used.
    std::function<void(const std::string&)> note;
};

/// Reads every file of cases/, and hands over what has ended for good: an answer, the one of the lowest number, or as
/// many failures as limits.attempts.
[[nodiscard]] Collected collect(const std::filesystem::path& cases_folder, const campaign::Campaign& campaign,
                                const campaign::Cases& cases, const Collector& collector);

}  // namespace grainsweep::spool
