#include "solver/geometry/loose_parts.hpp"

#include "solver/geometry/bounds.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <iterator>
#include <limits>
#include <numeric>
#include <unordered_map>
#include <utility>
#include <vector>

namespace grainsweep::geometry {
namespace {

constexpr double crack = 1e-3;     // of the extent: free edges nearer than this meet
constexpr double same = 1e-5;      // of the extent: lengths that differ by less
constexpr double lip_share = 0.5;  // of the width
constexpr double slender = 5;      // length over width
constexpr auto none = std::numeric_limits<std::uint32_t>::max();

double outward(const Vec3& x, const End& end) {
    return end.high ? x[end.axis] : -x[end.axis];
}

const Vec3& outermost(const Triangle& t, const End& end) {
    return *std::ranges::max_element(t.corner, {}, [&](const Vec3& x) { return outward(x, end); });
}

double reach(const Triangle& t, const End& end) {
    return outward(outermost(t, end), end);
}

double area(const Triangle& t) {
    return norm(cross(t.corner[1] - t.corner[0], t.corner[2] - t.corner[0])) / 2;
}

double size_of(const Mesh& mesh) {
    return norm(mesh.high() - mesh.low());
}

/// Returns the points where the sides of a triangle cross a level: two or none.
std::vector<Vec3> cut(const Triangle& t, const End& end, double level) {
    std::vector<Vec3> points;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 &a = t.corner[k], &b = t.corner[(k + 1) % 3];
        const double before = outward(a, end) - level, after = outward(b, end) - level;
        if ((before < 0) != (after < 0)) points.push_back(a + before / (before - after) * (b - a));
    }
    return points;
}

/// Points in which the sides of a triangle meet another one, and its corners on it.
void add_meeting_points(const Triangle& a, const Triangle& b, double tolerance, std::vector<Vec3>& into) {
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 &from = a.corner[k], &to = a.corner[(k + 1) % 3];
        if (b.nearest(from).distance <= tolerance) into.push_back(from);
        const double before = b.height(from), after = b.height(to);
        if ((before > 0) == (after > 0)) continue;
        const Vec3 through = from + before / (before - after) * (to - from);
        if (b.nearest(through).distance <= tolerance) into.push_back(through);
    }
}

/// Corners a < b of an edge.
using TriangleSide = std::pair<std::int32_t, std::int32_t>;

struct SideHash {
    std::size_t operator()(const TriangleSide& side) const {
        const auto a = static_cast<std::uint64_t>(side.first), b = static_cast<std::uint64_t>(side.second);
        const std::uint64_t h = (a << 32U | b) * 0x9E3779B97F4A7C15ULL;
        return static_cast<std::size_t>(h ^ (h >> 29U));
    }
};

struct Edge {
    std::array<std::uint32_t, 2> triangles{};  // the first two
    std::uint32_t count = 0;
    bool meets = false;  // free, along a free edge of another part
};

struct Part {
    std::vector<std::uint32_t> triangles;
    double area = 0;
    Bounds box;

    [[nodiscard]] double reach(const End& end) const { return end.high ? box.high[end.axis] : -box.low[end.axis]; }
};

class Parts {
public:
    Parts(const Mesh& mesh, std::size_t width)
        : mesh_(mesh), width_(width), same_(same * size_of(mesh)), first_(mesh.triangles().size()) {
        std::iota(first_.begin(), first_.end(), 0U);
        count_edges();
        for (const auto& [side, edge] : edges_)
            if (edge.count == 2) join(edge.triangles[0], edge.triangles[1]);
        join_along_cracks();
        collect();
    }

    [[nodiscard]] std::optional<LooseTriangles> loose_at(const End& end, double share) const {
        std::vector<std::uint32_t> outer(parts_.size());
        std::iota(outer.begin(), outer.end(), 0U);
        std::ranges::sort(outer, std::greater{}, [&](std::uint32_t p) { return parts_[p].reach(end); });
        double sum = 0;
        std::size_t count = 0;  // of loose parts before the first that is not
        while (count < outer.size()) {
            const Part& part = parts_[outer[count]];
            if ((sum += part.area) > share * area_ || !is_loose(part)) break;
            ++count;
        }
        if (count == 0 || count == outer.size()) return std::nullopt;
        const double rest = parts_[outer[count]].reach(end);
        outer.resize(count);
        std::erase_if(outer, [&](std::uint32_t p) { return parts_[p].reach(end) - rest <= same_; });
        if (outer.empty() || is_lip(outer, end, rest)) return std::nullopt;
        const Part& first = parts_[outer.front()];
        const auto tip = std::ranges::max_element(first.triangles, {},
                                                  [&](std::uint32_t t) { return reach(mesh_.triangles()[t], end); });
        LooseTriangles loose{0, outermost(mesh_.triangles()[*tip], end), first.reach(end) - rest};
        for (const std::uint32_t p : outer) loose.count += parts_[p].triangles.size();
        return loose;
    }

private:
    [[nodiscard]] std::array<TriangleSide, 3> sides(std::uint32_t t) const {
        const auto& c = mesh_.surface().triangles[t];
        return {TriangleSide(std::minmax(c[0], c[1])), TriangleSide(std::minmax(c[1], c[2])),
                TriangleSide(std::minmax(c[2], c[0]))};
    }
    [[nodiscard]] const Vec3& corner(std::int32_t c) const {
        return mesh_.surface().corners[static_cast<std::size_t>(c)];
    }

    void count_edges() {
        edges_.reserve(2 * first_.size());
        for (std::uint32_t t = 0; t < first_.size(); ++t)
            for (const TriangleSide& side : sides(t)) {
                Edge& edge = edges_[side];
                if (edge.count < 2) edge.triangles[edge.count] = t;
                ++edge.count;
            }
    }

    std::uint32_t first_of(std::uint32_t t) {
        while (first_[t] != t) t = first_[t] = first_[first_[t]];
        return t;
    }
    void join(std::uint32_t a, std::uint32_t b) {
        a = first_of(a);
        b = first_of(b);
        first_[std::max(a, b)] = std::min(a, b);
    }

    void join_along_cracks() {
        std::vector<std::uint32_t> piece(first_.size()), beside;
        for (std::uint32_t t = 0; t < piece.size(); ++t) piece[t] = first_of(t);
        const double near = crack * size_of(mesh_);
        for (auto& [side, edge] : edges_) {
            if (edge.count != 1) continue;
            const Vec3 middle = 0.5 * (corner(side.first) + corner(side.second));
            mesh_.near(middle, near, beside);
            for (const std::uint32_t t : beside) {
                if (piece[t] == piece[edge.triangles[0]]) continue;
                for (const TriangleSide& with : sides(t)) {
                    Edge& other = edges_.at(with);
                    const Vec3 &a = corner(with.first), along = corner(with.second) - a;
                    const double share = dot(middle - a, along) / dot(along, along);
                    if (other.count != 1 || !(share > 0 && share < 1)) continue;
                    if (norm(middle - a - share * along) > near) continue;
                    join(t, edge.triangles[0]);
                    edge.meets = other.meets = true;
                }
            }
        }
    }

    void collect() {
        std::vector<std::uint32_t> number(first_.size(), none);
        part_.resize(first_.size());
        for (std::uint32_t t = 0; t < first_.size(); ++t) {
            const Triangle& triangle = mesh_.triangles()[t];
            std::uint32_t& n = number[first_of(t)];
            if (n == none) {
                n = static_cast<std::uint32_t>(parts_.size());
                parts_.push_back({{}, 0, {triangle.corner[0], triangle.corner[0]}});
            }
            part_[t] = n;
            Part& part = parts_[n];
            part.triangles.push_back(t);
            part.area += area(triangle);
            area_ += area(triangle);
            part.box.widen(bounds_around(triangle.corner));
            free_sides_ += count_free(t);
        }
    }

    /// At one of the two ends along the width, and of a triangle that is not.
    [[nodiscard]] bool at_open_end(const TriangleSide& side, std::uint32_t t) const {
        const Vec3 &a = corner(side.first), &b = corner(side.second);
        const auto within = [&](double level) {
            const auto is_there = [&](const Vec3& x) { return std::abs(x[width_] - level) <= same_; };
            return is_there(a) && is_there(b) && !std::ranges::all_of(mesh_.triangles()[t].corner, is_there);
        };
        return within(mesh_.low()[width_]) || within(mesh_.high()[width_]);
    }
    [[nodiscard]] bool is_free(const TriangleSide& side, std::uint32_t t) const {
        const Edge& edge = edges_.at(side);
        return edge.count == 1 && !edge.meets && !at_open_end(side, t);
    }
    [[nodiscard]] std::ptrdiff_t count_free(std::uint32_t t) const {
        return std::ranges::count_if(sides(t), [&](const TriangleSide& side) { return is_free(side, t); });
    }

    [[nodiscard]] bool is_loose(const Part& part) const {
        std::unordered_map<TriangleSide, int, SideHash> times;
        bool shares_edge = false;
        for (const std::uint32_t t : part.triangles) {
            if (count_free(t) > 0) return true;
            for (const TriangleSide& side : sides(t)) {
                ++times[side];
                shares_edge = shares_edge || edges_.at(side).count > 2;
            }
        }
        const bool closed = std::ranges::all_of(times, [](const auto& side) { return side.second == 2; });
        return (closed && is_flat(part)) || (!shares_edge && !touches_along(part));
    }

    [[nodiscard]] bool is_flat(const Part& part) const {
        const Triangle& plane = mesh_.triangles()[part.triangles.front()];
        return std::ranges::all_of(part.triangles, [&](std::uint32_t t) {
            return std::ranges::all_of(mesh_.triangles()[t].corner, [&](const Vec3& x) {
                return std::abs(plane.height(x)) <= 10 * mesh_.tolerance();
            });
        });
    }

    /// Touches or cuts other parts in more than a point.
    [[nodiscard]] bool touches_along(const Part& part) const {
        std::vector<Vec3> points;
        std::vector<std::uint32_t> beside;
        for (const std::uint32_t t : part.triangles) {
            const Triangle& mine = mesh_.triangles()[t];
            const Vec3 middle = 0.5 * (mine.corner[0] + mine.corner[2]);
            const double radius = std::max(norm(mine.corner[0] - middle), norm(mine.corner[1] - middle));
            mesh_.near(middle, radius + mesh_.tolerance(), beside);
            for (const std::uint32_t other : beside) {
                if (part_[other] == part_[t]) continue;
                add_meeting_points(mine, mesh_.triangles()[other], mesh_.tolerance(), points);
                add_meeting_points(mesh_.triangles()[other], mine, mesh_.tolerance(), points);
            }
            for (const Vec3& x : points)
                if (norm(x - points.front()) > same_) return true;
        }
        return false;
    }

    /// A surface that is open elsewhere too, and parts of it that run along its width, a quarter of their reach beyond
    /// the rest.
    [[nodiscard]] bool is_lip(const std::vector<std::uint32_t>& outer, const End& end, double rest) const {
        if (end.axis == width_) return false;
        const double level = rest + (parts_[outer.front()].reach(end) - rest) / 4;
        std::ptrdiff_t own = 0;
        std::vector<std::pair<double, double>> spans;
        for (const std::uint32_t p : outer)
            for (const std::uint32_t t : parts_[p].triangles) {
                own += count_free(t);
                const auto points = cut(mesh_.triangles()[t], end, level);
                if (points.size() == 2) spans.emplace_back(std::minmax(points[0][width_], points[1][width_]));
            }
        if (own == free_sides_) return false;
        std::ranges::sort(spans);
        double covered = 0, reached = mesh_.low()[width_];
        for (const auto& [from, to] : spans) {
            covered += std::max(0.0, to - std::max(from, reached));
            reached = std::max(reached, to);
        }
        return covered >= lip_share * (mesh_.high()[width_] - mesh_.low()[width_]);
    }

    const Mesh& mesh_;
    std::size_t width_;
    double same_;  // m
    std::unordered_map<TriangleSide, Edge, SideHash> edges_;
    std::vector<std::uint32_t> first_, part_;  // of each triangle
    std::vector<Part> parts_;
    double area_ = 0;
    std::ptrdiff_t free_sides_ = 0;
};

}  // namespace

std::optional<LooseTriangles> loose_triangles(const Mesh& mesh, std::size_t width, std::span<const End> ends,
                                              double share) {
    const Parts parts(mesh, width);
    for (const End& end : ends)
        if (const auto loose = parts.loose_at(end, share)) return loose;
    return std::nullopt;
}

std::optional<Needle> needle_at(const Mesh& mesh, const End& end, double share) {
    std::vector<Triangle> outer(mesh.triangles().begin(), mesh.triangles().end());
    std::ranges::sort(outer, std::greater{}, [&](const Triangle& t) { return reach(t, end); });
    double all = 0, sum = 0;
    for (const Triangle& t : outer) all += area(t);
    std::size_t count = 0;
    while (count + 1 < outer.size() && (sum += area(outer[count])) <= share * all) ++count;
    Needle needle{outermost(outer[0], end), reach(outer[0], end) - reach(outer[count], end), 0};
    if (!(needle.length > same * size_of(mesh))) return std::nullopt;
    const double half = reach(outer[0], end) - needle.length / 2;
    std::vector<Vec3> section;
    for (std::size_t n = 0; n < count; ++n) std::ranges::copy(cut(outer[n], end, half), std::back_inserter(section));
    if (section.empty()) return std::nullopt;
    const auto [low, high] = bounds_around(section);
    needle.width = norm(high - low);
    if (needle.length < slender * needle.width) return std::nullopt;
    return needle;
}

}  // namespace grainsweep::geometry
