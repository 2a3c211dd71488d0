#include "sweep/campaign/csv_text.hpp"

#include "sweep/campaign/input_error.hpp"
#include "sweep/files/whole_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

namespace grainsweep::campaign {

namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t largest_table = 256ULL << 20U;

}  // namespace

std::string read_csv_text(const Cursor& file, const fs::path& path) {
    std::error_code error;
    if (!fs::is_regular_file(path, error)) file.refuse("there is no such file beside the campaign file");
    if (fs::file_size(path, error) > largest_table || error)
        file.refuse("the file must be readable and at most 256 MiB");
    std::string text = files::whole_file(path, error);
    if (error)  // the rows read so far are only a part, but would look like a shorter list
        file.refuse(fmt::format("'{}' cannot be read beyond line {}: {}", path.string(),
                                1 + std::ranges::count(text, '\n'), error.message()));
    return text;
}

}  // namespace grainsweep::campaign
