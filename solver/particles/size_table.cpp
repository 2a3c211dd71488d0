#include "solver/particles/size_table.hpp"

#include "solver/plain_text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>

namespace grainsweep::particles {
namespace {

constexpr double largest_diameter = 0.1;  // m: a larger number is in another unit
constexpr double smallest_diameter = 1e-8;
constexpr double tolerance = 0.01;  // by which printed shares may miss 1

struct Header {
    std::string_view text;
    int power;  ///< the shares are of all d^power
    bool cumulative;
};
constexpr std::array<Header, 6> headers = {{{"diameter,number_fraction", 0, false},
                                            {"diameter,area_fraction", 2, false},
                                            {"diameter,volume_fraction", 3, false},
                                            {"diameter,number_below", 0, true},
                                            {"diameter,area_below", 2, true},
                                            {"diameter,volume_below", 3, true}}};

struct Line {
    double diameter = 0, fraction = 0;
};

[[noreturn]] void refuse_table(const std::string& what) {
    throw std::invalid_argument("sizes" + what);
}
[[noreturn]] void refuse_table(std::size_t line, const std::string& what) {
    refuse_table(", line " + std::to_string(line) + ": " + what);
}

const Header& header_of(std::string_view line) {
    std::string plain(line);
    std::erase_if(plain, [](char c) { return c == ' ' || c == '\t'; });
    const auto found = std::ranges::find(headers, plain, &Header::text);
    if (found == headers.end())
        refuse_table(1,
                     "the header must be diameter and one of number_fraction, volume_fraction, area_fraction, "
                     "number_below, volume_below and area_below, with a comma between, not '" +
                         std::string(line.substr(0, 40)) + "'");
    return *found;
}

Line line_of(std::string_view text, std::size_t at, const std::vector<Line>& before) {
    const auto comma = std::min(text.find(','), text.size());
    const auto diameter = number_in(trimmed(text.substr(0, comma)));
    const auto fraction = number_in(trimmed(text.substr(std::min(comma + 1, text.size()))));
    if (!diameter || !fraction)
        refuse_table(at, "'" + std::string(text.substr(0, 60)) + "' is not two numbers with a comma between");
    if (!(*diameter >= smallest_diameter && *diameter <= largest_diameter))
        refuse_table(at,
                     "a diameter of " + shortest_text(*diameter) + " lies outside 1e-8 to 0.1 m (diameters are in m)");
    if (!before.empty() && !(*diameter > before.back().diameter))
        refuse_table(at, "diameters must grow from line to line, and " + shortest_text(*diameter) + " follows " +
                             shortest_text(before.back().diameter));
    if (!(*fraction >= 0 && *fraction <= 1 + tolerance))
        refuse_table(at, "a share of " + shortest_text(*fraction) + " lies outside 0 to 1");
    return {*diameter, *fraction};
}

/// Rows and whether they add up; sum: of classes, or the last of a cumulative table.
double total_of(const Header& header, const std::vector<Line>& lines) {
    double sum = 0;
    for (std::size_t k = 0; k < lines.size(); ++k) {
        sum += header.cumulative ? 0 : lines[k].fraction;
        if (header.cumulative && k > 0 && lines[k].fraction < lines[k - 1].fraction)
            refuse_table(": shares below a diameter must not fall, and " + shortest_text(lines[k].fraction) +
                         " follows " + shortest_text(lines[k - 1].fraction));
    }
    if (!header.cumulative) return sum;
    if (lines.size() < 2 || lines.front().fraction != 0)
        refuse_table(": shares below a diameter must begin with 0, at the smallest diameter");
    return lines.back().fraction;
}

}  // namespace

double SizeTable::Piece::diameter(double u) const {
    if (from == to) return from;
    if (even == Even::number) return from + u * (to - from);
    if (even == Even::area) return std::clamp(1 / (1 / from - u * (1 / from - 1 / to)), from, to);
    const double first = 1 / (from * from), last = 1 / (to * to);
    return std::clamp(1 / std::sqrt(first - u * (first - last)), from, to);
}

double SizeTable::Piece::moment(int power) const {
    const auto integral = [this](int of) {  // of d^of from `from` to `to`
        if (of == -1) return std::log(to / from);
        return (std::pow(to, of + 1) - std::pow(from, of + 1)) / (of + 1);
    };
    if (from == to) return std::pow(from, power);
    if (even == Even::number) return integral(power) / (to - from);
    if (even == Even::area) return integral(power - 2) / integral(-2);
    return integral(power - 3) / integral(-3);
}

SizeTable::Piece SizeTable::Piece::between(double low, double high) const {
    if (from == to) return {from, to, from >= low && from <= high ? share : 0, even};
    Piece part{std::max(from, low), std::min(to, high), 0, even};
    if (!(part.from < part.to)) return part;
    const auto particles = [this](double a, double b) {
        return even == Even::number ? b - a : even == Even::area ? 1 / a - 1 / b : 1 / (a * a) - 1 / (b * b);
    };
    part.share = share * particles(part.from, part.to) / particles(from, to);
    return part;
}

SizeTable SizeTable::read(std::string_view csv) {
    if (csv.starts_with("\xEF\xBB\xBF")) csv.remove_prefix(3);  // byte-order mark
    const Header* header = nullptr;
    std::vector<Line> lines;
    for (std::size_t at = 1; !csv.empty(); ++at) {
        const auto end = std::min(csv.find('\n'), csv.size());
        const std::string_view line = trimmed(csv.substr(0, end));
        csv.remove_prefix(std::min(end + 1, csv.size()));
        if (header == nullptr)
            header = &header_of(line);
        else if (!line.empty())
            lines.push_back(line_of(line, at, lines));
    }
    if (header == nullptr || lines.empty()) refuse_table(": there is no diameter");
    const double total = total_of(*header, lines);
    if (std::abs(total - 1) > tolerance) refuse_table(": the shares add up to " + shortest_text(total) + ", not to 1");

    SizeTable table;
    const Even even = header->power == 3 ? Even::volume : header->power == 2 ? Even::area : Even::number;
    for (std::size_t k = header->cumulative ? 1 : 0; k < lines.size(); ++k) {
        const Line& before = lines[header->cumulative ? k - 1 : k];
        const double share = header->cumulative ? lines[k].fraction - before.fraction : lines[k].fraction;
        if (share > 0) table.pieces_.push_back({before.diameter, lines[k].diameter, share, even});
    }
    double sum = 0;
    const double unit = lines.back().diameter;  // keeps cubes of micrometres well within range
    for (Piece& piece : table.pieces_) {
        const Piece scaled{piece.from / unit, piece.to / unit, 1, even};
        if (header->power > 0) piece.share /= scaled.moment(header->power);
        sum += piece.share;
    }
    for (Piece& piece : table.pieces_) piece.share /= sum;
    return table;
}

SizeTable SizeTable::over(double unit) const {
    SizeTable scaled = *this;
    for (Piece& piece : scaled.pieces_) {
        piece.from /= unit;
        piece.to /= unit;
    }
    return scaled;
}

double SizeTable::diameter(double u) const {
    double below = 0;
    for (std::size_t k = 0; k + 1 < pieces_.size(); ++k) {
        if (u < below + pieces_[k].share) return pieces_[k].diameter((u - below) / pieces_[k].share);
        below += pieces_[k].share;
    }
    return pieces_.back().diameter(std::clamp((u - below) / pieces_.back().share, 0.0, 1.0));
}

double SizeTable::moment(int power) const {
    double sum = 0;
    for (const Piece& piece : pieces_) sum += piece.share * piece.moment(power);
    return sum;
}

double SizeTable::share_below(double diameter, int power) const {
    double below = 0;
    for (const Piece& piece : pieces_)
        if (const Piece part = piece.between(0, diameter); part.share > 0) below += part.share * part.moment(power);
    return below / moment(power);
}

double SizeTable::quantile(double share, int power) const {
    double low = smallest(), high = largest();
    constexpr int halvings = 60;
    for (int k = 0; k < halvings; ++k) {
        const double middle = low + (high - low) / 2;
        (share_below(middle, power) < share ? low : high) = middle;
    }
    return high;
}

SizeTable SizeTable::between(double low, double high) const {
    SizeTable part;
    double sum = 0;
    for (const Piece& piece : pieces_)
        if (const Piece inside = piece.between(low, high); inside.share > 0) {
            part.pieces_.push_back(inside);
            sum += inside.share;
        }
    if (part.pieces_.empty())
        refuse_table(": none lies between " + shortest_text(low) + " and " + shortest_text(high) + " m");
    for (Piece& piece : part.pieces_) piece.share /= sum;
    return part;
}

std::string SizeTable::text() const {
    const auto number = [](double x) {
        std::array<char, 32> digits{};
        std::snprintf(digits.data(), digits.size(), "%.9g", x);
        return std::string(digits.data());
    };
    const bool classes = pieces_.front().from == pieces_.front().to;
    const Even even = pieces_.front().even;
    const int power = even == Even::volume ? 3 : even == Even::area ? 2 : 0;
    const char* const of = even == Even::volume ? "volume_" : even == Even::area ? "area_" : "number_";
    std::string csv = std::string("diameter,") + of + (classes ? "fraction" : "below");
    csv += "\n";
    const double all = moment(power);
    if (!classes) csv += number(smallest()) + ",0\n";
    double below = 0, end = smallest();
    for (std::size_t k = 0; k < pieces_.size(); ++k) {
        const Piece& piece = pieces_[k];
        if (!classes && piece.from > end) csv += number(piece.from) + "," + number(below) + "\n";
        const double share = piece.share * piece.moment(power) / all;
        below += share;
        end = piece.to;
        csv += number(end) + "," + number(classes ? share : k + 1 == pieces_.size() ? 1 : below) + "\n";
    }
    return csv;
}

}  // namespace grainsweep::particles
