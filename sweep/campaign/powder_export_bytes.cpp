// From the bytes of an export to text in UTF-8.
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/powder_export.hpp"
#include "sweep/campaign/workbook.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace grainsweep::campaign {
namespace {

void append_utf8(std::string& text, std::uint32_t point) {
    const auto byte = [&](std::uint32_t bits) { text += static_cast<char>(bits); };
    if (point < 0x80U) return byte(point);
    if (point < 0x800U) return byte(0xC0U | point >> 6U), byte(0x80U | (point & 0x3FU));
    if (point < 0x10000U) {
        byte(0xE0U | point >> 12U), byte(0x80U | (point >> 6U & 0x3FU)), byte(0x80U | (point & 0x3FU));
        return;
    }
    byte(0xF0U | point >> 18U), byte(0x80U | (point >> 12U & 0x3FU));
    byte(0x80U | (point >> 6U & 0x3FU)), byte(0x80U | (point & 0x3FU));
}

bool is_utf8(std::string_view text) {
    for (std::size_t k = 0; k < text.size();) {
        const auto lead = static_cast<unsigned char>(text[k]);
        const std::size_t length = lead < 0x80U            ? 1
                                   : (lead >> 5U) == 0x6U  ? 2
                                   : (lead >> 4U) == 0xEU  ? 3
                                   : (lead >> 3U) == 0x1EU ? 4
                                                           : 0;
        if (length == 0 || k + length > text.size()) return false;
        for (std::size_t j = 1; j < length; ++j)
            if ((static_cast<unsigned char>(text[k + j]) >> 6U) != 0x2U) return false;
        k += length;
    }
    return true;
}

std::string from_utf16(std::string_view bytes, bool little) {
    std::string text;
    std::uint32_t high = 0;
    for (std::size_t k = 0; k + 1 < bytes.size(); k += 2) {
        const auto first = static_cast<unsigned char>(bytes[k]), second = static_cast<unsigned char>(bytes[k + 1]);
        const std::uint32_t unit = little ? second * 256U + first : first * 256U + second;
        if (unit >= 0xD800U && unit < 0xDC00U) {
            high = unit;
        } else {
            const bool low = unit >= 0xDC00U && unit < 0xE000U;
            append_utf8(text, low ? 0x10000U + ((high & 0x3FFU) << 10U) + (unit & 0x3FFU) : unit);
        }
    }
    return text;
}

/// Whether most of every second byte is 0, as of UTF-16 without a byte order mark.
bool has_zeros(std::string_view bytes, std::size_t first) {
    std::size_t zeros = 0;
    const std::size_t looked_at = std::min<std::size_t>(bytes.size(), 1000);
    for (std::size_t k = first; k < looked_at; k += 2) zeros += bytes[k] == '\0' ? 1 : 0;
    return looked_at >= 8 && zeros * 10 > looked_at * 4;
}

/// Returns the text in UTF-8, and its original encoding.
ExportText decoded(std::string_view bytes) {
    if (bytes.starts_with("\xFF\xFE")) return {"UTF-16", {}, from_utf16(bytes.substr(2), true)};
    if (bytes.starts_with("\xFE\xFF")) return {"UTF-16", {}, from_utf16(bytes.substr(2), false)};
    if (has_zeros(bytes, 1)) return {"UTF-16", {}, from_utf16(bytes, true)};
    if (has_zeros(bytes, 0)) return {"UTF-16", {}, from_utf16(bytes, false)};
    if (bytes.starts_with("\xEF\xBB\xBF")) return {"UTF-8 with a byte order mark", {}, std::string(bytes.substr(3))};
    if (is_utf8(bytes)) return {"UTF-8", {}, std::string(bytes)};
    std::string text;
    for (const char c : bytes)  // the dashes of Windows-1252 lie among the controls of Latin-1
        append_utf8(text, c == '\x96' || c == '\x97' ? '-' : static_cast<unsigned char>(c));
    return {"Latin-1", {}, text};
}

}  // namespace

std::vector<ExportText> export_texts(std::string_view bytes) {
    const auto refuse = [](const char* why) { return input_error("EXPORT", "", why); };
    if (bytes.starts_with("\xD0\xCF\x11\xE0"))
        throw refuse("this is a workbook of an old Excel (.xls): save it as .xlsx or as CSV");
    if (bytes.starts_with("%PDF")) throw refuse("this is a report (PDF): export the table of the instrument as text");
    if (bytes.starts_with("{\\rtf")) throw refuse("this is a document (RTF): save the table as text or CSV");
    if (!is_archive(bytes)) return {decoded(bytes)};
    std::vector<ExportText> texts;
    for (auto& sheet : workbook_sheets(bytes))
        texts.push_back({"Excel workbook, sheet '" + sheet.name + "'", sheet.name, std::move(sheet.text)});
    return texts;
}

}  // namespace grainsweep::campaign
