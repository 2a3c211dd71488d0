#include "tests/support/surfaces.hpp"

#include "solver/geometry/weld.hpp"
#include "stats/random.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace grainsweep::tests {

using namespace geometry;

TriangleSurface surface_of(const Soup& soup) {
    return weld(soup).surface;
}

Soup quadrilateral(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    return {{a, b, c}, {a, c, d}};
}

Soup plate(double half, int n, const std::function<double(double, double)>& height) {
    Soup soup;
    const auto corner = [&](int i, int j) {
        const double x = half * (2.0 * i / n - 1), y = half * (2.0 * j / n - 1);
        return Vec3{x, y, height ? height(x, y) : 0.0};
    };
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
            soup = joined(std::move(soup),
                          quadrilateral(corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)));
    return soup;
}

Soup box(double a, double h) {
    Soup soup = quadrilateral({-a, -a, 0}, {a, -a, 0}, {a, a, 0}, {-a, a, 0});
    soup = joined(std::move(soup), quadrilateral({-a, a, -h}, {a, a, -h}, {a, -a, -h}, {-a, -a, -h}));
    soup = joined(std::move(soup), quadrilateral({a, -a, -h}, {a, a, -h}, {a, a, 0}, {a, -a, 0}));
    soup = joined(std::move(soup), quadrilateral({-a, a, -h}, {-a, -a, -h}, {-a, -a, 0}, {-a, a, 0}));
    soup = joined(std::move(soup), quadrilateral({a, a, -h}, {-a, a, -h}, {-a, a, 0}, {a, a, 0}));
    return joined(std::move(soup), quadrilateral({-a, -a, -h}, {a, -a, -h}, {a, -a, 0}, {-a, -a, 0}));
}

Soup drum(int n, double radius, double half_length) {
    Soup soup;
    const auto corner = [&](double x, int k) {
        const double angle = 2 * std::numbers::pi * (k % n) / n;
        return Vec3{x, radius * std::cos(angle), radius * std::sin(angle)};
    };
    for (int k = 0; k < n; ++k)
        soup = joined(std::move(soup), quadrilateral(corner(-half_length, k), corner(-half_length, k + 1),
                                                     corner(half_length, k + 1), corner(half_length, k)));
    return soup;
}

Soup joined(Soup a, const Soup& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

Soup shuffled(Soup soup, std::uint64_t seed) {
    const stats::Stream random(seed, 77);
    std::uint64_t draw = 0;
    for (std::size_t k = soup.size(); k > 1; --k)
        std::swap(soup[k - 1], soup[static_cast<std::size_t>(random.uniform(draw++) * static_cast<double>(k))]);
    for (auto& triangle : soup) {
        std::ranges::rotate(triangle, triangle.begin() + static_cast<int>(3 * random.uniform(draw++)));
        if (random.uniform(draw++) < 0.5) std::swap(triangle[0], triangle[1]);
    }
    return soup;
}

Vec3 plain_nearest(const std::array<Vec3, 3>& triangle, const Vec3& x) {
    const auto& [a, b, c] = triangle;
    const Vec3 u = b - a, v = c - a, w = x - a;
    const double determinant = dot(u, u) * dot(v, v) - dot(u, v) * dot(u, v);
    const double s = (dot(w, u) * dot(v, v) - dot(w, v) * dot(u, v)) / determinant;
    const double t = (dot(w, v) * dot(u, u) - dot(w, u) * dot(u, v)) / determinant;
    if (s >= 0 && t >= 0 && s + t <= 1) return a + s * u + t * v;
    Vec3 best = a;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3& from = triangle[k];
        const Vec3 along = triangle[(k + 1) % 3] - from;
        const Vec3 at = from + std::clamp(dot(x - from, along) / dot(along, along), 0.0, 1.0) * along;
        if (norm(x - at) < norm(x - best)) best = at;
    }
    return best;
}

std::vector<PlainContact> plain_contacts(const Soup& soup, const Vec3& x, double reach, double tolerance) {
    std::vector<PlainContact> all, kept;
    for (const auto& triangle : soup) {
        const Vec3 point = plain_nearest(triangle, x);
        all.push_back({point, norm(x - point)});
    }
    std::vector<std::size_t> order(soup.size());
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
    std::ranges::stable_sort(order, {}, [&](std::size_t k) { return all[k].distance; });
    for (std::size_t n = 0; n < order.size(); ++n) {
        const PlainContact& candidate = all[order[n]];
        if (candidate.distance >= reach) break;
        bool seen = false;
        for (std::size_t m = 0; m < n && !seen; ++m)
            seen = norm(plain_nearest(soup[order[m]], candidate.point) - candidate.point) <= tolerance;
        if (!seen) kept.push_back(candidate);
    }
    return kept;
}

Vec3 draw(const stats::Stream& random, std::uint64_t& at, const Vec3& half) {
    Vec3 x{};
    for (std::size_t k = 0; k < 3; ++k) x[k] = half[k] * (2 * random.uniform(at++) - 1);
    return x;
}

Soup random_soup(std::uint64_t seed, int n, double size) {
    const stats::Stream random(seed, 5);
    std::uint64_t at = 0;
    Soup soup;
    for (int k = 0; k < n; ++k) {
        const Vec3 middle = draw(random, at, {1, 1, 1});
        const double own = size * std::pow(10.0, -2 * random.uniform(at++));
        soup.push_back({middle + own * draw(random, at, {1, 1, 1}), middle + own * draw(random, at, {1, 1, 1}),
                        middle + own * draw(random, at, {1, 1, 1})});
    }
    return soup;
}

Soup random_fans(std::uint64_t seed) {
    const stats::Stream random(seed, 6);
    std::uint64_t at = 0;
    Soup soup;
    const Vec3 a = draw(random, at, {1, 1, 1}), b = draw(random, at, {1, 1, 1});
    for (int k = 0; k < 5; ++k) soup.push_back({a, b, draw(random, at, {1, 1, 1})});
    Vec3 rim = draw(random, at, {1, 1, 1});
    for (int k = 0; k < 7; ++k) {
        const Vec3 next = draw(random, at, {1, 1, 1});
        soup.push_back({a, rim, next});
        rim = next;
    }
    return soup;
}

Soup shattered_plate(std::uint64_t seed, int points) {
    const stats::Stream random(seed, 7);
    std::uint64_t at = 0;
    Soup soup = plate(1, 1);
    for (int k = 0; k < points; ++k) {
        const Vec3 x = draw(random, at, {1, 1, 0});
        for (std::size_t t = 0; t < soup.size(); ++t) {
            if (norm(plain_nearest(soup[t], x) - x) > 1e-12) continue;
            const auto [a, b, c] = soup[t];
            soup[t] = {a, b, x};
            soup.push_back({b, c, x});
            soup.push_back({c, a, x});
            break;
        }
    }
    return soup;
}

}  // namespace grainsweep::tests
