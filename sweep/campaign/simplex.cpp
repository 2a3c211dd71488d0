#include "sweep/campaign/simplex.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace grainsweep::campaign {

std::vector<double> shares_at(std::span<const double> u, std::span<const double> low) {
    const std::size_t d = low.size();
    std::vector<double> shares(low.begin(), low.end());
    double rest = 1 - std::accumulate(low.begin(), low.end(), 0.0), others = 0;
    for (std::size_t k = 0; k + 1 < d; ++k) {
        const double part = u[k] < 1 ? rest * -std::expm1(std::log1p(-u[k]) / static_cast<double>(d - 1 - k)) : rest;
        shares[k] += part;
        rest = std::max(0.0, rest - part);
        others += shares[k];
    }
    shares[d - 1] = std::max(low[d - 1], 1 - others);
    return shares;
}

void share_out(std::span<const Factor> factors, std::span<double> u) {
    std::vector<std::size_t> places;
    std::vector<double> low, coordinates;
    for (std::size_t j = 0; j < factors.size(); ++j) {
        if (!factors[j].share) continue;
        places.push_back(j);
        low.push_back(std::get<Between>(factors[j].range).low);
        coordinates.push_back(u[j]);
    }
    if (places.empty()) return;
    const auto shares = shares_at(coordinates, low);
    for (std::size_t k = 0; k < places.size(); ++k) {
        const auto& range = std::get<Between>(factors[places[k]].range);
        u[places[k]] = (shares[k] - range.low) / (range.high - range.low);
    }
}

bool add_to_one(std::span<const double> shares) {
    constexpr double rounding = 1e-9;
    return std::abs(std::accumulate(shares.begin(), shares.end(), 0.0) - 1) <= rounding;
}

}  // namespace grainsweep::campaign
