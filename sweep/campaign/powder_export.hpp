// Sizes of a powder as instruments and sieve sheets export them, made a table that scenes read.
//
// Recognised: UTF-8, UTF-16 and Latin-1 text; semicolons, tabs, commas or blanks between the columns; decimal points
// and commas; any lines before and behind the table; rows of falling size; classes "20-45", "<20" and the pan of a
// sieve tower; repeated groups of columns. What the file does not state is a choice, and its absence is refused by
// name.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace grainsweep::campaign {

/// What the user states about an export; absent: as the file says.
struct ExportChoices {
    std::optional<std::string> sizes = {}, shares = {};      ///< columns, by number from 1 or by header
    std::optional<std::string> unit = {};                    ///< of the sizes: "um"
    std::optional<std::string> as = {};                      ///< passing, retained (cumulative) or each
    std::optional<std::string> by = {};                      ///< volume or number
    std::optional<std::string> edge = {};                    ///< of a class that its size gives: lower, upper or middle
    std::optional<std::string> smallest = {}, largest = {};  ///< sizes that end the table, with their unit
};

/// A table of sizes and what was recognised on the way to it.
struct ImportedSizes {
    std::string csv;       ///< header and lines of diameter (m) and share below it, from 0 to 1
    std::string sentence;  ///< what was taken, for a reader
    std::vector<std::pair<std::string, std::string>> facts;  ///< what, as found
    std::vector<std::string> notes;                          ///< what was changed on the way
};

/// Imports an export. Throws WrongQuestion with one sentence, which names the option that answers an open question.
/// Shares that end within 1 % of their whole are divided by it, and up to 1 % without a size at an end is left out;
/// both make a note.
[[nodiscard]] ImportedSizes import_sizes(std::string_view bytes, const ExportChoices& choices);

/// Words of --as, --by and --edge.
inline constexpr std::array<std::string_view, 3> export_as = {"passing", "retained", "each"};
inline constexpr std::array<std::string_view, 2> export_by = {"volume", "number"};
inline constexpr std::array<std::string_view, 3> export_edges = {"lower", "upper", "middle"};

// The steps, internal to the import.

/// The numeric block of an export and the lines around it.
struct ExportGrid {
    std::string encoding;
    char separator = ',';
    bool decimal_comma = false;
    std::size_t first_line = 0, last_line = 0;   ///< of the block, from 1
    std::vector<std::vector<std::string>> rows;  ///< all of the same length
    std::vector<std::string> headers;            ///< of every column, as written; empty where there is none
    std::string around;                          ///< all other lines, in small letters, "um" for a micro sign
};

/// Finds the longest block of lines with the same number of cells that are numbers. Throws WrongQuestion where there is
/// none.
[[nodiscard]] ExportGrid export_grid(std::string_view bytes);
/// Small letters, "um" for a micro sign, "ss", "ae", "oe", "ue" for German letters.
[[nodiscard]] std::string plain_words(std::string_view text);
/// The number that a cell begins with, and what stands behind it. None: the cell is no number.
struct ExportNumber {
    double value = 0;
    std::string unit;
};
[[nodiscard]] std::optional<ExportNumber> export_number(std::string_view cell, bool decimal_comma);
/// The limits that a cell of sizes gives, in its unit: a number gives one, "20-45" both, "<20" and "pan" the upper one
/// (none for a pan), ">90" the lower one.
struct ExportSize {
    enum class Kind { point, range, below, above, pan } kind = Kind::point;
    double low = 0, high = 0;
    std::string unit;
};
[[nodiscard]] std::optional<ExportSize> export_size(std::string_view cell, bool decimal_comma);

/// Which columns hold what, as their headers and the choices say.
struct ExportColumns {
    std::size_t size = 0, share = 0;
    std::optional<std::size_t> upper;   ///< a second column of sizes: upper edges
    std::string unit;                   ///< of sizes
    std::string unit_from, share_name;  ///< for a reader
    std::optional<std::string> as;      ///< passing, retained, each, or sum: passing or retained
    std::optional<std::string> by;      ///< volume or number
    bool percent = false, weighed = false, sieved = false;
};
[[nodiscard]] ExportColumns export_columns(const ExportGrid& grid, const ExportChoices& choices);

}  // namespace grainsweep::campaign
