// Results of cases that were computed elsewhere: a CSV file with a line for each case, its inputs and outputs in
// columns.
#pragma once

#include "sweep/campaign/campaign.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::campaign {

/// Rules for reading a file of old results.
struct OldResultsRequest {
    std::filesystem::path file;
    std::filesystem::path folder;      ///< of files that are values of a parameter
    bool decimal_comma = false;        ///< "12,1" is 12.1
    bool partial = false;              ///< accepts a file without some scalars of the scene
    std::vector<std::string> ignored;  ///< columns that are not read
};

/// Number of a file and the precision with which it is written.
struct WrittenNumber {
    double value = 0;
    double tolerance = 0;  ///< half a unit of its last decimal
};

/// Line of the file: a case and its outputs.
struct OldResult {
    std::size_t line = 0;                ///< the header is line 1
    std::vector<Value> row;              ///< of the factors, in the order of the campaign
    std::vector<double> tolerances;      ///< up to which a factor is the same number; 0: exactly
    std::optional<std::int64_t> repeat;  ///< from the column `replicate`
    Outcome outcome = Outcome::completed;
    std::map<std::string, WrittenNumber, std::less<>> scalars;
};

struct OldResults {
    std::string hash;  ///< of the file's contents
    std::string text;
    std::vector<OldResult> results;
    std::size_t unanswered = 0;  ///< lines whose outcome is no answer, such as crashed; they are left out
};

/// Reads the file. A column is a factor, another parameter, a scalar observable, `outcome` or `replicate`; its header
/// may have a unit, "gap [mm]". Throws InputError with line, column, value and rule for an unknown or missing column, a
/// value that is no number or outside of its bounds or its factor's range, a parameter with another value than in the
/// campaign, and a line that `accepts` (the campaign's `where`) refuses.
[[nodiscard]] OldResults read_old_results(const OldResultsRequest& request, const Campaign& campaign,
                                          const Filter& accepts);

}  // namespace grainsweep::campaign
