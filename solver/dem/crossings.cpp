#include "solver/dem/crossings.hpp"

namespace grainsweep::dem {

using namespace geometry;

Crossings::Crossings(std::vector<CountingPlane> planes, const geometry::Domain& domain)
    : planes_(std::move(planes)), periods_(planes_.size(), 0.0), domain_(domain) {
    for (std::size_t p = 0; p < planes_.size(); ++p)
        for (std::size_t k = 0; k < 3; ++k)
            if (domain.periodic[k] && std::abs(planes_[p].normal[k]) == 1) periods_[p] = domain.length(k);
}

double Crossings::height(std::uint32_t plane, const Vec3& x) const {
    const double s = dot(x - planes_[plane].point, planes_[plane].normal), period = periods_[plane];
    return period > 0 ? s - period * std::nearbyint(s / period) : s;
}

void Crossings::take(std::vector<Crossing>& into) {
    into.insert(into.end(), found_.begin(), found_.end());
    found_.clear();
}

}  // namespace grainsweep::dem
