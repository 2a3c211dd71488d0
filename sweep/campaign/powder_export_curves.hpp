// Shares of rows as curves of shares below rising sizes. Internal to the import of sizes.
#pragma once

#include "sweep/campaign/powder_export_entries.hpp"

#include <string>
#include <vector>

namespace grainsweep::campaign::export_curves {

using export_entries::Entry;

/// Question to a table: what its shares are, and of what.
struct Meaning {
    std::string as, as_from;
    double whole = 1;
    std::string by;
};

/// Returns the curve of shares of classes; edge: position of a size in its class, or "both".
[[nodiscard]] ExportCurve of_classes(const std::vector<Entry>& entries, const std::string& edge, double whole);
/// Returns the edge of a class at which sums are given: the upper one for shares below a size, except where only the
/// lower one can be. Empty: the sizes are single.
[[nodiscard]] std::string edge_of_sums(const std::vector<Entry>& entries, const Meaning& meaning,
                                       const ExportChoices& choices);
/// Returns the curve of cumulative shares.
[[nodiscard]] ExportCurve of_sums(const std::vector<Entry>& entries, const Meaning& meaning, const std::string& edge);
/// Gives the curve its ends: by choices, by leaving out a small rest, or by asking.
void end_curve(ExportCurve& curve, const ExportChoices& choices, std::vector<std::string>& notes);
/// Removes the empty classes at both ends.
void trim(ExportCurve& curve);

}  // namespace grainsweep::campaign::export_curves
