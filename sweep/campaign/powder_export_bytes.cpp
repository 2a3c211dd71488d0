// From the bytes of an export to text in UTF-8.
//
// Of a workbook the parts that hold cells are read: the archive (PKWARE APPNOTE 6.3, methods stored and deflate), the
// list of sheets, the shared strings, the sheets. Styles, formulas and dates are not read: a cell is its stored value.
#include "sweep/campaign/powder_export.hpp"

#include "solver/plain_text.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>

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

constexpr std::size_t largest_part = 64U << 20U;  // of an unpacked file; an export has less than 1 MiB
constexpr std::size_t most_rows = 100'000, most_columns = 4096;

std::uint32_t little_endian(std::string_view bytes, std::size_t at, std::size_t count) {
    if (at + count > bytes.size()) refuse_export("this archive ends early: save the workbook again");
    std::uint32_t value = 0;
    for (std::size_t k = 0; k < count; ++k)
        value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + k])) << 8U * k;
    return value;
}

std::string inflated(std::string_view packed, std::size_t size) {
    if (size > largest_part) refuse_export("a sheet of this workbook is larger than 64 MiB");
    std::string text(size, '\0');
    z_stream stream{};
    if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) refuse_export("this workbook cannot be unpacked");
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
    stream.avail_in = static_cast<uInt>(packed.size());
    stream.next_out = reinterpret_cast<Bytef*>(text.data());
    stream.avail_out = static_cast<uInt>(text.size());
    const int end = inflate(&stream, Z_FINISH);
    inflateEnd(&stream);
    if (end != Z_STREAM_END || stream.total_out != size)
        refuse_export("this workbook is damaged: save it again, or as CSV");
    return text;
}

/// Files of an archive by name, from its directory at the end.
class ZipArchive {
public:
    explicit ZipArchive(std::string_view bytes) : bytes_(bytes) {
        constexpr std::size_t end_size = 22;
        const auto end = bytes.rfind("PK\x05\x06");
        if (end == std::string_view::npos || end + end_size > bytes.size())
            refuse_export("this archive ends early: save the workbook again");
        std::size_t at = little_endian(bytes, end + 16, 4);
        for (std::uint32_t left = little_endian(bytes, end + 10, 2); left > 0; --left) {
            const std::size_t name = little_endian(bytes, at + 28, 2);
            const std::size_t behind = little_endian(bytes, at + 30, 2) + little_endian(bytes, at + 32, 2);
            if (at + 46 + name > bytes.size()) refuse_export("this archive is damaged: save the workbook again");
            entries_[std::string(bytes.substr(at + 46, name))] = at;
            at += 46 + name + behind;
        }
    }
    [[nodiscard]] bool has(const std::string& name) const { return entries_.contains(name); }
    [[nodiscard]] std::string file(const std::string& name) const {
        const auto entry = entries_.find(name);
        if (entry == entries_.end()) return {};
        const std::size_t at = entry->second;
        const std::size_t packed = little_endian(bytes_, at + 20, 4), size = little_endian(bytes_, at + 24, 4);
        const std::size_t local = little_endian(bytes_, at + 42, 4);
        const std::size_t begin =
            local + 30 + little_endian(bytes_, local + 26, 2) + little_endian(bytes_, local + 28, 2);
        if (begin + packed > bytes_.size()) refuse_export("this archive is damaged: save the workbook again");
        const auto data = bytes_.substr(begin, packed);
        const auto method = little_endian(bytes_, at + 10, 2);
        if (method == 0) return std::string(data);
        if (method != 8) refuse_export("this archive is packed in a way that no workbook is: save it as CSV");
        return inflated(data, size);
    }

private:
    std::string_view bytes_;
    std::map<std::string, std::size_t, std::less<>> entries_;
};

/// XmlTag of an XML text with the text behind it, up to the next tag.
struct XmlTag {
    std::string_view name, attributes, behind;
    bool closes = false, empty = false;
};

/// Steps through the tags of an XML text; prefixes of namespaces are dropped.
class XmlTags {
public:
    explicit XmlTags(std::string_view xml) : rest_(xml) {}
    [[nodiscard]] std::optional<XmlTag> next() {
        const auto open = rest_.find('<');
        if (open == std::string_view::npos) return std::nullopt;
        const auto close = rest_.find('>', open);
        if (close == std::string_view::npos) return std::nullopt;
        std::string_view inside = rest_.substr(open + 1, close - open - 1);
        rest_.remove_prefix(close + 1);
        XmlTag tag;
        tag.behind = rest_.substr(0, rest_.find('<'));
        if (inside.starts_with('/')) tag.closes = true, inside.remove_prefix(1);
        if (inside.ends_with('/')) tag.empty = true, inside.remove_suffix(1);
        const auto blank = std::min(inside.find_first_of(" \t\r\n"), inside.size());
        tag.name = inside.substr(0, blank);
        tag.attributes = inside.substr(blank);
        if (const auto colon = tag.name.find(':'); colon != std::string_view::npos) tag.name.remove_prefix(colon + 1);
        return tag;
    }

private:
    std::string_view rest_;
};

/// Returns the text with its entities replaced, on one line.
std::string plain_xml(std::string_view xml) {
    std::string text;
    for (std::size_t k = 0; k < xml.size(); ++k) {
        const auto end = xml[k] == '&' ? xml.find(';', k) : std::string_view::npos;
        if (end == std::string_view::npos) {
            const bool blank = xml[k] == '\n' || xml[k] == '\r' || xml[k] == '\t';
            text += blank ? ' ' : xml[k];
            continue;
        }
        const auto entity = xml.substr(k + 1, end - k - 1);
        constexpr std::pair<std::string_view, char> named[] = {
            {"amp", '&'}, {"lt", '<'}, {"gt", '>'}, {"quot", '"'}, {"apos", '\''}};
        for (const auto& [name, letter] : named)
            if (entity == name) text += letter;
        if (entity.starts_with('#')) {
            const bool hexadecimal = entity.starts_with("#x");
            const auto digits = entity.substr(hexadecimal ? 2 : 1);
            std::uint32_t point = 0;
            std::from_chars(digits.data(), digits.data() + digits.size(), point, hexadecimal ? 16 : 10);
            append_utf8(text, point < 0x20U || point > 0x10FFFFU ? ' ' : point);
        }
        k = end;
    }
    return text;
}

std::string attribute(const XmlTag& tag, std::string_view name) {
    const auto at = tag.attributes.find(fmt::format(" {}=\"", name));
    if (at == std::string_view::npos) return {};
    const auto from = at + name.size() + 3;
    return plain_xml(tag.attributes.substr(from, tag.attributes.find('"', from) - from));
}

std::vector<std::string> shared_strings(const std::string& xml) {
    std::vector<std::string> strings;
    bool phonetic = false;
    for (XmlTags tags(xml); const auto tag = tags.next();) {
        if (tag->name == "si" && !tag->closes) strings.emplace_back();
        if (tag->name == "rPh") phonetic = !tag->closes;
        if (tag->name == "t" && !tag->closes && !phonetic && !strings.empty()) strings.back() += plain_xml(tag->behind);
    }
    return strings;
}

/// Row and column from 0 of a reference such as "B12"; absent: no reference.
std::optional<std::pair<std::size_t, std::size_t>> cell_place(std::string_view reference) {
    std::size_t column = 0, row = 0, k = 0;
    for (; k < reference.size() && reference[k] >= 'A' && reference[k] <= 'Z' && k < 4; ++k)
        column = column * 26 + static_cast<std::size_t>(reference[k] - 'A' + 1);
    const auto digits = reference.substr(k);
    if (column == 0 || std::from_chars(digits.data(), digits.data() + digits.size(), row).ec != std::errc() || row == 0)
        return std::nullopt;
    return std::pair(row - 1, column - 1);
}

/// A number as it was typed: 99.82, stored as 99.81999999999999.
std::string typed_number(const std::string& stored) {
    const auto number = number_in(stored);
    return number ? fmt::format("{:.15g}", *number) : stored;
}

/// SheetCells of a sheet as they are met.
class SheetCells {
public:
    void begin(const XmlTag& tag) {
        kind_ = attribute(tag, "t");
        if (const auto place = cell_place(attribute(tag, "r"))) {
            row_ = place->first, column_ = place->second;
        } else {
            ++column_;
        }
        if (row_ >= most_rows || column_ >= most_columns) refuse_export("this sheet is too large for an export");
    }
    void begin_row(const XmlTag& tag) {
        const auto number = number_in(attribute(tag, "r"));
        row_ = number && *number >= 1 && *number <= static_cast<double>(most_rows)
                   ? static_cast<std::size_t>(*number) - 1
                   : lines_.size();
        column_ = static_cast<std::size_t>(-1);
    }
    void value(std::string_view stored, const std::vector<std::string>& strings) {
        std::string text = plain_xml(stored);
        if (kind_ == "s") {
            const auto index = number_in(text);
            if (!index || *index < 0 || *index >= static_cast<double>(strings.size()))
                refuse_export("this workbook is damaged: a text of it is missing; save it again, or as CSV");
            text = strings[static_cast<std::size_t>(*index)];
        } else if (kind_.empty() || kind_ == "n") {
            text = typed_number(text);
        }
        append(text);
    }
    void append(const std::string& text) {
        if (lines_.size() <= row_) lines_.resize(row_ + 1);
        auto& line = lines_[row_];
        if (line.size() <= column_) line.resize(column_ + 1);
        line[column_] += text;
    }
    [[nodiscard]] std::string text() const {
        std::string all;
        for (const auto& line : lines_) {
            for (std::size_t k = 0; k < line.size(); ++k) all += (k > 0 ? "\t" : "") + line[k];
            all += '\n';
        }
        return all;
    }
    [[nodiscard]] bool inline_text() const { return kind_ == "inlineStr"; }

private:
    std::vector<std::vector<std::string>> lines_;
    std::size_t row_ = 0, column_ = 0;
    std::string kind_;
};

std::string sheet_text(const std::string& xml, const std::vector<std::string>& strings) {
    SheetCells cells;
    for (XmlTags tags(xml); const auto tag = tags.next();) {
        if (tag->closes) continue;
        if (tag->name == "row") cells.begin_row(*tag);
        if (tag->name == "c") cells.begin(*tag);
        if (tag->name == "v" && !tag->empty) cells.value(tag->behind, strings);
        if (tag->name == "t" && !tag->empty && cells.inline_text()) cells.append(plain_xml(tag->behind));
    }
    return cells.text();
}

/// Paths of the sheets by their ids.
std::map<std::string, std::string> sheet_paths(const std::string& relations) {
    std::map<std::string, std::string> paths;
    for (XmlTags tags(relations); const auto tag = tags.next();) {
        if (tag->name != "Relationship") continue;
        const std::string target = attribute(*tag, "Target");
        paths[attribute(*tag, "Id")] = target.starts_with('/') ? target.substr(1) : "xl/" + target;
    }
    return paths;
}

/// Returns the sheets of an Excel workbook (.xlsx, ECMA-376) that have cells, in its order: one line per row, tabs
/// between cells, numbers with decimal points. Throws InputError if the archive is damaged or holds no workbook.
std::vector<ExportText> workbook_sheets(std::string_view bytes) {
    const ZipArchive archive(bytes);
    if (!archive.has("xl/workbook.xml"))
        refuse_export(archive.has("content.xml") ? "this is an OpenDocument file: save the table as .xlsx or .csv"
                                                 : "this is an archive without an Excel workbook: unpack it first");
    const auto strings = shared_strings(archive.file("xl/sharedStrings.xml"));
    const auto paths = sheet_paths(archive.file("xl/_rels/workbook.xml.rels"));
    std::vector<ExportText> sheets;
    const std::string workbook = archive.file("xl/workbook.xml");
    std::size_t number = 0;  // of a sheet, from 1
    for (XmlTags tags(workbook); const auto tag = tags.next();) {
        if (tag->name != "sheet" || tag->closes) continue;
        ++number;
        const auto named = paths.find(attribute(*tag, "r:id"));
        const std::string path =
            named != paths.end() ? named->second : fmt::format("xl/worksheets/sheet{}.xml", number);
        if (!archive.has(path)) continue;
        std::string text = sheet_text(archive.file(path), strings);
        if (text.find_first_not_of("\t\n") == std::string::npos) continue;
        const std::string name = attribute(*tag, "name");
        sheets.push_back({"Excel workbook, sheet '" + name + "'", name, std::move(text)});
    }
    if (sheets.empty()) refuse_export("no sheet of this workbook has cells");
    return sheets;
}

}  // namespace

std::vector<ExportText> export_texts(std::string_view bytes) {
    if (bytes.starts_with("\xD0\xCF\x11\xE0"))
        refuse_export("this is a workbook of an old Excel (.xls): save it as .xlsx or as CSV");
    if (bytes.starts_with("%PDF")) refuse_export("this is a report (PDF): export the table of the instrument as text");
    if (bytes.starts_with("{\\rtf")) refuse_export("this is a document (RTF): save the table as text or CSV");
    const bool archive = bytes.starts_with("PK\x03\x04");
    return archive ? workbook_sheets(bytes) : std::vector{decoded(bytes)};
}

}  // namespace grainsweep::campaign
