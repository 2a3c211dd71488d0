// Full factorial lattice: every combination of levels, the last factor fastest.
//
// Coordinates of level i of k: i/(k-1) (endpoints; 1/2 where k = 1) or (i + 1/2)/k (centred). A factor that
// declares its levels takes those: (i + 1/2)/k, which its map floor(k u) turns into level i exactly.
#include "sweep/designs/kinds.hpp"

#include <array>
#include <stdexcept>

namespace grainsweep::designs {
namespace {

std::string factor_label(std::size_t j) {
    return "factor " + std::to_string(j + 1);
}

/// Levels asked for each factor: its own where it declares some, else the option's.
std::vector<std::int64_t> levels_of(const DesignRequest& request) {
    const auto found = request.options.find("levels");
    std::vector<std::int64_t> asked;
    bool one_for_all = false;
    if (found != request.options.end()) {
        if (const auto* one = std::get_if<std::int64_t>(&found->second)) {
            asked = {*one};
            one_for_all = true;
        } else if (const auto* each = std::get_if<std::vector<std::int64_t>>(&found->second)) {
            asked = *each;
        } else {
            throw std::invalid_argument("levels is one whole number, or a list of one per factor");
        }
    }
    const std::size_t d = request.dimensions();
    if (!one_for_all && !asked.empty() && asked.size() != d)
        throw std::invalid_argument("levels lists " + std::to_string(asked.size()) + " numbers; there are " +
                                    std::to_string(d) + " factors");
    std::vector<std::int64_t> levels(d);
    for (std::size_t j = 0; j < d; ++j) {
        const auto declared = static_cast<std::int64_t>(request.levels[j]);
        const std::int64_t wanted = asked.empty() ? 0 : asked[one_for_all ? 0 : j];
        if (declared != 0 && !one_for_all && wanted != 0 && wanted != declared)
            throw std::invalid_argument(factor_label(j) + " declares " + std::to_string(declared) +
                                        " levels of its own; the lattice cannot give it " + std::to_string(wanted));
        levels[j] = declared != 0 ? declared : wanted;
        if (levels[j] < 1)
            throw std::invalid_argument("a lattice needs a number of levels, at least 1, for " + factor_label(j) +
                                        ", which varies between two values");
    }
    return levels;
}

std::int64_t product_of(const std::vector<std::int64_t>& levels) {
    constexpr std::int64_t most = 100'000'000;
    std::int64_t points = 1;
    for (const std::int64_t k : levels) {
        if (points > most / k) throw std::invalid_argument("the lattice has more than 100000000 points");
        points *= k;
    }
    return points;
}

double coordinate(std::int64_t i, std::int64_t k, bool endpoints) {
    if (endpoints) return k == 1 ? 0.5 : static_cast<double>(i) / static_cast<double>(k - 1);
    return (static_cast<double>(i) + 0.5) / static_cast<double>(k);
}

std::int64_t lattice_size(const DesignRequest& request) {
    return product_of(levels_of(request));
}

PointSet lattice_points(const DesignRequest& request) {
    const std::size_t d = request.dimensions();
    const auto levels = levels_of(request);
    const std::int64_t points = product_of(levels);
    const bool endpoints = request.word("placement") == "endpoints";
    PointSet set{.dimensions = d, .sequences = 1, .coordinates = room_for(points, d)};
    for (std::int64_t p = 0; p < points; ++p) {
        std::int64_t rest = p;
        for (std::size_t j = d; j-- > 0;) {
            const bool declared = request.levels[j] != 0;
            set.coordinates[static_cast<std::size_t>(p) * d + j] =
                coordinate(rest % levels[j], levels[j], endpoints && !declared);
            rest /= levels[j];
        }
    }
    return set;
}

}  // namespace

DesignInfo lattice_design() {
    constexpr Interval level_counts{1, 1e6};
    static constexpr auto placements = std::to_array<std::string_view>({"endpoints", "centred"});
    return {.name = "lattice",
            .summary =
                "Every combination of levels, the last factor fastest: for maps, figures and factors that are "
                "words. Points grow as levels^factors, and with placement 'endpoints' the spread of an evenly "
                "varied factor comes out too large by sqrt((k+1)/(k-1)): 10.6 % at k = 10 levels; for "
                "statistics take 'centred', or better a halton design.",
            .other_names = {"full_factorial", "factorial", "fullfact", "grid", "cartesian", "mesh"},
            .options = {{{"levels", Field::Kind::value,
                          "one number for all factors, or one per factor; not needed where every factor declares its "
                          "levels",
                          "", level_counts},
                         true},
                        {{"placement", Field::Kind::word,
                          "endpoints: i/(k-1), the ends of the range included; centred: (i + 1/2)/k, the middles of k "
                          "equal cells",
                          R"("endpoints")", any_number, placements}}},
            .beginning = Beginning::corner,
            .size = lattice_size,
            .sample = lattice_points};
}

}  // namespace grainsweep::designs
