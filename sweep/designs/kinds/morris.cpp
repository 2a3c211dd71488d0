// Morris' screening (Morris 1991, Technometrics 33, 161-174): trajectories of d + 1 points on a grid of L
// levels per factor, i/(L-1); each step moves one factor, in random order, by Delta = L/(2(L-1)).
//
// Factors of a group make their steps at once (Campolongo, Cariboni & Saltelli 2007, Environ. Model. Softw. 22, 1509):
// trajectories of g + 1 points for g groups.
//
// Trajectory t is points t (d+1) ... t (d+1) + d. The set counts d + 1 sequences: a point's sequence is its
// place in its trajectory. L is even, so that every place is as likely as every other.
//
// A factor whose distribution has no ends has its grid at the middles of cells, (i + 1/2)/L: its steps are 1/2.
//
// A factor with k levels has them for its grid, unless L is a multiple of k: then each level is L/k places of the grid.
// Steps are floor(k/2) levels; where k is odd, the middle level moves to either end, and it is met twice as often as
// the others. Trajectories begin at a random permutation of the levels, then at another: k of them meet all levels.
#include "stats/random.hpp"
#include "sweep/designs/kinds.hpp"

#include <set>
#include <stdexcept>
#include <string>

namespace grainsweep::designs {
namespace {

std::size_t trajectory_length(std::size_t groups) {
    return groups + 1;
}

std::int64_t morris_size(const DesignRequest& request) {
    return request.count("trajectories") * static_cast<std::int64_t>(trajectory_length(request.group_count()));
}

std::string name_of(const DesignRequest& request, std::size_t j) {
    return j < request.factors.size() ? "factor '" + request.factors[j].name + "'" : "factor " + std::to_string(j + 1);
}

/// Where one factor stands on its trajectories.
class Axis {
public:
    Axis(const DesignRequest& request, std::size_t j)
        : seed_(request.seed),
          factor_(j),
          levels_(request.levels[j]),
          places_(static_cast<std::uint64_t>(request.count("grid"))),
          endless_(j < request.factors.size() && request.factors[j].endless()) {
        if (levels_ == 1)
            throw std::invalid_argument(name_of(request, j) +
                                        " has one level, so no trajectory moves it: give it under \"fixed\"");
        own_ = levels_ > 0 && places_ % levels_ != 0;
        if (own_) places_ = levels_;
    }

    /// The first place on trajectory t; `generator`: of all factors of the trajectory, one after the other.
    [[nodiscard]] std::uint64_t begin(std::uint64_t t, stats::Generator& generator) const {
        if (!own_) return generator.below(places_);
        const auto key = draw_key(seed_, DrawPurpose::morris, t / places_, 2, factor_);
        return stats::permutation(static_cast<std::uint32_t>(places_), stats::Generator(key))[t % places_];
    }
    [[nodiscard]] std::uint64_t moved(std::uint64_t place, std::uint64_t t) const {
        const std::uint64_t step = places_ / 2;
        if (places_ % 2 == 1 && place == step)
            return stats::Generator(draw_key(seed_, DrawPurpose::morris, t, 3, factor_)).below(2) == 0 ? 0
                                                                                                       : places_ - 1;
        return place < step ? place + step : place - step;
    }
    [[nodiscard]] double coordinate(std::uint64_t place) const {
        if (endless_) return (static_cast<double>(place) + 0.5) / static_cast<double>(places_);
        return static_cast<double>(place) / static_cast<double>(places_ - 1);
    }
    /// The level at a place, or the place of a continuous factor.
    [[nodiscard]] std::uint64_t level(std::uint64_t place) const {
        return levels_ == 0 ? place : place / (places_ / levels_);
    }
    [[nodiscard]] std::size_t levels() const { return levels_; }

private:
    std::uint64_t seed_, factor_;
    std::size_t levels_;
    std::uint64_t places_;
    bool endless_;
    bool own_ = false;  ///< its grid is its levels
};

/// Places of every factor along trajectory t, one row per point.
std::vector<std::vector<std::uint64_t>> trajectory(const std::vector<Axis>& axes, const DesignRequest& request,
                                                   std::uint64_t t) {
    stats::Generator generator(draw_key(request.seed, DrawPurpose::morris, t, 0));
    std::vector<std::uint64_t> places;
    for (const auto& axis : axes) places.push_back(axis.begin(t, generator));
    const stats::Generator shuffler(draw_key(request.seed, DrawPurpose::morris, t, 1));
    std::vector<std::vector<std::uint64_t>> points = {places};
    for (const auto group : stats::permutation(static_cast<std::uint32_t>(request.group_count()), shuffler)) {
        for (std::size_t j = 0; j < axes.size(); ++j)
            if (request.group(j) == group) places[j] = axes[j].moved(places[j], t);
        points.push_back(places);
    }
    return points;
}

/// Throws where the trajectories miss a level, and says how many do not.
void check_levels(const DesignRequest& request, const std::vector<Axis>& axes) {
    const auto trajectories = static_cast<std::uint64_t>(request.count("trajectories"));
    std::vector<std::set<std::uint64_t>> met(axes.size());
    std::string missed;
    const auto first_missed = [&]() -> std::string {
        for (std::size_t j = 0; j < axes.size(); ++j)
            if (met[j].size() < axes[j].levels())
                return std::to_string(met[j].size()) + " of the " + std::to_string(axes[j].levels()) + " levels of " +
                       name_of(request, j);
        return {};
    };
    for (std::uint64_t t = 0;; ++t) {
        if (t == trajectories) missed = first_missed();
        if (t >= trajectories && first_missed().empty()) {
            if (missed.empty()) return;
            throw std::invalid_argument("trajectories: " + std::to_string(trajectories) + " of them run only " +
                                        missed + "; " + std::to_string(t) + " or more run every level");
        }
        for (const auto& point : trajectory(axes, request, t))
            for (std::size_t j = 0; j < axes.size(); ++j)
                if (axes[j].levels() > 0) met[j].insert(axes[j].level(point[j]));
        if (t < trajectories && first_missed().empty()) return;
    }
}

PointSet morris_points(const DesignRequest& request) {
    const std::int64_t trajectories = request.count("trajectories");
    const std::int64_t grid = request.count("grid");
    if (grid % 2 != 0)
        throw std::invalid_argument("a Morris grid has an even number of levels, not " + std::to_string(grid));
    const std::size_t d = request.dimensions();
    const std::size_t length = trajectory_length(request.group_count());
    PointSet set{.dimensions = d,
                 .sequences = length,
                 .coordinates = room_for(trajectories * static_cast<std::int64_t>(length), d)};
    std::vector<Axis> axes;
    for (std::size_t j = 0; j < d; ++j) axes.emplace_back(request, j);
    check_levels(request, axes);
    auto coordinate = set.coordinates.begin();
    for (std::size_t t = 0; t < static_cast<std::size_t>(trajectories); ++t)
        for (const auto& point : trajectory(axes, request, t))
            for (std::size_t j = 0; j < d; ++j) *coordinate++ = axes[j].coordinate(point[j]);
    return set;
}

}  // namespace

DesignInfo morris_design() {
    return {
        .name = "morris",
        .summary =
            "Screening of many factors with few cases: trajectories x (factors + 1) cases, groups counted as factors, "
            "tell which factors matter "
            "(mu*) and which act non-linearly or jointly (sigma). For shares of the variance use halton or saltelli.",
        .other_names = {"elementary_effects", "screening"},
        .options = {{count_field("trajectories", 1, 1e6, "",
                                 "number of trajectories, 10 to 50 as a rule; each costs factors + 1 cases"),
                     true},
                    {count_field("grid", 2, 1000, "4",
                                 "places per continuous factor, even; a factor with levels has these for its grid")}},
        .extends = true,
        .purpose = Purpose::morris,
        .size = morris_size,
        .block = trajectory_length,
        .sample = morris_points};
}

}  // namespace grainsweep::designs
