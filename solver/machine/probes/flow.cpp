// What has passed through a plane, or a part of it, since the probe first looked: net, by centres, positive along the
// normal. A particle that is gone when the probe looks again has passed if free flight from where it was last carried
// it through. Where the domain is periodic across the plane, a particle is taken to have gone the shorter way.
#include "solver/machine/probes/probes.hpp"
#include "solver/machine/selection.hpp"

#include <cmath>

namespace grainsweep::machine::probes {
namespace {

using geometry::dot;
using geometry::operator-;

template <bool by_mass>
class FlowProbe final : public machine::Probe {
public:
    explicit FlowProbe(const Options& options)
        : selection_(options), point_(options.vector("point")), normal_(options.vector("normal")) {}

    double look(const Sight& sight) override {
        if (seen_.size() < sight.species.size()) seen_.resize(sight.species.size());
        const double period = period_of(sight.domain);
        std::vector<char> here(seen_.size(), 0);
        for (std::size_t i = 0; i < sight.size(); ++i) {
            const std::size_t id = sight.id(i);
            here[id] = 1;
            const double s = dot(sight.state.position[i] - point_, normal_);
            Seen& seen = seen_[id];
            if (seen.there != 0 && selection_.holds(sight, i))
                passed_ += crossings(seen.s, s, period) * amount(sight, i);
            seen = {1, s, dot(sight.state.velocity[i], normal_),
                    selection_.species_counts(sight, i) ? amount(sight, i) : 0};
        }
        for (std::size_t id = 0; id < seen_.size(); ++id) {
            if (here[id] != 0 || seen_[id].there == 0) continue;
            const double t = sight.time - time_;
            const double s = seen_[id].s + seen_[id].v * t + dot(sight.gravity, normal_) * t * t / 2;
            passed_ += crossings(seen_[id].s, s, 0) * seen_[id].amount;
            seen_[id].there = 0;
        }
        time_ = sight.time;
        return passed_;
    }

    void save(ByteWriter& out) const override {
        out.put(passed_);
        out.put(time_);
        out.put(seen_);
    }
    void restore(ByteReader& in) override {
        in.get(passed_);
        in.get(time_);
        in.get(seen_);
    }

private:
    /// A particle as it was last.
    struct Seen {
        std::int64_t there = 0;
        double s = 0, v = 0;  // along the normal, m and m/s
        double amount = 0;
    };

    static double amount(const Sight& sight, std::size_t i) { return by_mass ? sight.mass(i) : 1; }
    /// Net times through the plane, or one of its images, on the way from s to the next one.
    static double crossings(double from, double to, double period) {
        if (!(period > 0)) return (to >= 0 ? 1 : 0) - (from >= 0 ? 1 : 0);
        const double way = to - from - period * std::round((to - from) / period);
        return std::floor((from + way) / period) - std::floor(from / period);
    }
    /// Of a plane across a periodic axis; 0: none.
    [[nodiscard]] double period_of(const geometry::Domain& domain) const {
        for (std::size_t k = 0; k < 3; ++k)
            if (domain.periodic[k] && std::abs(normal_[k]) == 1) return domain.length(k);
        return 0;
    }

    Selection selection_;
    Vec3 point_, normal_;
    double passed_ = 0, time_ = 0;
    std::vector<Seen> seen_;  // by id
};

constexpr std::array flow_options = {
    of_option,
    OptionSpec{"in", OptionSpec::Kind::region, "", "the part of the plane: where the centre is just behind it"},
    OptionSpec{"point", OptionSpec::Kind::vector, "m", "a point of the plane", true},
    OptionSpec{"normal", OptionSpec::Kind::direction, "", "the direction that counts positive", true}};

template <bool by_mass>
std::unique_ptr<machine::Probe> make_flow(const Options& given) {
    return std::make_unique<FlowProbe<by_mass>>(given);
}

}  // namespace

const ProbeInfo flow_mass{"passed_mass", "kg", "mass that has passed through a plane; its slope is the mass flow",
                          flow_options, make_flow<true>};
const ProbeInfo flow_number{"passed_number", "1", "particles that have passed through a plane", flow_options,
                            make_flow<false>};

}  // namespace grainsweep::machine::probes
