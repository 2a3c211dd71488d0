// Latin hypercube (McKay, Beckman & Conover 1979): each factor visits each of n equal cells once,
//   x_pj = (pi_j(p) + u_pj)/n,  pi_j independent random permutations, u uniform in [0, 1).
#include "stats/random.hpp"
#include "sweep/designs/kinds.hpp"

#include <algorithm>
#include <cmath>

namespace grainsweep::designs {
namespace {

PointSet latin_hypercube_points(const DesignRequest& request) {
    const std::int64_t points = request.count("points");
    const std::size_t d = request.dimensions();
    PointSet set{.dimensions = d, .sequences = 1, .coordinates = room_for(points, d)};
    const double below_one = std::nextafter(1.0, 0.0);
    for (std::size_t j = 0; j < d; ++j) {
        const stats::Generator shuffler(draw_key(request.seed, DrawPurpose::latin_hypercube, j, 0));
        const auto cells = stats::permutation(static_cast<std::uint32_t>(points), shuffler);
        const stats::Stream inside(draw_key(request.seed, DrawPurpose::latin_hypercube, j, 1), 0);
        for (std::size_t p = 0; p < cells.size(); ++p) {
            const double x = (static_cast<double>(cells[p]) + inside.uniform(p)) / static_cast<double>(points);
            set.coordinates[p * d + j] = std::min(x, below_one);  // the sum may round up to n
        }
    }
    return set;
}

}  // namespace

DesignInfo latin_hypercube_design() {
    return {.name = "latin_hypercube",
            .summary =
                "Every factor evenly covered by itself, at random jointly. For a fixed, small number of points; it "
                "cannot be extended, and for statistics it is far behind halton (24000 points for 1 % on mean, sd, "
                "kurtosis and g1 together, random halton 650).",
            .options = {points_option("number of points")},
            .size = points_asked,
            .sample = latin_hypercube_points};
}

}  // namespace grainsweep::designs
