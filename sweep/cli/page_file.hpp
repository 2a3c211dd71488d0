// Where pages, figures and workbooks go: `report -o`, `--watch`, `figure -o`, `query -o`.
#pragma once

#include <string>
#include <string_view>

namespace grainsweep::cli {

/// A kind of file that the program writes: its word, and how such a file starts, without regard to case.
struct FileKind {
    std::string_view word, start;
};
inline constexpr FileKind html_page{"page", "<!doctype html>"};

/// Throws WrongQuestion, naming the option, where no page can be: a folder, no such folder, no permission, a file of
/// the database (empty: there is none). A file that is there and is of another kind belongs to the user: a campaign
/// file, say.
void check_page_file(std::string_view option, const std::string& output, const std::string& database,
                     const FileKind& kind = html_page);

/// The page in its place when whole, so that a failure leaves what was there; straight into what is no file.
/// Throws BrokenWorld.
void write_page_file(const std::string& output, const std::string& page);

}  // namespace grainsweep::cli
