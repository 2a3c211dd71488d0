#include "solver/particles/random_addition.hpp"

#include "stats/random.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace grainsweep::particles {
namespace {

using Vec3 = std::array<double, 3>;

constexpr int most_tries = 100'000;

/// Boxes with the spheres that reach into them, so that a try is compared only with what it could touch. In a large
/// room of few spheres boxes are longer than `edge`: there are a few per sphere. They change no result.
class Boxes {
public:
    Boxes(const Room& room, double edge, std::size_t spheres) : room_(room) {
        const double most = 8 * static_cast<double>(spheres) + 64;
        std::array<double, 3> count{};
        for (;; edge *= 1.3) {
            for (std::size_t a = 0; a < 3; ++a)
                count[a] = std::max(1.0, std::floor((room.high[a] - room.low[a]) / edge));
            if (count[0] * count[1] * count[2] <= most) break;
        }
        for (std::size_t a = 0; a < 3; ++a) {
            count_[a] = static_cast<std::int64_t>(count[a]);
            edge_[a] = (room.high[a] - room.low[a]) / count[a];
        }
        spheres_.resize(static_cast<std::size_t>(count_[0] * count_[1] * count_[2]));
    }

    /// Calls visit(box) for every box the cube around x reaches into; stops and returns false when visit does.
    template <class Visit>
    bool every(const Vec3& x, double radius, Visit visit) {
        std::array<std::int64_t, 3> first{}, last{};
        for (std::size_t a = 0; a < 3; ++a) {
            first[a] = static_cast<std::int64_t>(std::floor((x[a] - radius - room_.low[a]) / edge_[a]));
            last[a] = static_cast<std::int64_t>(std::floor((x[a] + radius - room_.low[a]) / edge_[a]));
            if (room_.periodic[a]) {
                last[a] = std::min(last[a], first[a] + count_[a] - 1);
            } else {
                first[a] = std::max<std::int64_t>(first[a], 0);
                last[a] = std::min(last[a], count_[a] - 1);
            }
        }
        const auto wrapped = [this](std::int64_t k, std::size_t a) {
            return room_.periodic[a] ? ((k % count_[a]) + count_[a]) % count_[a] : k;
        };
        for (std::int64_t i = first[0]; i <= last[0]; ++i)
            for (std::int64_t j = first[1]; j <= last[1]; ++j)
                for (std::int64_t k = first[2]; k <= last[2]; ++k) {
                    const std::int64_t box = (wrapped(i, 0) * count_[1] + wrapped(j, 1)) * count_[2] + wrapped(k, 2);
                    if (!visit(spheres_[static_cast<std::size_t>(box)])) return false;
                }
        return true;
    }

private:
    const Room& room_;
    std::array<std::int64_t, 3> count_{};
    Vec3 edge_{};
    std::vector<std::vector<std::size_t>> spheres_;
};

}  // namespace

std::optional<std::vector<Vec3>> random_addition(const Room& room, std::span<const double> radii, std::uint64_t seed) {
    std::vector<Vec3> centres(radii.size());
    if (radii.empty()) return centres;
    std::vector<std::size_t> order(radii.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return radii[a] > radii[b]; });
    for (std::size_t a = 0; a < 3; ++a)
        if (room.periodic[a] && 4 * radii[order.front()] > room.high[a] - room.low[a])
            throw std::invalid_argument("the largest sphere is wider than half the period it is to be placed in");

    const double mean = std::accumulate(radii.begin(), radii.end(), 0.0) / static_cast<double>(radii.size());
    Boxes boxes(room, 2 * mean, radii.size());
    for (const std::size_t i : order) {
        const double r = radii[i];
        stats::Generator random(stats::bits_at(seed, 0, i));
        const auto free = [&](const Vec3& x) {
            return boxes.every(x, r, [&](const std::vector<std::size_t>& present) {
                return std::ranges::none_of(present, [&](std::size_t j) {
                    Vec3 apart{};
                    for (std::size_t a = 0; a < 3; ++a) {
                        apart[a] = x[a] - centres[j][a];
                        const double period = room.high[a] - room.low[a];
                        if (room.periodic[a]) apart[a] -= period * std::nearbyint(apart[a] / period);
                    }
                    const double reach = r + radii[j];
                    return apart[0] * apart[0] + apart[1] * apart[1] + apart[2] * apart[2] < reach * reach;
                });
            });
        };
        bool placed = false;
        for (int tries = 0; tries < most_tries && !placed; ++tries) {
            for (std::size_t a = 0; a < 3; ++a) {
                const double inset = room.periodic[a] ? 0 : r;
                const double space = room.high[a] - room.low[a] - 2 * inset;
                centres[i][a] = room.low[a] + inset + std::max(space, 0.0) * random.uniform();
            }
            placed = (!room.holds || room.holds(centres[i], r)) && free(centres[i]);
        }
        if (!placed) return std::nullopt;
        boxes.every(centres[i], r, [i](std::vector<std::size_t>& present) {
            present.push_back(i);
            return true;
        });
    }
    return centres;
}

}  // namespace grainsweep::particles
