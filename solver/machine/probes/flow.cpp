// What has passed through a plane, or a part of it, since the probe first looked: net, by centres, positive along the
// normal. A particle that is gone when the probe looks again has passed if its last known velocity carried it through.
#include "solver/machine/probes/probes.hpp"
#include "solver/machine/selection.hpp"

namespace grainsweep::machine::probes {
namespace {

using geometry::dot;
using geometry::operator-;
using geometry::operator+;
using geometry::operator*;

template <bool by_mass>
class FlowProbe final : public machine::Probe {
public:
    explicit FlowProbe(const Options& options)
        : selection_(options), point_(options.vector("point")), normal_(options.vector("normal")) {}

    double look(const Sight& sight) override {
        if (side_.size() < sight.species.size()) side_.resize(sight.species.size(), unseen);
        amount_.resize(side_.size(), 0.0);
        heads_through_.resize(side_.size(), 0);
        std::vector<char> here(side_.size(), 0);
        for (std::size_t i = 0; i < sight.size(); ++i) {
            const std::size_t id = sight.id(i);
            here[id] = 1;
            const double s = dot(sight.state.position[i] - point_, normal_);
            const char now = s >= 0 ? beyond : before;
            if (side_[id] != unseen && side_[id] != now && selection_.holds(sight, i))
                passed_ += (now == beyond ? 1 : -1) * amount(sight, i);
            if (!sight.state.mobile[i]) continue;
            side_[id] = now;
            amount_[id] = selection_.species_counts(sight, i) ? amount(sight, i) : 0;
            const double v = dot(sight.state.velocity[i], normal_);
            heads_through_[id] = (now == before && v > 0) || (now == beyond && v < 0);
        }
        for (std::size_t id = 0; id < side_.size(); ++id) {
            if (here[id] != 0 || side_[id] == unseen || side_[id] == gone) continue;
            if (heads_through_[id]) passed_ += (side_[id] == before ? 1 : -1) * amount_[id];
            side_[id] = gone;
        }
        return passed_;
    }

    void save(ByteWriter& out) const override {
        out.put(passed_);
        out.put(side_);
        out.put(amount_);
        out.put(heads_through_);
    }
    void restore(ByteReader& in) override {
        in.get(passed_);
        in.get(side_);
        in.get(amount_);
        in.get(heads_through_);
    }

private:
    static constexpr char unseen = 0, before = 1, beyond = 2, gone = 3;
    static double amount(const Sight& sight, std::size_t i) { return by_mass ? sight.mass(i) : 1; }

    Selection selection_;
    Vec3 point_, normal_;
    double passed_ = 0;
    std::vector<char> side_, heads_through_;  // by id
    std::vector<double> amount_;
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
