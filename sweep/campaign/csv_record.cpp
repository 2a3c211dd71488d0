#include "sweep/campaign/csv_record.hpp"

#include "solver/plain_text.hpp"

#include <algorithm>
#include <cstddef>

namespace grainsweep::campaign {

CsvRecord take_csv_record(std::string_view& rest, char separator) {
    CsvRecord record(1);
    bool quoted = false;
    std::size_t k = 0;
    for (; k < rest.size(); ++k) {
        const char c = rest[k];
        if (quoted && c == '"' && k + 1 < rest.size() && rest[k + 1] == '"') {
            record.back() += rest[++k];
        } else if (c == '"') {
            quoted = !quoted;
        } else if (!quoted && c == separator) {
            record.emplace_back();
        } else if (!quoted && c == '\n') {
            break;
        } else if (quoted || c != '\r') {
            record.back() += c;
        }
    }
    rest.remove_prefix(std::min(k + 1, rest.size()));
    for (auto& cell : record) cell = trimmed(cell);
    return record;
}

}  // namespace grainsweep::campaign
