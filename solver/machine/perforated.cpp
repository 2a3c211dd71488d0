// A perforated plate as triangles. Rows of cells, each around one hole; an odd row of a triangular pattern is shifted
// by half a pitch. The edge of a hole is a polygon around the circle, so a sphere passes if it is smaller than the
// hole. Neighbouring triangles share whole sides.
#include "solver/machine/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <stdexcept>

namespace grainsweep::machine {
namespace {

using geometry::Vec3;
using geometry::operator+;
using geometry::operator*;

constexpr int hole_sides = 32;
constexpr int most_holes = 5000;
constexpr double same_place = 1e-9;  // pitches

struct PlatePoint {
    double x = 0, y = 0;
};

double hole_angle(int k) {
    return 2 * std::numbers::pi * k / hole_sides;
}

/// Returns a number of whole lengths that fit, where rounding does not count.
int fitting(double length, double part) {
    return static_cast<int>(std::floor(length / part * (1 + 1e-12)));
}

void sort_places(std::vector<double>& places, double pitch) {
    std::ranges::sort(places);
    const auto near = [pitch](double a, double b) { return b - a < same_place * pitch; };
    places.erase(std::unique(places.begin(), places.end(), near), places.end());
}

class PlateCells {
public:
    PlateCells(const Perforated& plate, double length, double width)
        : plate_(plate),
          length_(length),
          width_(width),
          height_(plate.pattern == Perforated::Pattern::square ? plate.pitch : plate.pitch * std::sqrt(0.75)),
          columns_(fitting(length, plate.pitch)),
          rows_(fitting(width, height_)),
          left_((length - columns_ * plate.pitch) / 2),
          low_((width - rows_ * height_) / 2) {
        if (columns_ < 1 || rows_ < 1) throw std::invalid_argument("the plate is smaller than a pitch");
        if (std::int64_t{columns_} * rows_ > most_holes)
            throw std::invalid_argument("the plate has more than 5000 holes: make it periodic");
        if (!(corner_radius() < height_ / 2))
            throw std::invalid_argument(
                "holes must leave a web between them: less than 0.99 pitches wide, and 0.86 in a triangular pattern");
        for (int k = 0; k < hole_sides; ++k) {
            const double x = std::cos(hole_angle(k)), y = std::sin(hole_angle(k));
            const double to_side = plate.pitch / 2 / std::abs(x), to_end = height_ / 2 / std::abs(y);
            if (to_side <= to_end)
                sides_.push_back(to_side * y);
            else
                ends_.push_back(to_end * x);
        }
        for (auto* places : {&sides_, &ends_}) sort_places(*places, plate.pitch);
    }

    [[nodiscard]] Triangles made(const Vec3& corner, const Vec3& x, const Vec3& y) {
        const auto place = [&](const PlatePoint& p) { return corner + p.x * x + p.y * y; };
        std::vector<std::vector<double>> lines;
        for (int row = 0; row <= rows_; ++row) lines.push_back(line_below(row));
        const std::vector<double> ends{0, length_};
        if (low_ > 0) {
            solid(ends, lines.front(), 0, low_, {});
            solid(lines.back(), ends, width_ - low_, width_, {});
        }
        for (int row = 0; row < rows_; ++row) {
            const auto below = static_cast<std::size_t>(row);
            add_row(row, lines[below], lines[below + 1]);
        }
        Triangles triangles;
        for (const auto& [a, b, c] : flat_) triangles.push_back({place(a), place(b), place(c)});
        return triangles;
    }

private:
    [[nodiscard]] double corner_radius() const { return plate_.hole / 2 / std::cos(std::numbers::pi / hole_sides); }
    [[nodiscard]] bool shifted(int row) const {
        return plate_.pattern == Perforated::Pattern::triangular && row % 2 == 1;
    }
    [[nodiscard]] int holes_of(int row) const { return columns_ - (shifted(row) ? 1 : 0); }
    [[nodiscard]] double begin_of(int row) const { return left_ + (shifted(row) ? plate_.pitch / 2 : 0); }

    /// Returns the corners of triangles on the line below a row.
    [[nodiscard]] std::vector<double> line_below(int row) const {
        std::vector<double> places{0, length_};
        for (const int of : {row - 1, row}) {
            if (of < 0 || of >= rows_) continue;
            for (int hole = 0; hole <= holes_of(of); ++hole) {
                const double side = begin_of(of) + hole * plate_.pitch;
                places.push_back(side);
                if (hole == holes_of(of)) break;
                for (const double end : ends_) places.push_back(side + plate_.pitch / 2 + end);
            }
        }
        sort_places(places, plate_.pitch);
        return places;
    }

    void add_row(int row, const std::vector<double>& below, const std::vector<double>& above) {
        const double low = low_ + row * height_, high = low + height_, middle = low + height_ / 2;
        std::vector<double> side;
        for (const double y : sides_) side.push_back(middle + y);
        const double begin = begin_of(row), end = begin + holes_of(row) * plate_.pitch;
        const auto part = [&](const std::vector<double>& line, double from, double to) {
            std::vector<double> within;
            for (const double x : line)
                if (x > from - same_place * plate_.pitch && x < to + same_place * plate_.pitch) within.push_back(x);
            return within;
        };
        if (begin > same_place * plate_.pitch) {
            solid(part(below, 0, begin), part(above, 0, begin), low, high, {{}, side});
            solid(part(below, end, length_), part(above, end, length_), low, high, {side, {}});
        }
        for (int hole = 0; hole < holes_of(row); ++hole) {
            const double from = begin + hole * plate_.pitch, to = from + plate_.pitch;
            pierced(outline(part(below, from, to), part(above, from, to), low, high, {side, side}),
                    {(from + to) / 2, middle});
        }
    }

    struct Sides {
        std::vector<double> left, right;  // y of further corners
    };

    /// Returns the corners of a rectangle and on its sides, around it.
    static std::vector<PlatePoint> outline(const std::vector<double>& below, const std::vector<double>& above,
                                           double low, double high, const Sides& sides) {
        std::vector<PlatePoint> points;
        for (const double x : below) points.push_back({x, low});
        for (const double y : sides.right) points.push_back({below.back(), y});
        for (auto x = above.rbegin(); x != above.rend(); ++x) points.push_back({*x, high});
        for (auto y = sides.left.rbegin(); y != sides.left.rend(); ++y) points.push_back({below.front(), *y});
        return points;
    }

    void solid(const std::vector<double>& below, const std::vector<double>& above, double low, double high,
               const Sides& sides) {
        const auto points = outline(below, above, low, high, sides);
        const PlatePoint centre{(below.front() + below.back()) / 2, (low + high) / 2};
        for (std::size_t k = 0; k < points.size(); ++k)
            flat_.push_back({centre, points[k], points[(k + 1) % points.size()]});
    }

    /// Adds a rectangle with a hole: between two corners of the hole, what lies between the rays through them.
    void pierced(std::vector<PlatePoint> points, const PlatePoint& centre) {
        const auto angle_of = [&](const PlatePoint& p) {
            const double angle = std::atan2(p.y - centre.y, p.x - centre.x);
            return angle < -same_place ? angle + 2 * std::numbers::pi : angle;
        };
        std::ranges::sort(points, {}, angle_of);
        const auto corner = [&](int k) {
            return PlatePoint{centre.x + corner_radius() * std::cos(hole_angle(k)),
                              centre.y + corner_radius() * std::sin(hole_angle(k))};
        };
        std::size_t p = 0;
        for (int k = 0; k < hole_sides; ++k) {
            const PlatePoint here = corner(k);
            for (; angle_of(points[p]) < hole_angle(k + 1) - same_place; ++p) {
                const bool last = p + 1 == points.size();
                flat_.push_back({here, points[p], points[last ? 0 : p + 1]});
                if (last) break;
            }
            flat_.push_back({here, points[k + 1 == hole_sides ? 0 : p], corner((k + 1) % hole_sides)});
        }
    }

    const Perforated& plate_;
    double length_, width_, height_;
    int columns_, rows_;
    double left_, low_;                 // of the holes' cells
    std::vector<double> sides_, ends_;  // where the rays through a hole's corners leave its cell, from its centre
    std::vector<std::array<PlatePoint, 3>> flat_;
};

}  // namespace

Triangles triangles_of(const Perforated& plate) {
    const double length = geometry::norm(plate.along), width = geometry::norm(plate.across);
    if (!(length > 0 && width > 0)) throw std::invalid_argument("a plate needs two sides");
    if (std::abs(geometry::dot(plate.along, plate.across)) > 1e-9 * length * width)
        throw std::invalid_argument("\"along\" and \"across\" of a plate must be at a right angle");
    return PlateCells(plate, length, width).made(plate.corner, (1 / length) * plate.along, (1 / width) * plate.across);
}

}  // namespace grainsweep::machine
