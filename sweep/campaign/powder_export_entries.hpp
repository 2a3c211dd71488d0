// Rows of an export as sizes in m and printed shares. Internal to the import of sizes.
#pragma once

#include "sweep/campaign/powder_export.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace grainsweep::campaign::export_entries {

inline constexpr double small_rest = 0.01;  // relative: by which shares may miss their whole
inline constexpr double share_rounding = 1e-9;

/// Size and printed share of one row.
struct Entry {
    ExportSize size;  ///< in m
    double share = 0;
    bool stated = true;  ///< a share is printed
    std::size_t line = 0;
    std::string cell;  ///< size as written
};

/// Returns a length of an option in m. Throws InputError unless it is above 0.
[[nodiscard]] double metres(const std::string& text, std::string_view option);
/// Returns the rows from the smallest size on.
[[nodiscard]] std::vector<Entry> entries_of(const ExportGrid& grid, const ExportColumns& columns,
                                            std::vector<std::string>& notes);
/// Returns passing, retained or each; requests a choice if neither words nor numbers decide.
[[nodiscard]] std::string kind_of_shares(const std::vector<Entry>& entries, const ExportColumns& columns,
                                         const ExportChoices& choices, std::string& from);
/// Returns 1, 100, or of weighed classes their sum; `end`: the sum at the end of cumulative shares.
[[nodiscard]] double whole_of(const std::vector<Entry>& entries, const std::string& as, const ExportColumns& columns,
                              double end, std::vector<std::string>& notes);

}  // namespace grainsweep::campaign::export_entries
