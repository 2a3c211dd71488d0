// Where pages go: `report -o`, `--watch`.
#pragma once

#include <string>
#include <string_view>

namespace grainsweep::cli {

/// Throws WrongQuestion, naming the option, where no page can be: a folder, no such folder, no permission, a file of
/// the database (empty: there is none). A file that is there and is no page belongs to the user: a campaign file, say.
void check_page_file(std::string_view option, const std::string& output, const std::string& database);

/// The page in its place when whole, so that a failure leaves what was there; straight into what is no file.
/// Throws BrokenWorld.
void write_page_file(const std::string& output, const std::string& page);

}  // namespace grainsweep::cli
