// Result of a command in all its forms: text for people, rows (CSV) and one value (JSON) for programs.
#pragma once

#include "sweep/report/table.hpp"

#include <iosfwd>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace grainsweep::report {

struct Document {
    std::vector<std::variant<std::string, store::Table>> text = {};  ///< lines and tables
    store::Table rows = {};
    Json value = {};
    bool alone = false;      ///< the rows have no campaign column, so rows of other documents cannot follow
    bool converged = false;  ///< by the rule of its campaign; for a calibration: it has a posterior

    /// Appends one or several lines to the text, with or without a last line end.
    Document& say(std::string line = "");
    Document& say_notes(const std::vector<std::string>& notes);
    /// Appends a table to the text.
    Document& show(store::Table table);
};

void write(std::ostream& out, const Document& document, Format format);

/// Writes documents one after the other: texts with an empty line between them, rows in one table, or a list of values.
void write(std::ostream& out, std::span<const Document> documents, Format format);

}  // namespace grainsweep::report
