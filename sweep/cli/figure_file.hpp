// Options and output file of a figure for print: `figure` and `accuracy`.
#pragma once

#include "sweep/cli/parser.hpp"
#include "sweep/plot/plot.hpp"

#include <string>

namespace grainsweep::cli {

struct FigureFile {
    std::string output, width = "85mm";
};

/// Adds -o and --width to a command.
void declare_figure_file(Parser& parser, FigureFile& file);

/// Returns the width in mm. Throws InputError for one that is no length from 40 to 400 mm.
[[nodiscard]] double width_in_mm(const FigureFile& file);
/// Returns the type of the file. Throws InputError if its name has another ending or it cannot be written;
/// `database` may not be overwritten.
[[nodiscard]] plot::FileType figure_type(const FigureFile& file, const std::string& database);

/// Draws and writes the figure. Returns the number of bytes.
std::size_t write_figure(const FigureFile& file, const plot::Figure& figure, const std::string& database);

}  // namespace grainsweep::cli
