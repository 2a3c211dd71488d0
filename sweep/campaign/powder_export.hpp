// Import of powder sizes from exports of instruments and sieve sheets, as a table for scenes.
//
// Recognised forms:
//
//   text      UTF-8, UTF-16 and Latin-1; any lines before and behind the table
//   columns   separated by semicolons, tabs, commas or blanks; repeated groups of columns
//   numbers   decimal points and commas
//   rows      also of falling size; classes "20-45", "<20" and the pan of a sieve tower
//
// Information that the file does not contain must be given as a choice; the
// refusal names the missing choice.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace grainsweep::campaign {

/// Choices of the user about an export; absent: as in the file.
struct ExportChoices {
    std::optional<std::string> sizes = {}, shares = {};      ///< columns, by number from 1 or by header
    std::optional<std::string> unit = {};                    ///< of the sizes: "um"
    std::optional<std::string> as = {};                      ///< passing, retained (cumulative) or each
    std::optional<std::string> by = {};                      ///< volume or number
    std::optional<std::string> edge = {};                    ///< position of a size in its class: lower, upper or
                                                             ///< middle
    std::optional<std::string> smallest = {}, largest = {};  ///< sizes that end the table, with their unit
};

/// Imported table of sizes, with the recognised properties.
struct ImportedSizes {
    std::string csv;       ///< header and lines of diameter (m) and share below it, from 0 to 1
    std::string sentence;  ///< description of the import
    std::vector<std::pair<std::string, std::string>> facts;  ///< property and value found
    std::vector<std::string> notes;                          ///< changes made by the import
};

/// Imports an export. Throws InputError with one sentence, which names the option for missing information. Shares
/// that end within 1 % of their whole are normalised, and up to 1 % without a size at an end is left out; both add a
/// note.
[[nodiscard]] ImportedSizes import_sizes(std::string_view bytes, const ExportChoices& choices);

/// Words of --as, --by and --edge.
inline constexpr std::array<std::string_view, 3> export_as = {"passing", "retained", "each"};
inline constexpr std::array<std::string_view, 2> export_by = {"volume", "number"};
inline constexpr std::array<std::string_view, 3> export_edges = {"lower", "upper", "middle"};

// Steps of the import, internal.

/// Numeric block of an export and the lines around it.
struct ExportGrid {
    std::string encoding;
    char separator = ',';
    bool decimal_comma = false;
    std::size_t first_line = 0, last_line = 0;   ///< of the block, from 1
    std::vector<std::vector<std::string>> rows;  ///< all of the same length
    std::vector<std::string> headers;            ///< of every column, as written; empty: none
    std::string around;                          ///< all other lines, in small letters, "um" for a micro sign
};

/// Finds the longest block of lines with the same number of numeric cells. Throws InputError if there is none.
[[nodiscard]] ExportGrid export_grid(std::string_view bytes);
/// Returns the text in small letters, with "um" for a micro sign and "ss", "ae", "oe", "ue" for German letters.
[[nodiscard]] std::string plain_words(std::string_view text);
/// Number at the start of a cell, and the text behind it. Empty: the cell is no number.
struct ExportNumber {
    double value = 0;
    std::string unit;
};
[[nodiscard]] std::optional<ExportNumber> export_number(std::string_view cell, bool decimal_comma);
/// Limits of a cell of sizes, in its unit: a number gives one, "20-45" both, "<20" and "pan" the upper one (without a
/// value for a pan), ">90" the lower one.
struct ExportSize {
    enum class Kind { point, range, below, above, pan } kind = Kind::point;
    double low = 0, high = 0;
    std::string unit;
};
[[nodiscard]] std::optional<ExportSize> export_size(std::string_view cell, bool decimal_comma);

/// Meaning of the columns, by their headers and the choices.
struct ExportColumns {
    std::size_t size = 0, share = 0;
    std::optional<std::size_t> upper;   ///< a second column of sizes: upper edges
    std::string unit;                   ///< of sizes
    std::string unit_from, share_name;  ///< for messages
    std::optional<std::string> as;      ///< passing, retained, each, or sum: passing or retained
    std::optional<std::string> by;      ///< volume or number
    bool percent = false, weighed = false, sieved = false;
};
[[nodiscard]] ExportColumns export_columns(const ExportGrid& grid, const ExportChoices& choices);

}  // namespace grainsweep::campaign
