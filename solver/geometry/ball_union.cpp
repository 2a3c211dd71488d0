#include "solver/geometry/ball_union.hpp"

#include <boost/math/special_functions/legendre.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace grainsweep::geometry {
namespace {

constexpr int gauss_points = 48;
constexpr double least_arc = 1e-14, least_slab = 1e-13;

/// Nodes in (-1, 1) and weights.
struct GaussRule {
    std::vector<double> at, weight;

    GaussRule() {
        for (const double zero : boost::math::legendre_p_zeros<double>(gauss_points)) {  // those above 0
            const double slope = boost::math::legendre_p_prime(gauss_points, zero);
            for (const double node : {-zero, zero}) {
                at.push_back(node);
                weight.push_back(2 / ((1 - zero * zero) * slope * slope));
            }
        }
    }
};

struct Circle {
    double x, y, r;
};

/// Area and moments of a plane region.
struct PlaneMoments {
    double area = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;
};

/// Indefinite integrals of cos^a sin^b at an angle.
struct Powers {
    double c1, c2, c3, c4, s1, s2, s3, s4, cs, ccs, cccs;

    explicit Powers(double t) {
        const double c = std::cos(t), s = std::sin(t), double_angle = std::sin(2 * t) / 4, four = std::sin(4 * t) / 32;
        c1 = s, c2 = t / 2 + double_angle, c3 = s - s * s * s / 3, c4 = 3 * t / 8 + double_angle + four;
        s1 = -c, s2 = t / 2 - double_angle, s3 = c * c * c / 3 - c, s4 = 3 * t / 8 - double_angle + four;
        cs = s * s / 2, ccs = -c * c * c / 3, cccs = -c * c * c * c / 4;
    }
};

/// Adds the part of an arc to the integrals over the outline: A = 1/2 (x dy - y dx), of x: x^2/2 dy, of x^2: x^3/3 dy
/// ...
void add_arc(const Circle& circle, double from, double to, PlaneMoments& into) {
    const Powers a(from), b(to);
    const auto [x, y, r] = circle;
    const double c1 = b.c1 - a.c1, c2 = b.c2 - a.c2, c3 = b.c3 - a.c3, c4 = b.c4 - a.c4;
    const double s1 = b.s1 - a.s1, s2 = b.s2 - a.s2, s3 = b.s3 - a.s3, s4 = b.s4 - a.s4;
    const double cs = b.cs - a.cs, ccs = b.ccs - a.ccs, cccs = b.cccs - a.cccs;
    into.area += r / 2 * (r * (to - from) + x * c1 + y * s1);
    into.x += r / 2 * (x * x * c1 + 2 * x * r * c2 + r * r * c3);
    into.y += r / 2 * (y * y * s1 + 2 * y * r * s2 + r * r * s3);
    into.xx += r / 3 * (x * x * x * c1 + 3 * x * x * r * c2 + 3 * x * r * r * c3 + r * r * r * c4);
    into.yy += r / 3 * (y * y * y * s1 + 3 * y * y * r * s2 + 3 * y * r * r * s3 + r * r * r * s4);
    into.xy +=
        r / 2 * (y * (x * x * c1 + 2 * x * r * c2 + r * r * c3) + r * (x * x * cs + 2 * x * r * ccs + r * r * cccs));
}

/// Returns the moments of the union of circles.
PlaneMoments slice_of(std::vector<Circle> circles) {
    std::ranges::sort(circles, [](const Circle& a, const Circle& b) { return a.r > b.r; });
    std::vector<Circle> kept;  // those that lie in no other
    for (const Circle& c : circles)
        if (std::ranges::none_of(kept, [&](const Circle& other) {
                return std::hypot(c.x - other.x, c.y - other.y) <= other.r - c.r + 1e-15 * other.r;
            }))
            kept.push_back(c);
    PlaneMoments sum;
    std::vector<double> cuts;
    for (std::size_t i = 0; i < kept.size(); ++i) {
        const Circle& c = kept[i];
        constexpr double whole = 2 * std::numbers::pi;
        cuts.assign({0.0, whole});
        for (std::size_t j = 0; j < kept.size(); ++j) {
            const double dx = kept[j].x - c.x, dy = kept[j].y - c.y, d = std::hypot(dx, dy);
            if (j == i || d >= c.r + kept[j].r || d <= std::abs(c.r - kept[j].r)) continue;
            const double cosine = (d * d + c.r * c.r - kept[j].r * kept[j].r) / (2 * d * c.r);
            const double half = std::acos(std::clamp(cosine, -1.0, 1.0)), middle = std::atan2(dy, dx);
            for (const double at : {middle - half, middle + half}) cuts.push_back(at - whole * std::floor(at / whole));
        }
        std::ranges::sort(cuts);
        for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
            if (cuts[k + 1] - cuts[k] < least_arc) continue;
            const double middle = (cuts[k] + cuts[k + 1]) / 2;
            const double x = c.x + c.r * std::cos(middle), y = c.y + c.r * std::sin(middle);
            bool covered = false;
            for (std::size_t j = 0; j < kept.size() && !covered; ++j)
                covered = j != i && std::hypot(x - kept[j].x, y - kept[j].y) < kept[j].r;
            if (!covered) add_arc(c, cuts[k], cuts[k + 1], sum);
        }
    }
    return sum;
}

bool meet(const Ball& a, const Ball& b) {
    const double d = norm(b.centre - a.centre);
    return d < a.radius + b.radius && d > std::abs(a.radius - b.radius);
}

/// Appends the heights of the points that three spheres have in common.
void add_common_heights(const Ball& a, const Ball& b, const Ball& c, std::vector<double>& heights) {
    const Vec3 ab = b.centre - a.centre, ac = c.centre - a.centre;
    const double d = norm(ab);
    const Vec3 ex = (1 / d) * ab;
    const double i = dot(ex, ac);
    const Vec3 across = ac - i * ex;
    const double q = norm(across);
    if (q < 1e-12) return;
    const Vec3 ey = (1 / q) * across, ez = cross(ex, ey);
    const double ra = a.radius, rb = b.radius, rc = c.radius;
    const double x = (ra * ra - rb * rb + d * d) / (2 * d);
    const double y = (ra * ra - rc * rc + i * i + q * q - 2 * i * x) / (2 * q);
    const double z2 = ra * ra - x * x - y * y;
    if (!(z2 > 0)) return;
    const double z = a.centre[2] + x * ex[2] + y * ey[2];
    heights.push_back(z + std::sqrt(z2) * ez[2]);
    heights.push_back(z - std::sqrt(z2) * ez[2]);
}

/// Returns the heights at which the outline of a slice changes its arcs, ascending.
std::vector<double> changes_of(const std::vector<Ball>& balls) {
    std::vector<double> heights;
    for (std::size_t i = 0; i < balls.size(); ++i) {
        const auto& [x, r] = balls[i];
        heights.push_back(x[2] - r);
        heights.push_back(x[2] + r);
        std::vector<std::size_t> met;
        for (std::size_t j = i + 1; j < balls.size(); ++j)
            if (meet(balls[i], balls[j])) met.push_back(j);
        for (const std::size_t j : met) {
            const Vec3 d = balls[j].centre - x;
            const double distance = norm(d), rj = balls[j].radius;
            const double along = (distance * distance + r * r - rj * rj) / (2 * distance);
            const double circle = std::sqrt(std::max(r * r - along * along, 0.0)), upright = d[2] / distance;
            const double reach = circle * std::sqrt(std::max(0.0, 1 - upright * upright));
            heights.push_back(x[2] + along * upright - reach);
            heights.push_back(x[2] + along * upright + reach);
            for (const std::size_t k : met)
                if (k > j && meet(balls[j], balls[k])) add_common_heights(balls[i], balls[j], balls[k], heights);
        }
    }
    std::ranges::sort(heights);
    return heights;
}

}  // namespace

Solid solid_of(std::span<const Ball> given) {
    // In units of the largest radius, about the first centre.
    double unit = 0;
    for (const Ball& ball : given) unit = std::max(unit, ball.radius);
    const Vec3 origin = given.front().centre;
    std::vector<Ball> balls;
    for (const Ball& ball : given) balls.push_back({(1 / unit) * (ball.centre - origin), ball.radius / unit});
    const std::vector<double> heights = changes_of(balls);
    static const GaussRule gauss;
    double volume = 0;
    Vec3 first{};
    std::array<double, 6> second{};  // xx xy xz yy yz zz
    std::vector<Circle> circles;
    for (std::size_t h = 0; h + 1 < heights.size(); ++h) {
        const double low = heights[h], width = heights[h + 1] - low;
        if (width < least_slab) continue;
        for (std::size_t g = 0; g < gauss_points; ++g) {
            // z = low + width (1 - cos t)/2: areas grow with the root of the height where a circle begins.
            const double t = std::numbers::pi / 2 * (1 + gauss.at[g]);
            const double z = low + width * (1 - std::cos(t)) / 2;
            const double weight = gauss.weight[g] * std::numbers::pi / 2 * width * std::sin(t) / 2;
            circles.clear();
            for (const auto& [x, r] : balls)
                if (std::abs(z - x[2]) < r) circles.push_back({x[0], x[1], std::sqrt(r * r - (z - x[2]) * (z - x[2]))});
            if (circles.empty()) continue;
            const PlaneMoments m = slice_of(circles);
            volume += weight * m.area;
            first += weight * Vec3{m.x, m.y, z * m.area};
            const std::array<double, 6> of_slice = {m.xx, m.xy, z * m.x, m.yy, z * m.y, z * z * m.area};
            for (std::size_t k = 0; k < 6; ++k) second[k] += weight * of_slice[k];
        }
    }
    const Vec3 c = (1 / volume) * first;
    const double xx = second[0] - volume * c[0] * c[0], xy = second[1] - volume * c[0] * c[1],
                 xz = second[2] - volume * c[0] * c[2], yy = second[3] - volume * c[1] * c[1],
                 yz = second[4] - volume * c[1] * c[2], zz = second[5] - volume * c[2] * c[2];
    const double cube = unit * unit * unit, fifth = cube * unit * unit;
    return solid_of(volume * cube, origin + unit * c,
                    {fifth * (yy + zz), -fifth * xy, -fifth * xz, fifth * (xx + zz), -fifth * yz, fifth * (xx + yy)});
}

}  // namespace grainsweep::geometry
