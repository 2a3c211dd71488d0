#include "sweep/campaign/csv_text.hpp"

#include "sweep/campaign/wrong_question.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

namespace grainsweep::campaign {

namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t largest_file = 256ULL << 20U;

}  // namespace

std::string read_csv_text(const Cursor& file, const fs::path& path) {
    std::error_code error;
    if (!fs::is_regular_file(path, error)) file.refuse("there is no such file beside the campaign file");
    if (fs::file_size(path, error) > largest_file || error)
        file.refuse("the file must be readable and at most 256 MiB");
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(path.c_str(), "rb"), std::fclose);
    if (!stream) file.refuse(fmt::format("'{}' cannot be read: {}", path.string(), std::strerror(errno)));
    std::string text;
    std::array<char, 65536> part{};
    for (std::size_t got = 1; got > 0;) {
        got = std::fread(part.data(), 1, part.size(), stream.get());
        text.append(part.data(), got);
    }
    if (std::ferror(stream.get()) != 0) {  // what was read is a part, and would pass for a shorter list
        const std::string why = std::strerror(errno);
        file.refuse(fmt::format("'{}' cannot be read beyond line {}: {}", path.string(),
                                1 + std::ranges::count(text, '\n'), why));
    }
    constexpr std::string_view utf8_mark = "\xEF\xBB\xBF";
    if (text.starts_with(utf8_mark)) text.erase(0, utf8_mark.size());
    return text;
}

}  // namespace grainsweep::campaign
