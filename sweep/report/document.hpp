// An answer in every form in which a command shows it: text for people, rows (CSV) and one value (JSON) for programs.
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
    bool alone = false;      ///< the rows name no campaign: those of no other document come below them
    bool converged = false;  ///< by the rule of its campaign; of a calibration: it has a posterior

    /// A line of the text, or several; the end of the last one may be there.
    Document& say(std::string line = "");
    Document& say_notes(const std::vector<std::string>& notes);
    /// A table of the text.
    Document& show(store::Table table);
};

void write(std::ostream& out, const Document& document, Format format);

/// One after the other: text with an empty line between them, the rows in one table, a list of values.
void write(std::ostream& out, std::span<const Document> documents, Format format);

}  // namespace grainsweep::report
