// Solid fraction by points: the share of points of a region that lie in a sphere. It counts overlapping spheres of a
// clump once, and needs no centres. Points are those of the additive sequence x_n = frac(n a), a_k = g^-k, g^4 = g + 1,
// in the box around the region: their share errs by less than as many random points would.
#include "solver/machine/neighbourhood.hpp"
#include "solver/machine/probe.hpp"
#include "solver/machine/upright.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace grainsweep::machine::probes {
namespace {

using geometry::dot;
using geometry::operator-;

constexpr double standard_points = 20000;

/// Returns the mobile spheres of the selected species.
Neighbourhood spheres_in(const Frame& frame, const Selection& selection) {
    const Frame spheres = frame.of_spheres();
    const auto& state = spheres.state;
    const double largest = state.radius.empty() ? 1 : std::ranges::max(state.radius);
    Neighbourhood found(frame.domain, 2 * largest);
    for (std::size_t i = 0; i < spheres.size(); ++i)
        if (state.mobile[i] != 0 && selection.is_of(spheres, spheres.id(i)))
            found.add(state.position[i], state.radius[i]);
    return found;
}

class PointFraction final : public machine::Probe {
public:
    explicit PointFraction(const Options& options)
        : selection_(options),
          in_(*options.region("in")),
          points_(options.number("points", standard_points)),
          below_top_(options.given<double>("below_top")) {}
    double look(const Frame& frame) override {
        const Vec3 up = up_of(frame, std::nullopt);
        const double top = below_top_ ? top_of(frame, up) - *below_top_ : undefined;
        const Neighbourhood spheres = spheres_in(frame, selection_);
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
            if (spheres.occupied(x, 0)) ++covered;
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
    return probe_row<PointFraction>(
        "point_fraction", "1",
        "share of the points of a region that lie in a particle: the solid fraction, also of clumps",
        point_fraction_options, {.flaw = flaw_of_point_fraction});
}

}  // namespace grainsweep::machine::probes
