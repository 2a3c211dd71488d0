#include "tests/support/drum_picture.hpp"

#include "tests/support/reference.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace grainsweep::tests {
namespace {

constexpr double masked = 0.6;   // of R^2
constexpr int reach = 3;         // of the closing: 7 x 7
constexpr int half_circle = 16;  // vertices
constexpr double map_levels = 255, map_threshold = 10;

using Point = std::array<double, 2>;  // in pixels

/// Areas of polygons in pixels, exact: each edge, cut at pixel borders, adds what lies to its right in its row; a sum
/// along the row then gives the area in each pixel.
class AreaSum {
public:
    explicit AreaSum(int n) : n_(n), change_(static_cast<std::size_t>(n * (n + 1)), 0) {}

    /// Counter-clockwise polygons add `weight` times their area.
    void add(std::span<const Point> polygon, double weight) {
        for (std::size_t k = 0; k < polygon.size(); ++k) edge(polygon[k], polygon[(k + 1) % polygon.size()], weight);
    }
    [[nodiscard]] std::vector<double> sum() const {
        std::vector<double> values;
        values.reserve(static_cast<std::size_t>(n_ * n_));
        for (int j = 0; j < n_; ++j) {
            double area = 0;
            for (int i = 0; i < n_; ++i) values.push_back(area += change_[at(i, j)]);
        }
        return values;
    }

private:
    [[nodiscard]] std::size_t at(int i, int j) const { return static_cast<std::size_t>(j * (n_ + 1) + i); }

    void edge(Point a, Point b, double weight) {
        if (a[1] == b[1]) return;
        // Upwards on the right of a counter-clockwise polygon: what is to its right does not count.
        if (a[1] < b[1]) weight = -weight;
        if (a[1] > b[1]) std::swap(a, b);
        const double slope = (b[0] - a[0]) / (b[1] - a[1]);
        for (int j = std::max(0, static_cast<int>(std::floor(a[1]))); j < n_ && j < b[1]; ++j) {
            const double low = std::max(a[1], static_cast<double>(j)), high = std::min(b[1], j + 1.0);
            if (high > low) row(j, a[0] + slope * (low - a[1]), a[0] + slope * (high - a[1]), high - low, weight);
        }
    }
    /// A piece of an edge within row j, from x to y over a height.
    void row(int j, double x, double y, double height, double weight) {
        if (x > y) std::swap(x, y);
        const auto cell = [this](double place) { return std::clamp(static_cast<int>(std::floor(place)), -1, n_); };
        const int first = cell(x), last = cell(y);
        for (int i = first; i <= last; ++i) {
            const double from = std::max(x, static_cast<double>(i == -1 ? std::min(x, -1.0) : i));
            const double to = i == n_ ? y : std::min(y, i + 1.0);
            const double share = y > x ? (to - from) / (y - x) : 1;
            if (!(share > 0)) continue;
            const double part = weight * height * share;
            if (i < 0) {
                change_[at(0, j)] += part;
            } else if (i < n_) {
                const double inside = (i + 1) - 0.5 * (from + to);
                change_[at(i, j)] += part * inside;
                change_[at(i + 1, j)] += part * (1 - inside);
            }
        }
    }

    int n_;
    std::vector<double> change_;
};

/// Half a circle, counter-clockwise from the angle.
void half(std::vector<Point>& polygon, const Point& centre, double radius, double from, bool backwards = false) {
    for (int k = 0; k < half_circle; ++k) {
        const int place = backwards ? half_circle - 1 - k : k;
        const double angle = from + std::numbers::pi * place / (half_circle - 1);
        polygon.push_back({centre[0] + radius * std::cos(angle), centre[1] + radius * std::sin(angle)});
    }
}

}  // namespace

DrumPicture::DrumPicture(double radius, int pixels) : radius_(radius), side_(2 * radius / pixels), n_(pixels) {
    const auto corner = [&](int k) { return radius * (2.0 * k / (pixels - 1) - 1); };
    for (int j = 0; j < pixels; ++j)
        for (int i = 0; i < pixels; ++i)
            mask_.push_back(corner(i) * corner(i) + corner(j) * corner(j) <= masked * radius * radius ? 1 : 0);
}

std::vector<double> DrumPicture::map(const DrumFrames& frames) const {
    AreaSum area(n_);
    const auto place = [&](std::size_t frame, std::size_t i) {
        const auto& x = frames.centres[frame][i];
        return Point{(x[0] + radius_) / side_, (x[1] + radius_) / side_};
    };
    std::vector<Point> polygon;
    for (std::size_t i = 0; i < frames.radius.size(); ++i) {
        const double r = frames.radius[i] / side_;
        for (std::size_t k = 0; k + 1 < frames.centres.size(); ++k) {
            const Point a = place(k, i), b = place(k + 1, i);
            const double distance = std::hypot(b[0] - a[0], b[1] - a[1]);
            if (distance == 0) continue;
            const double weight = 1 / (2 * r * distance),
                         behind = std::atan2(b[1] - a[1], b[0] - a[0]) + std::numbers::pi / 2;
            polygon.clear();
            half(polygon, a, r, behind);
            half(polygon, b, r, behind, true);
            area.add(polygon, weight);
            if (k + 2 < frames.centres.size()) continue;
            polygon.clear();
            half(polygon, b, r, behind);
            half(polygon, b, r, behind + std::numbers::pi);
            area.add(polygon, weight);
        }
    }
    return area.sum();
}

std::vector<double> DrumPicture::cover(const DrumFrames& frames) const {
    std::vector<double> share(pixels(), 0);
    std::vector<char> hidden;
    for (const auto& centres : frames.centres) {
        hidden.assign(pixels(), 0);
        for (std::size_t k = 0; k < centres.size(); ++k) {
            const double x = (centres[k][0] + radius_) / side_, z = (centres[k][1] + radius_) / side_;
            const double r = frames.radius[k] / side_;
            for (int j = std::max(0, static_cast<int>(z - r) - 1); j < std::min<double>(n_, z + r + 1); ++j)
                for (int i = std::max(0, static_cast<int>(x - r) - 1); i < std::min<double>(n_, x + r + 1); ++i)
                    if (std::hypot(i + 0.5 - x, j + 0.5 - z) <= r) hidden[static_cast<std::size_t>(j * n_ + i)] = 1;
        }
        for (std::size_t k = 0; k < share.size(); ++k)
            share[k] += hidden[k] / static_cast<double>(frames.centres.size());
    }
    return share;
}

std::vector<double> DrumPicture::closed(const std::vector<double>& values) const {
    const auto swept = [this](const std::vector<double>& from, bool largest, bool rows) {
        std::vector<double> to(from.size());
        for (int j = 0; j < n_; ++j)
            for (int i = 0; i < n_; ++i) {
                const int middle = rows ? i : j;
                const int low = std::max(0, middle - reach), high = std::min(n_ - 1, middle + reach);
                double best = from[static_cast<std::size_t>(rows ? j * n_ + low : low * n_ + i)];
                for (int k = low + 1; k <= high; ++k) {
                    const double value = from[static_cast<std::size_t>(rows ? j * n_ + k : k * n_ + i)];
                    best = largest ? std::max(best, value) : std::min(best, value);
                }
                to[static_cast<std::size_t>(j * n_ + i)] = best;
            }
        return to;
    };
    return swept(swept(swept(swept(values, true, true), true, false), false, true), false, false);
}

std::vector<char> DrumPicture::of_map(std::vector<double> map) const {
    for (std::size_t k = 0; k < map.size(); ++k) map[k] *= mask_[k];
    const auto [low, high] = std::ranges::minmax(map);
    const double range = high > low ? high - low : 1;
    for (double& v : map) v = std::floor(map_levels * (v - low) / range);
    const auto grey = closed(map);
    std::vector<char> picture(grey.size());
    for (std::size_t k = 0; k < grey.size(); ++k) picture[k] = mask_[k] != 0 && grey[k] > map_threshold ? 1 : 0;
    return picture;
}

std::vector<char> DrumPicture::of_cover(std::vector<double> share, double level) const {
    for (std::size_t k = 0; k < share.size(); ++k) share[k] *= mask_[k];
    const auto grey = closed(share);
    std::vector<char> picture(grey.size());
    for (std::size_t k = 0; k < grey.size(); ++k) picture[k] = mask_[k] != 0 && grey[k] >= level - 1e-12 ? 1 : 0;
    return picture;
}

double DrumPicture::difference(const std::vector<char>& a, const std::vector<char>& b) const {
    double pixels = 0;
    for (std::size_t k = 0; k < mask_.size(); ++k) pixels += mask_[k] != 0 && a[k] != b[k] ? 1 : 0;
    return pixels * side_ * side_;
}

std::vector<char> DrumPicture::read(const std::filesystem::path& file) const {
    const auto runs = tests::read_table(file);
    std::vector<char> picture(pixels(), 0);
    for (std::size_t k = 0; k < runs.rows; ++k) {
        const auto row = std::llround(runs.at("row", k)), first = std::llround(runs.at("first", k));
        const auto last = first + std::llround(runs.at("length", k));
        if (row < 0 || row >= n_ || first < 0 || last > n_)
            throw std::runtime_error("a line of black pixels leaves the picture in " + file.string());
        for (auto i = first; i < last; ++i) picture[static_cast<std::size_t>(row * n_ + i)] = 1;
    }
    return picture;
}

}  // namespace grainsweep::tests
