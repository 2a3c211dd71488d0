#include "stats/moment_statistics.hpp"

#include <cmath>
#include <cstddef>

namespace grainsweep::stats {

std::array<double, 3> central_moments(const RawMoments& m) {
    const double a = m[0];
    return {m[1] - a * a, m[2] - 3 * a * m[1] + 2 * a * a * a,
            m[3] - 4 * a * m[2] + 6 * a * a * m[1] - 3 * a * a * a * a};
}

std::array<MomentStatistic, 4> moment_statistics(const RawMoments& m) {
    const double a = m[0];
    const auto [v, mu3, mu4] = central_moments(m);
    const RawMoments dv{-2 * a, 1, 0, 0};
    const RawMoments d3{-3 * m[1] + 6 * a * a, -3 * a, 1, 0};
    const RawMoments d4{-4 * m[2] + 12 * a * m[1] - 12 * a * a * a, 6 * a * a, -4 * a, 1};
    const double sd = std::sqrt(v);
    std::array<MomentStatistic, 4> all;
    all[0] = {a, {1, 0, 0, 0}};
    all[1].value = sd;
    all[2].value = mu3 / (v * sd);
    all[3].value = mu4 / (v * v);
    for (std::size_t p = 0; p < 4; ++p) {
        all[1].gradient[p] = dv[p] / (2 * sd);
        all[2].gradient[p] = d3[p] / (v * sd) - 1.5 * mu3 * dv[p] / (v * v * sd);
        all[3].gradient[p] = d4[p] / (v * v) - 2 * mu4 * dv[p] / (v * v * v);
    }
    return all;
}

}  // namespace grainsweep::stats
