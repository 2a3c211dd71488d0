// Rows of a table in Markdown.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace grainsweep::tests {

/// A cell must not break its row.
[[nodiscard]] inline std::string escaped(const std::string& text) {
    std::string cell;
    for (const char c : text) cell += c == '|' ? std::string("\\|") : std::string(1, c);
    return cell;
}

[[nodiscard]] inline std::string row(const std::vector<std::string>& cells) {
    std::string line = "|";
    for (const auto& cell : cells) line += " " + escaped(cell) + " |";
    return line + "\n";
}

[[nodiscard]] inline std::string head(const std::vector<std::string>& cells) {
    std::string rule = "|";
    for (std::size_t k = 0; k < cells.size(); ++k) rule += "---|";
    return row(cells) + rule + "\n";
}

/// As code; nothing stays nothing.
[[nodiscard]] inline std::string code(const std::string& text) {
    return text.empty() ? "" : "`" + text + "`";
}

}  // namespace grainsweep::tests
