#include "sweep/report/file_size.hpp"

#include <fmt/format.h>

#include <array>
#include <system_error>

namespace grainsweep::report {

std::string size_text(std::uintmax_t bytes) {
    constexpr std::array units = {"B", "kB", "MB", "GB", "TB"};
    auto size = static_cast<double>(bytes);
    std::size_t unit = 0;
    while (size >= 999.5 && unit + 1 < units.size()) {  // 999.6 would be shown as 1000
        size /= 1000;
        ++unit;
    }
    return unit > 0 && size < 9.95 ? fmt::format("{:.1f} {}", size, units[unit])
                                   : fmt::format("{:.0f} {}", size, units[unit]);
}

std::string named_with_size(const std::filesystem::path& file) {
    std::error_code none;
    const auto bytes = std::filesystem::file_size(file, none);
    return none ? file.string() : fmt::format("{} ({})", file.string(), size_text(bytes));
}

}  // namespace grainsweep::report
