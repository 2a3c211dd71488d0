#include "solver/geometry/stl.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>

namespace grainsweep::geometry {
namespace {

constexpr std::size_t header_size = 80;
constexpr std::size_t prologue_size = header_size + 4;
constexpr std::size_t record_size = 50;  // normal, three corners, two bytes of no meaning

using Corners = std::vector<std::array<Vec3, 3>>;

[[noreturn]] void refuse(const std::string& what) {
    throw std::invalid_argument("STL: " + what);
}

std::uint32_t word(std::string_view bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t k = 0; k < 4; ++k)
        value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + k])) << (8 * k);
    return value;
}

void require_sound(const Vec3& x, std::size_t triangle) {
    for (const double c : x)
        if (!(std::abs(c) <= largest_coordinate))
            refuse("triangle " + std::to_string(triangle + 1) +
                   " has a corner that is no number or farther than 1e9 m from the origin");
}

Corners read_binary(std::string_view bytes, double scale) {
    const std::size_t count = word(bytes, header_size);
    Corners triangles(count);
    for (std::size_t t = 0; t < count; ++t)
        for (std::size_t c = 0; c < 3; ++c) {
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t bits = word(bytes, prologue_size + record_size * t + 4 * (3 * (c + 1) + k));
                float value = 0;
                std::memcpy(&value, &bits, sizeof value);
                triangles[t][c][k] = scale * static_cast<double>(value);
            }
            require_sound(triangles[t][c], t);
        }
    return triangles;
}

/// Words of a text between blanks, with the number of the line that they stand in.
class Words {
public:
    explicit Words(std::string_view text) : text_(text) {}

    /// In small letters; empty at the end of the text.
    std::string next() {
        while (at_ < text_.size() && is_blank(text_[at_])) line_ += text_[at_++] == '\n' ? 1 : 0;
        std::string found;
        while (at_ < text_.size() && !is_blank(text_[at_])) {
            const char c = text_[at_++];
            found += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
        }
        return found;
    }
    void skip_line() {
        while (at_ < text_.size() && text_[at_] != '\n') ++at_;
    }
    void expect(std::string_view wanted) {
        const std::string found = next();
        if (found != wanted) wrong("'" + std::string(wanted) + "'", found);
    }
    double number() {
        const std::string found = next();
        const char* first = found.data() + (found.starts_with('+') ? 1 : 0);
        double value = 0;
        const auto [end, error] = std::from_chars(first, found.data() + found.size(), value);
        if (error != std::errc() || end != found.data() + found.size() || end == first) wrong("a number", found);
        return value;
    }
    [[noreturn]] void wrong(const std::string& wanted, const std::string& found) const {
        refuse("line " + std::to_string(line_) + ": " + wanted + " is expected" +
               (found.empty() ? ", and the file ends" : ", not '" + found.substr(0, 40) + "'"));
    }

private:
    static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f' || c == '\v'; }

    std::string_view text_;
    std::size_t at_ = 0;
    std::size_t line_ = 1;
};

/// One or more of: solid ... facet normal a b c outer loop vertex x y z (three times) endloop endfacet ... endsolid
Corners read_text(std::string_view text, double scale) {
    Corners triangles;
    Words words(text);
    for (std::string solid = words.next(); !solid.empty(); solid = words.next()) {
        if (solid != "solid") words.wrong("'solid'", solid);
        words.skip_line();  // its name
        for (;;) {
            const std::string head = words.next();
            if (head == "endsolid") break;
            if (head != "facet") words.wrong("'facet' or 'endsolid'", head);
            words.expect("normal");
            for (int k = 0; k < 3; ++k) (void)words.next();  // whatever it is: some programs write nan
            words.expect("outer");
            words.expect("loop");
            std::array<Vec3, 3> corners{};
            for (Vec3& corner : corners) {
                words.expect("vertex");
                for (double& x : corner) x = scale * words.number();
                require_sound(corner, triangles.size());
            }
            words.expect("endloop");
            words.expect("endfacet");
            triangles.push_back(corners);
        }
        words.skip_line();
    }
    return triangles;
}

bool begins_with_solid(std::string_view contents) {
    const auto first = contents.find_first_not_of(" \t\r\n");
    if (first == std::string_view::npos) return false;
    constexpr std::string_view mark = "solid";
    const std::string_view head = contents.substr(first, mark.size());
    return std::ranges::equal(head, mark, [](char a, char b) { return (a | 0x20) == b; });
}

}  // namespace

StlSurface read_stl(std::string_view contents, double scale) {
    if (!(std::isfinite(scale) && scale > 0)) refuse("the scale must be positive");
    if (contents.starts_with("\xEF\xBB\xBF")) contents.remove_prefix(3);  // byte-order mark
    const bool long_enough = contents.size() >= prologue_size;
    const std::size_t count = long_enough ? word(contents, header_size) : 0;
    const bool binary = long_enough && contents.size() == prologue_size + record_size * count;
    if (!binary && (!begins_with_solid(contents) || contents.find('\0') != std::string_view::npos)) {
        if (!long_enough)
            refuse(
                "it is neither text that begins with 'solid' nor has it the 84 bytes before the first triangle of "
                "a binary file");
        refuse("it is no text, and as a binary file of " + std::to_string(count) + " triangles it would have " +
               std::to_string(prologue_size + record_size * count) + " bytes, not " + std::to_string(contents.size()));
    }
    const Corners triangles = binary ? read_binary(contents, scale) : read_text(contents, scale);
    if (triangles.empty()) refuse("there is no triangle in it");
    StlSurface read{weld(triangles), binary};
    if (read.surface.triangles.empty()) refuse("none of its triangles has an area");
    return read;
}

}  // namespace grainsweep::geometry
