// Output files for pages, figures and workbooks: `report -o`, `--watch`, `figure -o`, `query -o`.
#pragma once

#include <string>
#include <string_view>

namespace grainsweep::cli {

/// Kind of output file: its name, and the start of such a file in any case.
struct FileKind {
    std::string_view word, start;
};
inline constexpr FileKind html_page{"page", "<!doctype html>"};

/// Throws InputError with the option if the page cannot be written: the output is a folder, its folder is missing,
/// or there is no permission. Files of `database` (empty: none) and existing files of another kind, such as a campaign
/// file, are refused, too.
void check_page_file(std::string_view option, const std::string& output, const std::string& database,
                     const FileKind& kind = html_page);

/// Throws the same for -o of a command that converts a file, and if -o is missing or names the file itself; `input`:
/// its path, `kind_of_input`: "export".
void check_converted_file(const std::string& output, const std::string& input, std::string_view kind_of_input,
                          const FileKind& kind);

/// Writes the page and then moves it to its place, so that a failure leaves an existing file unchanged; writes directly
/// to devices and pipes. Throws SystemError.
void write_page_file(const std::string& output, const std::string& page);

}  // namespace grainsweep::cli
