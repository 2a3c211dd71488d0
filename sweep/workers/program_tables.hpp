// Numbers in the tables and the standard output of a program. A missing or invalid number throws std::invalid_argument
// with a sentence that names file and place.
#pragma once

#include "sweep/workers/program_folder.hpp"

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::workers {

inline constexpr std::size_t largest_table = std::size_t{64} << 20U;
/// Largest number of values of a series or profile.
inline constexpr std::size_t most_values = 500'000;

/// Error: a value is absent, or NaN; it is neither unreadable nor ambiguous.
class NoValue : public std::invalid_argument {
public:
    using std::invalid_argument::invalid_argument;
};

/// Table whose columns have names. The names stand in the first line without #, or, if that line has only numbers, in
/// the last line with # before it. Empty lines and other lines that begin with # are skipped. Rows below further names,
/// as of a second table, are refused.
class ProgramTable {
public:
    /// `separator`: comma, semicolon, tab or blank.
    ProgramTable(std::string file, std::string text, std::string separator);

    /// Returns a value. Rows count from 0; negative rows count from the end.
    [[nodiscard]] double value(const std::string& column, std::int64_t row) const;
    [[nodiscard]] std::vector<double> column(const std::string& name) const;

private:
    /// Takes the names of the columns from the first line without #, or from the remark before it. Returns whether the
    /// line had the names.
    bool take_head(std::string_view line, std::string_view remark);
    /// Notes the place of a line that names other columns than the head.
    void note_other_head(std::string_view line);
    [[nodiscard]] std::vector<std::string> cells_of(std::string_view line) const;
    [[nodiscard]] std::size_t place_of(const std::string& column) const;
    [[nodiscard]] double number(std::size_t row, std::size_t place, const std::string& column) const;

    std::string file_, text_, separator_;
    std::vector<std::string> names_;
    std::vector<std::string_view> rows_;
    std::string_view other_head_;       ///< first line below rows that names other columns
    std::size_t rows_of_the_head_ = 0;  ///< above it
};

/// Returns the first group of the regular expression in the last matching line of standard output.
[[nodiscard]] double last_in_output(const ProgramFolder& folder, const std::string& pattern);

}  // namespace grainsweep::workers
