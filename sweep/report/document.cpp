#include "sweep/report/document.hpp"

#include <algorithm>
#include <ostream>
#include <utility>

namespace grainsweep::report {
namespace {

void write_lines_and_tables(std::ostream& out, const Document& document) {
    for (const auto& part : document.text)
        if (const auto* line = std::get_if<std::string>(&part))
            out << *line << '\n';
        else
            write(out, std::get<store::Table>(part), Format::text);
}

store::Table rows_of_all(std::span<const Document> documents) {
    if (documents.empty()) return {};
    store::Table all = documents.front().rows;
    if (documents.front().alone) return all;
    for (const auto& document : documents.subspan(1))
        if (!document.alone) all.rows.insert(all.rows.end(), document.rows.rows.begin(), document.rows.rows.end());
    return all;
}

}  // namespace

Document& Document::say(std::string line) {
    if (line.ends_with('\n')) line.pop_back();
    text.emplace_back(std::move(line));
    return *this;
}

Document& Document::say_notes(const std::vector<std::string>& notes) {
    for (const auto& note : notes) say("note: " + note);
    return *this;
}

Document& Document::show(store::Table table) {
    text.emplace_back(std::move(table));
    return *this;
}

void write(std::ostream& out, const Document& document, Format format) {
    if (format == Format::text) write_lines_and_tables(out, document);
    if (format == Format::csv) write(out, document.rows, format);
    if (format == Format::json) write(out, document.value);
}

void write(std::ostream& out, std::span<const Document> documents, Format format) {
    if (format == Format::csv) return write(out, rows_of_all(documents), format);
    if (format == Format::json) return write(out, Json::list(documents, &Document::value));
    for (std::size_t k = 0; k < documents.size(); ++k) {
        if (k > 0) out << '\n';
        write_lines_and_tables(out, documents[k]);
    }
}

}  // namespace grainsweep::report
