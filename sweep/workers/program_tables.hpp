// Numbers in the tables and in the standard output that a program left. What is not there or no number throws
// std::invalid_argument with a sentence that names file and place.
#pragma once

#include "sweep/workers/program_folder.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::workers {

inline constexpr std::size_t largest_table = std::size_t{64} << 20U;
/// Values of a series or profile.
inline constexpr std::size_t most_values = 500'000;

/// Columns with names: in the first line without #, or, where that has numbers only, in the last line with # before it.
/// Empty lines and other lines that begin with # are passed over.
class ProgramTable {
public:
    /// `separator`: comma, semicolon, tab or blank.
    ProgramTable(std::string file, std::string text, std::string separator);

    /// Of a row from 0, or from the end where it is negative.
    [[nodiscard]] double value(const std::string& column, std::int64_t row) const;
    [[nodiscard]] std::vector<double> column(const std::string& name) const;

private:
    /// The names of the columns, from the first line without # or the remark before it; whether it was the line.
    bool take_head(std::string_view line, std::string_view remark);
    [[nodiscard]] std::vector<std::string> cells_of(std::string_view line) const;
    [[nodiscard]] std::size_t place_of(const std::string& column) const;
    [[nodiscard]] double number(std::size_t row, std::size_t place, const std::string& column) const;

    std::string file_, text_, separator_;
    std::vector<std::string> names_;
    std::vector<std::string_view> rows_;
};

/// The first group of the expression in the last line of standard output that has it.
[[nodiscard]] double last_in_output(const ProgramFolder& folder, const std::string& pattern);

}  // namespace grainsweep::workers
