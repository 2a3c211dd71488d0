#include "sweep/cli/figure_file.hpp"

#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/quantity.hpp"
#include "sweep/cli/page_file.hpp"

#include <fmt/format.h>

#include <variant>

namespace grainsweep::cli {

using plot::FileType;

void declare_figure_file(Parser& parser, FigureFile& file) {
    parser.add_option("-o,--output FILE", file.output, "file to write; ends in .pdf, .svg or .png");
    parser.add_option("--width LENGTH", file.width, "width of the figure; default: 85mm, a column of most journals");
}

double width_in_mm(const FigureFile& file) {
    constexpr double narrowest = 40, widest = 400;
    const std::string rule =
        fmt::format("must be a length from {:.0f} to {:.0f} mm, such as 85mm or 17cm", narrowest, widest);
    const auto refuse = [&](const std::string& why) {
        throw campaign::input_error("--width", fmt::format("'{}'", file.width), why);
    };
    if (file.width.find_first_not_of("0123456789.+-eE ") == std::string::npos) refuse(rule);  // a number has no unit
    const auto metres = campaign::in_si(file.width, "m");
    if (std::holds_alternative<std::string>(metres)) refuse(rule);
    const double mm = 1000 * std::get<double>(metres);
    if (!(mm >= narrowest && mm <= widest)) refuse(rule);
    return mm;
}

FileType figure_type(const FigureFile& file, const std::string& database) {
    if (file.output.empty()) throw campaign::input_error("-o", "", "name a file that ends in .pdf, .svg or .png");
    const auto type = plot::file_type(file.output);
    if (!type) throw campaign::input_error("-o", fmt::format("'{}'", file.output), "must end in .pdf, .svg or .png");
    static constexpr FileKind pdf{"PDF file", "%pdf-"}, svg{"SVG file", "<?xml"}, png{"PNG file", "\x89png"};
    check_page_file("-o", file.output, database, *type == FileType::pdf ? pdf : *type == FileType::svg ? svg : png);
    return *type;
}

std::size_t write_figure(const FigureFile& file, const plot::Figure& figure, const std::string& database) {
    const auto bytes = plot::drawn(figure, width_in_mm(file), figure_type(file, database));
    write_page_file(file.output, bytes);
    return bytes.size();
}

}  // namespace grainsweep::cli
