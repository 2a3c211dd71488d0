#include "solver/geometry/level_surface.hpp"

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <utility>

namespace grainsweep::geometry {
namespace {

/// Nodes 0 ... nodes-1 along each axis: those of the grid, the first and the last twice.
class Nets {
public:
    Nets(const std::function<double(const Vec3&)>& f, const Vec3& low, const Vec3& high, int cells)
        : low_(low), high_(high), cells_(cells), nodes_(static_cast<std::size_t>(cells) + 3) {
        values_.reserve(nodes_ * nodes_ * nodes_);
        for (std::size_t k = 0; k < nodes_; ++k)
            for (std::size_t j = 0; j < nodes_; ++j)
                for (std::size_t i = 0; i < nodes_; ++i) values_.push_back(f(place({i, j, k})));
        corner_of_.assign(values_.size(), -1);
    }

    TriangleSurface surface() {
        for (std::size_t k = 0; k + 1 < nodes_; ++k)
            for (std::size_t j = 0; j + 1 < nodes_; ++j)
                for (std::size_t i = 0; i + 1 < nodes_; ++i) set_corner({i, j, k});
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (std::size_t k = 0; k < nodes_; ++k)
                for (std::size_t j = 0; j < nodes_; ++j)
                    for (std::size_t i = 0; i < nodes_; ++i) set_faces({i, j, k}, axis);
        return std::move(surface_);
    }

private:
    using Node = std::array<std::size_t, 3>;

    [[nodiscard]] Vec3 place(const Node& node) const {
        Vec3 x;
        for (std::size_t a = 0; a < 3; ++a) {
            const double share = std::clamp((static_cast<double>(node[a]) - 1) / cells_, 0.0, 1.0);
            x[a] = low_[a] + share * (high_[a] - low_[a]);
        }
        return x;
    }
    [[nodiscard]] std::size_t index(const Node& node) const { return node[0] + nodes_ * (node[1] + nodes_ * node[2]); }
    [[nodiscard]] double value(const Node& node) const { return values_[index(node)]; }
    [[nodiscard]] static Node beside(Node node, std::size_t axis, std::size_t by = 1) {
        node[axis] += by;
        return node;
    }

    /// The corner of the cell above the node, where f changes sign in it.
    void set_corner(const Node& node) {
        Vec3 sum{};
        int crossings = 0;
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (std::size_t side = 0; side < 4; ++side) {
                const Node from = beside(beside(node, (axis + 1) % 3, side % 2), (axis + 2) % 3, side / 2);
                const Node to = beside(from, axis);
                const double a = value(from);
                const double b = value(to);
                if ((a > 0) == (b > 0)) continue;
                sum += place(from) + (a / (a - b)) * (place(to) - place(from));
                ++crossings;
            }
        if (crossings == 0) return;
        corner_of_[index(node)] = static_cast<std::int32_t>(surface_.corners.size());
        surface_.corners.push_back((1.0 / crossings) * sum);
    }

    /// The quadrilateral around the edge from the node along the axis, between the corners of the four cells at it.
    void set_faces(const Node& node, std::size_t axis) {
        const std::size_t u = (axis + 1) % 3;
        const std::size_t v = (axis + 2) % 3;
        if (node[axis] + 1 >= nodes_ || node[u] == 0 || node[v] == 0 || node[u] + 1 >= nodes_ || node[v] + 1 >= nodes_)
            return;
        const bool out = value(node) > 0;
        if (out == (value(beside(node, axis)) > 0)) return;
        const auto corner = [&](std::size_t back_u, std::size_t back_v) {
            Node cell = node;
            cell[u] -= back_u;
            cell[v] -= back_v;
            return corner_of_[index(cell)];
        };
        std::array<std::int32_t, 4> ring = {corner(1, 1), corner(0, 1), corner(0, 0), corner(1, 0)};
        if (out) std::reverse(ring.begin(), ring.end());
        surface_.triangles.push_back({ring[0], ring[1], ring[2]});
        surface_.triangles.push_back({ring[0], ring[2], ring[3]});
    }

    Vec3 low_, high_;
    int cells_;
    std::size_t nodes_;
    std::vector<double> values_;
    std::vector<std::int32_t> corner_of_;  // of the cell above a node; -1: none
    TriangleSurface surface_;
};

}  // namespace

TriangleSurface level_surface(const std::function<double(const Vec3&)>& f, const Vec3& low, const Vec3& high,
                              int cells) {
    if (cells < 1) throw std::invalid_argument("a surface needs a grid of at least one cell");
    return Nets(f, low, high, cells).surface();
}

}  // namespace grainsweep::geometry
