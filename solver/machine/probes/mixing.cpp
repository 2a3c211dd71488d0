// How well species are mixed: the Lacey index, and the share of a species in a region.
//
// Lacey (1954), by volume in cubic cells, for spheres of several sizes. With the solid volume V_c and the share p_c of
// the first species in a cell, and the share P in the whole bed,
//
//     s^2 = sum V_c (p_c - P)^2/sum V_c      s0^2 = P (1 - P)      sr^2 = P (1 - P) (P v_B + (1 - P) v_A)/mean V_c
//     M = (s0^2 - s^2)/(s0^2 - sr^2),        v_s = sum v^2/sum v over the spheres of a species
//
// over the cells that hold at least a fifth of their volume. 0: apart, 1: mixed as by chance. Undefined for fewer than
// two cells, and where cells have fewer than two grains on average.
#include "solver/machine/probe.hpp"
#include "solver/machine/selection.hpp"

#include <cmath>
#include <cstdint>
#include <map>

namespace grainsweep::machine::probes {
namespace {

/// By chance alone cells of two grains scatter by half of what separate powders do; cells of one are always apart.
constexpr double most_by_chance = 0.5;

struct LaceyCell {
    double first = 0, all = 0;
};

class Lacey final : public machine::Probe {
public:
    explicit Lacey(const Options& options)
        : of_(options.numbers("of")),
          in_(options.region("in")),
          cell_(options.number("cell")),
          origin_(options.vector("origin", {})),
          least_(options.number("least", 0.2)) {}

    double look(const Frame& frame) override {
        std::map<std::array<std::int64_t, 3>, LaceyCell> cells;
        std::array<double, 2> volume{}, squares{};
        const auto here = now(in_);
        for (std::size_t i = 0; i < frame.size(); ++i) {
            const std::size_t species = frame.species_of(i);
            if (frame.state.mobile[i] == 0 || (species != of_[0] && species != of_[1])) continue;
            if (here && !here->contains(frame.state.position[i])) continue;
            const double v = frame.volume(i);
            const std::size_t which = species == of_[0] ? 0 : 1;
            volume[which] += v;
            squares[which] += v * v;
            std::array<std::int64_t, 3> at{};
            for (std::size_t k = 0; k < 3; ++k)
                at[k] = static_cast<std::int64_t>(std::floor((frame.state.position[i][k] - origin_[k]) / cell_));
            LaceyCell& cell = cells[at];
            cell.all += v;
            if (which == 0) cell.first += v;
        }
        return index(cells, volume, squares);
    }

private:
    double index(const std::map<std::array<std::int64_t, 3>, LaceyCell>& cells, const std::array<double, 2>& volume,
                 const std::array<double, 2>& squares) const {
        if (!(volume[0] > 0 && volume[1] > 0)) return undefined;
        const double share = volume[0] / (volume[0] + volume[1]);
        double solid = 0, variance = 0, count = 0;
        for (const auto& [at, cell] : cells) {
            if (cell.all < least_ * cell_ * cell_ * cell_) continue;
            const double off = cell.first / cell.all - share;
            solid += cell.all;
            variance += cell.all * off * off;
            ++count;
        }
        if (count < 2) return undefined;  // one cell has the shares of the bed
        const double apart = share * (1 - share);
        const double mixed =
            apart * (share * squares[1] / volume[1] + (1 - share) * squares[0] / volume[0]) / (solid / count);
        if (!(mixed < most_by_chance * apart)) return undefined;
        return (apart - variance / solid) / (apart - mixed);
    }

    std::vector<std::size_t> of_;
    std::optional<Region> in_;
    double cell_;
    Vec3 origin_;
    double least_;
};

class MassShare final : public machine::Probe {
public:
    explicit MassShare(const Options& options) : of_(options), in_(options.region("in")) {}
    double look(const Frame& frame) override {
        double of_species = 0, all = 0;
        const auto here = now(in_);
        for (std::size_t i = 0; i < frame.size(); ++i) {
            if (frame.state.mobile[i] == 0 || (here && !here->contains(frame.state.position[i]))) continue;
            all += frame.mass(i);
            if (of_.holds(frame, i)) of_species += frame.mass(i);
        }
        return all > 0 ? of_species / all : undefined;
    }

private:
    Selection of_;
    std::optional<Region> in_;
};

std::string flaw_of_lacey(const Options& given) {
    return given.numbers("of").size() == 2 ? "" : "a Lacey index is of two species: \"of\": [\"a\", \"b\"]";
}

constexpr std::array lacey_options = {
    option("of", Field::Kind::species, "", "the two species", true), in_option,
    option("cell", Field::Kind::quantity, "m", "side of the cubic cells: three to five particles", true, {1e-6, 1e3}),
    option("origin", Field::Kind::vector, "m", "a corner of a cell; default: the origin"),
    option("least", Field::Kind::quantity, "1", "solid share of a cell's volume from which on it counts; default: 0.2",
           false, {0, 1})};
constexpr std::array share_options = {option("of", Field::Kind::species, "", "the species whose share it is", true),
                                      in_option};

}  // namespace

ProbeInfo lacey() {
    return probe_row<Lacey>("lacey", "1", "Lacey index of two species: 0 apart, 1 mixed as by chance", lacey_options,
                            {.flaw = flaw_of_lacey});
}
ProbeInfo mass_share() {
    return probe_row<MassShare>("mass_share", "1", "mass of some species divided by that of all, in a region",
                                share_options);
}

}  // namespace grainsweep::machine::probes
