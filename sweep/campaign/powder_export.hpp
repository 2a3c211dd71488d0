// Import of powder sizes from exports of instruments and sieve sheets, as a table for scenes.
//
// Recognised forms:
//
//   files     text in UTF-8, UTF-16 and Latin-1; Excel workbooks (.xlsx)
//   tables    any lines before and behind; several tables or samples; rows of numbers with a name in front
//   columns   separated by semicolons, tabs, commas or blanks; repeated groups of columns; classes of two columns
//   numbers   decimal points and commas, marks of thousands
//   sizes     rising and falling; classes "20-45", "<20", "-40+60 mesh"; the pan of a sieve tower, also as size 0;
//             um, mm, nm, inches, numbers of sieves (ASTM E11, Tyler, BS 410), phi
//
// Information that the file does not contain must be given as a choice; the refusal names the missing choice.
// Percentiles that the file states are compared to the imported ones.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace grainsweep::campaign {

/// Choices of the user about an export; absent: as in the file.
struct ExportChoices {
    std::optional<std::string> sizes = {}, shares = {};      ///< columns, by number from 1 or by header
    std::optional<std::string> unit = {};                    ///< of the sizes: "um", "phi" or a series of sieves
    std::optional<std::string> as = {};                      ///< passing, retained (cumulative) or each
    std::optional<std::string> by = {};                      ///< volume, mass, area or number
    std::optional<std::string> edge = {};                    ///< position of a size in its class: lower, upper or
                                                             ///< middle
    std::optional<std::string> smallest = {}, largest = {};  ///< sizes that end the table, with their unit
    std::optional<std::string> sample = {};                  ///< of several: its name or number
};

/// Imported table of sizes, with the recognised properties.
struct ImportedSizes {
    std::string csv;       ///< header and lines of diameter (m) and share below it, from 0 to 1
    std::string sentence;  ///< description of the import
    std::vector<std::pair<std::string, std::string>> facts;  ///< property and value found
    std::vector<std::string> notes;                          ///< changes made by the import
    std::vector<std::string> warnings;                       ///< contradictions between the file and the import
};

/// Imports an export. Throws InputError with one sentence, which names the option for missing information. Shares
/// that end within 1 % of their whole are normalised, and up to 1 % without a size at an end is left out; both add a
/// note.
[[nodiscard]] ImportedSizes import_sizes(std::string_view bytes, const ExportChoices& choices);

/// Words of --as, --by and --edge.
inline constexpr std::array<std::string_view, 3> export_as = {"passing", "retained", "each"};
inline constexpr std::array<std::string_view, 4> export_by = {"volume", "mass", "area", "number"};
inline constexpr std::array<std::string_view, 3> export_edges = {"lower", "upper", "middle"};

// Steps of the import, internal.

/// Throws InputError about the export.
[[noreturn]] void refuse_export(const std::string& why);
/// Returns whether a text holds one of the words.
[[nodiscard]] bool has_word(std::string_view text, std::span<const std::string_view> words);

/// Text of an export, or of one sheet of a workbook, in UTF-8.
struct ExportText {
    std::string encoding, sheet, text;
};
/// Returns the texts of an export. Throws InputError for other kinds of files.
[[nodiscard]] std::vector<ExportText> export_texts(std::string_view bytes);

/// Numeric block of an export and the lines around it.
struct ExportGrid {
    std::string encoding;
    std::string sheet;  ///< of a workbook
    char separator = ',';
    bool decimal_comma = false;
    std::vector<std::size_t> lines;              ///< of every row, from 1
    std::vector<std::vector<std::string>> rows;  ///< all of the same length
    std::vector<std::string> headers;            ///< of every column, as written; empty: none
    std::vector<std::size_t> numbers;            ///< of every column in the file, from 1
    std::vector<std::string> around;             ///< lines that describe this table, in small letters, "um" for a micro
                                                 ///< sign
    std::string words;                           ///< these lines as one text
    std::vector<std::string> notes;
    bool sample_chosen = false;  ///< by --sample: a table, or rows
};

/// Finds the table of sizes and shares. Throws InputError if there is none, or several without a choice.
[[nodiscard]] ExportGrid export_grid(std::string_view bytes, const ExportChoices& choices);
/// Returns the text in small letters, with "um" for a micro sign and "ss", "ae", "oe", "ue" for German letters.
[[nodiscard]] std::string plain_words(std::string_view text);
/// Returns um, mm, nm, m, cm or in for a word that means one of them; else an empty text.
[[nodiscard]] std::string length_unit(std::string_view word);
/// Number at the start of a cell, and the text behind it. Empty: the cell is no number.
struct ExportNumber {
    double value = 0;
    std::string unit;
};
[[nodiscard]] std::optional<ExportNumber> export_number(std::string_view cell, bool decimal_comma);
/// Returns the number in a cell of the table; empty: it is no number.
[[nodiscard]] std::optional<double> number_at(const ExportGrid& grid, std::size_t row, std::size_t column);
/// Limits of a cell of sizes, in its unit: a number gives one, "20-45" both, "<20" and "pan" the upper one (without a
/// value for a pan), ">90" the lower one.
struct ExportSize {
    enum class Kind { point, range, below, above, pan } kind = Kind::point;
    double low = 0, high = 0;
    std::string unit = {};     ///< stated by the cell
    bool retained_on = false;  ///< "+40": above it
};
[[nodiscard]] std::optional<ExportSize> export_size(std::string_view cell, bool decimal_comma);

/// Meaning of a header by its words.
struct ExportHeading {
    std::string plain;
    bool share = false, size = false;
    bool density = false;     ///< per length or per logarithm, neither a share nor a sum
    bool percentile = false;  ///< column of percents at which sizes are given
    bool ignored = false;     ///< numbers of rows
    bool with_sieve = false;  ///< weights of sieves, empty or with what they hold
    bool sieve_number = false;
    bool radius = false;                          ///< sizes are radii
    std::string length;                           ///< unit of sizes; empty: none
    std::optional<std::string> as = {}, by = {};  ///< as: also "sum", which is passing or retained
};
[[nodiscard]] ExportHeading export_heading(const std::string& header);

/// Meaning of the columns, by their headers and the choices.
struct ExportColumns {
    std::size_t size = 0, share = 0;
    std::optional<std::size_t> upper = {};  ///< a second column of sizes: upper edges
    std::string unit;                       ///< of sizes without their own unit; empty: none is needed
    std::string unit_from, share_name;      ///< for messages
    std::optional<std::string> as = {};     ///< passing, retained, each, or sum: passing or retained
    std::optional<std::string> by = {};     ///< volume, area or number
    std::optional<std::string> edge = {};   ///< lower or upper, by the header of the sizes
    bool percent = false, weighed = false, sieved = false;
    bool radius = false;  ///< sizes are radii
};
[[nodiscard]] ExportColumns export_columns(const ExportGrid& grid, const ExportChoices& choices);
/// Returns "2 'Volume (%)'": number and header of columns.
[[nodiscard]] std::string column_list(const ExportGrid& grid, const std::vector<std::size_t>& columns);

/// Shares below rising sizes (m) as parts of the whole.
struct ExportCurve {
    std::vector<double> sizes, below;

    [[nodiscard]] double quantile(double share) const;
};

/// Percentile that the lines around a table state.
struct StatedPercentile {
    double share = 0;
    std::vector<double> sizes;      ///< possible readings, of several samples all, m
    std::string name;               ///< as "dx (50) 620 um"
    std::optional<std::string> by;  ///< volume or number
};
/// Returns the percentiles that the lines around a table state; sizes without a unit have that of the table.
[[nodiscard]] std::vector<StatedPercentile> stated_percentiles(const ExportGrid& grid, const std::string& unit);
/// Returns whether the curve may pass its share at the stated size: the class of sizes that holds the share must hold
/// the size, within the rounding of both.
[[nodiscard]] bool agrees(const ExportCurve& curve, const StatedPercentile& stated);

}  // namespace grainsweep::campaign
