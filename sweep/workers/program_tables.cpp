#include "sweep/workers/program_tables.hpp"

#include "solver/plain_text.hpp"
#include "sweep/campaign/csv_record.hpp"
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
constexpr std::size_t longest_searched = 4096;  // a search takes up to the square of its line's length
constexpr std::chrono::minutes longest_search{10};

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

/// Fortran writes 1.0D+03, or 1.0Q+03, and 1.0-103 where the exponent has three digits.
std::string with_plain_exponent(std::string_view text) {
    std::string plain(text);
    for (std::size_t k = 1; k + 1 < plain.size(); ++k) {
        const bool after_number = is_digit(plain[k - 1]) || plain[k - 1] == '.';
        const bool letter = std::string_view("dDqQ").find(plain[k]) != std::string_view::npos;
        if (after_number && letter) plain[k] = 'e';
        if (after_number && (plain[k] == '+' || plain[k] == '-')) plain.insert(k, 1, 'e');
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

/// The exponent with which the text behind a number goes on: the expression has found the number without it.
std::optional<std::string> exponent_behind(const std::string& behind) {
    static const std::regex exponent("^[eEdDqQ][-+]?[0-9]+(?![0-9A-Za-z_])");
    std::smatch found;
    if (!std::regex_search(behind, found, exponent)) return std::nullopt;
    return found.str();
}

std::optional<double> number_of(std::string_view text) {
    const auto number = any_number_of(text);
    return number && std::isfinite(*number) ? number : std::nullopt;
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
            continue;
        }
        if (names_.empty() && take_head(line, remark)) continue;
        if (rows_.size() >= most_rows)
            throw std::invalid_argument(fmt::format("{} has more than {} rows", file_, most_rows));
        rows_.push_back(line);
    }
    if (names_.empty()) take_head({}, remark);
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
    throw std::invalid_argument(fmt::format("{} has no column '{}'; it has {}", file_, column,
                                            listed.empty() ? "none" : shortened(listed, 200)));
}

double ProgramTable::number(std::size_t row, std::size_t place, const std::string& column) const {
    const auto cells = cells_of(rows_[row]);
    if (place >= cells.size()) throw std::invalid_argument(fmt::format("{}: row {} has no '{}'", file_, row, column));
    if (const auto number = number_of(cells[place])) return *number;
    throw std::invalid_argument(
        fmt::format("{}: '{}' in row {} is '{}', which is no number", file_, column, row, shortened(cells[place], 60)));
}

double ProgramTable::value(const std::string& column, std::int64_t row) const {
    const std::size_t place = place_of(column);
    const auto rows = static_cast<std::int64_t>(rows_.size());
    const std::int64_t at = row < 0 ? rows + row : row;
    if (at < 0 || at >= rows)
        throw std::invalid_argument(fmt::format("{} has {} rows, and row {} is asked", file_, rows, row));
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
    std::optional<std::string> last, behind;
    std::string line;
    std::smatch parts;
    const auto search = [&] {
        if (std::regex_search(line, parts, found->second) && parts[1].matched) {
            last = parts[1].str();
            behind = std::string(parts[1].second, line.cend());
        }
        line.clear();
    };
    const auto began = std::chrono::steady_clock::now();
    std::array<char, 65536> piece{};
    for (ssize_t length = 0;
         (length = ::read(file.number(), piece.data(), piece.size())) > 0 || (length < 0 && errno == EINTR);) {
        if (std::chrono::steady_clock::now() - began > longest_search)
            throw std::invalid_argument(fmt::format("standard output: to search for '{}' takes too long", pattern));
        for (ssize_t k = 0; k < length; ++k) {
            const char c = piece[static_cast<std::size_t>(k)];
            if (c == '\n')
                search();
            else if (line.size() < longest_searched)
                line += c;
        }
    }
    if (!line.empty()) search();
    if (!last) throw std::invalid_argument(fmt::format("standard output has no line with '{}'", pattern));
    if (const auto cut = exponent_behind(*behind))
        throw std::invalid_argument(fmt::format("standard output: '{}' found '{}', a part of the number '{}{}'",
                                                pattern, shortened(*last, 60), shortened(*last, 60), *cut));
    if (const auto number = number_of(*last)) return *number;
    throw std::invalid_argument(
        fmt::format("standard output: '{}' found '{}', which is no number", pattern, shortened(*last, 60)));
}

}  // namespace grainsweep::workers
