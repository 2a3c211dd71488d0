// Crossings of counting planes by the centres of mobile particles, exact to the step.
//
// Only particles near a plane are followed from step to step: when the lists are made, every particle within `reach` of
// it. No other particle comes to the plane before the lists are made anew, because a list ends when a particle has
// moved by a skin.
#pragma once

#include "solver/geometry/domain.hpp"
#include "solver/geometry/vector.hpp"

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace grainsweep::dem {

using geometry::Vec3;

/// Plane through a point; the unit normal is the direction that counts as forward.
struct CountingPlane {
    Vec3 point{}, normal{};
};

struct Crossing {
    std::int32_t id = 0;
    std::uint32_t plane = 0;
    bool forward = true;
    double steps = 0;  ///< time steps since the start, with the part of the step in which it crossed
    Vec3 position{};   ///< where it crossed, on a straight way in the step, m
};

class Crossings {
public:
    Crossings() = default;
    /// Planes across a periodic axis have an image in every period.
    Crossings(std::vector<CountingPlane> planes, const geometry::Domain& domain);

    [[nodiscard]] bool wanted() const { return !planes_.empty(); }
    /// Selects the particles that are followed, of `count`: the mobile ones within `reach`, m.
    template <class IsMobile, class PositionOf>
    void list(std::size_t count, double reach, IsMobile&& is_mobile, PositionOf&& position_of) {
        followed_.clear();
        reach_ = reach;
        for (std::uint32_t p = 0; p < planes_.size(); ++p)
            for (std::size_t i = 0; i < count; ++i) {
                if (!is_mobile(i)) continue;
                const Vec3 x = position_of(i);
                const double s = height(p, x);
                if (std::abs(s) <= reach) followed_.push_back({p, i, s, x});
            }
    }
    /// Adds the crossings of a step, or a part of one, that took `span` steps and ended after `steps` steps.
    template <class IdOf, class PositionOf>
    void follow(double steps, double span, IdOf&& id_of, PositionOf&& position_of) {
        for (Followed& one : followed_) {
            using namespace geometry;
            const Vec3 x = position_of(one.particle);
            const double s = height(one.plane, x), from = one.height;
            const Vec3 before = std::exchange(one.position, x);
            one.height = s;
            // A larger difference: the particle entered through the other end of a period.
            const double period = periods_[one.plane], farthest = period > 0 ? period / 2 : reach_;
            if ((s >= 0) == (from >= 0) || !(std::abs(s - from) < farthest)) continue;
            const double share = from / (from - s);
            found_.push_back({id_of(one.particle), one.plane, s >= 0, steps - (1 - share) * span,
                              before + share * domain_.separation(x, before)});
        }
    }
    /// Moves all crossings so far behind `into`, in the order of the steps.
    void take(std::vector<Crossing>& into);
    /// Forgets the crossings that were not taken: a restored state does not continue the steps that made them.
    void forget() { found_.clear(); }

private:
    struct Followed {
        std::uint32_t plane;
        std::size_t particle;
        double height;  // above the plane or its nearest image, m
        Vec3 position;
    };
    [[nodiscard]] double height(std::uint32_t plane, const Vec3& x) const;

    std::vector<CountingPlane> planes_;
    std::vector<double> periods_;  // of each plane; 0: none
    geometry::Domain domain_;
    double reach_ = 0;
    std::vector<Followed> followed_;
    std::vector<Crossing> found_;
};

}  // namespace grainsweep::dem
