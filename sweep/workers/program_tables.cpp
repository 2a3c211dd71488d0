#include "sweep/workers/program_tables.hpp"

#include "solver/plain_text.hpp"
#include "sweep/campaign/csv_table.hpp"
#include "sweep/campaign/output_pattern.hpp"
#include "sweep/workers/worker_state.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <map>
#include <optional>
#include <regex>
#include <stdexcept>
#include <utility>

namespace grainsweep::workers {
namespace {

constexpr std::size_t most_columns = 10'000, most_rows = 10'000'000;
constexpr std::size_t longest_searched = 4096;                 // a search takes up to the square of its line's length
constexpr std::size_t largest_beyond = std::size_t{1} << 20U;  // kept of the rest of a line
constexpr std::chrono::minutes longest_search{10};

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

/// Fortran writes 1.0D+03, or 1.0Q+03, and 1.0-103 where the exponent has three digits.
std::string with_plain_exponent(std::string_view text) {
    std::string plain(text);
    const auto has_three_digits = [&plain](std::size_t sign) {
        return plain.size() == sign + 4 && std::all_of(plain.end() - 3, plain.end(), is_digit) &&
               plain.find('.') < sign;
    };
    for (std::size_t k = 1; k + 1 < plain.size(); ++k) {
        const bool after_number = is_digit(plain[k - 1]) || plain[k - 1] == '.';
        const bool letter = std::string_view("dDqQ").find(plain[k]) != std::string_view::npos;
        if (after_number && letter) plain[k] = 'e';
        if (after_number && (plain[k] == '+' || plain[k] == '-') && has_three_digits(k)) plain.insert(k, 1, 'e');
    }
    return plain;
}

/// With a sign, infinite or none, too, as programs write them.
std::optional<double> any_number_of(std::string_view text) {
    text = trimmed(text);
    if (text.starts_with('+')) text.remove_prefix(1);
    if (const auto number = any_number_in(text)) return number;
    return any_number_in(with_plain_exponent(text));
}

/// Group of a match, and the text around it that the expression did not match.
struct FoundText {
    FoundText(const std::smatch& parts, bool is_cut)
        : group(parts[1].str()), behind(parts[1].second, parts.suffix().second), cut(is_cut && behind.empty()) {
        if (parts[1].second == parts[0].second) unmatched = parts.suffix().str();
        if (parts[1].first == parts[0].first) before = parts.prefix().str();
    }
    std::string group, behind;
    std::string before, unmatched;  ///< empty if the expression itself goes on
    bool cut = false;               ///< the line is longer than what is searched, up to the end of the group
};

/// Returns the number that the group is a part of: the expression found it without its exponent, its sign, or the
/// digits on the other side of a point or comma.
std::optional<std::string> whole_number_around(const FoundText& found) {
    static const std::regex exponent("^[eEdDqQ][-+]?[0-9]+(?![0-9A-Za-z_])");
    static const std::regex digits_behind("^[.,][0-9]+"), sign_before("(?:^|[^0-9A-Za-z_.)\\]])(-)$");
    static const std::regex digits_before("-?[0-9.]*[0-9](?:[.]|[eEdDqQ][-+]?)?$");
    std::smatch part;
    if (std::regex_search(found.behind, part, exponent)) return found.group + part.str();
    const bool whole = !found.group.empty() && std::ranges::all_of(trimmed(found.group), [](char c) {
        return is_digit(c) || c == '-' || c == '+';
    });
    if (whole && is_digit(found.group.back()) && std::regex_search(found.unmatched, part, digits_behind))
        return found.group + part.str();
    const bool begins = !found.group.empty() && (is_digit(found.group.front()) || found.group.front() == '.');
    if (begins && std::regex_search(found.before, part, digits_before)) return part.str() + found.group;
    if (begins && std::regex_search(found.before, part, sign_before)) return "-" + found.group;
    return std::nullopt;
}

/// Returns the letters with which every match begins, which are found faster than the expression; may be empty.
std::string literal_of(std::string_view pattern) {
    if (pattern.find('|') != std::string_view::npos) return {};
    if (pattern.starts_with('^')) pattern.remove_prefix(1);
    const auto end = std::min(pattern.find_first_of(".^$()[]{}*+?\\"), pattern.size());
    const bool optional =
        end > 0 && end < pattern.size() && std::string_view("*?{").find(pattern[end]) != std::string_view::npos;
    return std::string(pattern.substr(0, optional ? end - 1 : end));
}

std::optional<double> number_of(std::string_view text) {
    const auto number = any_number_of(text);
    return number && std::isfinite(*number) ? number : std::nullopt;
}

/// Throws for a text that is no finite number; empty or NaN: there is no value.
[[noreturn]] void refuse_text(const std::string& place, std::string_view text) {
    const auto sentence = place + ", which is no number";
    const auto number = any_number_of(text);
    if (trimmed(text).empty() || (number && std::isnan(*number))) throw NoValue(sentence);
    throw std::invalid_argument(sentence);
}

}  // namespace

ProgramTable::ProgramTable(std::string file, std::string text, std::string separator)
    : file_(std::move(file)), text_(std::move(text)), separator_(std::move(separator)) {
    std::string_view rest = text_, remark;
    if (rest.starts_with("\xEF\xBB\xBF")) rest.remove_prefix(3);
    while (!rest.empty()) {
        const auto end = rest.find('\n');
        const auto line = trimmed(rest.substr(0, end));
        rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
        if (line.empty()) continue;
        if (line.starts_with('#')) {
            if (names_.empty()) remark = line;
            note_other_head(line);
            continue;
        }
        if (names_.empty() && take_head(line, remark)) continue;
        if (rows_.size() >= most_rows)
            throw std::invalid_argument(fmt::format("{} has more than {} rows", file_, most_rows));
        note_other_head(line);
        rows_.push_back(line);
    }
    if (names_.empty()) take_head({}, remark);
}

void ProgramTable::note_other_head(std::string_view line) {
    const bool remark = line.starts_with('#');
    if (rows_.empty() || !other_head_.empty() || (!remark && (is_digit(line.front()) || line.front() == '-'))) return;
    while (line.starts_with('#')) line = trimmed(line.substr(1));
    const auto cells = cells_of(line);
    const auto is_name = [](const std::string& cell) { return !cell.empty() && !any_number_of(cell); };
    if (cells.size() < 2 || cells == names_ || !std::ranges::all_of(cells, is_name)) return;
    // Any words may stand in a remark.
    const auto known = [this](const auto& cell) { return std::ranges::find(names_, cell) != names_.end(); };
    if (remark && !std::ranges::all_of(cells, known)) return;
    other_head_ = line;
    rows_of_the_head_ = rows_.size();
}

bool ProgramTable::take_head(std::string_view line, std::string_view remark) {
    while (remark.starts_with('#')) remark = trimmed(remark.substr(1));
    auto cells = cells_of(line);
    const bool named =
        remark.empty() || !std::ranges::all_of(cells, [](const auto& cell) { return any_number_of(cell).has_value(); });
    names_ = named ? std::move(cells) : cells_of(remark);
    return named;
}

std::vector<std::string> ProgramTable::cells_of(std::string_view line) const {
    if (separator_ == "comma") return campaign::take_csv_record(line);
    std::vector<std::string> cells;
    const char between = separator_ == "semicolon" ? ';' : '\t';
    while (cells.size() < most_columns) {
        if (separator_ == "blank") {
            line = trimmed(line);
            if (line.empty()) break;
        }
        const auto end = separator_ == "blank" ? line.find_first_of(" \t") : line.find(between);
        cells.emplace_back(trimmed(line.substr(0, end)));
        if (end == std::string_view::npos) break;
        line.remove_prefix(end + 1);
    }
    return cells;
}

std::size_t ProgramTable::place_of(const std::string& column) const {
    const auto found = std::ranges::find(names_, column);
    if (std::ranges::count(names_, column) > 1)
        throw std::invalid_argument(fmt::format("{} has two columns '{}'", file_, column));
    if (found != names_.end()) return static_cast<std::size_t>(found - names_.begin());
    std::string listed;
    for (const auto& name : names_) listed += (listed.empty() ? "" : ", ") + name;
    throw NoValue(fmt::format("{} has no column '{}'; it has {}", file_, column,
                              listed.empty() ? "none" : shortened(listed, 200)));
}

double ProgramTable::number(std::size_t row, std::size_t place, const std::string& column) const {
    if (!other_head_.empty() && row >= rows_of_the_head_)
        throw std::invalid_argument(fmt::format("{}: row {} stands below other names, '{}': the file has two tables",
                                                file_, row, shortened(std::string(other_head_), 60)));
    const auto cells = cells_of(rows_[row]);
    if (place >= cells.size()) throw NoValue(fmt::format("{}: row {} has no '{}'", file_, row, column));
    for (std::size_t k = names_.size(); separator_ == "comma" && k < cells.size(); ++k)
        if (!trimmed(cells[k]).empty())
            throw std::invalid_argument(
                fmt::format("{}: row {} has {} cells under {} names; numbers have decimal points", file_, row,
                            cells.size(), names_.size()));
    if (const auto number = number_of(cells[place])) return *number;
    refuse_text(fmt::format("{}: '{}' in row {} is '{}'", file_, column, row, shortened(cells[place], 60)),
                cells[place]);
}

double ProgramTable::value(const std::string& column, std::int64_t row) const {
    const std::size_t place = place_of(column);
    const auto rows = static_cast<std::int64_t>(rows_.size());
    const std::int64_t at = row < 0 ? rows + row : row;
    if (at < 0 || at >= rows) throw NoValue(fmt::format("{} has {} rows, and row {} is asked", file_, rows, row));
    return number(static_cast<std::size_t>(at), place, column);
}

std::vector<double> ProgramTable::column(const std::string& name) const {
    const std::size_t place = place_of(name);
    if (rows_.size() > most_values)
        throw std::invalid_argument(
            fmt::format("{} has {} rows, and a series has at most {}", file_, rows_.size(), most_values));
    std::vector<double> values;
    values.reserve(rows_.size());
    for (std::size_t row = 0; row < rows_.size(); ++row) values.push_back(number(row, place, name));
    return values;
}

double last_in_output(const ProgramFolder& folder, const std::string& pattern) {
    static std::map<std::string, std::regex> known;
    auto found = known.find(pattern);
    if (found == known.end()) found = known.emplace(pattern, campaign::output_pattern(pattern)).first;
    std::string why;
    const auto file = folder.open("stdout.txt", why);
    if (!file.is_open()) throw std::invalid_argument("standard output " + why);
    const auto literal = literal_of(pattern);
    std::optional<FoundText> last;
    std::string line, beyond;  // what is searched of a line, and what is not
    bool may_be_beyond = false;
    std::smatch parts;
    const auto search = [&] {
        // The end of a line of Windows is two ends with nothing between them.
        const bool may_match = !line.empty() && line.find(literal) != std::string::npos;
        if (may_match && std::regex_search(line, parts, found->second) && parts[1].matched) {
            last.emplace(parts, line.size() >= longest_searched);
            may_be_beyond = false;
        } else if (!beyond.empty() && !literal.empty() && !pattern.starts_with('^')) {
            may_be_beyond = may_be_beyond || (line + beyond).find(literal) != std::string::npos;
        }
        line.clear(), beyond.clear();
    };
    const auto began = std::chrono::steady_clock::now();
    std::array<char, 65536> piece{};
    for (ssize_t length = 0;
         (length = ::read(file.number(), piece.data(), piece.size())) > 0 || (length < 0 && errno == EINTR);) {
        if (std::chrono::steady_clock::now() - began > longest_search)
            throw std::invalid_argument(fmt::format("standard output: to search for '{}' takes too long", pattern));
        std::string_view rest(piece.data(), static_cast<std::size_t>(std::max<ssize_t>(length, 0)));
        while (!rest.empty()) {
            const auto end = rest.find_first_of("\r\n");  // a progress bar returns to the start of its line
            const auto part = rest.substr(0, end), here = part.substr(0, longest_searched - line.size());
            line += here;
            beyond += part.substr(here.size()).substr(0, largest_beyond - beyond.size());
            if (end == std::string_view::npos) break;
            search();
            rest.remove_prefix(end + 1);
        }
    }
    if (!line.empty()) search();
    if (may_be_beyond)
        throw std::invalid_argument(
            fmt::format("standard output: '{}' may stand beyond the first {} bytes of a line, which alone are searched",
                        pattern, longest_searched));
    if (!last) throw NoValue(fmt::format("standard output has no line with '{}'", pattern));
    if (last->cut)
        throw std::invalid_argument(fmt::format(
            "standard output: '{}' found a value beyond the first {} bytes of a line", pattern, longest_searched));
    if (const auto whole = whole_number_around(*last))
        throw std::invalid_argument(fmt::format(
            "standard output: '{}' found '{}', a part of the number '{}'{}", pattern, shortened(last->group, 60),
            shortened(*whole, 60),
            whole->find(',') == std::string::npos
                ? ""
                : "; numbers have decimal points, and a comma between two numbers belongs to the expression"));
    if (const auto number = number_of(last->group)) return *number;
    refuse_text(fmt::format("standard output: '{}' found '{}'", pattern, shortened(last->group, 60)), last->group);
}

}  // namespace grainsweep::workers
