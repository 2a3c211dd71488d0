#include "solver/particles/ball_cover.hpp"

#include "solver/geometry/bounds.hpp"
#include "solver/geometry/triangle.hpp"
#include "stats/random.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <stdexcept>
#include <utility>

namespace grainsweep::particles {

using namespace geometry;

namespace {

constexpr double cells_across = 40;  // voxels along the shortest side
constexpr double most_voxels = 3e6;
constexpr std::size_t candidates = 1500;  // balls
constexpr double swelling = 0.04;         // of the shortest side
constexpr double smallest_ball = 0.3;     // of the largest inscribed one

std::int64_t whole(double x) {
    return static_cast<std::int64_t>(x);
}

/// Body on a grid of voxels: which of their centres lie in it.
class Voxels {
public:
    explicit Voxels(const TriangleSurface& surface) {
        const auto [low, high] = geometry::bounds_around(surface.corners);
        const Vec3 size = high - low;
        shortest_ = std::ranges::min(size);
        edge_ = std::max(shortest_ / cells_across, std::cbrt(size[0] * size[1] * size[2] / most_voxels));
        for (std::size_t k = 0; k < 3; ++k) {
            count_[k] = static_cast<std::int64_t>(std::ceil(size[k] / edge_)) + 2 * margin;
            low_[k] = (low[k] + high[k]) / 2 - edge_ * static_cast<double>(count_[k]) / 2;
        }
        inside_.assign(static_cast<std::size_t>(count_[0] * count_[1] * count_[2]), 0);
        fill(surface);
    }

    [[nodiscard]] double shortest() const { return shortest_; }
    [[nodiscard]] const std::vector<std::uint8_t>& inside() const { return inside_; }
    [[nodiscard]] Vec3 centre(std::size_t voxel) const {
        const auto v = static_cast<std::int64_t>(voxel);
        return place(v % count_[0], v / count_[0] % count_[1], v / (count_[0] * count_[1]));
    }
    /// Calls visit(voxel) for each voxel whose centre lies in a ball.
    template <class Visit>
    void each_in(const Ball& ball, Visit&& visit) const {
        const auto range = [&](std::size_t k, double half) {
            const double first = (ball.centre[k] - half - low_[k]) / edge_ - 0.5;
            const double last = (ball.centre[k] + half - low_[k]) / edge_ - 0.5;
            return std::pair(std::max<std::int64_t>(0, whole(std::ceil(first))),
                             std::min(count_[k] - 1, whole(std::floor(last))));
        };
        const auto [z0, z1] = range(2, ball.radius);
        for (std::int64_t z = z0; z <= z1; ++z) {
            const double dz = place(0, 0, z)[2] - ball.centre[2];
            const double disc = std::sqrt(std::max(0.0, ball.radius * ball.radius - dz * dz));
            const auto [y0, y1] = range(1, disc);
            for (std::int64_t y = y0; y <= y1; ++y) {
                const double dy = place(0, y, 0)[1] - ball.centre[1];
                const auto [x0, x1] = range(0, std::sqrt(std::max(0.0, disc * disc - dy * dy)));
                for (std::int64_t x = x0; x <= x1; ++x) visit(number(x, y, z));
            }
        }
    }

private:
    static constexpr std::int64_t margin = 4;

    [[nodiscard]] Vec3 place(std::int64_t x, std::int64_t y, std::int64_t z) const {
        return {low_[0] + edge_ * (static_cast<double>(x) + 0.5), low_[1] + edge_ * (static_cast<double>(y) + 0.5),
                low_[2] + edge_ * (static_cast<double>(z) + 0.5)};
    }
    [[nodiscard]] std::size_t number(std::int64_t x, std::int64_t y, std::int64_t z) const {
        return static_cast<std::size_t>(x + count_[0] * (y + count_[1] * z));
    }
    /// Counts the faces that a line along z through each column of voxels crosses.
    void fill(const TriangleSurface& surface) {
        constexpr double off_x = 1.1e-4, off_y = 0.7e-4;  // of a voxel: a line meets no edge
        std::vector<std::vector<double>> crossings(static_cast<std::size_t>(count_[0] * count_[1]));
        for (const auto& t : surface.triangles) {
            std::array<Vec3, 3> c{};
            for (std::size_t k = 0; k < 3; ++k) c[k] = surface.corners[static_cast<std::size_t>(t[k])];
            const auto range = [&](std::size_t k) {
                const auto [least, most] = std::minmax({c[0][k], c[1][k], c[2][k]});
                return std::pair(std::max<std::int64_t>(0, whole(std::floor((least - low_[k]) / edge_ - 1))),
                                 std::min(count_[k] - 1, whole(std::ceil((most - low_[k]) / edge_))));
            };
            const double area = (c[1][0] - c[0][0]) * (c[2][1] - c[0][1]) - (c[2][0] - c[0][0]) * (c[1][1] - c[0][1]);
            if (area == 0) continue;
            const auto [x0, x1] = range(0);
            const auto [y0, y1] = range(1);
            for (std::int64_t y = y0; y <= y1; ++y)
                for (std::int64_t x = x0; x <= x1; ++x) {
                    const Vec3 p = place(x, y, 0) + edge_ * Vec3{off_x, off_y, 0};
                    const double u =
                        ((p[0] - c[0][0]) * (c[2][1] - c[0][1]) - (c[2][0] - c[0][0]) * (p[1] - c[0][1])) / area;
                    const double v =
                        ((c[1][0] - c[0][0]) * (p[1] - c[0][1]) - (p[0] - c[0][0]) * (c[1][1] - c[0][1])) / area;
                    if (u < 0 || v < 0 || u + v > 1) continue;
                    crossings[static_cast<std::size_t>(x + count_[0] * y)].push_back(c[0][2] + u * (c[1][2] - c[0][2]) +
                                                                                     v * (c[2][2] - c[0][2]));
                }
        }
        for (std::int64_t y = 0; y < count_[1]; ++y)
            for (std::int64_t x = 0; x < count_[0]; ++x) {
                auto& heights = crossings[static_cast<std::size_t>(x + count_[0] * y)];
                std::ranges::sort(heights);
                std::size_t below = 0;
                for (std::int64_t z = 0; z < count_[2]; ++z) {
                    while (below < heights.size() && heights[below] < place(x, y, z)[2]) ++below;
                    if (below % 2 == 1) inside_[number(x, y, z)] = 1;
                }
            }
    }

    double shortest_ = 0, edge_ = 0;
    std::array<std::int64_t, 3> count_{};
    Vec3 low_{};
    std::vector<std::uint8_t> inside_;
};

double distance_to(const std::vector<Triangle>& triangles, const Vec3& x) {
    double least = std::numeric_limits<double>::infinity();
    for (const Triangle& triangle : triangles) {
        if (std::abs(triangle.height(x)) >= least) continue;
        least = std::min(least, triangle.nearest(x).distance);
    }
    return least;
}

/// Returns inscribed balls about points of the body, swollen: none much smaller than the largest.
std::vector<Ball> inscribed_balls(const TriangleSurface& surface, const Voxels& voxels) {
    std::vector<Triangle> triangles;
    for (const auto& t : surface.triangles) {
        std::array<Vec3, 3> corners{};
        for (std::size_t k = 0; k < 3; ++k) corners[k] = surface.corners[static_cast<std::size_t>(t[k])];
        triangles.push_back(Triangle::of(corners));
    }
    std::vector<std::size_t> within;
    for (std::size_t v = 0; v < voxels.inside().size(); ++v)
        if (voxels.inside()[v] != 0) within.push_back(v);
    if (within.empty()) throw std::invalid_argument("the body is too thin: no ball fits into it");
    std::vector<Ball> balls;
    double largest = 0;
    const std::size_t count = std::min(candidates, within.size());
    for (std::size_t n = 0; n < count; ++n) {
        const double u = stats::to_unit(stats::bits_at(1, 0, n));
        const auto chosen =
            count == within.size() ? n : static_cast<std::size_t>(u * static_cast<double>(within.size()));
        const Vec3 x = voxels.centre(within[chosen]);
        balls.push_back({x, distance_to(triangles, x)});
        largest = std::max(largest, balls.back().radius);
    }
    std::erase_if(balls, [&](const Ball& ball) { return ball.radius < smallest_ball * largest; });
    for (Ball& ball : balls) ball.radius += swelling * voxels.shortest();
    return balls;
}

/// Voxels that spheres cover, in the body and outside of it.
struct Covered {
    double inside = 0, outside = 0;
    [[nodiscard]] double overlap(double body) const { return inside / (body + outside); }
};

/// Returns the cover by these balls, scaled to the volume of the body.
BallCover scaled_to(const geometry::Solid& solid, const Voxels& voxels, double body, std::vector<Ball> balls) {
    BallCover cover{.balls = std::move(balls)};
    const double scale = std::cbrt(solid.volume / solid_of(cover.balls).volume);
    double smallest = std::numeric_limits<double>::infinity(), largest = 0;
    for (Ball& ball : cover.balls) {
        ball.centre = solid.centre + scale * (ball.centre - solid.centre);
        ball.radius *= scale;
        smallest = std::min(smallest, ball.radius), largest = std::max(largest, ball.radius);
    }
    std::vector<std::uint8_t> covered(voxels.inside().size(), 0);
    Covered sum;
    for (const Ball& ball : cover.balls)
        voxels.each_in(ball, [&](std::size_t v) {
            if (covered[v] != 0) return;
            covered[v] = 1;
            (voxels.inside()[v] != 0 ? sum.inside : sum.outside) += 1;
        });
    cover.overlap = sum.overlap(body);
    cover.smallest = smallest / largest;
    return cover;
}

[[noreturn]] void refuse_error(std::size_t spheres, double overlap) {
    char text[200];
    std::snprintf(text, sizeof text,
                  "%zu spheres share %.3g of the volume with the body, and more would add little: an error of at least "
                  "%.3g is needed",
                  spheres, overlap, 1 - overlap);
    throw std::invalid_argument(text);
}

}  // namespace

BallCover ball_cover(const TriangleSurface& surface, const CoverRequest& request) {
    const auto solid = solid_of(surface);
    if (!solid)
        throw std::invalid_argument(
            "the surface is not closed, or has no volume: every edge must belong to two triangles");
    const Voxels voxels(surface);
    const std::vector<Ball> balls = inscribed_balls(surface, voxels);
    const auto& inside = voxels.inside();
    const double body = static_cast<double>(std::ranges::count(inside, std::uint8_t{1}));
    std::vector<std::uint8_t> covered(inside.size(), 0);
    Covered sum;
    std::vector<double> gain(balls.size(), std::numeric_limits<double>::infinity());  // at most this
    std::vector<Ball> chosen;
    while (chosen.size() < request.most) {
        // Gains only fall: a ball whose gain is of now and the largest is the best.
        std::vector<bool> now(balls.size(), false);
        std::size_t best = 0;
        for (;;) {
            best = static_cast<std::size_t>(std::ranges::max_element(gain) - gain.begin());
            if (now[best]) break;
            double count = 0;
            voxels.each_in(balls[best], [&](std::size_t v) { count += inside[v] != 0 && covered[v] == 0 ? 1 : 0; });
            gain[best] = count;
            now[best] = true;
        }
        if (!(gain[best] > 0)) break;
        if (chosen.size() >= 2 && gain[best] < (request.error ? least_gain_of_error : least_gain) * body) break;
        voxels.each_in(balls[best], [&](std::size_t v) {
            if (covered[v] != 0) return;
            covered[v] = 1;
            (inside[v] != 0 ? sum.inside : sum.outside) += 1;
        });
        gain[best] = 0;
        chosen.push_back(balls[best]);
        if (!request.error || 1 - sum.overlap(body) > *request.error || chosen.size() < 2) continue;
        BallCover cover = scaled_to(*solid, voxels, body, chosen);
        if (1 - cover.overlap <= *request.error) return cover;
    }
    BallCover cover = scaled_to(*solid, voxels, body, chosen);
    if (request.error && chosen.size() < request.most && 1 - cover.overlap > *request.error)
        refuse_error(chosen.size(), cover.overlap);
    return cover;
}

}  // namespace grainsweep::particles
