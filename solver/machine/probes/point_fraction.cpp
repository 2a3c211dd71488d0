// Solid fraction by points: the share of points of a region that lie in a sphere. It counts overlapping spheres of a
// clump once, and needs no centres. Points are those of the additive sequence x_n = frac(n a), a_k = g^-k, g^4 = g + 1,
// in the box around the region: their share errs by less than as many random points would.
#include "solver/machine/probe.hpp"
#include "solver/machine/upright.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <vector>

namespace grainsweep::machine::probes {
namespace {

using geometry::dot;
using geometry::operator-;

constexpr double standard_points = 20000;

/// Spheres by cells as wide as the largest one.
class SphereCells {
public:
    SphereCells(const Frame& frame, const Selection& selection) : frame_(frame.of_spheres()) {
        for (std::size_t i = 0; i < frame_.size(); ++i) width_ = std::max(width_, 2 * frame_.state.radius[i]);
        for (std::size_t k = 0; k < 3; ++k) {
            const geometry::Domain& domain = frame_.domain;
            count_[k] =
                domain.periodic[k] ? std::max<std::int64_t>(1, std::llround(std::floor(domain.length(k) / width_))) : 0;
            edge_[k] = domain.periodic[k] ? domain.length(k) / static_cast<double>(count_[k]) : width_;
        }
        for (std::size_t i = 0; i < frame_.size(); ++i)
            if (frame_.state.mobile[i] != 0 && selection.species_counts(frame_, i))
                cells_[cell_of(frame_.state.position[i])].push_back(i);
    }
    [[nodiscard]] bool covers(const Vec3& x) const {
        const Cell middle = cell_of(x);
        for (std::int64_t dx = -1; dx <= 1; ++dx)
            for (std::int64_t dy = -1; dy <= 1; ++dy)
                for (std::int64_t dz = -1; dz <= 1; ++dz) {
                    const auto found = cells_.find(wrapped({middle[0] + dx, middle[1] + dy, middle[2] + dz}));
                    if (found == cells_.end()) continue;
                    for (const std::size_t i : found->second) {
                        const Vec3 d = frame_.domain.separation(x, frame_.state.position[i]);
                        if (dot(d, d) < frame_.state.radius[i] * frame_.state.radius[i]) return true;
                    }
                }
        return false;
    }

private:
    using Cell = std::array<std::int64_t, 3>;
    [[nodiscard]] Cell wrapped(Cell cell) const {
        for (std::size_t k = 0; k < 3; ++k)
            if (count_[k] > 0) cell[k] = (cell[k] % count_[k] + count_[k]) % count_[k];
        return cell;
    }
    [[nodiscard]] Cell cell_of(const Vec3& x) const {
        Cell cell{};
        for (std::size_t k = 0; k < 3; ++k)
            cell[k] = static_cast<std::int64_t>(std::floor((x[k] - frame_.domain.low[k]) / edge_[k]));
        return wrapped(cell);
    }

    Frame frame_;
    double width_ = 0;
    std::array<std::int64_t, 3> count_{};
    Vec3 edge_{};
    std::map<Cell, std::vector<std::size_t>> cells_;
};

class PointFraction final : public machine::Probe {
public:
    explicit PointFraction(const Options& options)
        : selection_(options),
          in_(*options.region("in")),
          points_(options.number("points", standard_points)),
          below_top_(options.has("below_top") ? std::optional(options.number("below_top")) : std::nullopt) {}
    double look(const Frame& frame) override {
        const Vec3 up = up_of(frame, std::nullopt);
        const double top = below_top_ ? top_of(frame, up) - *below_top_ : undefined;
        const SphereCells spheres(frame, selection_);
        const Bounds box = in_.bounds();
        constexpr double g = 1.2207440846057596;  // root of g^4 = g + 1
        const Vec3 step = {1 / g, 1 / (g * g), 1 / (g * g * g)};
        double inside = 0, covered = 0;
        for (double n = 1; n <= points_; ++n) {
            Vec3 x{};
            for (std::size_t k = 0; k < 3; ++k) {
                const double u = n * step[k];
                x[k] = box.low[k] + (u - std::floor(u)) * (box.high[k] - box.low[k]);
            }
            if (!in_.contains(x) || (below_top_ && !(dot(x, up) <= top))) continue;
            ++inside;
            if (spheres.covers(x)) ++covered;
        }
        return inside > 0 ? covered / inside : undefined;
    }

private:
    /// Returns the height below which 95 % of the centres of particles in the region lie.
    [[nodiscard]] double top_of(const Frame& frame, const Vec3& up) const {
        std::vector<double> heights;
        selection_.each(frame, [&](std::size_t i) { heights.push_back(dot(frame.state.position[i], up)); });
        if (heights.empty()) return undefined;
        const auto place = static_cast<std::size_t>(0.95 * static_cast<double>(heights.size() - 1));
        std::ranges::nth_element(heights, heights.begin() + static_cast<std::ptrdiff_t>(place));
        return heights[place];
    }

    Selection selection_;
    Region in_;
    double points_;
    std::optional<double> below_top_;
};

constexpr std::array point_fraction_options = {
    of_option, option("in", Field::Kind::region, "", "the region: a box, cylinder or ball", true),
    option("points", Field::Kind::quantity, "1", "number of points in the box around the region; default: 20000", false,
           {1, 1e7}),
    option("below_top", Field::Kind::quantity, "m",
           "only points at least this far below the height of 95 % of the centres in the region; default: all")};

std::string flaw_of_point_fraction(const Options& given) {
    return given.region("in")->volume() ? "" : "points need a region with a volume: a box, cylinder or ball";
}

}  // namespace

ProbeInfo point_fraction() {
    return {"point_fraction",
            "1",
            "share of the points of a region that lie in a particle: the solid fraction, also of clumps",
            point_fraction_options,
            make_probe<PointFraction>,
            false,
            {},
            flaw_of_point_fraction};
}

}  // namespace grainsweep::machine::probes
